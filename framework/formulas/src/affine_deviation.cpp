// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/affine_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "operations.hpp"

namespace cordon::formulas {

Interval BoxEnclosure::deviation(Index row, const Eigen::RowVectorXd& slope) const {
  Interval at_center{0, 0}, along{0, 0};
  for (Index i = 0; i < slope.size(); ++i) {
    if (slope[i] == 0) continue;
    at_center = at_center + slope[i] * point(center_[i]);
    along = along + slope[i] * (point(center_[i]) + Interval{-radius_[i], radius_[i]});
  }
  Interval bounds = natural_[as_size(row)] - along;
  for (const std::optional<Form>& form : {mean_value(row), first_order(row)}) {
    if (!form) continue;
    Interval sum = form->offset - at_center;
    std::size_t entry = 0;
    for (Index i = 0; i < slope.size(); ++i) {
      const bool has_entry =
          entry < evaluator_.partials(row) && evaluator_.partial(row, entry).variable == i;
      const Interval partial = has_entry ? form->gradient[entry++] : Interval{0, 0};
      sum = sum + (partial - point(slope[i])) * Interval{-radius_[i], radius_[i]};
    }
    bounds = intersection(bounds, sum);
  }
  return bounds;
}

Index BoxEnclosure::most_bent(Index row) const {
  Index most = -1;
  double reached = 0;
  for (std::size_t e = 0; e < evaluator_.partials(row); ++e) {
    const Index variable = evaluator_.partial(row, e).variable;
    if (function().is_affine_in(row, variable)) continue;
    const Interval slope = gradient_[first_entry(row) + e];
    double share = (0.5 * slope.upper - 0.5 * slope.lower) * radius_[variable];
    if (!is_enclosed(row) || !std::isfinite(share)) share = infinity * radius_[variable];
    if (share > reached) {
      reached = share;
      most = variable;
    }
  }
  return most;
}

namespace {

class DeviationSearch {
 public:
  DeviationSearch(BoxEnclosure& function, Index row, const Eigen::RowVectorXd& slope)
      : function_(function), row_(row), slope_(slope) {}

  Deviation run(std::span<const Interval> box, std::size_t most_parts, double tolerance) {
    take(Variables(box.begin(), box.end()));
    if (function_.function().is_affine(row_)) take_around_zero(box);
    while (parts_.size() < most_parts) {
      const std::size_t worst = part_that_reaches_farthest();
      const Interval& reached = parts_[worst].bounds;
      const double gap = std::max(reached.upper - attained_.upper, attained_.lower - reached.lower);
      if (gap <= tolerance * (attained_.upper - attained_.lower) || !bisect(worst)) break;
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
    const auto bent = static_cast<std::size_t>(parts_[which].bent);
    if (parts_[which].bent < 0) return false;
    Variables lower = parts_[which].box, upper = lower;
    const double at = middle(lower[bent]);
    if (!(at > lower[bent].lower && at < lower[bent].upper)) return false;
    lower[bent].upper = upper[bent].lower = at;
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(which));
    take(std::move(lower));
    take(std::move(upper));
    return true;
  }

  /// Bounds of an affine row are as good over a larger box, but for the rounding of its value at
  /// the centre, which is none at 0.
  void take_around_zero(std::span<const Interval> box) {
    Variables around(box.begin(), box.end());
    for (Index i = 0; i < slope_.size(); ++i) {
      const double size = around[as_size(i)].magnitude();
      around[as_size(i)] = {-size, size};
    }
    function_.set_box(around);
    Interval& bounds = parts_.front().bounds;
    bounds = intersection(bounds, function_.deviation(row_, slope_));
  }

  void take(Variables box) {
    function_.set_box(box);
    Part part{std::move(box), function_.deviation(row_, slope_), function_.most_bent(row_)};
    if (function_.is_enclosed(row_)) sample(part.box);
    parts_.push_back(std::move(part));
  }

  /// At the centre, and at the two vertices to which the linear part around it leads.
  void sample(const Variables& box) {
    Eigen::RowVectorXd around(slope_.size());
    function_.affine(row_, around);
    around -= slope_;
    for (const double direction : {0.0, 1.0, -1.0}) {
      Variables at = box;
      double along = 0;
      for (Index i = 0; i < slope_.size(); ++i) {
        const Interval side = box[as_size(i)];
        const double towards = direction * around[i];
        const double z = towards > 0 ? side.upper : towards < 0 ? side.lower : middle(side);
        at[as_size(i)] = point(z);
        along += slope_[i] * z;
      }
      const Interval value = function_.evaluator().evaluate_row(at, row_);
      if (!value.is_finite()) continue;
      const double deviation = middle(value) - along;
      attained_ = hull(attained_, point(deviation));
    }
  }

  BoxEnclosure& function_;
  Index row_;
  const Eigen::RowVectorXd& slope_;
  std::vector<Part> parts_;
  Interval attained_{infinity, -infinity};
};

}  // namespace

Deviation bound_deviation(BoxEnclosure& function, Index row, const Eigen::RowVectorXd& slope,
                          std::span<const Interval> box, std::size_t most_parts, double tolerance) {
  return DeviationSearch(function, row, slope).run(box, most_parts, tolerance);
}

}  // namespace cordon::formulas
