// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/cones/forbidden_reach.hpp"

#include <algorithm>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"

namespace cordon::designers {

namespace {

constexpr double most_times = 1e3;                          ///< that a direction is followed
constexpr double end_of_ray = 1 - 1e-9;                     ///< of it: Q does not end there
constexpr double widest_room = .5, narrowest_room = 1e-10;  ///< of the terms

}  // namespace

std::optional<ForbiddenReach> ForbiddenReach::of(const SeparationProblem& problem,
                                                 const PairProgram& pair, const Star& star) {
  if (pair.rows() == 0 || pair.vanished > 0) return std::nullopt;
  ScaledPair rows(pair, problem.U, problem.epsilon);
  Matrix G = rows.factor * rows.G;
  const Matrix N = (rows.scale.asDiagonal() * pair.N)(Eigen::all, star.free);
  const Vector c = rows.scale.cwiseProduct(linalg::product(pair.N, star.centre) - pair.c);
  const Vector size = G.cwiseAbs().rowwise().sum();
  if (!(size.minCoeff() > 0)) return std::nullopt;  // a row without room
  const Vector terms = rows.factor * rows.scale.cwiseProduct(pair.terms(star.centre.cwiseAbs()));
  for (double share = widest_room; share > narrowest_room; share /= 2) {
    const Vector room = share * size;
    BoxedProgram moved(G, c, {terms, room + tube_row_noise * terms});
    if (moved.is_empty() != cordon::Answer::no) continue;
    return ForbiddenReach(pair, star, std::move(rows), std::move(G), N, c, room);
  }
  return std::nullopt;
}

ForbiddenReach::Answer ForbiddenReach::along(const Vector& v) const {
  // θ = (1 + τ) most_times / 2
  const Index g = G_.cols();
  const Vector step = linalg::product(N_, v), half = .5 * most_times * step;
  Matrix A(G_.rows(), g + 1);
  A << G_, -half;
  const BoxedProgram::Bound farthest =
      BoxedProgram(std::move(A), c_ + half).maximum(Vector::Unit(g + 1, g));
  Answer answer;
  if (!farthest.solved || !farthest.xi) return answer;
  const Vector& xi = *farthest.xi;
  const double most = .5 * most_times * (1 + std::clamp(xi[g], -1.0, 1.0));
  if (xi[g] < end_of_ray && farthest.y.allFinite()) {
    const SeparatingFacet facet = facet_of(rows_, -farthest.y);
    if (!facet.a.isZero(0)) answer.facet = facet;
  }
  const Vector inside = xi.head(g).cwiseMax(-1.0).cwiseMin(1.0);
  const double noise = tube_row_noise + static_cast<double>(g + N_.cols() + 4) *
                                            std::numeric_limits<double>::epsilon();
  Vector size = star_->centre.cwiseAbs();
  size(star_->free) += most * v.cwiseAbs();
  const Vector terms = rows_.factor * rows_.scale.cwiseProduct(pair_->terms(size));
  const Vector missed = (linalg::product(G_, inside) - c_ - most * step).cwiseAbs() + noise * terms;
  const double lambda = missed.cwiseQuotient(missed + room_).maxCoeff();
  const double theta = (1 - lambda) * (1 - 1e-14) * most;
  if (theta > 0) answer.inverse = rounding::up(1 / theta);
  return answer;
}

double ForbiddenReach::inverse_within(const Vector& size) const {
  const Vector moved = (1 + tube_row_noise) * linalg::product(N_.cwiseAbs(), size);
  return moved.size() ? moved.cwiseQuotient(room_).maxCoeff() : 0;
}

}  // namespace cordon::designers
