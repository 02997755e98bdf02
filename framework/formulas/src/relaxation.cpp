// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "operations.hpp"

namespace cordon::formulas {

namespace {

/// Ranges narrower than this share of their size are constants, and so are those narrower than
/// this: products of what is made of them would underflow, and margins of proofs with them.
constexpr double narrow = 1e-14, smallest_width = 1e-150;

/// Or unbounded: nothing can be said of what follows.
bool is_narrow(Interval x) {
  const double width = x.upper - x.lower;
  return !x.is_finite() || width <= std::max(smallest_width, narrow * x.magnitude());
}

double coefficient(const AffineExpression& x, std::size_t i) {
  return i < x.coefficients.size() ? x.coefficients[i] : 0.0;
}

bool has_finite_coefficients(const AffineExpression& x) {
  return std::ranges::all_of(x.coefficients, [](double c) { return std::isfinite(c); });
}

/// ψ = φ or -φ of an operation with one operand, over an interval of it.
class Curve {
 public:
  Curve(const Node& node, Interval domain, Interval value, Rounding rounding)
      : node_(node), domain_(domain), rounding_(rounding) {
    const Interval bend = second_derivative(node, domain, value, rounding);
    is_bent_ = bend.lower >= 0 || bend.upper <= 0 || node.operation == Operation::absolute_value;
    if (bend.upper <= 0) sign_ = -1;
  }

  /// Is ψ convex, for the sign that it has?
  bool is_bent() const { return is_bent_; }
  double sign() const { return sign_; }
  const Interval& domain() const { return domain_; }

  /// The middle of the derivative, which need not be bounded.
  double slope(double t) const { return middle(derivative(point(t))); }
  double secant() const {
    const Interval rise = at(domain_.upper) - at(domain_.lower);
    return middle(rise / (point(domain_.upper) - point(domain_.lower)));
  }

  /// The larger one of ψ(t) - slope t at both ends: of a convex ψ its maximum over all t.
  double above_ends(double slope) const {
    return std::max((at(domain_.lower) - slope * point(domain_.lower)).upper,
                    (at(domain_.upper) - slope * point(domain_.upper)).upper);
  }

  /// Of the tangent at t: ψ(x) ≥ slope x + offset for convex ψ; -∞: none.
  double tangent_offset(double t, double slope) const {
    const Interval error = derivative(point(t)) - point(slope);
    if (!error.is_finite()) return -infinity;
    const Interval left_out{0, (error * (domain_ - point(t))).magnitude()};
    return (at(t) - slope * point(t) - left_out).lower;
  }

  /// Bounds of ψ(t) - slope t over the domain: the values at the ends of pieces over which it is
  /// monotone, and of small pieces over which that is not proven.
  Interval bounds(double slope) const { return bounds(slope, domain_, infinity, 0); }

 private:
  Interval at(double t) const { return values(point(t)); }
  Interval values(Interval t) const { return sign_ * range_of(node_, t, {0, 0}, rounding_); }
  Interval derivative(Interval t) const {
    return sign_ * first_derivative(node_, t, range_of(node_, t, {0, 0}, rounding_), rounding_);
  }
  /// `before`: the width of the derivative over twice the piece; where halving does not narrow it
  /// any more, rounding is all that is left.
  Interval bounds(double slope, Interval piece, double before, int halvings) const {
    const Interval rises = derivative(piece) - point(slope);
    const auto left_over = [&](double t) { return at(t) - slope * point(t); };
    if (rises.lower >= 0 || rises.upper <= 0)
      return hull(left_over(piece.lower), left_over(piece.upper));
    const double center = std::clamp(middle(piece), piece.lower, piece.upper),
                 width = rises.upper - rises.lower;
    if (halvings < sure_halvings || (halvings < most_halvings && width < 0.75 * before))
      return hull(bounds(slope, {piece.lower, center}, width, halvings + 1),
                  bounds(slope, {center, piece.upper}, width, halvings + 1));
    const Interval natural = values(piece) - slope * piece;
    if (!rises.is_finite()) return natural;
    return intersection(natural, left_over(center) + rises * (piece - point(center)));
  }

  static constexpr int sure_halvings = 3, most_halvings = 12;
  const Node& node_;
  Interval domain_;
  Rounding rounding_;
  bool is_bent_;
  double sign_ = 1;
};

}  // namespace

bool AffineExpression::is_constant() const {
  return std::ranges::all_of(coefficients, [](double c) { return c == 0; });
}

AffineExpression Relaxation::variable(Index i) const {
  AffineExpression made;
  made.coefficients.assign(as_size(i) + 1, 0.0);
  made.coefficients.back() = 1;
  return made;
}

Interval Relaxation::range(const AffineExpression& expression) const {
  Interval sum = expression.offset;
  for (std::size_t i = 0; i < expression.coefficients.size(); ++i)
    if (expression.coefficients[i] != 0) sum = sum + expression.coefficients[i] * variables_[i];
  return sum;
}

AffineExpression Relaxation::combined(Interval a, const AffineExpression& x, Interval b,
                                      const AffineExpression& y, Interval offset) const {
  AffineExpression made{{}, a * x.offset + b * y.offset + offset};
  made.coefficients.resize(std::max(x.coefficients.size(), y.coefficients.size()));
  for (std::size_t i = 0; i < made.coefficients.size(); ++i) {
    const Interval sum = a * point(coefficient(x, i)) + b * point(coefficient(y, i));
    made.coefficients[i] = middle(sum);
    if (!sum.is_point())
      made.offset = made.offset + (sum - point(made.coefficients[i])) * variables_[i];
  }
  return made;
}

AffineExpression Relaxation::scaled(Interval a, const AffineExpression& x) const {
  return combined(a, x, {0, 0}, {}, {0, 0});
}

AffineExpression Relaxation::lifted(Interval range, int node) {
  if (is_narrow(range)) return constant(range);
  variables_.push_back(range);
  lifted_.push_back(node);
  return variable(static_cast<Index>(variables_.size()) - 1);
}

void Relaxation::require(const AffineExpression& expression) {
  if (!std::isfinite(expression.offset.lower) || expression.is_constant()) return;
  if (has_finite_coefficients(expression) && range(expression).upper > 0)
    inequalities_.push_back({expression.coefficients, -expression.offset.lower});
}

/// One function's tape, part by part as rows need them.
class Relaxation::Walk {
 public:
  Walk(Relaxation& relaxation, const Evaluator& evaluator, std::span<const AffineExpression> inputs)
      : relaxation_(relaxation),
        evaluator_(evaluator),
        inputs_(inputs),
        made_(evaluator.function().tape().size()) {}

  const AffineExpression& expression(int place) {
    std::optional<AffineExpression>& made = made_[static_cast<std::size_t>(place)];
    if (made) return *made;
    AffineExpression found = make(place);
    const bool is_usable = found.offset.is_finite() && has_finite_coefficients(found);
    made = is_usable ? std::move(found) : constant(evaluator_.part(place));
    return *made;
  }

 private:
  const Node& node(int place) const {
    return evaluator_.function().tape()[static_cast<std::size_t>(place)].node;
  }
  Interval value(int place) {
    return intersected(evaluator_.part(place), relaxation_.range(expression(place)));
  }
  /// Of two enclosures of one range; rounding never leaves nothing.
  static Interval intersected(Interval a, Interval b) {
    const Interval both = intersection(a, b);
    return both.is_empty() ? a : both;
  }
  AffineExpression sum(double a, const AffineExpression& x, double b, const AffineExpression& y,
                       Interval offset = {0, 0}) const {
    return relaxation_.combined(point(a), x, point(b), y, offset);
  }

  AffineExpression lifted(int place) {
    return relaxation_.lifted(evaluator_.part(place),
                              evaluator_.function().tape()[as_size(place)].source);
  }

  AffineExpression make(int place) {
    const Node& n = node(place);
    switch (n.operation) {
      case Operation::constant:
        return constant(n.value);
      case Operation::variable:
        return inputs_[static_cast<std::size_t>(n.number)];
      case Operation::add:
        return sum(1, expression(n.a), 1, expression(n.b));
      case Operation::subtract:
        return sum(1, expression(n.a), -1, expression(n.b));
      case Operation::negate:
        return relaxation_.scaled(-one, expression(n.a));
      case Operation::multiply:
        return product(place);
      case Operation::minimum:
      case Operation::maximum:
        return larger_or_smaller(place, n.operation == Operation::maximum ? 1 : -1);
      default:
        return curve(place);
    }
  }

  AffineExpression product(int place) {
    const Node& n = node(place);
    for (const auto& [factor, other] : {std::pair(n.a, n.b), std::pair(n.b, n.a)}) {
      const Node& divisor = node(factor);
      if (divisor.operation == Operation::power && divisor.number == -1 &&
          !expression(divisor.a).is_constant())
        return quotient(place, other, divisor.a);
    }
    const AffineExpression x = expression(n.a), y = expression(n.b);
    if (x.is_constant()) return relaxation_.scaled(x.offset, y);
    if (y.is_constant()) return relaxation_.scaled(y.offset, x);
    const AffineExpression z = lifted(place);
    if (!z.is_constant()) require_product(z, x, value(n.a), y, value(n.b));
    return z;
  }

  /// z = x / y, as x = z y.
  AffineExpression quotient(int place, int numerator, int denominator) {
    const AffineExpression x = expression(numerator), y = expression(denominator);
    const AffineExpression z = lifted(place);
    if (!z.is_constant()) require_product(x, z, evaluator_.part(place), y, value(denominator));
    return z;
  }

  /// The inequalities of z = x y.
  void require_product(const AffineExpression& z, const AffineExpression& x, Interval x_range,
                       const AffineExpression& y, Interval y_range) {
    if (!x_range.is_finite() || !y_range.is_finite()) return;
    const auto above = [&](double at_x, double at_y) {  // z ≥ at_x y + at_y x - at_x at_y
      relaxation_.require(sum(-1, z, 1, sum(at_x, y, at_y, x, -(at_x * point(at_y)))));
    };
    const auto below = [&](double at_x, double at_y) {
      relaxation_.require(sum(1, z, -1, sum(at_x, y, at_y, x, -(at_x * point(at_y)))));
    };
    above(x_range.lower, y_range.lower);
    above(x_range.upper, y_range.upper);
    below(x_range.lower, y_range.upper);
    below(x_range.upper, y_range.lower);
  }

  /// sign max(sign x, sign y): not below either, and no further above y than the chord of
  /// max(d, 0) over d = sign (x - y).
  AffineExpression larger_or_smaller(int place, double sign) {
    const Node& n = node(place);
    const AffineExpression x = expression(n.a), y = expression(n.b), d = sum(sign, x, -sign, y);
    const Interval range = relaxation_.range(d);
    if (range.lower >= 0) return x;
    if (range.upper <= 0) return y;
    const AffineExpression z = lifted(place);
    if (z.is_constant() || !range.is_finite()) return z;
    relaxation_.require(sum(sign, x, -sign, z));
    relaxation_.require(sum(sign, y, -sign, z));
    const double slope = middle(point(range.upper) / (point(range.upper) - point(range.lower)));
    const double at_lower = -(slope * point(range.lower)).lower,
                 at_upper = (point(range.upper) - slope * point(range.upper)).upper;
    // sign (z - y) ≤ slope d + max over both ends of max(d, 0) - slope d
    relaxation_.require(
        sum(1, sum(sign, z, -sign, y), -slope, d, point(-std::max(at_lower, at_upper))));
    return z;
  }

  AffineExpression curve(int place) {
    const Node& n = node(place);
    const AffineExpression x = expression(n.a);
    const Interval range = within_domain(n, value(n.a)), all = evaluator_.part(place);
    if (x.is_constant() || range.is_empty() || is_narrow(range)) return constant(all);
    const AffineExpression z = lifted(place);
    if (z.is_constant()) return z;
    const Curve psi(n, range, all, evaluator_.rounding());
    psi.is_bent() ? bend(psi, z, x) : turn(psi, z, x);
    return z;
  }

  /// Below its secant, above tangents.
  void bend(const Curve& psi, const AffineExpression& z, const AffineExpression& x) {
    const double secant = psi.secant(), sign = psi.sign();
    if (std::isfinite(secant))
      relaxation_.require(sum(sign, z, -secant, x, point(-psi.above_ends(secant))));
    for (const double t : {psi.domain().lower, middle(psi.domain()), psi.domain().upper}) {
      const double slope = psi.slope(t);
      const double offset = std::isfinite(slope) ? psi.tangent_offset(t, slope) : -infinity;
      if (std::isfinite(offset)) relaxation_.require(sum(-sign, z, slope, x, point(offset)));
    }
  }

  /// Between lines of four slopes.
  void turn(const Curve& psi, const AffineExpression& z, const AffineExpression& x) {
    const Interval domain = psi.domain();
    for (const double slope : {psi.secant(), psi.slope(domain.lower), psi.slope(middle(domain)),
                               psi.slope(domain.upper)}) {
      const Interval bounds = std::isfinite(slope) ? psi.bounds(slope) : real_line;
      if (std::isfinite(bounds.upper))
        relaxation_.require(sum(1, z, -slope, x, point(-bounds.upper)));
      if (std::isfinite(bounds.lower))
        relaxation_.require(sum(-1, z, slope, x, point(bounds.lower)));
    }
  }

  Relaxation& relaxation_;
  const Evaluator& evaluator_;
  std::span<const AffineExpression> inputs_;
  std::vector<std::optional<AffineExpression>> made_;
};

std::vector<AffineExpression> Relaxation::add(const Evaluator& evaluator,
                                              std::span<const Index> rows,
                                              std::span<const AffineExpression> inputs) {
  Walk walk(*this, evaluator, inputs);
  std::vector<AffineExpression> made;
  for (const Index row : rows) made.push_back(walk.expression(evaluator.function().place(row)));
  return made;
}

}  // namespace cordon::formulas
