// SPDX-License-Identifier: GPL-3.0-or-later
// The box beside the set: its parts, and what outputs and invariants leave of it.
#include <algorithm>

#include "cordon/core/tolerances.hpp"
#include "observers/nonlinear/box_parts.hpp"
#include "observers/nonlinear/recursion.hpp"

namespace cordon::estimators {

namespace {

/// A contraction that shrinks no side by more than this share of it is the last one.
constexpr double least_progress = 0.01;

}  // namespace

/// The hull of the images takes the place of the range where it is narrower.
void NonlinearRecursion::cut_into_parts(Box& range, VectorIn u, Index k) {
  images_.clear();
  Vector doubts(B_.dim());
  for (Index i = 0; i < B_.dim(); ++i) doubts[i] = f_.slope_spread(i);
  const BoxCuts cuts = cuts_of(B_, doubts, options_.parts);
  if (cuts.parts() == 1) return;
  Box hull = Box::empty(B_.dim());
  for (const Box& part : parts_of(B_, cuts)) {
    set_variables(f_variables_, part, W_hull_, u, k);
    enclose(*f_of_part_, f_variables_);
    images_.push_back(intersected(range_of(*f_of_part_), range));
    hull = hull_of(hull, images_.back());
  }
  range = std::move(hull);
}

/// A part is left out where it is proven to hold no state.
bool NonlinearRecursion::contract(const Sample& now) {
  if (images_.empty()) return contract(now, B_);
  Box left = Box::empty(B_.dim());
  for (const Box& image : images_) {
    Box part = intersected(image, B_);
    if (!part.is_empty() && contract(now, part)) left = hull_of(left, part);
  }
  images_.clear();
  B_ = std::move(left);
  return !B_.is_empty();
}

bool NonlinearRecursion::contract(const Sample& now, Box& box) {
  const std::vector<Index> rows = rows_of(now);
  set_variables(g_variables_, box, V_hull_, now.u, now.k);
  g_.evaluator().evaluate(g_variables_);
  g_.evaluator().bound_rounding();
  std::vector<double> rooms;
  for (const Index row : rows)
    rooms.push_back(room(g_.evaluator().rounding_error(row), target(row, now)));
  bool goes_on = true;
  for (int sweep = 0; sweep < options_.most_sweeps && goes_on; ++sweep) {
    const std::vector<Interval> before = g_variables_;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (!contract_row(rows[i], target(rows[i], now), rooms[i])) return false;
    goes_on = false;
    for (Index i = 0; i < model_->states(); ++i) {
      const Interval was = before[as_size(i)], is = g_variables_[as_size(i)];
      goes_on = goes_on || is.upper - is.lower < (1 - least_progress) * (was.upper - was.lower);
    }
  }
  for (Index i = 0; i < model_->states(); ++i) {
    box.lower[i] = g_variables_[as_size(i)].lower;
    box.upper[i] = g_variables_[as_size(i)].upper;
  }
  return true;
}

bool NonlinearRecursion::contract_row(Index row, double value, double room) {
  before_row_ = g_variables_;
  if (g_.evaluator().contract(g_variables_, row, {value - room, value + room})) return true;
  g_variables_ = before_row_;
  if (room == 0) return false;
  const double far = rounding_doubt * room;
  if (!g_.evaluator().contract(g_variables_, row, {value - far, value + far})) return false;
  g_variables_ = before_row_;  // left as it is
  return true;
}

}  // namespace cordon::estimators
