// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/json_cursor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t shown_entries = 3;  // wrong entries of one list that are reported one by one

std::string number_text(double x) {
  std::string text = std::to_string(static_cast<std::int64_t>(x));
  return text;
}

/// U+0000 … U+001F, U+007F … U+009F: what a terminal would act on, and what would break a line of a
/// table. The text is UTF-8.
bool holds_control_characters(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool wide =
        byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (byte < 0x20 || byte == 0x7F || wide) return true;
  }
  return false;
}

/// Reads the entries of a list of numbers into `out`; reports the first wrong ones and the number
/// of the others.
template <class Entry, class Out>
bool read_entries(const Cursor& list, Entry&& entry, Out&& out) {
  std::size_t wrong = 0;
  const auto& items = list.value().items();
  for (std::size_t j = 0; j < items.size(); ++j) {
    const std::optional<double> x = entry(items[j]);
    if (x) {
      out(j, *x);
    } else if (++wrong <= shown_entries) {
      list.item(j).expect(Kind::number, "");
    }
  }
  if (wrong > shown_entries)
    list.error("holds " + std::to_string(wrong - shown_entries) +
               " more entries that are not numbers");
  return wrong == 0;
}

std::optional<double> finite_entry(const Value& value) {
  return value.kind == Kind::number ? std::optional<double>(value.number) : std::nullopt;
}

bool is_moderate(std::size_t rows, std::size_t cols) {
  const auto limit = static_cast<std::size_t>(max_entries);
  return rows <= limit && cols <= limit && rows * std::max<std::size_t>(cols, 1) <= limit;
}

/// Puts one entry, [row, column, number], into A; reports what is wrong with it.
bool read_sparse_entry(const Cursor& at, Matrix& A, std::vector<bool>& taken) {
  if (!at.expect(Kind::array, "an entry is [row, column, number], counted from 1")) return false;
  if (at.size() != 3) {
    at.error("has " + counted(static_cast<Index>(at.size()), "number") + ", must have 3",
             "an entry is [row, column, number], counted from 1");
    return false;
  }
  const auto row = read_integer(at.item(0), 1, static_cast<double>(A.rows()));
  const auto column = read_integer(at.item(1), 1, static_cast<double>(A.cols()));
  const auto number = read_number(at.item(2));
  if (!row || !column || !number) return false;
  const auto place = static_cast<std::size_t>((*row - 1) * A.cols() + *column - 1);
  if (taken[place]) {
    at.error(
        "repeats the entry in row " + std::to_string(*row) + ", column " + std::to_string(*column),
        "name each entry once; entries are not added up");
    return false;
  }
  taken[place] = true;
  A(*row - 1, *column - 1) = *number;
  return true;
}

std::optional<Matrix> read_sparse_matrix(const Cursor& at) {
  const std::string form =
      "the sparse form is {\"rows\": 2, \"cols\": 3, \"entries\": [[1, 3, 0.5]]}";
  at.expect_keys({"rows", "cols", "entries"}, "key of a sparse matrix", "");
  const auto rows_at = at.need("rows", form), cols_at = at.need("cols", form),
             entries = at.need("entries", form);
  const auto limit = static_cast<double>(max_entries);
  const Index rows = rows_at ? read_integer(*rows_at, 0, limit).value_or(-1) : -1;
  const Index cols = cols_at ? read_integer(*cols_at, 0, limit).value_or(-1) : -1;
  if (rows < 0 || cols < 0 || !entries || !entries->expect(Kind::array, form)) return std::nullopt;
  if (!is_moderate(static_cast<std::size_t>(rows), static_cast<std::size_t>(cols))) {
    at.error("has more than " + std::to_string(max_entries) + " entries, those that are 0 counted");
    return std::nullopt;
  }
  if (rows * cols == 0 && entries->size() > 0) {
    entries->error("holds entries of a matrix that is " + shape(rows, cols), form);
    return std::nullopt;
  }
  Matrix A = Matrix::Zero(rows, cols);
  std::vector<bool> taken(static_cast<std::size_t>(A.size()));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < entries->size() && wrong < shown_entries; ++i) {
    if (!read_sparse_entry(entries->item(i), A, taken)) ++wrong;
  }
  return wrong == 0 ? std::optional<Matrix>(std::move(A)) : std::nullopt;
}

std::optional<double> bound_entry(const Value& value) {
  if (value.kind == Kind::text && value.text() == "inf") return infinity;
  if (value.kind == Kind::text && value.text() == "-inf") return -infinity;
  return finite_entry(value);
}

}  // namespace

std::optional<Cursor> Cursor::find(std::string_view key) const {
  const Value* found = value_->find(key);
  return found ? std::optional<Cursor>(Cursor(*found, child(pointer_, key), *problems_))
               : std::nullopt;
}

std::optional<Cursor> Cursor::need(std::string_view key, const std::string& suggestion) const {
  std::optional<Cursor> found = find(key);
  if (!found) problems_->add(child(pointer_, key), value_->line, "is missing", suggestion);
  return found;
}

void Cursor::error(std::string message, std::string suggestion) const {
  problems_->add(pointer_, value_->line, std::move(message), std::move(suggestion));
}

bool Cursor::expect(Kind kind, const std::string& suggestion) const {
  if (is(kind)) return true;
  if (is(Kind::broken)) {
    problems_->pass_over();
  } else {
    std::string hint = suggestion;
    if (hint.empty() && is(Kind::text) && kind == Kind::number)
      hint = "write the number without quotes";
    error(
        "is " + std::string(kind_name(value_->kind)) + ", must be " + std::string(kind_name(kind)),
        std::move(hint));
  }
  return false;
}

bool Cursor::expect_keys(const std::vector<std::string>& keys, const std::string& noun,
                         const std::string& suggestion) const {
  if (!expect(Kind::object, suggestion)) return false;
  for (std::size_t i = 0; i < size(); ++i) {
    const std::string& key = value_->keys()[i];
    if (key == "$comment" || key == "$schema" ||
        std::find(keys.begin(), keys.end(), key) != keys.end())
      continue;
    problems_->add_unknown(child(pointer_, key), value_->items()[i].line, "unknown " + noun,
                           suggest(key, keys));
  }
  return true;
}

std::optional<double> read_number(const Cursor& at) {
  return at.expect(Kind::number, "") ? std::optional<double>(at.value().number) : std::nullopt;
}

std::optional<std::int64_t> read_integer(const Cursor& at, double lowest, double highest) {
  const std::optional<double> x = read_number(at);
  if (!x) return std::nullopt;
  const double low = std::max(lowest, -max_integer), high = std::min(highest, max_integer);
  if (*x != std::floor(*x)) {
    at.error("must be an integer", "the next ones are " +
                                       number_text(std::clamp(std::floor(*x), low, high)) +
                                       " and " + number_text(std::clamp(std::ceil(*x), low, high)));
    return std::nullopt;
  }
  if (*x < low || *x > high) {
    at.error(*x < low ? "is too small" : "is too large",
             "must lie between " + number_text(low) + " and " + number_text(high));
    return std::nullopt;
  }
  return static_cast<std::int64_t>(*x);
}

std::optional<bool> read_flag(const Cursor& at) {
  return at.expect(Kind::boolean, "write true or false without quotes")
             ? std::optional<bool>(at.value().flag)
             : std::nullopt;
}

std::optional<std::string> read_text(const Cursor& at, std::size_t limit) {
  if (!at.expect(Kind::text, "")) return std::nullopt;
  const std::string& text = at.value().text();
  if (text.empty() || text.find('\0') != std::string::npos) {
    at.error(text.empty() ? "is an empty text" : "holds a NUL character");
    return std::nullopt;
  }
  if (text.size() > limit) {
    at.error("is longer than " + std::to_string(limit) + " bytes", "shorten it");
    return std::nullopt;
  }
  return text;
}

std::optional<std::string> read_line(const Cursor& at, std::size_t limit) {
  auto text = read_text(at, limit);
  if (!text || !holds_control_characters(*text)) return text;
  at.error("holds a control character", "write it in one line, without tabs and escape sequences");
  return std::nullopt;
}

std::optional<std::string> read_choice(const Cursor& at, const std::vector<std::string>& choices) {
  if (!at.expect(Kind::text, suggest("", choices))) return std::nullopt;
  const std::string& text = at.value().text();
  if (std::find(choices.begin(), choices.end(), text) != choices.end()) return text;
  at.error("unknown choice " + in_quotes(text), suggest(text, choices));
  return std::nullopt;
}

std::optional<Vector> read_vector(const Cursor& at, Index limit) {
  if (!at.expect(Kind::array, "write a list of numbers: [1, 2]")) return std::nullopt;
  if (static_cast<Index>(at.size()) > limit) {
    at.error("has " + std::to_string(at.size()) + " entries, at most " + std::to_string(limit) +
             " are allowed");
    return std::nullopt;
  }
  Vector x(static_cast<Index>(at.size()));
  const bool good = read_entries(
      at, finite_entry, [&](std::size_t j, double entry) { x[static_cast<Index>(j)] = entry; });
  return good ? std::optional<Vector>(std::move(x)) : std::nullopt;
}

std::optional<Vector> read_bounds(const Cursor& at) {
  if (!at.expect(Kind::array,
                 "write a list of numbers; a free coordinate has \"-inf\" and \"inf\""))
    return std::nullopt;
  if (static_cast<Index>(at.size()) > max_dimension) {
    at.error("has " + std::to_string(at.size()) + " entries, at most " +
             std::to_string(max_dimension) + " are allowed");
    return std::nullopt;
  }
  Vector x(static_cast<Index>(at.size()));
  bool good = true;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    if (const auto entry = bound_entry(item.value())) {
      x[static_cast<Index>(i)] = *entry;
      continue;
    }
    good = false;
    item.expect(Kind::number, "a bound is a number without quotes, or \"inf\" or \"-inf\"");
  }
  return good ? std::optional<Vector>(std::move(x)) : std::nullopt;
}

std::optional<Matrix> read_matrix(const Cursor& at) {
  const std::string form = "a matrix is a list of rows: [[1, 2], [3, 4]]";
  if (is_sparse_matrix(at.value())) return read_sparse_matrix(at);
  if (!at.expect(Kind::array, form)) return std::nullopt;
  const auto& rows = at.value().items();
  if (rows.empty()) return Matrix(0, 0);
  const std::size_t cols = rows.front().items().size();
  if (!is_moderate(rows.size(), cols)) {
    at.error("has more than " + std::to_string(max_entries) + " entries");
    return std::nullopt;
  }
  Matrix A(static_cast<Index>(rows.size()), static_cast<Index>(cols));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rows.size() && wrong < shown_entries; ++i) {
    const Cursor row = at.item(i);
    if (!row.expect(Kind::array, form))
      return std::nullopt;  // the other rows are probably of the same kind
    if (row.size() != cols) {
      ++wrong;
      row.error("has " + counted(static_cast<Index>(row.size()), "number") +
                    ", the first row has " + std::to_string(cols),
                "all rows are of equal length; a decimal comma makes two numbers of one");
    } else if (!read_entries(row, finite_entry, [&](std::size_t j, double x) {
                 A(static_cast<Index>(i), static_cast<Index>(j)) = x;
               })) {
      ++wrong;
    }
  }
  return wrong == 0 ? std::optional<Matrix>(std::move(A)) : std::nullopt;
}

bool is_sparse_matrix(const Value& value) {
  if (value.kind != Kind::object || value.find("type")) return false;
  return value.find("entries") || value.find("rows") || value.find("cols");
}

Cursor entry_of(const Cursor& matrix, Index row, Index column) {
  if (!is_sparse_matrix(matrix.value())) {
    return matrix.item(static_cast<std::size_t>(row)).item(static_cast<std::size_t>(column));
  }
  const Cursor entries = *matrix.find("entries");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::vector<Value>& entry = entries.value().items()[i].items();
    if (entry[0].number == static_cast<double>(row + 1) &&
        entry[1].number == static_cast<double>(column + 1)) {
      return entries.item(i);
    }
  }
  return matrix;
}

std::optional<std::vector<std::string>> read_names(const Cursor& at, const std::string& noun) {
  if (!at.expect(Kind::array, "write a list of texts: [\"a\", \"b\"]")) return std::nullopt;
  std::vector<std::string> names;
  std::set<std::string> seen;
  bool good = true;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    const auto name = read_text(item, 4096);
    good = good && name.has_value();
    if (!name) continue;
    if (!seen.insert(*name).second) {
      item.error("repeats the " + noun + " " + in_quotes(*name), "name each " + noun + " once");
      good = false;
    }
    names.push_back(*name);
  }
  return good ? std::optional<std::vector<std::string>>(std::move(names)) : std::nullopt;
}

std::string shape(Index rows, Index cols) {
  return std::to_string(rows) + " × " + std::to_string(cols);
}

std::string counted(Index number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

namespace {

/// Is there a 0 with an integer behind it, as 0,5 would be read?
bool has_zero_before(const Vector& x) {
  for (Index i = 0; i + 1 < x.size(); ++i)
    if (x[i] == 0 && x[i + 1] > 0 && x[i + 1] == std::trunc(x[i + 1])) return true;
  return false;
}

}  // namespace

bool expect_size(const Cursor& at, const Vector& x, Index size, const std::string& like) {
  if (x.size() == size) return true;
  at.error("has " + counted(x.size(), "number") + ", must have " + std::to_string(size) + " like " +
               like,
           x.size() > size && has_zero_before(x) ? "a decimal comma? Write 0.5, not 0,5" : "");
  return false;
}

}  // namespace cordon::json
