// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/box_enclosure.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "operations.hpp"

namespace cordon::formulas {

namespace {

/// The distance from `center` to both ends, rounded up.
double reach(Interval x, double center) {
  return std::max(
      {0.0, directed::plus(x.upper, -center).upper, directed::plus(center, -x.lower).upper});
}

Interval symmetric(double radius) { return {-radius, radius}; }

/// Is every derivative by w that some row has free of z?
bool has_constant_columns(const Function& function, Index first) {
  for (Index row = 0; row < function.rows(); ++row)
    for (Index w = first; w < function.differentiated(); ++w)
      if (!function.is_affine_in(row, w)) return false;
  return true;
}

}  // namespace

BoxEnclosure::BoxEnclosure(std::shared_ptr<const Function> function, Index states, AffineForm form,
                           Rounding rounding, Undefined undefined)
    : evaluator_(std::move(function), rounding, undefined),
      states_(states),
      form_(form),
      w_depends_on_x_(!has_constant_columns(this->function(), states)),
      center_(Vector::Zero(this->function().differentiated())),
      radius_(center_),
      point_(as_size(this->function().variables()), Interval{0, 0}),
      natural_(as_size(this->function().rows()), real_line),
      at_center_(natural_),
      errors_(natural_.size(), 0.0),
      reasons_(natural_.size()),
      has_slopes_(natural_.size(), false),
      remainders_(natural_.size(), Interval{0, 0}),
      bent_(natural_.size()),
      curvatures_(natural_.size()) {
  if (this->function().order() < (has_second_derivatives() ? 2 : 1) || states < 0 ||
      states > center_.size())
    throw Error(Errc::dimension, "an enclosure needs the derivatives of its form");
  std::size_t count = 0;
  for (Index row = 0; row < this->function().rows(); ++row) {
    entries_.push_back(count);
    count += evaluator_.partials(row);
  }
  gradient_.assign(count, Interval{0, 0});
  gradient_at_center_ = gradient_;
  for (Index row = 0; row < this->function().rows() && form == AffineForm::convex_differences;
       ++row)
    bent_[as_size(row)] = bent_variables(row);
}

void BoxEnclosure::set_box(std::span<const Interval> variables) {
  for (Index i = 0; i < center_.size(); ++i) {
    const Interval side = variables[as_size(i)];
    center_[i] = middle(side);
    radius_[i] = reach(side, center_[i]);
  }
  evaluator_.evaluate(variables);
  evaluator_.bound_rounding();
  for (Index row = 0; row < function().rows(); ++row) {
    const bool is_enclosed = evaluator_.is_enclosed(row);
    natural_[as_size(row)] = is_enclosed ? evaluator_.value(row) : real_line;
    errors_[as_size(row)] = evaluator_.rounding_error(row);
    if (is_enclosed) continue;
    const Violation* violation = evaluator_.violation_of(row);
    reasons_[as_size(row)] = violation ? violation->to_string(function()) : "its bounds overflow";
  }
  take_derivatives(variables);
  take_point(variables);
}

void BoxEnclosure::take_derivatives(std::span<const Interval> variables) {
  evaluator_.differentiate();
  for (Index row = 0; row < function().rows(); ++row)
    for (std::size_t e = 0; e < evaluator_.partials(row); ++e)
      gradient_[first_entry(row) + e] = evaluator_.partial(row, e).value;
  if (has_second_derivatives()) {
    evaluator_.differentiate_twice();
    for (Index row = 0; row < function().rows(); ++row) {
      remainders_[as_size(row)] = remainder(row);
      if (is_bounded_by_vertices(row)) take_curvature(row);
    }
  }
  take_slopes(variables);
  if (has_second_derivatives() || !w_depends_on_x_) return;
  std::copy(variables.begin(), variables.end(), point_.begin());
  for (Index i = 0; i < states_; ++i) point_[as_size(i)] = {center_[i], center_[i]};
  evaluator_.evaluate(point_);
  evaluator_.differentiate();
  for (Index row = 0; row < function().rows(); ++row) {
    for (std::size_t e = 0; e < evaluator_.partials(row); ++e) {
      const Evaluator::Partial partial = evaluator_.partial(row, e);
      if (partial.variable >= states_ && !has_slopes_[as_size(row)])
        gradient_[first_entry(row) + e] = partial.value;
    }
  }
}

/// In place of derivatives that are not bounded.
void BoxEnclosure::take_slopes(std::span<const Interval> variables) {
  bool any = false;
  for (Index row = 0; row < function().rows(); ++row) {
    const Form form{{0, 0}, gradient_.data() + first_entry(row)};
    has_slopes_[as_size(row)] = is_enclosed(row) && !is_bounded(row, form);
    any = any || has_slopes_[as_size(row)];
  }
  if (!any) return;
  set_center(variables);
  evaluator_.take_slopes(point_);
  for (Index row = 0; row < function().rows(); ++row)
    for (std::size_t e = 0; has_slopes_[as_size(row)] && e < evaluator_.partials(row); ++e)
      gradient_[first_entry(row) + e] = evaluator_.partial(row, e).value;
}

void BoxEnclosure::set_center(std::span<const Interval> variables) {
  std::copy(variables.begin(), variables.end(), point_.begin());
  for (Index i = 0; i < center_.size(); ++i) point_[as_size(i)] = {center_[i], center_[i]};
}

void BoxEnclosure::take_point(std::span<const Interval> variables) {
  set_center(variables);
  evaluator_.evaluate(point_);
  if (has_second_derivatives()) evaluator_.differentiate();
  for (Index row = 0; row < function().rows(); ++row) {
    at_center_[as_size(row)] = evaluator_.is_enclosed(row) ? evaluator_.value(row) : real_line;
    if (!has_second_derivatives()) continue;
    for (std::size_t e = 0; e < evaluator_.partials(row); ++e)
      gradient_at_center_[first_entry(row) + e] = evaluator_.partial(row, e).value;
  }
  for (Index row = 0; row < function().rows(); ++row)
    if (is_bounded_by_vertices(row)) take_vertices(variables, row);
}

bool BoxEnclosure::is_bounded_by_vertices(Index row) const {
  return !bent_[as_size(row)].empty() && is_enclosed(row) && remainders_[as_size(row)].is_finite();
}

std::string BoxEnclosure::why_not_enclosed(Index row) const {
  return is_enclosed(row) ? "" : reasons_[as_size(row)];
}

Interval BoxEnclosure::remainder(Index row) const {
  Interval diagonal{0, 0}, others{0, 0};
  for (std::size_t e = 0; e < evaluator_.second_partials(row); ++e) {
    const Evaluator::SecondPartial partial = evaluator_.second_partial(row, e);
    const double product = directed::times(radius_[partial.i], radius_[partial.j]).upper;
    if (partial.i == partial.j) {
      // The square of the distance is between 0 and r².
      diagonal = diagonal + partial.value * Interval{0, product};
    } else {
      others = others + symmetric(directed::times(partial.value.magnitude(), product).upper);
    }
  }
  return 0.5 * diagonal + others;
}

bool BoxEnclosure::is_bounded(Index row, const Form& form) const {
  return form.offset.is_finite() &&
         std::all_of(form.gradient, form.gradient + evaluator_.partials(row),
                     [](Interval derivative) { return derivative.is_finite(); });
}

std::optional<BoxEnclosure::Form> BoxEnclosure::mean_value(Index row) const {
  const Form form{at_center_[as_size(row)], gradient_.data() + first_entry(row)};
  return is_enclosed(row) && is_bounded(row, form) ? std::optional(form) : std::nullopt;
}

std::optional<BoxEnclosure::Form> BoxEnclosure::first_order(Index row) const {
  if (!has_second_derivatives() || !is_enclosed(row) || !remainders_[as_size(row)].is_finite())
    return std::nullopt;
  const Form form{at_center_[as_size(row)] + remainders_[as_size(row)],
                  gradient_at_center_.data() + first_entry(row)};
  return is_bounded(row, form) ? std::optional(form) : std::nullopt;
}

std::optional<BoxEnclosure::Quadratic> BoxEnclosure::quadratic(Index row) const {
  if (!first_order(row)) return std::nullopt;
  Quadratic made{at_center_[as_size(row)], {}, {}};
  for (std::size_t e = 0; e < evaluator_.partials(row); ++e)
    made.gradient.push_back(
        {evaluator_.partial(row, e).variable, gradient_at_center_[first_entry(row) + e]});
  for (std::size_t e = 0; e < evaluator_.second_partials(row); ++e)
    made.curvature.push_back(evaluator_.second_partial(row, e));
  return made;
}

Interval BoxEnclosure::range(Index row) const {
  Interval range = natural_[as_size(row)];
  for (const std::optional<Form>& form : {mean_value(row), first_order(row)}) {
    if (!form) continue;
    Interval sum = form->offset;
    for (std::size_t e = 0; e < evaluator_.partials(row); ++e)
      sum = sum + form->gradient[e] * symmetric(radius_[evaluator_.partial(row, e).variable]);
    range = intersection(range, sum);
  }
  return range;
}

double BoxEnclosure::slope_spread(Index variable) const {
  double sum = 0;
  for (Index row = 0; row < function().rows(); ++row) {
    for (std::size_t e = 0; e < evaluator_.partials(row); ++e) {
      if (evaluator_.partial(row, e).variable != variable) continue;
      const Interval slope = gradient_[first_entry(row) + e];
      const double spread = 0.5 * slope.upper - 0.5 * slope.lower;
      sum += is_enclosed(row) && std::isfinite(spread) ? spread : infinity;
    }
  }
  return sum;
}

BoxEnclosure::Affine BoxEnclosure::affine(Index row, Eigen::Ref<Eigen::RowVectorXd> slope) const {
  slope.setZero();
  std::optional<Form> found = first_order(row);
  if (!found) found = mean_value(row);
  if (!found) {
    const Interval natural = natural_[as_size(row)];
    if (!natural.is_finite()) return {0, infinity};
    return {middle(natural), reach(natural, middle(natural))};
  }
  double radius = 0;
  for (std::size_t e = 0; e < evaluator_.partials(row); ++e) {
    const Index variable = evaluator_.partial(row, e).variable;
    slope[variable] = middle(found->gradient[e]);
    const double rest = reach(found->gradient[e], slope[variable]);
    radius = directed::plus(radius, directed::times(rest, radius_[variable]).upper).upper;
  }
  const double value = middle(found->offset);
  return {value, directed::plus(radius, reach(found->offset, value)).upper};
}

}  // namespace cordon::formulas
