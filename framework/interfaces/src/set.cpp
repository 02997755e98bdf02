// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/solvers/view_questions.hpp"
#include "direction_apart.hpp"

namespace cordon {

namespace {

void require(VectorIn x, Index dim, const char* what) {
  if (x.size() != dim) {
    throw Error(Errc::dimension, std::string(what) + ": a vector of size " +
                                     std::to_string(x.size()) + " for a set of dimension " +
                                     std::to_string(dim));
  }
  if (!x.allFinite())
    throw Error(Errc::not_finite, std::string(what) + ": the vector has a NaN or infinite entry");
}

void require_same(const Set& X, const Set& Y, const char* what) {
  if (X.dim() == Y.dim()) return;
  throw Error(Errc::dimension, std::string(what) + ": dimensions " + std::to_string(X.dim()) +
                                   " and " + std::to_string(Y.dim()) + " differ");
}

/// Must answers hold for the numbers as stored?
bool is_outward(const Set& X) { return X.backend().info().rounding != Rounding::nominal; }

/// The form of a box: its centre and radius are rounded outward where they are no doubles, and what
/// the form has beyond the box is not the box's.
bool is_box_form(const LineForm& X) {
  const auto axis_parallel = [](const Matrix& columns) {
    for (Index j = 0; j < columns.cols(); ++j) {
      if ((columns.col(j).array() != 0).count() > 1) return false;
    }
    return true;
  };
  return X.constraints() == 0 && axis_parallel(X.G) && axis_parallel(X.M);
}

/// Boxes around two sets that have no point in common, compared without rounding.
bool are_apart(const Box& X, const Box& Y) {
  return (X.lower.array() > Y.upper.array()).any() || (Y.lower.array() > X.upper.array()).any();
}

bool is_within(const Box& X, const Box& Y) {
  return X.is_empty() ||
         ((X.lower.array() >= Y.lower.array()).all() && (X.upper.array() <= Y.upper.array()).all());
}

Answer only(Answer allowed, Answer answer) { return answer == allowed ? answer : Answer::unknown; }

/// What is said of the set that a view writes down, of a set that the view may only hold.
Answer as_claimed(const View& X, Answer allowed, Answer answer, Certificate* why) {
  if (X.claim == Tightness::exact || answer == allowed) return answer;
  if (why && answer != Answer::unknown) *why = {};
  return Answer::unknown;
}

}  // namespace

Index Complexity::count(std::string_view name) const {
  if (name == "generators") return generators;
  if (name == "lines") return lines;
  if (name == "constraints") return constraints;
  for (const Named& other : others) {
    if (other.name == name) return other.count;
  }
  return 0;
}

void* Set::operator new(std::size_t size) {
  if (void* const memory = take_memory(size)) return memory;
  throw std::bad_alloc();
}

void* Set::operator new(std::size_t size, std::align_val_t alignment) {
  return ::operator new(size, alignment);
}

LineForm Set::line_form() const { return do_line_form(); }

View Set::view() const { return do_view(); }

View Set::view_along(MatrixIn directions) const {
  if (directions.rows() != dim_)
    throw Error(Errc::dimension, "view: the directions have another dimension than the set");
  Inequalities rows{Matrix(directions.cols(), dim_), Vector(directions.cols())};
  Index kept = 0;
  for (Index j = 0; j < directions.cols(); ++j) {
    const double h = support(directions.col(j));
    if (!std::isfinite(h)) continue;
    rows.H.row(kept) = directions.col(j).transpose();
    rows.h[kept++] = h;
  }
  rows.H.conservativeResize(kept, Eigen::NoChange);
  rows.h.conservativeResize(kept);
  return with_rows(view(), rows);
}

Answer Set::is_empty(Certificate* why) const { return do_is_empty(why); }

Answer Set::contains(VectorIn x, Certificate* why) const {
  require(x, dim_, "contains");
  const Answer answer = do_contains(x, why);
  if (answer != Answer::unknown || has_exact_form() || dim_ == 0) return answer;
  const auto direction = direction_apart(*this, x);
  if (!direction) return answer;
  if (why) *why = *direction;
  return Answer::no;
}

Answer Set::is_subset_of(const Set& other, Certificate* why) const {
  require_same(*this, other, "is_subset_of");
  if (this == &other) return Answer::yes;
  if (&other.backend() == backend_) {
    const Answer own = do_is_subset_of(other, why);
    if (own != Answer::unknown) return own;
  }
  const View right = other.view();
  const Answer form = is_within_form(other, right, why);
  if (right.rows.rows() == 0 || form != Answer::yes || is_empty() == Answer::yes) return form;
  if (why) *why = {};
  for (Index i = 0; i < right.rows.rows(); ++i) {
    if (!(support(right.rows.H.row(i).transpose()) <= right.rows.h[i])) return Answer::unknown;
  }
  return Answer::yes;
}

/// In the form of another set's view, and by that in the set, as far as it has no inequalities?
Answer Set::is_within_form(const Set& other, const View& right, Certificate* why) const {
  const Answer answer = is_outward(*this) || is_outward(other)
                            ? outward::is_subset(line_form(), right.form, why)
                            : is_subset(line_form(), right.form, why);
  const auto unknown = [why] {
    if (why) *why = {};
    return Answer::unknown;
  };
  // `yes` needs an exact right-hand side, `no` an exact left-hand side; an outer form of the other
  // one only strengthens it
  if (answer == Answer::yes && right.claim == Tightness::outer && is_empty() != Answer::yes)
    return unknown();
  if (answer == Answer::yes && is_box_form(right.form) &&
      !is_within(interval_hull(), other.interval_hull()))
    return unknown();
  if (answer == Answer::no && !has_exact_form()) return unknown();
  return answer;
}

Answer Set::is_disjoint_from(const Set& other, Certificate* why) const {
  require_same(*this, other, "is_disjoint_from");
  if (&other.backend() == backend_) {
    const Answer own = do_is_disjoint_from(other, why);
    if (own != Answer::unknown) return own;
  }
  const View left = view(), right = other.view();
  Answer answer = is_disjoint(left, right, why);
  const bool exact = left.claim == Tightness::exact && right.claim == Tightness::exact;
  const auto unknown = [why] {
    if (why) *why = {};
    return Answer::unknown;
  };
  if (answer == Answer::no && is_box_form(left.form) && is_box_form(right.form) &&
      are_apart(interval_hull(), other.interval_hull()))
    return unknown();
  if (answer == Answer::no && !exact) answer = unknown();
  if (answer != Answer::unknown || exact || dim_ == 0) return answer;
  const auto direction = direction_apart(*this, other);
  if (!direction) return answer;
  if (why) *why = *direction;
  return Answer::yes;
}

Answer Set::is_bounded() const { return dim_ == 0 ? Answer::yes : do_is_bounded(); }

double Set::support(VectorIn d, Vector* at, Certificate* why) const {
  require(d, dim_, "support");
  const double h = do_support(d, why);
  if (at) {
    *at = std::isfinite(h) ? do_maximizer(d) : Vector(0);
    if (at->size() != dim_ || !at->allFinite()) at->resize(0);
  }
  return std::isnan(h) ? infinity : h;
}

Box Set::interval_hull(std::vector<Certificate>* why) const {
  if (why) why->assign(static_cast<std::size_t>(2 * dim_), Certificate{});
  if (dim_ == 0) return {Vector(0), Vector(0)};
  Box hull = do_interval_hull(why);
  if (why) why->resize(static_cast<std::size_t>(2 * dim_));
  return hull;
}

Volume Set::volume() const {
  if (dim_ == 0) {
    const Answer empty = is_empty();
    return {empty == Answer::yes ? 0.0 : 1.0, empty != Answer::unknown};
  }
  const Box hull = interval_hull();
  if (hull.is_empty()) return {0.0, true};
  std::optional<Volume> own;
  if (hull.is_bounded()) own = do_volume();
  if (own && own->exact && own->value >= 0) return *own;
  double value = 1;
  for (Index i = 0; i < dim_; ++i) {
    const double edge = hull.upper[i] - hull.lower[i];
    if (edge == 0) return {0.0, true};  // flat in a coordinate
    if (edge < infinity) value *= edge;
  }
  // the product of tiny edges may be 0, and 0 · inf no number
  if (own && own->value >= 0) value = std::min(value, own->value);
  return {hull.is_bounded() ? value : infinity, false};
}

bool Set::do_has_exact_form() const { return backend_->info().exact_exchange; }

View Set::do_view() const {
  return {do_line_form(), {}, do_has_exact_form() ? Tightness::exact : Tightness::outer};
}

Answer Set::do_is_empty(Certificate* why) const {
  const View X = do_view();
  return as_claimed(X, Answer::yes, cordon::is_empty(X, why), why);
}

Answer Set::do_contains(VectorIn x, Certificate* why) const {
  const View X = do_view();
  return as_claimed(X, Answer::no, cordon::contains(X, x, why), why);
}

Answer Set::do_is_bounded() const {
  const View X = do_view();
  const bool exact = X.is_exact_form();
  const Answer answer = cordon::is_bounded(exact ? X.form : folded(X).form);
  return exact ? answer : only(Answer::yes, answer);
}

double Set::do_support(VectorIn d, Certificate* why) const {
  const View X = do_view();
  const double alone =
      is_outward(*this) ? outward::support(X.form, d, why) : cordon::support(X.form, d, why);
  if (X.rows.rows() == 0) return alone;
  Certificate proof;
  const double value = cordon::support(X, d, &proof);
  if (proof.kind != Certificate::Kind::rows || value >= alone) return alone;
  if (why) *why = std::move(proof);
  return value;
}

Vector Set::do_maximizer(VectorIn d) const {
  return has_exact_form() ? maximizer(do_line_form(), d) : Vector(0);
}

Box Set::do_interval_hull(std::vector<Certificate>* why) const {
  const View X = do_view();
  Box hull =
      is_outward(*this) ? outward::interval_hull(X.form, why) : cordon::interval_hull(X.form, why);
  if (X.rows.rows() == 0 || hull.is_empty()) return hull;
  for (Index i = 0; i < 2 * dim_; ++i) {
    Certificate proof;
    const double h = do_support((i % 2 ? -1 : 1) * Vector::Unit(dim_, i / 2), &proof);
    if (h == -infinity) return Box::empty(dim_);
    double& bound = i % 2 ? hull.lower[i / 2] : hull.upper[i / 2];
    if (!(h < (i % 2 ? -bound : bound))) continue;
    bound = i % 2 ? -h : h;
    if (why) (*why)[as_size(i)] = std::move(proof);
  }
  for (Index i = 0; i < dim_; ++i) {
    if (hull.lower[i] > hull.upper[i]) std::swap(hull.lower[i], hull.upper[i]);
  }
  return hull;
}

}  // namespace cordon
