// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/node_program.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "designers/facets/quadratic_minimum.hpp"

namespace cordon::designers {

using linalg::product;
using linalg::transposed_product;

namespace {

constexpr double row_rounding = 1e-14;  ///< of the terms of a row, from computing its coefficients

constexpr double tube_room = 2e-10;  ///< kept of the factors of tubes

}  // namespace

NodeProgram::NodeProgram(const SeparationProblem& problem) : problem_(problem) {
  const InputSequences& U = problem.U;
  hard_.A.resize(0, 0);
  for (Index j = 0; j < U.G.cols(); ++j) hard_.add_column(-1, 1, 0);
  for (Index i = 0; i < U.b.size(); ++i) hard_.add_row(U.A.row(i).transpose(), U.b[i], 0);
  for (const TubeConditions& tube : problem.conditions) {
    if (tube.b.size() == 0) continue;
    const Index first = hard_.lower.size();
    for (Index j = 0; j < tube.A.cols(); ++j) hard_.add_column(-1, 1, 0);
    const Matrix by_zeta = product(tube.Omega, U.G);
    const Vector right = tube.b + product(tube.Omega, U.c);
    const Vector terms = tube.terms(U.c.cwiseAbs() + U.G.cwiseAbs().rowwise().sum());
    for (Index i = 0; i < tube.b.size(); ++i) {
      Vector row = Vector::Zero(first + tube.A.cols());
      row.head(U.G.cols()) = -by_zeta.row(i).transpose();
      row.tail(tube.A.cols()) = tube.A.row(i).transpose();
      const double scale = terms[i] > 0 ? std::exp2(-std::ilogb(terms[i])) : 1.0;
      hard_.add_row(row * scale, right[i] * scale, row_rounding * terms[i] * scale);
    }
  }
  full_ = hard_;
  add_cost();
}

void NodeProgram::add_cost() {
  const InputSequences& U = problem_.U;
  const Cost& cost = problem_.cost;
  const Index n = U.c.size();
  const Vector apart = U.c - cost.reference;
  const Vector spread = U.G.cwiseAbs().rowwise().sum();
  reach_ = apart.cwiseAbs() + spread;
  column_.assign(static_cast<std::size_t>(n), -1);

  Vector price = cost.weights.cwiseProduct(reach_);
  if (cost.kind == Cost::Kind::quadratic) price = price.cwiseProduct(reach_);
  unit_ = n > 0 && price.maxCoeff() > 0 ? price.maxCoeff() : 1;
  price /= unit_;
  price_ = price;
  double least = 0;  // of what does not change
  for (Index i = 0; i < n; ++i) {
    if (spread[i] == 0)
      least = cost.kind == Cost::Kind::norm_inf ? std::max(least, price[i]) : least + price[i];
  }
  least *= 1 - 1e-14;
  Index largest = -1;
  if (cost.kind == Cost::Kind::norm_inf) {
    largest = full_.add_column(least, 1 + 1e-9, 1);
  } else {
    constant_ = least * unit_;
  }
  for (Index i = 0; i < n; ++i) {
    if (spread[i] == 0 || price[i] == 0) continue;
    const Vector by_zeta = U.G.row(i).transpose() / reach_[i];
    const double offset = apart[i] / reach_[i];
    const auto k = static_cast<std::size_t>(i);
    switch (cost.kind) {
      case Cost::Kind::norm_1: {
        column_[k] = full_.add_column(0, 1 + 1e-9, price[i]);
        full_.add_column(0, 1 + 1e-9, price[i]);
        Vector row = Vector::Zero(full_.lower.size());
        row.head(by_zeta.size()) = -by_zeta;
        row[column_[k]] = 1;
        row[column_[k] + 1] = -1;
        full_.add_row(row, offset, row_rounding);
        break;
      }
      case Cost::Kind::norm_inf:
        for (const double sign : {1.0, -1.0}) {
          Vector row = Vector::Zero(full_.lower.size());
          row.head(by_zeta.size()) = -sign * price[i] * by_zeta;
          row[largest] = 1;
          full_.add_row_above(row, sign * price[i] * offset, row_rounding, 2);
        }
        break;
      case Cost::Kind::quadratic:
        column_[k] = full_.add_column(0, 1 + 1e-9, price[i]);
        for (const double at : {-1.0, -.5, .5, 1.0}) touch(full_, i, at);
        break;
    }
  }
}

/// t_i - 2 τ (G_i ζ)/σ_i ≥ 2 τ (c_i - r_i)/σ_i - τ²
void NodeProgram::touch(BoundedProgram& program, Index i, double at) const {
  const InputSequences& U = problem_.U;
  Vector row = Vector::Zero(program.lower.size());
  row.head(U.G.cols()) = -2 * at / reach_[i] * U.G.row(i).transpose();
  row[column_[static_cast<std::size_t>(i)]] = 1;
  program.add_row_above(row, 2 * at * (U.c[i] - problem_.cost.reference[i]) / reach_[i] - at * at,
                        row_rounding, 5);
}

/// With the factors of tubes, the columns of `hard_` behind ζ, a little inside their bounds.
LinearProgram NodeProgram::inside(const BoundedProgram& program) const {
  Vector room = Vector::Ones(program.lower.size());
  const Index zetas = problem_.U.G.cols();
  room.segment(zetas, hard_.lower.size() - zetas).setConstant(1 - tube_room);
  return LinearProgram(program.A, program.b, program.lower.cwiseProduct(room),
                       program.upper.cwiseProduct(room));
}

NodeProgram::Answer NodeProgram::solve(const std::vector<const SeparatingFacet*>& chosen,
                                       const std::vector<Vector>& touched) {
  Answer answer;
  for (const SeparatingFacet* facet : chosen) {
    if (rounding::norm_1(facet->a).upper < facet->in) answer.impossible = true;
  }
  if (answer.impossible) return answer;

  BoundedProgram program = full_;
  for (const Vector& u : touched) {
    for (Index i = 0; i < u.size(); ++i) {
      if (column_[static_cast<std::size_t>(i)] >= 0)
        touch(program, i, (u[i] - problem_.cost.reference[i]) / reach_[i]);
    }
  }
  for (const SeparatingFacet* facet : chosen) {
    program.add_row_above(facet->a, facet->out, 0, facet->a.cwiseAbs().sum() - facet->in);
  }
  ++programs_;
  const LinearProgram::Solution solution = inside(program).maximize(-program.cost);
  if (solution.status != LinearProgram::Status::optimal) {
    answer.impossible = proven_impossible(chosen);
    return answer;
  }
  const auto rows = static_cast<Index>(chosen.size());
  for (Index f = 0; f < rows; ++f)
    program.b[program.b.size() - rows + f] = chosen[static_cast<std::size_t>(f)]->in;
  answer.bound = in_cost(proven_minimum(program, -solution.y));
  answer.zeta = solution.x.head(problem_.U.G.cols()).cwiseMax(-1.0).cwiseMin(1.0);
  const auto multipliers = (-unit_ * solution.y.tail(rows)).cwiseMax(0.0);
  for (Index f = 0; f < rows; ++f) answer.multipliers.push_back(multipliers[f]);
  if (problem_.cost.kind == Cost::Kind::quadratic) polish(program, chosen, solution.x, answer);
  return answer;
}

std::optional<Vector> NodeProgram::farthest(const Vector& direction) {
  Vector objective = Vector::Zero(hard_.lower.size());
  objective.head(problem_.U.G.cols()) = transposed_product(problem_.U.G, direction);
  ++programs_;
  const LinearProgram::Solution solution = inside(hard_).maximize(objective);
  if (solution.status != LinearProgram::Status::optimal) return std::nullopt;
  SeparatingFacet end{objective.head(problem_.U.G.cols())};
  end.out = end.in = solution.objective - 1e-9 * end.a.cwiseAbs().sum();
  return solve({&end}).zeta;
}

double NodeProgram::in_cost(double value) const {
  const double cost = rounding::down(constant_ + rounding::down(unit_ * value));
  return std::isfinite(cost) ? std::max(0.0, cost) : 0;
}

/// The minimum of the true cost near x. With tangents there its multipliers prove a lower bound.
void NodeProgram::polish(const BoundedProgram& program,
                         const std::vector<const SeparatingFacet*>& chosen, const Vector& x,
                         Answer& answer) {
  const InputSequences& U = problem_.U;
  const Index n = hard_.lower.size(), zetas = U.G.cols();
  const auto k = static_cast<Index>(chosen.size());
  std::vector<Index> inputs;
  for (Index i = 0; i < U.c.size(); ++i) {
    if (column_[static_cast<std::size_t>(i)] >= 0) inputs.push_back(i);
  }
  const auto q = static_cast<Index>(inputs.size());
  QuadraticProgram exact{Matrix::Zero(q, n), Vector(q), Vector(q), hard_.A, hard_.b,
                         Matrix::Zero(k, n), Vector(k)};
  exact.A.rightCols(n - zetas) *= 1 - tube_room;
  for (Index row = 0; row < q; ++row) {
    const Index i = inputs[static_cast<std::size_t>(row)];
    exact.D.row(row).head(zetas) = U.G.row(i) / reach_[i];
    exact.o[row] = (U.c[i] - problem_.cost.reference[i]) / reach_[i];
    exact.price[row] = price_[i];
  }
  for (Index f = 0; f < k; ++f) {
    exact.F.row(f).head(zetas) = chosen[static_cast<std::size_t>(f)]->a.transpose();
    exact.e[f] = chosen[static_cast<std::size_t>(f)]->out;
  }
  const std::optional<QuadraticMinimum> found = quadratic_minimum(exact, x.head(n));
  if (!found) return;

  BoundedProgram touched = program;
  const Vector at = exact.o + product(exact.D, found->z);
  for (Index row = 0; row < q; ++row)
    touch(touched, inputs[static_cast<std::size_t>(row)], at[row]);
  Vector y = Vector::Zero(touched.b.size());
  y.head(hard_.b.size()) = found->of_A;
  y.segment(program.b.size() - k, k) = found->of_F;
  y.tail(q) = exact.price;
  answer.bound = std::max(answer.bound, in_cost(proven_minimum(touched, y)));
  answer.zeta = found->z.head(zetas).cwiseMax(-1.0).cwiseMin(1.0);
  for (Index f = 0; f < k; ++f)
    answer.multipliers[static_cast<std::size_t>(f)] = unit_ * std::max(0.0, found->of_F[f]);
}

/// The least sum of what the rows miss is positive.
bool NodeProgram::proven_impossible(const std::vector<const SeparatingFacet*>& chosen) {
  BoundedProgram program = hard_;
  for (const SeparatingFacet* facet : chosen) {
    program.add_row_above(facet->a, facet->in, 0, facet->a.cwiseAbs().sum() - facet->in);
  }
  for (Index i = 0; i < program.b.size(); ++i) {
    const Vector size = program.lower.cwiseAbs().cwiseMax(program.upper.cwiseAbs());
    const double most = roomy(program.A.row(i).cwiseAbs().dot(size) + std::abs(program.b[i]));
    for (const double sign : {1.0, -1.0}) program.A(i, program.add_column(0, most, 1)) = sign;
  }
  ++programs_;
  const LinearProgram::Solution solution =
      LinearProgram(program.A, program.b, program.lower, program.upper).maximize(-program.cost);
  return solution.status == LinearProgram::Status::optimal &&
         proven_minimum(program, -solution.y) > 0;
}

}  // namespace cordon::designers
