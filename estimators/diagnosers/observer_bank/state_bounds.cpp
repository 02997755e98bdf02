// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/state_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;
using sets::Zonotope;

constexpr double parallel =
    1e-9;  // share of a row that may stand across a direction whose support is known

Vector size_of(const std::vector<Zonotope>& all, Index n) {
  Vector size = Vector::Zero(n);
  for (const Zonotope& Z : all)
    size = size.cwiseMax(Z.c.cwiseAbs() + Z.G.cwiseAbs().rowwise().sum());
  return size;
}

}  // namespace

std::vector<Zonotope> plant_starts(const ModeBank& bank, const OfflineOptions& options) {
  if (options.initial_set)
    return {invariant::enclosing_zonotope(*options.initial_set, "the initial set")};
  std::vector<Zonotope> starts;
  for (const Mode& mode : bank.modes) {
    Zonotope start =
        invariant::enclosing_zonotope(mode.model.X0, "X0 of mode \"" + mode.name + "\"");
    const bool known = std::any_of(starts.begin(), starts.end(), [&](const Zonotope& other) {
      return other.c == start.c && other.G.cols() == start.G.cols() && other.G == start.G;
    });
    if (!known) starts.push_back(std::move(start));
  }
  return starts;
}

StateBounds::StateBounds(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
                         const OfflineOptions& options)
    : accuracy_(options.accuracy) {
  const ModeDynamics& first = modes.front();
  const Index n = first.A.rows();
  if (options.state_set) {
    set_ = invariant::enclosing_zonotope(*options.state_set, "the state set");
    if (set_->dim() != n)
      throw Error(Errc::dimension, "the state set has another dimension than the models");
    return;
  }
  const bool same = std::all_of(modes.begin(), modes.end(),
                                [&](const ModeDynamics& mode) { return mode.A == first.A; });
  if (!same || invariant::is_schur(first.A) != Answer::yes) return;
  for (const ModeDynamics& mode : modes) drives_.push_back(plant_drive(mode));
  starts_ = plant_starts(bank, options);
  decay_.emplace(first.A, size_of(drives_, n), "A");
  Matrix directions(n + first.C_raw.rows(), n);
  directions << Matrix::Identity(n, n), first.C_raw;
  for (Index k = 0; k < directions.rows(); ++k) {
    const Vector d = directions.row(k).transpose();
    const invariant::SwitchedSupports h =
        invariant::switched_supports(*decay_, drives_, starts_, d, accuracy_);
    computed_.emplace_back(d, Interval{-h.minus, h.plus});
  }
}

/// The bound along a direction that is known, times a factor, and what is left of the row by the
/// bounds of the coordinates.
Interval StateBounds::along(VectorIn row) const {
  const Index n = row.size();
  for (const auto& [d, range] : computed_) {
    const double length = d.squaredNorm();
    if (length == 0) continue;
    const double factor = row.dot(d) / length;
    const Vector rest = row - factor * d;
    if (!(rest.norm() <= parallel * row.norm())) continue;
    double slack = 0;
    for (Index i = 0; i < n; ++i) {
      const Interval& x = computed_[static_cast<std::size_t>(i)].second;
      const double error =
          std::abs(rest[i]) + 4 * rounding::unit * (std::abs(row[i]) + std::abs(factor * d[i]));
      slack += error * std::max(std::abs(x.lower), std::abs(x.upper));
    }
    const double a = factor * range.lower, b = factor * range.upper;
    slack = slack * (1 + 1e-12) + 2 * rounding::unit * std::max(std::abs(a), std::abs(b));
    return {rounding::down(std::min(a, b) - slack), rounding::up(std::max(a, b) + slack)};
  }
  const invariant::SwitchedSupports h =
      invariant::switched_supports(*decay_, drives_, starts_, row, accuracy_);
  return {-h.minus, h.plus};
}

Zonotope StateBounds::image(const Matrix& T) const {
  if (set_) return sets::affine_map(*set_, T, Vector::Zero(T.rows()));
  if (!decay_) {
    throw Error(Errc::invalid,
                "the state acts on the errors, since modes differ in A or C or sensors have "
                "ranges, and nothing bounds it: give "
                "\"state_set\"");
  }
  Vector center(T.rows()), radius(T.rows());
  for (Index i = 0; i < T.rows(); ++i) {
    const Interval range = along(T.row(i).transpose());
    center[i] = 0.5 * range.lower + 0.5 * range.upper;
    radius[i] = rounding::up(std::max(range.upper - center[i], center[i] - range.lower));
  }
  if (T.isZero(0)) return {center, Matrix(T.rows(), 0)};
  return sets::drop_zero_generators({center, radius.asDiagonal()});
}

Vector StateBounds::magnitude(const Matrix& T) const {
  const Box hull = sets::interval_hull(image(T));
  return hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
}

Vector observer_slack(const ModeDynamics& observer, const invariant::Decay& decay,
                      const Vector& state, const Vector& error, double accuracy) {
  const Index q = observer.C.rows(), n = observer.A.rows();
  std::vector<Zonotope> columns;
  for (Index b = 0; b < q; ++b) columns.push_back({Vector::Zero(n), observer.L.col(b)});
  Matrix K(q, q);
  for (Index a = 0; a < q; ++a) {
    const auto supports =
        invariant::minimal_supports(decay, columns, observer.C_raw.row(a).transpose(), accuracy);
    for (Index b = 0; b < q; ++b)
      K(a, b) = observer.g_rad[a] * supports[static_cast<std::size_t>(b)].plus.upper;
  }
  const Vector constant = observer.g_rad.cwiseProduct(observer.feedthrough + state + error);
  const std::optional<Matrix> s = linalg::solve(Matrix::Identity(q, q) - K, constant);
  if (s && (s->array() >= 0).all() && invariant::is_schur(K) == Answer::yes) {
    const Vector raised = s->col(0) * (1 + 1e-12);
    if (((product(K, raised) + constant).array() <= raised.array()).all() || constant.isZero(0))
      return raised;
  }
  throw Error(Errc::invalid,
              "the ranges of the sensors of mode \"" + observer.name +
                  "\" are too wide: the error of its observer has no bound with this gain");
}

}  // namespace cordon::estimators
