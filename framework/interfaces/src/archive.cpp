// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/archive.hpp"

#include <algorithm>
#include <cstring>

#include "cordon/interfaces/line_form_set.hpp"
#include "line_form_sets.hpp"

namespace cordon {

namespace {

/// Times that differences can be taken of.
constexpr Index latest = Index{1} << 60;
/// An empty set has any dimension in a few bytes, but its exchange form takes memory.
constexpr Index most_dimensions = Index{1} << 20;

/// A set that is its exchange form, of no plugin's backend.
void one_form(Archive& archive, SetPtr& X) {
  LineForm form = X ? X->line_form() : LineForm{};
  Rounding rounding = X ? X->backend().info().rounding : Rounding::nominal;
  archive(form);
  archive.choice(rounding, 3);
  if (!X) X = line_form_set(std::move(form), rounding, Tightness::exact).set;
}

}  // namespace

Archive::Archive(std::shared_ptr<const SetBackend> backend)
    : backend_(std::move(backend)), reading_(false) {}

Archive::Archive(std::shared_ptr<const SetBackend> backend, std::string bytes)
    : backend_(std::move(backend)), reading_(true), bytes_(std::move(bytes)) {}

Archive::~Archive() = default;

void Archive::refuse(const std::string& what) const {
  throw Error(Errc::invalid, "a saved state: " + what + " at byte " + std::to_string(at_) +
                                 "; it is not one of this component, or it is damaged");
}

void Archive::expect_end() const {
  if (reading_ && at_ != bytes_.size()) refuse("more than was expected");
}

void Archive::raw(void* data, std::size_t size) {
  if (size == 0) return;
  if (!reading_) {
    bytes_.append(static_cast<const char*>(data), size);
    return;
  }
  if (size > bytes_.size() - at_) refuse("it ends too early");
  std::memcpy(data, bytes_.data() + at_, size);
  at_ += size;
}

void Archive::tag(char type) {
  char found = type;
  raw(&found, 1);
  if (found != type) refuse("a value of another type");
}

void Archive::integer(std::int64_t& value) {
  tag('i');
  raw(&value, sizeof value);
}

std::size_t Archive::length(std::size_t size) {
  tag('n');
  auto count = static_cast<std::uint64_t>(size);
  raw(&count, sizeof count);
  if (reading_ && count > bytes_.size() - at_) refuse("a length beyond its end");
  return static_cast<std::size_t>(count);
}

void Archive::numbers(double* data, Index count) {
  raw(data, static_cast<std::size_t>(count) * sizeof(double));
}

void Archive::section(std::string_view name) {
  std::string found(name);
  one(found);
  if (found != name) refuse("\"" + std::string(name) + "\" was expected");
}

void Archive::one(bool& value) {
  tag('b');
  char byte = value ? 1 : 0;
  raw(&byte, 1);
  if (byte != 0 && byte != 1) refuse("neither true nor false");
  value = byte == 1;
}

void Archive::one(double& value) {
  tag('d');
  raw(&value, sizeof value);
}

void Archive::one(std::string& value) {
  value.resize(length(value.size()));
  raw(value.data(), value.size());
}

void Archive::one(Vector& value) {
  tag('v');
  const std::size_t size = length(static_cast<std::size_t>(value.size()));
  if (reading_ && size > (bytes_.size() - at_) / sizeof(double)) refuse("a length beyond its end");
  value.resize(static_cast<Index>(size));
  numbers(value.data(), value.size());
}

void Archive::one(Matrix& value) {
  tag('m');
  std::int64_t rows = value.rows(), cols = value.cols();
  integer(rows);
  integer(cols);
  // A shape without entries takes no bytes, but has to fit those of other matrices.
  constexpr std::int64_t most = std::int64_t{1} << 31;
  const bool is_shape = rows >= 0 && cols >= 0 && rows < most && cols < most;
  const auto left = static_cast<std::int64_t>((bytes_.size() - at_) / sizeof(double));
  if (reading_ && (!is_shape || rows * cols > left)) refuse("a shape beyond its end");
  value.resize(rows, cols);
  numbers(value.data(), value.size());
}

void Archive::same_shape(Vector& value) {
  const Index size = value.size();
  one(value);
  if (value.size() != size) refuse("a vector of another size");
}

void Archive::same_shape(Matrix& value) {
  const Index rows = value.rows(), cols = value.cols();
  one(value);
  if (value.rows() != rows || value.cols() != cols) refuse("a matrix of another shape");
}

void Archive::set(Enclosure& value, Index dimension) {
  one(value);
  if (!value.set || value->dim() != dimension) refuse("a set of another dimension");
}

void Archive::one(Box& value) {
  (*this)(value.lower, value.upper);
  if (value.lower.size() != value.upper.size()) refuse("a box of two sizes");
}

void Archive::one(LineForm& value) {
  (*this)(value.c, value.G, value.M, value.S, value.A, value.b);
  if (!reading_) return;
  try {
    check(value, "a set");
  } catch (const Error& error) {
    refuse(error.what());
  }
}

void Archive::one(Sample& value) {
  (*this)(value.k, value.u, value.y, value.missing);
  if (value.k < -latest || value.k > latest) refuse("a time that there is not");
  for (const Index i : value.missing) {
    if (i < 0 || i >= value.y.size()) refuse("an output that there is not");
  }
}

void Archive::one(Certificate& value) {
  choice(value.kind, 7);
  (*this)(value.data, value.margin);
}

void Archive::one(Contradiction& value) {
  (*this)(value.k, value.output, value.distance, value.before);
}

void Archive::one(SetPtr& value) {
  // 0: none; 1 … : one that was there before; one more: the next one.
  const auto known = std::find(sets_.begin(), sets_.end(), value);
  std::int64_t number = value ? known - sets_.begin() + 1 : 0;
  integer(number);
  const auto count = static_cast<std::int64_t>(sets_.size());
  if (number < 0 || number > count + 1) refuse("a set that there is not");
  if (number == 0) {
    value.reset();
  } else if (number <= count) {
    value = sets_[static_cast<std::size_t>(number - 1)];
  } else {
    if (reading_) value.reset();
    bool is_form = value && &value->backend() != backend_.get() && detail::is_line_form_set(*value);
    one(is_form);
    if (is_form) {
      one_form(*this, value);
    } else {
      backend_->serialize(value, *this);
    }
    if (value->dim() > most_dimensions) refuse("a set of too many dimensions");
    sets_.push_back(value);
  }
}

void Archive::one(Enclosure& value) { (*this)(value.set, value.tightness); }

}  // namespace cordon
