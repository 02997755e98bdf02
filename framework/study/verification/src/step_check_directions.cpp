// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a step along directions: beside the successors of the set before, which need no
// vertices.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "step_check.hpp"

namespace cordon::verification {

namespace {

constexpr double direction_tolerance = 1e-12;  ///< of bounds that floating-point proofs attain
/// Of a margin: what a proof in rational arithmetic of a bound found in floating point may take.
constexpr double share_of_proof = 0.125;

/// A bound of dᵀx in X, and whether rational arithmetic proves it but for a share of the slack.
struct Bound {
  Bound(const LineForm& X, const Vector& d, double slack) {
    Certificate why;
    value = support(X, d, &why);
    shown = value == -infinity || proves_support(X, d, value + share_of_proof * slack, why);
  }
  /// With multipliers of the set as it was rounded: |y|ᵀ|Δb| is what a change of b moves.
  Bound(const Enclosure& X, const Vector& d, double slack) {
    Certificate why;
    value = support(X.set, d, &why);
    if (value == -infinity) {
      shown = proves_empty(X.widened, why);
    } else {
      if (why.data.size() == X.rows.size())
        value += why.data.cwiseAbs().dot(X.rows) + d.cwiseAbs().dot(X.center);
      shown = proves_support(X.widened, d, value + share_of_proof * slack, why);
    }
  }
  double value;
  bool shown;
};

/// By rational arithmetic, where proofs with bounded rounding errors fail: rows that depend on each
/// other.
double least_support(const LineForm& X, const Vector& d) {
  try {
    return exact::support(X, d).lower;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return -infinity;
  }
}

}  // namespace

/// What is asked along every direction.
struct StepCheck::Along {
  LineForm successors;
  std::optional<Enclosure> enclosed;
  std::function<LineForm(double)> relax;
  bool claims, holds_them_all;
  std::optional<LineForm> relaxed = std::nullopt, barely = std::nullopt;

  /// How far they reach if rows are relaxed, which nominal operations may have done.
  double reach(const Vector& d) {
    if (!relaxed) relaxed = relax(1);
    return support(*relaxed, d);
  }
  /// By how much farther that is than if rows are relaxed by next to nothing.
  double moved(const Vector& d) {
    if (!barely) barely = relax(Successors::next_to_nothing);
    const double least = lower_support(*barely, d), most = reach(d);
    return std::isfinite(least) && std::isfinite(most) ? std::max(0.0, most - least) : 0.0;
  }
};

void StepCheck::against(const Successors& of_the_set_before, const Matrix& directions,
                        bool holds_them_all, const std::atomic<bool>* stop) {
  const bool claims =
      step_.tightness == Tightness::exact && !reported_empty() && row_.exact_exchange;
  Along by{of_the_set_before.exact(), of_the_set_before.enclosed(), of_the_set_before.relaxed,
           claims, holds_them_all};
  for (Index j = 0; j < directions.cols() && !violation_; ++j) {
    if (stop && stop->load()) return;
    along(directions.col(j), by);
  }
  for (Index i = 0; i < row_.rows.rows() && !violation_ && !reported_empty(); ++i) {
    if (stop && stop->load()) return;
    along(row_.rows.H.row(i), by);
  }
  exact_stays_ = claims && !violation_;
}

void StepCheck::along(const Vector& d, Along& by) {
  double slack = (margin_ + direction_tolerance * size_).dot(d.cwiseAbs()) + rounding::tiny;
  const bool coordinate = (d.array() != 0).count() == 1;
  Index i = 0;
  d.cwiseAbs().maxCoeff(&i);
  const double hull = !coordinate ? infinity
                      : d[i] > 0  ? d[i] * step_.hull.upper[i]
                                  : d[i] * step_.hull.lower[i];
  const double limit = limit_of(d);
  const double set = reported_empty() ? -infinity : std::min(limit, support(row_.set, d));
  double reached = reported_empty() ? -infinity : std::min(limit, lower_support(row_.set, d));
  const auto settled = [&](const Bound& bound) {
    return bound.shown && bound.value + share_of_proof * slack <= std::min(hull, reached) + slack;
  };
  if (by.enclosed) {
    const Bound bound(*by.enclosed, d, slack);
    const bool in_hull = bound.shown && bound.value + share_of_proof * slack <= hull + slack;
    if (in_hull && !settled(bound) && !reported_empty())
      reached = std::max(reached, std::min(limit, least_support(row_.set, d)));
    if (settled(bound) && !(by.claims && reached > bound.value + slack)) return;
  }
  const Bound bound(by.successors, d, slack);
  const double needed = bound.value;
  const bool beyond = by.claims && needed != -infinity && reached > needed + slack &&
                      (!nominal_ || reached > needed + slack + by.moved(d));
  if (beyond && nominal_ && reached <= by.reach(d) + slack) {
    return open(fmt::format(
        "whether the estimate keeps to the successors of the set before along {}", text(d)));
  }
  if (beyond) {
    return violated(fmt::format("the estimate is claimed exact, but reaches {:.17g} along {} where "
                                "no successor of the set before that is "
                                "consistent with the data lies beyond {:.17g}",
                                reached, text(d), needed),
                    true);
  }
  // nothing beyond: a rational proof that the successors keep below a value that the set is proven
  // to reach
  const double allowed = std::min(hull, set);
  if (allowed == infinity && needed == infinity && row_.set.lines() > 0) return;
  if (settled(bound)) return;
  try {
    const Interval exact = exact::support(by.successors, d);
    const bool misses = exact.lower > allowed + slack && exact.lower < infinity;
    if (misses && nominal_) slack += by.moved(d);
    const bool by_rounding =
        misses && nominal_ && exact.lower <= allowed + slack + (by.reach(d) - exact.lower);
    if (std::isfinite(slack)) {
      if (exact.lower > allowed + slack && by.holds_them_all && !by_rounding) {
        const bool of_hull = allowed == hull && coordinate;
        return violated(fmt::format("a successor of the set before, consistent with the data, "
                                    "reaches {:.17g} along {}; the "
                                    "reported {} only {:.17g}",
                                    exact.lower, text(d), of_hull ? "hull" : "set", allowed),
                        !of_hull);
      }
      if (exact.upper <= std::min(hull, reached) + slack) return;
      if (!reported_empty() &&
          exact.upper <= std::min({hull, limit, exact::support(row_.set, d).lower}) + slack)
        return;
    }
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
  }
  open(fmt::format(
      "whether the reported set reaches as far along {} as the successors of the set before",
      text(d)));
}

}  // namespace cordon::verification
