// SPDX-License-Identifier: GPL-3.0-or-later
// Axes: where their ticks are, and what stands beside them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cordon::report {

/// Round numbers (1, 2 or 5 times a power of ten apart) within [lower, upper], about `count` of
/// them.
std::vector<double> nice_ticks(double lower, double upper, int count, bool whole = false);

/// The same, closer where there would be fewer than three although there is room for as many.
std::vector<double> upright_ticks(double lower, double upper, int count);

/// Powers of ten within [lower, upper], with 2 and 5 between them over three decades or less; round
/// numbers where these would be fewer than three. Both bounds are positive.
std::vector<double> log_ticks(double lower, double upper);

/// "⁻³".
std::string superscript(int number);

/// A number with at most `digits` digits, with a power of ten where it is very large or small; ∞
/// and − as they are printed.
std::string short_text(double value, int digits = 6);

/// The digits, from 6 to 15, that tell values of [lower, upper] apart, also far from the origin.
int digits_within(double lower, double upper);

/// Are numbers of a logarithmic axis written with powers of ten? So they are, all of them, if a
/// tick lies outside of [0.001, 10000].
bool has_powers(double lower, double upper);

/// A number on a logarithmic axis: "0.002", or "2·10⁻³" with powers of ten, also where it is 1.
std::string log_text(double value, bool powers);

/// A value of an axis as a place in a drawing.
struct Axis {
  double lower = 0, upper = 1;
  double begin = 0, end = 1;  ///< the places of `lower` and `upper`
  bool log = false;

  /// ±∞, and what has no logarithm, lie beyond the edge.
  double operator()(double value) const;
  std::vector<double> ticks(int count, bool whole = false) const {
    return log ? log_ticks(lower, upper) : nice_ticks(lower, upper, count, whole);
  }
  std::vector<double> upright(int count) const {
    return log ? log_ticks(lower, upper) : upright_ticks(lower, upper, count);
  }
  /// A tick, or a value between the ticks.
  std::string text(double value) const {
    return log ? log_text(value, has_powers(lower, upper))
               : short_text(value, digits_within(lower, upper));
  }
};

/// An axis over the finite ones among the values (positive ones if `log`), with a margin, from
/// `begin` to `end`. An axis of positive values begins at zero where that costs little room.
Axis axis_over(const std::vector<double>& values, bool log, double begin, double end);

}  // namespace cordon::report
