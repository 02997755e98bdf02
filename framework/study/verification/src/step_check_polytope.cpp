// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a step against the exact set of all states that model and data allow, by its vertices
// and inequalities.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "solvers/polytope_representation.hpp"
#include "solvers/rational_questions.hpp"
#include "step_check.hpp"

namespace cordon::verification {

namespace {

using rational::Rational;
using rational::RationalVector;
constexpr double underflow =
    1e-300;  ///< of bounds that are 0 but for the smallest numbers there are
constexpr double ill_conditioned =
    1e-6;  ///< rounding moves an inequality by more than this share of it

/// The largest entry of each coordinate among the lines: how far off their directions are is a
/// share of it.
Vector reach_of(const Matrix& lines) {
  return lines.cols() ? Vector(lines.cwiseAbs().rowwise().maxCoeff())
                      : Vector(Vector::Zero(lines.rows()));
}
/// How many times as large as the lines' entries x is.
double length_along(const Vector& reach, const Vector& x) {
  double length = 0;
  for (Index i = 0; i < x.size(); ++i) {
    if (reach[i] > 0) length = std::max(length, x[i] / reach[i]);
  }
  return length;
}
/// Their largest entries, for divisions: where no line has an entry, that of d, or 1 where that is
/// 0 too.
Vector units_of(const Matrix& lines, const Vector& d) {
  Vector units = reach_of(lines);
  for (Index i = 0; i < units.size(); ++i) {
    if (units[i] == 0) units[i] = d[i] != 0 ? std::abs(d[i]) : 1;
  }
  return units;
}

/// Is nothing left of a set but for the rounding of its rows? By how much that moves it cannot be
/// told.
bool empty_by_rounding(const LineForm& strict, const LineForm& relaxed) {
  return exact::is_empty(strict) == Answer::yes && is_empty(relaxed) != Answer::yes;
}

bool is_proven_empty(const LineForm& X) {
  try {
    return exact::is_empty(X) == Answer::yes;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return false;
  }
}

}  // namespace

/// Is a point of X_k within the tolerance of x? Vertices of an exact estimate lie on its boundary,
/// where no proof for x itself succeeds with bounded rounding errors: a step of a quarter of the
/// tolerance towards the centre makes room.
bool StepCheck::holds_nearby(const Vector& x) {
  const LineForm& X = row_.set;
  if (X.lines() > 0 || (margin_.array() == 0).any()) return false;
  if (!center_) center_ = BoxedProgram(X.A, X.b).central_point();
  if (!*center_) return false;
  Matrix rows(X.constraints() + X.dim(), X.generators());
  rows << X.A, X.G;
  Vector right(rows.rows());
  right << X.b, x - X.c;
  const auto found = BoxedProgram(rows, right).central_point(1e-6);
  if (!found) return false;
  const double step =
      std::min(1.0, (margin_.array() / size_.cwiseMax(margin_).array()).minCoeff()) / 4;
  const Vector xi = (1 - step) * found->cwiseMax(-1.0).cwiseMin(1.0) + step * **center_;
  const auto radius = repair_radius(X.A, X.b, xi);
  if (!radius || ((xi.cwiseAbs() + *radius).array() > 1 - rounding::unit * 4).any()) return false;
  const Vector error = rounding::product_error(X.G, xi) + linalg::product(X.G.cwiseAbs(), *radius);
  const Vector off = (x - X.c - linalg::product(X.G, xi)).cwiseAbs();
  const Vector last = 8 * rounding::unit * (x.cwiseAbs() + X.c.cwiseAbs());
  return ((off + error + last).array() <= almost_all_of_margin * margin_.array()).all();
}

/// By how much a set that turns by the rounding of its lines' directions may miss x.
Vector StepCheck::turned_by(const Vector& x) const {
  const Vector reach = reach_of(row_.set.M);
  return line_tolerance_ * length_along(reach, x.cwiseAbs()) * reach;
}

/// The first coordinate in which x is outside the hull by more than the margin.
std::optional<Index> StepCheck::outside_hull(const RationalVector& x, const Vector& margin) const {
  for (Index i = 0; i < margin.size(); ++i) {
    const double lower = step_.hull.lower[i], upper = step_.hull.upper[i];
    const Rational slack = rational::exact(margin[i]);
    if (upper < infinity && x[as_size(i)] > rational::exact(upper) + slack) return i;
    if (lower > -infinity && x[as_size(i)] < rational::exact(lower) - slack) return i;
  }
  return std::nullopt;
}

const StepCheck::Moved& StepCheck::moved_by_rounding(const Successors& successors) {
  if (moved_) return *moved_;
  moved_ = Moved{Vector::Zero(size_.size()), Vector::Zero(size_.size())};
  const LineForm strict = successors.exact(),
                 barely = successors.relaxed(Successors::next_to_nothing),
                 relaxed = successors.relaxed(1);
  if (empty_by_rounding(strict, relaxed)) moved_->perhaps.setConstant(infinity);
  for (Index i = 0; i < size_.size(); ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const Vector d = sign * Vector::Unit(size_.size(), i);
      const double most = support(relaxed, d);
      const auto reaches_beyond = [&](const LineForm& X, double& moved) {
        const double least = exact::support(X, d).lower;
        if (std::isfinite(least)) moved = std::max(moved, most - least);
      };
      reaches_beyond(strict, moved_->perhaps[i]);
      reaches_beyond(barely, moved_->surely[i]);
    }
  }
  return *moved_;
}

/// Is x in the hull and in X_k, within the margin?
bool StepCheck::fits(const RationalVector& exact, const Vector& margin) const {
  return !outside_hull(exact, margin) && exact::contains(row_.set, exact, margin, row_margin_);
}

void StepCheck::contains_vertex(const RationalVector& exact, const Successors& successors) {
  Vector x(size_.size());
  for (Index i = 0; i < x.size(); ++i) x[i] = rational::nearest(exact[as_size(i)]);
  if (reported_empty()) {
    return violated(
        fmt::format(
            "the estimate is called empty, but the state {} is consistent with model and data",
            text(x)),
        true);
  }
  const std::string whether =
      fmt::format("whether the reported set contains the vertex {} of the exact one", text(x));
  const bool has_room = (margin_.array() > 0).all();
  const Vector margin = margin_ + turned_by(x);
  try {
    const bool in_hull = !outside_hull(exact, margin);
    if (in_hull && has_room && (holds_nearby(x) || contains(widened_, x) == Answer::yes)) return;
    if (fits(exact, margin)) return;
    if (nominal_) {
      const auto& [surely, perhaps] = moved_by_rounding(successors);
      if (surely.allFinite() && fits(exact, margin + surely)) return;
      if (!perhaps.allFinite() || fits(exact, margin + perhaps)) return open(whether);
    }
    if (const auto i = outside_hull(exact, margin)) {
      return missed(fmt::format("the state {} is consistent with model and data, but lies outside "
                                "the hull in coordinate {}: {:.17g} is not "
                                "in [{:.17g}, {:.17g}]",
                                text(x), *i + 1, x[*i], step_.hull.lower[*i], step_.hull.upper[*i]),
                    false);
    }
    missed(fmt::format(
               "the state {} is consistent with model and data, but lies outside the reported set",
               text(x)),
           true);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    open(whether);
  }
}

void StepCheck::contains_direction(const Vector& d, bool line) {
  const Matrix lines = exact::lineality_space(row_.set);
  const auto spanned = [&](const Vector& units) {
    const Matrix basis = linalg::range_basis(units.cwiseInverse().asDiagonal() * lines);
    const Vector scaled = d.cwiseQuotient(units);
    const Vector beyond =
        scaled - linalg::product(basis, linalg::transposed_product(basis, scaled));
    return beyond.norm() <= line_tolerance_ * scaled.norm();
  };
  if (!reported_empty() && spanned(units_of(lines, d))) return;
  const std::string along = (line ? "±" : "") + text(d);
  // entries that are small beside others may have cancelled to few digits
  if (nominal_ && !reported_empty() && spanned(Vector::Ones(d.size()))) {
    return open("whether the reported set is unbounded along " + along);
  }
  missed(fmt::format("the exact set is unbounded along {}, the reported set is not", along), true);
}

/// Does X_k keep to dᵀx ≤ limit but for lines that leave it by the rounding of their directions
/// alone?
bool StepCheck::keeps_across_lines(const Vector& d, double limit) const {
  LineForm X = eliminate_lines(row_.set);
  const Vector off = linalg::transposed_product(X.M, d).cwiseAbs();
  const Matrix scaled = units_of(X.M, d).cwiseInverse().asDiagonal() * X.M;
  const Vector lengths = scaled.colwise().lpNorm<Eigen::Infinity>();
  if ((off.array() > line_tolerance_ * d.cwiseAbs().dot(reach_of(X.M)) * lengths.array()).any())
    return false;
  X.M.resize(X.dim(), 0);
  X.S.resize(X.constraints(), 0);
  return support(X, d) <= limit + underflow;
}

/// X_k keeps to the inequality normalᵀx ≤ h of F.
void StepCheck::within(const RationalVector& normal, const Rational& h,
                       const Successors& successors) {
  Rational slack = 0;
  Vector d(size_.size());
  for (Index i = 0; i < d.size(); ++i) {
    d[i] = rational::nearest(normal[as_size(i)]);
    slack += abs(normal[as_size(i)]) * rational::exact(claim_margin_[i]);
  }
  const double limit = rational::nearest(h), room = rational::nearest(slack);
  if (room > 0 && support(row_.set, d) <= limit + almost_all_of_margin * room) return;
  try {
    const exact::Support reached = exact::support(row_.set, normal);
    using Kind = exact::Support::Kind;
    if (reached.kind == Kind::empty || (reached.kind == Kind::finite && reached.value <= h + slack))
      return;
    if (reached.kind == Kind::unbounded &&
        keeps_across_lines(d, limit + almost_all_of_margin * room))
      return;
    bool may_be_one =
        false;  // two rows that are parallel but for rounding, of which nominal operations make one
    if (nominal_) {
      const exact::Support strict = exact::support(successors.exact(), normal);
      const exact::Support relaxed = exact::support(successors.relaxed(1), normal);
      if (strict.kind == Kind::empty && relaxed.kind != Kind::empty) {
        return open(fmt::format("whether the estimate keeps to the exact set along {}", text(d)));
      }
      may_be_one = strict.kind == Kind::finite && relaxed.kind == Kind::unbounded;
      if (strict.kind == Kind::finite && relaxed.kind == Kind::finite) {
        const exact::Support barely =
            exact::support(successors.relaxed(Successors::next_to_nothing), normal);
        const Rational surely =
            barely.kind == Kind::finite ? Rational(relaxed.value - barely.value) : Rational(0);
        if (reached.kind == Kind::finite && reached.value <= h + slack + surely) return;
        const Rational perhaps = relaxed.value - strict.value;
        const double size = std::abs(limit) + d.cwiseAbs().dot(size_ + reach_of(row_.set.M));
        may_be_one = reached.kind == Kind::unbounded
                         ? perhaps > rational::exact(ill_conditioned * size)
                         : reached.value <= h + slack + perhaps;
      }
    }
    if (row_.exact_exchange &&
        !may_be_one) {  // an outer export may reach beyond the set that the claim is about
      const double value =
          reached.kind == Kind::finite ? rational::nearest(reached.value) : infinity;
      return missed(fmt::format("the estimate is claimed exact, but reaches {:.17g} along {} where "
                                "no consistent state lies beyond {:.17g}",
                                value, text(d), limit),
                    true);
    }
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
  }
  if (!row_.exact_exchange) {
    beyond_exchange_ = true;
    return;
  }
  open(fmt::format("whether the estimate keeps to the exact set along {}", text(d)));
}

void StepCheck::against(const Polytope& F, const Successors& successors) {
  const Description& generators = F.representation().generators();
  for (std::size_t j = 0; j < generators.rows.size() && !violation_; ++j) {
    const RationalVector& row = generators.rows[j];
    if (sgn(row[0]) != 0) contains_vertex({row.begin() + 1, row.end()}, successors);
  }
  const Polytope::Generators g = F.generators();
  for (Index j = 0; j < g.rays.cols() && !violation_; ++j) contains_direction(g.rays.col(j), false);
  for (Index j = 0; j < g.lines.cols() && !violation_; ++j)
    contains_direction(g.lines.col(j), true);
  keep_to_inequalities(F, successors);
  if (violation_ || step_.tightness != Tightness::exact || reported_empty()) return;
  const std::int64_t before = undecided_;
  if (F.is_empty()) {
    // data are rounded, or contradicted each other before: where nominal operations have room for
    // that, there is nothing to compare with
    const bool by_rounding = nominal_ && !is_proven_empty(successors.relaxed(1));
    exact_holds_ = claim_margin_.isZero(0) && is_proven_empty(row_.set);
    exact_stays_ = !exact_holds_ && by_rounding;
    if (!exact_holds_ && !by_rounding)
      open(
          "the estimate is claimed exact and is not called empty, but no state is consistent with "
          "model and data");
    return;
  }
  const Description& faces = F.representation().inequalities();
  for (std::size_t i = 0; i < faces.rows.size() && !violation_; ++i) {
    // β + aᵀx ≥ 0, divided by the largest entry of a
    RationalVector row = faces.rows[i];
    const Rational largest =
        abs(*std::max_element(row.begin() + 1, row.end(), [](const Rational& a, const Rational& b) {
          return abs(a) < abs(b);
        }));
    for (Rational& entry : row) entry /= largest;
    RationalVector normal(row.begin() + 1, row.end());
    if (faces.linear[i]) within(normal, -row[0], successors);
    for (Rational& entry : normal) entry = -entry;
    if (!violation_) within(normal, row[0], successors);
  }
  const bool settled = !violation_ && undecided_ == before;
  exact_holds_ = settled && !beyond_exchange_;
  exact_stays_ = settled && beyond_exchange_;
}

void StepCheck::against(const std::vector<Vector>& states) {
  const Successors none = unknown_successors(size_.size());
  for (std::size_t i = 0; i < states.size() && !violation_; ++i)
    contains_vertex(rational::exact(states[i]), none);
}

bool is_converted(const Polytope& F) {
  try {
    F.representation().generators();
    F.representation().inequalities();
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return false;
  }
  return true;
}

}  // namespace cordon::verification
