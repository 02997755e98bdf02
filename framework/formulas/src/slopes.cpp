// SPDX-License-Identifier: GPL-3.0-or-later
// Slopes S with F(x) - F(h) ∈ S (x - h): at parts with one operand the chords from h to the ends
// bound those to all points between them where the part is convex or concave [Neumaier1990].
#include "cordon/core/error.hpp"
#include "cordon/formulas/evaluator.hpp"
#include "operations.hpp"

namespace cordon::formulas {

namespace {

/// (φ(end) - φ(t)) / (end - t) for all t of `at`; the real line where end - t may be 0.
Interval chord(const Node& node, double end, Interval at, Interval value_at, Rounding rounding) {
  const Interval difference = point(end) - at;
  if (difference.contains(0) || !std::isfinite(end)) return real_line;
  const Interval rise = range_of(node, point(end), {0, 0}, rounding) - value_at;
  return rise.is_finite() ? rise / difference : real_line;
}

/// (φ(x) - φ(t)) / (x - t) for x ∈ a and t ∈ at, of a part with one operand.
Interval slope_of(const Node& node, Interval a, Interval at, Interval value, Interval value_at,
                  Rounding rounding) {
  if (!value_at.is_finite()) return real_line;
  if (node.operation == Operation::square_root)
    return elementary::reciprocal_of_positive(value + value_at);
  const Interval derivative = first_derivative(node, a, value, rounding),
                 bend = second_derivative(node, a, value, rounding);
  const bool is_convex = bend.lower >= 0 || node.operation == Operation::absolute_value,
             is_concave = bend.upper <= 0;
  if (is_convex == is_concave) return derivative;
  const Interval low = chord(node, is_convex ? a.lower : a.upper, at, value_at, rounding),
                 high = chord(node, is_convex ? a.upper : a.lower, at, value_at, rounding);
  return intersection(derivative, {low.lower, high.upper});
}

}  // namespace

void Evaluator::take_slopes(std::span<const Interval> center) {
  other_values_.resize(values_.size());
  values_.swap(other_values_);
  violations_.swap(other_violations_);
  evaluate(center);
  values_.swap(other_values_);
  violations_.swap(other_violations_);
  const std::vector<Interval>& at_center = other_values_;
  const auto& tape = function_->tape();
  const auto& entries = function_->gradients();
  const auto s = [&](int entry) {
    return entry < 0 ? Interval{0, 0} : gradients_[static_cast<std::size_t>(entry)];
  };
  for (int place = 0; place < static_cast<int>(tape.size()); ++place) {
    const auto here = static_cast<std::size_t>(place);
    const Node& node = tape[here].node;
    const int begin = tape[here].gradient, end = function_->gradient_end(place);
    if (begin == end || node.operation == Operation::variable) continue;
    const auto of = [&](const std::vector<Interval>& values, int operand) {
      return operand < 0 ? Interval{0, 0} : values[static_cast<std::size_t>(operand)];
    };
    const Interval a = of(values_, node.a), b = of(values_, node.b), a_at = of(at_center, node.a);
    const bool is_product = node.operation == Operation::multiply;
    const Interval slope = node.b >= 0 ? one
                                       : slope_of(node, within_domain(node, a), a_at, values_[here],
                                                  at_center[here], rounding_);
    const bool first = node.operation == Operation::minimum ? a.upper < b.lower : a.lower > b.upper,
               second =
                   node.operation == Operation::minimum ? b.upper < a.lower : b.lower > a.upper;
    for (int entry = begin; entry < end; ++entry) {
      const Function::GradientEntry& e = entries[static_cast<std::size_t>(entry)];
      Interval& made = gradients_[static_cast<std::size_t>(entry)];
      if (is_product) {
        made = s(e.a) * b + a_at * s(e.b);
      } else if (node.operation == Operation::add) {
        made = s(e.a) + s(e.b);
      } else if (node.operation == Operation::subtract) {
        made = s(e.a) - s(e.b);
      } else if (node.b >= 0) {
        made = first ? s(e.a) : second ? s(e.b) : hull(s(e.a), s(e.b));
      } else {
        made = slope * s(e.a);
      }
    }
  }
}

}  // namespace cordon::formulas
