// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/affine_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "operations.hpp"

namespace cordon::formulas {

std::optional<Interval> BoxEnclosure::deviation_by(FormOfRow form, VectorIn weights,
                                                   MatrixIn slopes) const {
  Interval sum{0, 0};
  std::vector<Interval> left(as_size(slopes.cols()), Interval{0, 0});  // of slopes, of all rows
  for (Index row = 0; row < weights.size(); ++row) {
    if (weights[row] == 0) continue;
    const std::optional<Form> found = (this->*form)(row);
    if (!found) return std::nullopt;
    Interval offset = found->offset;
    std::size_t entry = 0;
    for (Index i = 0; i < slopes.cols(); ++i) {
      const bool has_entry =
          entry < evaluator_.partials(row) && evaluator_.partial(row, entry).variable == i;
      const Interval partial = has_entry ? found->gradient[entry++] : Interval{0, 0};
      left[as_size(i)] = left[as_size(i)] + weights[row] * (partial - point(slopes(row, i)));
      offset = offset - slopes(row, i) * point(center_[i]);
    }
    sum = sum + weights[row] * offset;
  }
  for (Index i = 0; i < slopes.cols(); ++i)
    sum = sum + left[as_size(i)] * Interval{-radius_[i], radius_[i]};
  return sum;
}

Interval BoxEnclosure::deviation(VectorIn weights, MatrixIn slopes) const {
  Interval bounds{0, 0};
  for (Index row = 0; row < weights.size(); ++row) {
    if (weights[row] == 0) continue;
    Interval left = natural_[as_size(row)];
    for (Index i = 0; i < slopes.cols(); ++i)
      left = left - slopes(row, i) * (point(center_[i]) + Interval{-radius_[i], radius_[i]});
    bounds = bounds + weights[row] * left;
  }
  for (const FormOfRow form : {&BoxEnclosure::mean_value, &BoxEnclosure::first_order}) {
    if (const auto sum = deviation_by(form, weights, slopes)) bounds = intersection(bounds, *sum);
  }
  return bounds;
}

Index BoxEnclosure::most_bent(VectorIn weights) const {
  Vector reached = Vector::Zero(function().differentiated());
  for (Index row = 0; row < weights.size(); ++row) {
    for (std::size_t e = 0; weights[row] != 0 && e < evaluator_.partials(row); ++e) {
      const Index variable = evaluator_.partial(row, e).variable;
      if (function().is_affine_in(row, variable) || radius_[variable] == 0) continue;
      const Interval slope = gradient_[first_entry(row) + e];
      const double spread = 0.5 * slope.upper - 0.5 * slope.lower;
      reached[variable] += is_enclosed(row) && std::isfinite(spread)
                               ? std::abs(weights[row]) * spread * radius_[variable]
                               : infinity;
    }
  }
  Index most = -1;
  for (Index i = 0; i < reached.size(); ++i)
    if (reached[i] > 0 && (most < 0 || reached[i] > reached[most])) most = i;
  return most;
}

double deviation_at(Evaluator& evaluator, VectorIn weights, MatrixIn slopes,
                    std::span<const Interval> at) {
  double sum = 0;
  for (Index row = 0; row < weights.size(); ++row) {
    if (weights[row] == 0) continue;
    const Interval value = evaluator.evaluate_row(at, row);
    if (!value.is_finite()) return std::numeric_limits<double>::quiet_NaN();
    double left = middle(value);
    for (Index i = 0; i < slopes.cols(); ++i) left -= slopes(row, i) * at[as_size(i)].lower;
    sum += weights[row] * left;
  }
  return sum;
}

namespace {

constexpr double close_enough = 1e-3;  ///< share of the width that is attained

class DeviationSearch {
 public:
  DeviationSearch(BoxEnclosure& function, VectorIn weights, MatrixIn slopes)
      : function_(function), weights_(weights), slopes_(slopes) {}

  Deviation run(std::span<const Interval> box, std::size_t most_parts) {
    take(Variables(box.begin(), box.end()));
    if (is_affine()) take_around_zero(box);
    while (parts_.size() < most_parts) {
      const std::size_t worst = part_that_reaches_farthest();
      const Interval& reached = parts_[worst].bounds;
      const double gap = std::max(reached.upper - attained_.upper, attained_.lower - reached.lower);
      if (gap <= close_enough * (attained_.upper - attained_.lower) || !bisect(worst)) break;
    }
    Interval bounds = parts_.front().bounds;
    for (const Part& part : parts_) bounds = hull(bounds, part.bounds);
    return {bounds.is_finite() ? bounds : real_line, attained_, parts_.size()};
  }

 private:
  using Variables = std::vector<Interval>;
  struct Part {
    Variables box;
    Interval bounds;
    Index bent;
  };

  bool is_affine() const {
    for (Index row = 0; row < weights_.size(); ++row)
      if (weights_[row] != 0 && !function_.function().is_affine(row)) return false;
    return true;
  }

  std::size_t part_that_reaches_farthest() const {
    std::size_t above = 0, below = 0;
    for (std::size_t i = 1; i < parts_.size(); ++i) {
      if (parts_[i].bounds.upper > parts_[above].bounds.upper) above = i;
      if (parts_[i].bounds.lower < parts_[below].bounds.lower) below = i;
    }
    const double over = parts_[above].bounds.upper - attained_.upper,
                 under = attained_.lower - parts_[below].bounds.lower;
    return over >= under ? above : below;
  }

  bool bisect(std::size_t which) {
    if (parts_[which].bent < 0) return false;
    const std::size_t bent = as_size(parts_[which].bent);
    Variables lower = std::move(parts_[which].box), upper = lower;
    const double at = middle(lower[bent]);
    if (!(at > lower[bent].lower && at < lower[bent].upper)) {
      parts_[which].box = std::move(lower);
      return false;
    }
    lower[bent].upper = upper[bent].lower = at;
    parts_[which] = enclosed(std::move(lower));
    take(std::move(upper));
    return true;
  }

  /// Bounds of affine rows are as good over a larger box, but for the rounding of their values at
  /// the centre, which is none at 0.
  void take_around_zero(std::span<const Interval> box) {
    Variables around(box.begin(), box.end());
    for (Index i = 0; i < slopes_.cols(); ++i) {
      const double size = around[as_size(i)].magnitude();
      around[as_size(i)] = {-size, size};
    }
    function_.set_box(around);
    Interval& bounds = parts_.front().bounds;
    bounds = intersection(bounds, function_.deviation(weights_, slopes_));
  }

  void take(Variables box) { parts_.push_back(enclosed(std::move(box))); }

  Part enclosed(Variables box) {
    function_.set_box(box);
    Part part{std::move(box), function_.deviation(weights_, slopes_),
              function_.most_bent(weights_)};
    sample(part.box);
    return part;
  }

  /// At the centre, and at the two vertices to which the linear part around it leads.
  void sample(const Variables& box) {
    Eigen::RowVectorXd towards = Eigen::RowVectorXd::Zero(slopes_.cols()), slope = towards;
    for (Index row = 0; row < weights_.size(); ++row) {
      if (weights_[row] == 0) continue;
      function_.affine(row, slope);
      towards += weights_[row] * (slope - slopes_.row(row));
    }
    Variables at = box;
    for (const double direction : {0.0, 1.0, -1.0}) {
      for (Index i = 0; i < slopes_.cols(); ++i) {
        const Interval side = box[as_size(i)];
        const double way = direction * towards[i];
        at[as_size(i)] = point(way > 0 ? side.upper : way < 0 ? side.lower : middle(side));
      }
      const double value = deviation_at(function_.evaluator(), weights_, slopes_, at);
      if (std::isfinite(value)) attained_ = hull(attained_, point(value));
    }
  }

  BoxEnclosure& function_;
  Vector weights_;
  Matrix slopes_;
  std::vector<Part> parts_;
  Interval attained_{infinity, -infinity};
};

}  // namespace

Deviation bound_deviation(BoxEnclosure& function, VectorIn weights, MatrixIn slopes,
                          std::span<const Interval> box, std::size_t most_parts) {
  return DeviationSearch(function, weights, slopes).run(box, most_parts);
}

}  // namespace cordon::formulas
