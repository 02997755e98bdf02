// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/interchange/mat_wire.hpp"

#include <cstring>

#include "experiments/interchange/mat_file.hpp"

namespace cordon::mat {

namespace {

void put(std::string& out, std::int64_t number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void put(std::string& out, const std::string& text) {
  put(out, static_cast<std::int64_t>(text.size()));
  out += text;
}

void put(std::string& out, const Value& value) {
  put(out, static_cast<std::int64_t>(value.kind));
  put(out, value.text);
  put(out, value.numbers.rows());
  put(out, value.numbers.cols());
  out.append(reinterpret_cast<const char*>(value.numbers.data()),
             static_cast<std::size_t>(value.numbers.size()) * sizeof(double));
  put(out, value.rows);
  put(out, value.cols);
  put(out, static_cast<std::int64_t>(value.names.size()));
  for (const std::string& name : value.names) put(out, name);
  for (const Value& item : value.items) put(out, item);
}

/// Takes values from the front of the bytes; nothing where they end too early or make no sense.
class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : rest_(bytes) {}
  bool at_end() const { return rest_.empty(); }

  std::optional<std::int64_t> count(std::int64_t limit) {
    std::int64_t number = 0;
    if (rest_.size() < sizeof number) return std::nullopt;
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return number >= 0 && number <= limit ? std::optional(number) : std::nullopt;
  }

  std::optional<std::string> text() {
    const auto size = count(static_cast<std::int64_t>(rest_.size()));
    if (!size || static_cast<std::size_t>(*size) > rest_.size()) return std::nullopt;
    std::string own(rest_.substr(0, static_cast<std::size_t>(*size)));
    rest_.remove_prefix(own.size());
    return own;
  }

  std::optional<Value> value(int depth) {
    Value value;
    const auto kind = count(static_cast<std::int64_t>(Value::Kind::refused));
    auto own = kind ? text() : std::nullopt;
    if (!own || depth > max_nesting) return std::nullopt;
    value.kind = static_cast<Value::Kind>(*kind);
    value.text = std::move(*own);
    if (!numbers(value.numbers) || !items(value, depth)) return std::nullopt;
    return value;
  }

 private:
  bool numbers(Matrix& out) {
    const auto rows = count(max_numbers), cols = rows ? count(max_numbers) : std::nullopt;
    if (!rows || !cols) return false;
    const std::int64_t size = *rows * *cols;  // below 2⁵¹
    const auto available = static_cast<std::int64_t>(rest_.size() / sizeof(double));
    if (size > available) return false;
    out.resize(*rows, *cols);
    const std::size_t bytes = static_cast<std::size_t>(size) * sizeof(double);
    if (bytes > 0) std::memcpy(out.data(), rest_.data(), bytes);
    rest_.remove_prefix(bytes);
    return true;
  }

  bool items(Value& value, int depth) {
    const auto rows = count(max_numbers), cols = rows ? count(max_numbers) : std::nullopt;
    const auto names = cols ? count(static_cast<std::int64_t>(rest_.size())) : std::nullopt;
    if (!names) return false;
    value.rows = *rows, value.cols = *cols;
    for (std::int64_t i = 0; i < *names; ++i) {
      auto name = text();
      if (!name) return false;
      value.names.push_back(std::move(*name));
    }
    const std::int64_t elements = *rows * *cols;
    const bool structs = value.is(Value::Kind::structs),
               container = structs || value.is(Value::Kind::cell);
    if (!container) return elements == 0 && *names == 0;
    if (elements > static_cast<std::int64_t>(rest_.size())) return false;  // each takes some bytes
    const std::int64_t all = structs ? elements * *names : elements;
    if (all > static_cast<std::int64_t>(rest_.size())) return false;
    for (std::int64_t i = 0; i < all; ++i) {
      auto item = this->value(depth + 1);
      if (!item) return false;
      value.items.push_back(std::move(*item));
    }
    return true;
  }

  std::string_view rest_;
};

}  // namespace

std::string to_wire(const Variables& variables) {
  std::string out;
  for (const Variable& variable : variables) {
    put(out, variable.name);
    put(out, variable.value);
  }
  return out;
}

std::optional<Variables> from_wire(std::string_view bytes) {
  WireReader reader(bytes);
  Variables variables;
  while (!reader.at_end()) {
    auto name = reader.text();
    auto value = name ? reader.value(0) : std::nullopt;
    if (!value) return std::nullopt;
    variables.push_back({std::move(*name), std::move(*value)});
  }
  return variables;
}

}  // namespace cordon::mat
