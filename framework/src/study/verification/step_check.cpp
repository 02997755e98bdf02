// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/step_check.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::verification {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Of a coordinate's size: rounding errors that nominal operations add up to, and those of a vertex written as doubles.
constexpr double nominal_tolerance = 1e-9, outward_tolerance = 1e-14;

std::string text(VectorIn x) {
  std::string out = "(";
  for (Index i = 0; i < x.size(); ++i) out += fmt::format("{}{}", i ? ", " : "", x[i] + 0.0);
  return out + ")";
}

}  // namespace

StepCheck::StepCheck(const RecordedStep& step, const RecordedSet& row, Rounding rounding)
    : step_(step),
      row_(row),
      size_(Vector::Ones(step.hull.dim())),
      tolerance_(rounding == Rounding::nominal ? nominal_tolerance : outward_tolerance) {
  for (Index i = 0; i < size_.size(); ++i) {
    const double reach = std::max(std::abs(step.hull.lower[i]), std::abs(step.hull.upper[i]));
    if (std::isfinite(reach) && reach > 0) size_[i] = reach;
  }
  widened_ = minkowski_sum(row.set, make_box({-tolerance_ * size_, tolerance_ * size_}));
}

void StepCheck::violated(std::string what, bool in_sets_file) {
  if (!violation_) violation_ = {std::move(what), in_sets_file};
}

void StepCheck::open(std::string what) {
  if (undecided_++ == 0) first_undecided_ = std::move(what);
}

void StepCheck::proofs() {
  emptiness_proof();
  // An outer export is larger than the set whose hull was reported: nothing follows about the bounds.
  if (reported_empty() || !row_.exact_exchange) return;
  for (Index i = 0; i < step_.hull.dim() && !violation_; ++i) {
    bound_proof(i, true);
    bound_proof(i, false);
  }
}

void StepCheck::emptiness_proof() {
  if (step_.consistent == Answer::unknown) return;
  if (row_.proof.kind == Certificate::Kind::none) {
    open(fmt::format("\"consistent\" is \"{}\", but no proof was stored", to_string(step_.consistent)));
    return;
  }
  if (step_.consistent == Answer::no) {
    if (!proves_empty(row_.set, row_.proof)) {
      return violated("the estimate is called empty, but the stored proof does not hold in rational arithmetic", true);
    }
  } else if (row_.exact_exchange && !proves_not_empty(row_.set, row_.proof)) {
    return violated("the estimate is called non-empty, but the stored proof does not hold in rational arithmetic", true);
  }
  ++proofs_;
}

void StepCheck::bound_proof(Index i, bool upper) {
  const double bound = upper ? step_.hull.upper[i] : -step_.hull.lower[i];
  if (bound == infinity) return;
  const Vector d = Vector::Unit(size_.size(), i) * (upper ? 1.0 : -1.0);
  // Boxes are exported with centre and radius rounded; lines are eliminated nominally.
  const double slack = (row_.set.lines() > 0 ? tolerance_ : outward_tolerance) * size_[i];
  const std::size_t place = static_cast<std::size_t>(2 * i + (upper ? 0 : 1));
  const Certificate none, &why = place < row_.hull_proofs.size() ? row_.hull_proofs[place] : none;
  if (why.kind != Certificate::Kind::none && proves_support(row_.set, d, bound + slack, why)) {
    ++proofs_;
    return;
  }
  const double reached = attained(row_.set, d);
  const std::string name =
      fmt::format("the {} bound of coordinate {}, {:.17g},", upper ? "upper" : "lower", i + 1, upper ? bound : -bound);
  if (reached > bound + slack) {
    return violated(fmt::format("{} lies inside the reported set, which reaches {:.17g}", name, upper ? reached : -reached),
                    false);
  }
  if (why.kind == Certificate::Kind::none) return open(name + " has no proof");
  violated(name + " is not what its stored proof proves in rational arithmetic", false);
}

/// Is a point of X_k within the tolerance of x? Vertices of an exact estimate lie on its boundary, where no proof for x itself
/// succeeds with bounded rounding errors: a step of a quarter of the tolerance towards the centre makes room.
bool StepCheck::holds_nearby(const Vector& x) {
  const LineForm& X = row_.set;
  if (X.lines() > 0) return false;
  if (!center_) center_ = BoxedProgram(X.A, X.b).central_point();
  if (!*center_) return false;
  Matrix rows(X.constraints() + X.dim(), X.generators());
  rows << X.A, X.G;
  Vector right(rows.rows());
  right << X.b, x - X.c;
  const auto found = BoxedProgram(rows, right).central_point(1e-6);
  if (!found) return false;
  const double step = tolerance_ / 4;
  const Vector xi = (1 - step) * found->cwiseMax(-1.0).cwiseMin(1.0) + step * **center_;
  const auto radius = repair_radius(X.A, X.b, xi);
  if (!radius || ((xi.cwiseAbs() + *radius).array() > 1 - rounding::unit * 4).any()) return false;
  const Vector error = rounding::product_error(X.G, xi) + linalg::product(X.G.cwiseAbs(), *radius);
  const Vector off = (x - X.c - linalg::product(X.G, xi)).cwiseAbs();
  const Vector last = 8 * rounding::unit * (x.cwiseAbs() + X.c.cwiseAbs());
  return ((off + error + last).array() <= tolerance_ * size_.array()).all();
}

void StepCheck::contains_vertex(const Vector& x) {
  if (reported_empty()) {
    return violated(fmt::format("the estimate is called empty, but the state {} is consistent with model and data", text(x)),
                    true);
  }
  for (Index i = 0; i < x.size(); ++i) {
    const double slack = tolerance_ * size_[i];
    if (x[i] <= step_.hull.upper[i] + slack && x[i] >= step_.hull.lower[i] - slack) continue;
    return violated(
        fmt::format("the state {} is consistent with model and data, but lies outside the hull in coordinate {}: {:.17g} is not "
                    "in [{:.17g}, {:.17g}]",
                    text(x), i + 1, x[i], step_.hull.lower[i], step_.hull.upper[i]),
        false);
  }
  if (holds_nearby(x)) return;
  const Answer inside = contains(widened_, x);
  if (inside == Answer::no) {
    violated(fmt::format("the state {} is consistent with model and data, but lies outside the reported set", text(x)), true);
  } else if (inside == Answer::unknown) {
    open(fmt::format("whether the reported set contains the vertex {} of the exact one", text(x)));
  }
}

void StepCheck::contains_direction(const Vector& d, bool line) {
  const Matrix basis = lineality_space(row_.set);
  const Vector beyond = d - linalg::product(basis, linalg::transposed_product(basis, d));
  const double off = beyond.norm() / d.norm();
  if (!reported_empty() && off <= nominal_tolerance) return;
  violated(fmt::format("the exact set is unbounded along {}{}, the reported set is not", line ? "±" : "", text(d)), true);
}

/// X_k keeps to the inequality normalᵀx ≤ h of F.
void StepCheck::within(const Vector& normal, double h, const Polytope& F) {
  const double slack = tolerance_ * normal.cwiseAbs().dot(size_);
  if (support(row_.set, normal) <= h + slack) return;
  const double reached = attained(row_.set, normal);
  // an outer export may reach beyond the set that the claim is about
  if (row_.exact_exchange && reached > F.support(normal).upper + slack) {
    violated(
        fmt::format("the estimate is claimed exact, but reaches {:.17g} along {} where no consistent state lies beyond {:.17g}",
                    reached, text(normal), h),
        true);
  } else {
    open(fmt::format("whether the estimate keeps to the exact set along {}", text(normal)));
  }
}

void StepCheck::against(const Polytope& F) {
  const Polytope::Generators g = F.generators();
  for (Index j = 0; j < g.vertices.cols() && !violation_; ++j) contains_vertex(g.vertices.col(j));
  for (Index j = 0; j < g.rays.cols() && !violation_; ++j) contains_direction(g.rays.col(j), false);
  for (Index j = 0; j < g.lines.cols() && !violation_; ++j) contains_direction(g.lines.col(j), true);
  if (violation_ || step_.tightness != Tightness::exact || reported_empty()) return;
  const std::int64_t before = undecided_;
  if (F.is_empty()) {
    open("the estimate is claimed exact and is not called empty, but no state is consistent with model and data");
  } else {
    const Polytope::Inequalities faces = F.inequalities();
    for (Index i = 0; i < faces.h.size() && !violation_; ++i) within(faces.H.row(i), faces.h[i], F);
    for (Index i = 0; i < faces.q.size() && !violation_; ++i) {
      within(faces.Q.row(i), faces.q[i], F);
      within(-faces.Q.row(i), -faces.q[i], F);
    }
  }
  exact_holds_ = !violation_ && undecided_ == before;
}

void StepCheck::against(const LineForm& successors, const Matrix& directions) {
  const bool claims = step_.tightness == Tightness::exact && !reported_empty() && row_.exact_exchange;
  for (Index j = 0; j < directions.cols() && !violation_; ++j) {
    const Vector d = directions.col(j);
    const double slack = tolerance_ * d.cwiseAbs().dot(size_);
    Certificate why;
    const double needed = support(successors, d, &why);
    const bool coordinate = (d.array() != 0).count() == 1;
    Index i = 0;
    d.cwiseAbs().maxCoeff(&i);
    const double hull = !coordinate ? infinity : d[i] > 0 ? d[i] * step_.hull.upper[i] : d[i] * step_.hull.lower[i];
    const double set = reported_empty() ? -infinity : support(row_.set, d),
                 reached = reported_empty() ? -infinity : attained(row_.set, d);
    if (claims && reached > needed + slack) {
      violated(
          fmt::format("the estimate is claimed exact, but reaches {:.17g} along {} where no successor of the set before that is "
                      "consistent with the data lies beyond {:.17g}",
                      reached, text(d), needed),
          true);
      continue;
    }
    const double allowed = std::min(hull, set);
    // nothing beyond: a rational proof that the successors keep below a value that the set is proven to reach
    if (allowed == infinity && needed == infinity && row_.set.lines() > 0) continue;
    const bool shown = needed == -infinity || proves_support(successors, d, needed + 0.5 * slack, why);
    if (shown && needed + 0.5 * slack <= std::min(hull, reached) + slack) continue;
    try {
      const rounding::Range exact = exact::support(successors, d);
      if (exact.lower > allowed + slack) {
        violated(
            fmt::format("a successor of the set before, consistent with the data, reaches {:.17g} along {}; the reported {} only "
                        "{:.17g}",
                        exact.lower, text(d), allowed == hull && coordinate ? "hull" : "set", allowed),
            !(allowed == hull && coordinate));
        continue;
      }
      if (exact.upper <= std::min(hull, reached) + slack) continue;
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
    }
    open(fmt::format("whether the reported set reaches as far along {} as the successors of the set before", text(d)));
  }
  exact_holds_ = claims && !violation_;
}

}  // namespace cordon::verification
