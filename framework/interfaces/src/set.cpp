// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "cordon/solvers/set_questions.hpp"

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

}  // namespace

bool Set::exact_exchange() const { return backend_->info().exact_exchange; }

LineForm Set::line_form() const { return do_line_form(); }

Answer Set::is_empty(Certificate* why) const { return do_is_empty(why); }

Answer Set::contains(VectorIn x, Certificate* why) const {
  require(x, dim_, "contains");
  return do_contains(x, why);
}

Answer Set::is_subset_of(const Set& other, Certificate* why) const {
  require_same(*this, other, "is_subset_of");
  if (this == &other) return Answer::yes;
  const LineForm right = other.line_form();
  const Answer answer = is_outward(*this) || is_outward(other)
                            ? outward::is_subset(line_form(), right, why)
                            : is_subset(line_form(), right, why);
  // `yes` needs an exact right-hand side, `no` an exact left-hand side; an outer form of the other
  // one only strengthens it
  if (answer == Answer::yes && !other.exact_exchange() && is_empty() != Answer::yes)
    return Answer::unknown;
  if (answer == Answer::yes && is_box_form(right) &&
      !is_within(interval_hull(), other.interval_hull())) {
    if (why) *why = {};
    return Answer::unknown;
  }
  if (answer == Answer::no && !exact_exchange()) return Answer::unknown;
  return answer;
}

Answer Set::is_disjoint_from(const Set& other, Certificate* why) const {
  require_same(*this, other, "is_disjoint_from");
  const LineForm left = line_form(), right = other.line_form();
  Answer answer = is_disjoint(left, right, why);
  if (answer == Answer::no && is_box_form(left) && is_box_form(right) &&
      are_apart(interval_hull(), other.interval_hull())) {
    answer = Answer::unknown;
    if (why) *why = {};
  }
  return exact_exchange() && other.exact_exchange() ? answer : only(Answer::yes, answer);
}

Answer Set::is_bounded() const { return dim_ == 0 ? Answer::yes : do_is_bounded(); }

double Set::support(VectorIn d, Certificate* why) const {
  require(d, dim_, "support");
  const double h = do_support(d, why);
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
  if (dim_ == 0) return {is_empty() == Answer::yes ? 0.0 : 1.0, true};
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

Answer Set::do_is_empty(Certificate* why) const {
  const Answer answer = cordon::is_empty(do_line_form(), why);
  return exact_exchange() ? answer : only(Answer::yes, answer);
}

Answer Set::do_contains(VectorIn x, Certificate* why) const {
  const Answer answer = cordon::contains(do_line_form(), x, why);
  return exact_exchange() ? answer : only(Answer::no, answer);
}

Answer Set::do_is_bounded() const {
  const Answer answer = cordon::is_bounded(do_line_form());
  return exact_exchange() ? answer : only(Answer::yes, answer);
}

double Set::do_support(VectorIn d, Certificate* why) const {
  return is_outward(*this) ? outward::support(do_line_form(), d, why)
                           : cordon::support(do_line_form(), d, why);
}

Box Set::do_interval_hull(std::vector<Certificate>* why) const {
  return is_outward(*this) ? outward::interval_hull(do_line_form(), why)
                           : cordon::interval_hull(do_line_form(), why);
}

}  // namespace cordon
