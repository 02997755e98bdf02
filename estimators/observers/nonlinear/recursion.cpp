// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/recursion.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "observers/nonlinear/box_parts.hpp"
#include "observers/nonlinear/lifted_image.hpp"

namespace cordon::estimators {

namespace {

using formulas::BoxEnclosure;

/// Of a set that tells nothing of a coordinate any more: its width beside that of the box.
constexpr double lost_width = 4;

/// Its hull, for boxes as tight as doubles allow: formulas may end where the set does.
Box sides_of(const LineForm& set) {
  if (set.lines() > 0 || set.constraints() > 0) return interval_hull(set);
  Box sides{set.c, set.c};
  for (Index i = 0; i < set.dim(); ++i) {
    double radius = 0;
    for (Index j = 0; j < set.generators(); ++j)
      radius = directed::plus(radius, std::abs(set.G(i, j))).upper;
    sides.lower[i] = directed::plus(set.c[i], -radius).lower;
    sides.upper[i] = directed::plus(set.c[i], radius).upper;
  }
  return sides;
}

template <class Enclosure>
bool lacks_rows(const Enclosure& of) {
  for (Index row = 0; row < of.function().rows(); ++row)
    if (!of.is_enclosed(row)) return true;
  return false;
}

}  // namespace

NonlinearRecursion::NonlinearRecursion(const Model& model,
                                       std::shared_ptr<const SetBackend> backend,
                                       NonlinearOptions options)
    : model_(model.nonlinear),
      backend_(std::move(backend)),
      options_(options),
      f_(model_->f, model_->states(), options_.form, backend_->info().rounding, model_->undefined),
      g_(model_->g, model_->states(), options_.form, backend_->info().rounding, model_->undefined),
      W_(backend_->import(model.W)),
      V_(backend_->import(model.V)),
      W_hull_(W_->interval_hull()),
      V_hull_(V_->interval_hull()),
      f_variables_(as_size(model_->f->variables())),
      g_variables_(as_size(model_->g->variables())) {
  contracts_ = options_.contracts && (options_.boxes_only || options_.row_by_row ||
                                      options_.relaxes || has_bent_outputs());
  needs_predicted_hull_ = contracts_ || options_.row_by_row || has_bent_outputs();
  if (options_.parts > 1)
    f_of_part_.emplace(model_->f, model_->states(), options_.form, backend_->info().rounding,
                       model_->undefined);
  if (model_->admissible) take_admissible(*model_->admissible);
}

bool NonlinearRecursion::has_bent_outputs() const {
  for (Index row = 0; row < model_->g->rows(); ++row)
    if (!model_->g->is_affine(row)) return true;
  return false;
}

/// With nominal sets by as much wider as their proofs are: a state on its boundary is rounded.
void NonlinearRecursion::take_admissible(const LineForm& set) {
  admissible_hull_ = interval_hull(set);
  admissible_sides_ = sides_of(set);
  Vector room = Vector::Zero(set.dim());
  for (Index i = 0; i < set.dim() && backend_->info().rounding == Rounding::nominal; ++i) {
    for (double* const bound : {&admissible_hull_.lower[i], &admissible_hull_.upper[i]})
      if (std::isfinite(*bound))
        room[i] = std::max(room[i], tolerances::proof_margin * std::abs(*bound));
  }
  admissible_hull_.lower -= room;
  admissible_hull_.upper += room;
  if (!admissible_hull_.is_bounded() && !backend_->info().unbounded) return;  // B is cut alone
  admissible_ = backend_->sum(backend_->import(set), backend_->box({-room, room}));
}

bool NonlinearRecursion::start(Enclosure X) {
  before_.reset();
  images_.clear();
  is_predicted_ = false;
  set(std::move(X));
  B_ = hull();
  return admit();
}

bool NonlinearRecursion::admit() {
  if (B_.is_empty()) return false;
  if (!model_->admissible) return true;
  if (admissible_.set && !options_.boxes_only &&
      backend_->box(B_)->is_subset_of(*admissible_) != Answer::yes)
    set(backend_->intersection(X_, Matrix::Identity(B_.dim(), B_.dim()), admissible_));
  B_ = intersected(B_, admissible_hull_);
  if (options_.boxes_only) hull_ = B_;
  return narrow_box();
}

void NonlinearRecursion::serialize(Archive& archive) {
  archive.set(X_, model_->states());
  archive(B_);
  if (B_.dim() != X_->dim() || B_.lower.hasNaN() || B_.upper.hasNaN())
    archive.refuse("no box of the states");
  if (!archive.is_reading()) return;
  before_.reset();
  images_.clear();
  hull_.reset();
}

void NonlinearRecursion::set(Enclosure X) {
  X_ = std::move(X);
  hull_.reset();
  is_reduced_ = false;
}

const Box& NonlinearRecursion::hull() const {
  if (hull_) return *hull_;
  Box& box = hull_.emplace(X_->interval_hull());
  if (backend_->info().rounding != Rounding::nominal || box.is_empty()) return box;
  // The hull of a nominal set holds up to rounding errors of the terms it is made of, the box at
  // all times.
  for (Index i = 0; i < box.dim(); ++i) {
    const double size = std::max(std::abs(box.lower[i]), std::abs(box.upper[i]));
    const double of_f = is_predicted_ ? rounding_doubt * f_.rounding_error(i) : 0;
    const double room = std::max(tolerances::proof_margin * size, of_f);
    box.lower[i] -= room;
    box.upper[i] += room;
  }
  return box;
}

void NonlinearRecursion::set_variables(std::vector<Interval>& variables, const Box& B,
                                       const Box& noise, VectorIn u, Index k) const {
  std::size_t at = 0;
  for (const Box* box : {&B, &noise})
    for (Index i = 0; i < box->dim(); ++i) variables[at++] = {box->lower[i], box->upper[i]};
  for (const double known : u) variables[at++] = {known, known};
  const auto time = static_cast<double>(k);
  variables[at] = {time, time};
}

bool NonlinearRecursion::cut_to_admissible(std::vector<Interval>& variables) const {
  bool is_cut = false;
  for (Index i = 0; model_->admissible && i < model_->states(); ++i) {
    Interval& x = variables[as_size(i)];
    const Interval cut = intersection(x, {admissible_sides_.lower[i], admissible_sides_.upper[i]});
    if (cut.lower > cut.upper) continue;
    is_cut = is_cut || cut.lower > x.lower || cut.upper < x.upper;
    x = cut;
  }
  return is_cut;
}

void NonlinearRecursion::enclose(BoxEnclosure& function, std::vector<Interval>& variables) const {
  function.set_box(variables);
  if (lacks_rows(function) && cut_to_admissible(variables)) function.set_box(variables);
}

void NonlinearRecursion::evaluate(formulas::Evaluator& function,
                                  std::vector<Interval>& variables) const {
  function.evaluate(variables);
  if (lacks_rows(function) && cut_to_admissible(variables)) function.evaluate(variables);
  function.bound_rounding();
}

std::string NonlinearRecursion::row_name(Index row) const { return "x_" + std::to_string(row + 1); }

Box NonlinearRecursion::range_of(const BoxEnclosure& enclosure) const {
  Box range = Box::space(model_->states());
  for (Index row = 0; row < range.dim(); ++row) {
    if (!enclosure.is_enclosed(row)) continue;
    const Interval values = options_.natural_only ? enclosure.natural(row) : enclosure.range(row);
    const double near = room(enclosure.rounding_error(row));
    range.lower[row] = directed::plus(values.lower, -near).lower;
    range.upper[row] = directed::plus(values.upper, near).upper;
  }
  return range;
}

Box NonlinearRecursion::predicted_range(VectorIn u, Index k) {
  set_variables(f_variables_, B_, W_hull_, u, k);
  enclose(f_, f_variables_);
  Box range = range_of(f_);
  if (options_.parts > 1) cut_into_parts(range, u, k);
  for (Index row = 0; row < range.dim(); ++row) {
    const bool is_enclosed =
        f_.is_enclosed(row) ||
        (!options_.relaxes && std::isfinite(range.lower[row]) && std::isfinite(range.upper[row]));
    if (!is_enclosed)
      throw Error(Errc::not_enclosed, "no bounded set encloses " + row_name(row) + " at k = " +
                                          std::to_string(k + 1) + ": " + f_.why_not_enclosed(row));
  }
  return range;
}

/// A row that is enclosed in parts alone is a box.
AffineRows NonlinearRecursion::predicted_rows(const Box& range) const {
  AffineRows form = affine_rows(f_, all_rows(range.dim()));
  for (Index row = 0; row < range.dim(); ++row) {
    if (f_.is_enclosed(row)) {
      form.radius[row] = directed::plus(form.radius[row], room(f_.rounding_error(row))).upper;
      continue;
    }
    const double middle = 0.5 * range.lower[row] + 0.5 * range.upper[row];
    form.offset[row] = middle;
    form.radius[row] = std::max(directed::plus(range.upper[row], -middle).upper,
                                directed::plus(middle, -range.lower[row]).upper);
  }
  return form;
}

Enclosure NonlinearRecursion::predicted_set(const Box& range) const {
  const Index n = model_->states();
  const AffineRows form = predicted_rows(range);
  const auto around = [&](const Vector& radius) { return backend_->box({-radius, radius}); };
  if (options_.lifts) {
    const LineForm Z = cartesian_product(X_->line_form(), W_->line_form());
    const bool outward = backend_->info().rounding != Rounding::nominal;
    if (auto lifted = lifted_image(f_, form, Z, outward)) {
      for (Index row = 0; row < n; ++row)
        lifted->radius[row] =
            directed::plus(lifted->radius[row], room(f_.rounding_error(row))).upper;
      const Enclosure image = backend_->sum(backend_->import(lifted->set), around(lifted->radius));
      return backend_->reduce(image, options_.budget);
    }
  }
  const Matrix disturbed = form.slope.rightCols(model_->disturbances()),
               unit = Matrix::Identity(n, n);
  const Term terms[] = {{disturbed, W_}, {unit, around(form.radius)}};
  return backend_->predict(X_, {form.slope.leftCols(n), form.offset, terms});
}

bool NonlinearRecursion::predict(VectorIn u, Index k) {
  if (B_.is_empty()) return false;
  if (!B_.is_bounded())
    throw Error(Errc::not_enclosed, "the estimate at k = " + std::to_string(k) +
                                        " is unbounded, and formulas are enclosed over boxes");
  Box range = predicted_range(u, k);
  is_predicted_ = true;
  if (options_.boxes_only) {
    hull_ = B_ = range;  // the set follows with the correction
    return admit();
  }
  if (options_.relaxes) {
    before_ = Before{X_, B_, u, k};
    B_ = model_->admissible ? intersected(range, admissible_hull_) : range;
    return !B_.is_empty();
  }
  set(predicted_set(range));
  B_ = std::move(range);
  if (!model_->admissible && !needs_predicted_hull_) return true;
  B_ = options_.carries_box ? intersected(hull(), B_) : hull();
  return admit();
}

double NonlinearRecursion::target(Index row, const Sample& now) const {
  return row < model_->outputs() ? now.y[row] : 0.0;
}

double NonlinearRecursion::room(double error, double value) const {
  const bool outward = backend_->info().rounding != Rounding::nominal;
  const double own = outward ? rounding::unit : tolerances::product_noise;
  return directed::plus(error, directed::times(own, std::abs(value)).upper).upper;
}

std::vector<Index> NonlinearRecursion::rows_of(const Sample& now) const {
  std::vector<Index> rows = present_outputs(now);
  for (Index i = 0; i < model_->invariants; ++i) rows.push_back(model_->outputs() + i);
  return rows;
}

bool NonlinearRecursion::narrow_box() {
  if (hull().is_empty()) return false;
  B_ = options_.carries_box || needs_predicted_hull_ ? intersected(B_, hull()) : hull();
  return !B_.is_empty();
}

void NonlinearRecursion::set_box() {
  X_ = backend_->box(B_);
  hull_ = B_;
  is_reduced_ = false;
}

/// X ∩ {x : x_i ∈ B_i} for the coordinates in which B is bounded and narrower.
bool NonlinearRecursion::cut_by_box() {
  std::vector<Index> narrower;
  for (Index i = 0; i < B_.dim(); ++i)
    if ((B_.lower[i] > hull().lower[i] || B_.upper[i] < hull().upper[i]) &&
        std::isfinite(B_.lower[i]) && std::isfinite(B_.upper[i]))
      narrower.push_back(i);
  if (narrower.empty()) return true;
  cut(narrower);
  return narrow_box();
}

void NonlinearRecursion::cut(const std::vector<Index>& coordinates) {
  const auto count = static_cast<Index>(coordinates.size());
  Matrix rows = Matrix::Zero(count, B_.dim());
  Box sides = Box::space(count);
  for (Index i = 0; i < count; ++i) {
    const Index coordinate = coordinates[as_size(i)];
    rows(i, coordinate) = 1;
    sides.lower[i] = B_.lower[coordinate];
    sides.upper[i] = B_.upper[coordinate];
  }
  set(backend_->intersection(X_, rows, backend_->box(sides)));
}

std::vector<Index> NonlinearRecursion::lost_coordinates() const {
  std::vector<Index> lost;
  for (Index i = 0; i < B_.dim(); ++i)
    if (hull().upper[i] - hull().lower[i] > lost_width * (B_.upper[i] - B_.lower[i]))
      lost.push_back(i);
  return lost;
}

/// Zonotopes that are enclosed wherever they are cut may grow without end beside a box that stays:
/// they are cut by it where they are this much wider, and are replaced by it where that is in vain.
bool NonlinearRecursion::keep_to_box() {
  if (!options_.carries_box || !B_.is_bounded()) return true;
  const std::vector<Index> lost = lost_coordinates();
  if (lost.empty()) return true;
  for (const Index coordinate : lost) cut({coordinate});
  if (!narrow_box()) return false;
  if (!lost_coordinates().empty()) set_box();
  return true;
}

bool NonlinearRecursion::correct_rows(const Sample& now, const std::vector<Index>& rows) {
  if (!B_.is_bounded()) return narrow_box();  // no affine form
  set_variables(g_variables_, B_, V_hull_, now.u, now.k);
  enclose(g_, g_variables_);
  std::vector<Index> usable;
  std::ranges::copy_if(rows, std::back_inserter(usable),
                       [&](Index row) { return g_.is_enclosed(row); });
  if (usable.empty()) return narrow_box();
  const Index n = model_->states(), count = static_cast<Index>(usable.size());
  AffineRows form = affine_rows(g_, usable);
  Vector z(count);
  for (Index i = 0; i < count; ++i) {
    const Interval left = directed::plus(target(usable[as_size(i)], now), -form.offset[i]);
    z[i] = left.lower;
    const double error =
        directed::plus(left.upper, -left.lower).upper +
        room(g_.rounding_error(usable[as_size(i)]), target(usable[as_size(i)], now));
    form.radius[i] = directed::plus(form.radius[i], error).upper;
  }
  Matrix noise(count, model_->noises() + count);
  noise << form.slope.rightCols(model_->noises()), Matrix::Identity(count, count);
  const Enclosure both = backend_->product(V_, backend_->box({-form.radius, form.radius}));
  set(backend_->correct(X_, {form.slope.leftCols(n), z, {noise, both}}));
  return narrow_box();
}

bool NonlinearRecursion::correct(const Sample& now) {
  if (contracts_ && !contract(now)) return false;
  if (options_.boxes_only) {
    set_box();
    return true;
  }
  if (options_.relaxes) return correct_relaxed(now);
  if (contracts_ && !options_.row_by_row && !cut_by_box()) return false;
  const std::vector<Index> rows = rows_of(now);
  if (!options_.row_by_row) return correct_rows(now, rows);
  return std::ranges::all_of(rows, [&](Index row) { return correct_rows(now, {row}); }) &&
         keep_to_box();
}

void NonlinearRecursion::reduce() {
  const Enclosure reduced = backend_->reduce(X_, options_.budget);
  is_reduced_ = reduced.set != X_.set;
  X_ = reduced;
}

bool NonlinearRecursion::is_box_narrower() const {
  return is_reduced_ || (B_.lower.array() > hull().lower.array()).any() ||
         (B_.upper.array() < hull().upper.array()).any();
}

}  // namespace cordon::estimators
