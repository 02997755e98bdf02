// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "cordon/core/rounding.hpp"
#include "study/reading/read_parts.hpp"
#include "study/text/numbers.hpp"

namespace cordon::json {

namespace {

constexpr int shown_entries = 3;  // wrong entries of one matrix that are reported one by one

/// a - b, rounded up where it is not exact.
double difference_above(double a, double b) {
  const double s = a - b, part = a - s;
  const double error = (a - (s + part)) + (part - b);
  return error > 0 ? rounding::up(s) : s;
}

/// Reports every entry for which `wrong` has a message: the first ones one by one, at their places
/// in `at`.
template <class Wrong>
bool expect_entries(const Cursor& at, const Matrix& A, Wrong&& wrong,
                    const std::string& suggestion) {
  int count = 0;
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) {
      const std::string message = wrong(i, j);
      if (message.empty() || ++count > shown_entries) continue;
      entry_of(at, i, j).error(message, suggestion);
    }
  }
  if (count > shown_entries)
    at.error("holds " + std::to_string(count - shown_entries) + " more entries of this kind");
  return count == 0;
}

/// Two matrices of the same size.
bool read_pair(const Cursor& at, const char* first, const char* second, Matrix& A, Matrix& B) {
  const auto a_at =
      at.need(first, std::string("an interval matrix holds both ") + first + " and " + second);
  const auto b_at =
      at.need(second, std::string("an interval matrix holds both ") + first + " and " + second);
  auto a = a_at ? read_matrix(*a_at) : std::nullopt, b = b_at ? read_matrix(*b_at) : std::nullopt;
  if (!a || !b) return false;
  if (a->rows() != b->rows() || a->cols() != b->cols()) {
    b_at->error("is " + shape(b->rows(), b->cols()) + ", must be " + shape(a->rows(), a->cols()) +
                " like " + a_at->pointer());
    return false;
  }
  A = std::move(*a), B = std::move(*b);
  return true;
}

std::optional<IntervalMatrix> read_center_and_radius(const Cursor& at) {
  IntervalMatrix A;
  if (!read_pair(at, "center", "radius", A.center, A.radius)) return std::nullopt;
  const Cursor radius_at = *at.find("radius");
  const auto negative = [&](Index i, Index j) {
    return A.radius(i, j) < 0 ? "is negative: " + detail::to_text(A.radius(i, j)) : std::string();
  };
  if (!expect_entries(radius_at, A.radius, negative, "a radius is at least 0")) return std::nullopt;
  const auto too_large = [&](Index i, Index j) {
    const bool finite = std::isfinite(std::abs(A.center(i, j)) + A.radius(i, j));
    return finite ? std::string() : "the interval leaves the range of double";
  };
  if (!expect_entries(radius_at, A.radius, too_large, "give a smaller radius")) return std::nullopt;
  return A;
}

/// As centre and radius, which enclose what the bounds say.
std::optional<IntervalMatrix> read_lower_and_upper(const Cursor& at) {
  Matrix lower, upper;
  if (!read_pair(at, "lower", "upper", lower, upper)) return std::nullopt;
  const auto reversed = [&](Index i, Index j) {
    const double low = lower(i, j), high = upper(i, j);
    return low <= high ? std::string()
                       : "the interval is empty: " + detail::to_text(low) + " is above " +
                             detail::to_text(high);
  };
  if (!expect_entries(*at.find("lower"), lower, reversed, "exchange lower and upper"))
    return std::nullopt;
  IntervalMatrix A(lower);
  for (Index i = 0; i < lower.rows(); ++i) {
    for (Index j = 0; j < lower.cols(); ++j) {
      const double low = lower(i, j), high = upper(i, j);
      if (low == high) continue;
      const double center = A.center(i, j) = low / 2 + high / 2;
      A.radius(i, j) = std::max(difference_above(center, low), difference_above(high, center));
    }
  }
  return A;
}

}  // namespace

std::optional<IntervalMatrix> read_interval_matrix(const Cursor& at) {
  if (!at.is(Value::Kind::object) || is_sparse_matrix(at.value())) {
    auto exact = read_matrix(at);
    return exact ? std::optional(IntervalMatrix(std::move(*exact), Matrix())) : std::nullopt;
  }
  const std::string form =
      "write {\"center\": [[...]], \"radius\": [[...]]}, or {\"lower\": [[...]], \"upper\": "
      "[[...]]}";
  at.expect_keys({"center", "radius", "lower", "upper"}, "key of an interval matrix", "");
  const bool middle = at.find("center") || at.find("radius"),
             bounds = at.find("lower") || at.find("upper");
  if (middle == bounds) {
    at.error(middle ? "holds both a centre or radius and bounds"
                    : "holds neither centre and radius nor bounds",
             form);
    return std::nullopt;
  }
  return middle ? read_center_and_radius(at) : read_lower_and_upper(at);
}

}  // namespace cordon::json
