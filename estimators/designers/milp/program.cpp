// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/milp/program.hpp"

#include <cmath>
#include <limits>

namespace cordon::designers {

namespace {

void append(Vector& v, Index count, double value) {
  v.conservativeResize(v.size() + count);
  v.tail(count).setConstant(value);
}

/// The entries of `row`, from column `first` on, without those that are rounding noise beside the
/// largest: the solver scales.
Terms terms_of(const Vector& row, Index first) {
  constexpr double noise = 1e-12;
  Terms terms;
  const double least = row.size() > 0 ? noise * row.cwiseAbs().maxCoeff() : 0;
  for (Index j = 0; j < row.size(); ++j) {
    if (std::abs(row[j]) > least) terms.emplace_back(first + j, row[j]);
  }
  return terms;
}

Terms& operator+=(Terms& terms, const Terms& more) {
  terms.insert(terms.end(), more.begin(), more.end());
  return terms;
}

}  // namespace

InputProgram::InputProgram(const SeparationProblem& problem)
    : inputs_(problem.U.c.size()), cost_(problem.cost) {
  add_inputs(problem.U);
  add_cost();
  for (const TubeConditions& rows : problem.conditions) add_conditions(rows);
}

Index InputProgram::add_columns(Index count, double lower, double upper, bool integer) {
  const Index first = program_.cost.size();
  append(program_.cost, count, 0);
  append(program_.lower, count, lower);
  append(program_.upper, count, upper);
  program_.integer.insert(program_.integer.end(), static_cast<std::size_t>(count), integer);
  return first;
}

void InputProgram::add_row(const Terms& terms, double lower, double upper) {
  const Index row = program_.row_lower.size();
  append(program_.row_lower, 1, lower);
  append(program_.row_upper, 1, upper);
  for (const auto& [col, value] : terms) program_.entries.push_back({row, col, value});
}

void InputProgram::add_row(const Vector& a, double lower, double upper) {
  add_row(terms_of(a, 0), lower, upper);
}

void InputProgram::add_inputs(const InputSequences& U) {
  add_columns(inputs_, -infinity, infinity);
  const Vector radius = U.G.cwiseAbs().rowwise().sum();
  program_.lower = U.c - radius;
  program_.upper = U.c + radius;
  const bool box = U.b.size() == 0 && U.G.cols() <= inputs_ &&
                   ((U.G.array() != 0).cast<int>().rowwise().sum().array() <= 1).all() &&
                   ((U.G.array() != 0).cast<int>().colwise().sum().array() <= 1).all();
  if (box) return;
  const Index xi = add_columns(U.G.cols(), -1, 1);
  for (Index i = 0; i < inputs_; ++i) {
    Terms row{{i, 1.0}};
    row += terms_of(-U.G.row(i), xi);
    add_row(row, U.c[i], U.c[i]);
  }
  for (Index i = 0; i < U.b.size(); ++i) add_row(terms_of(U.A.row(i), xi), U.b[i], U.b[i]);
}

void InputProgram::add_cost() {
  const bool together = cost_.kind == Cost::Kind::norm_inf;
  costs_ = together ? 1 : inputs_;
  first_cost_ = add_columns(costs_, 0, infinity);
  program_.cost.tail(costs_).setOnes();
  if (cost_.kind == Cost::Kind::quadratic) return;  // t ≥ 0 until there are tangents
  for (Index i = 0; i < inputs_; ++i) {
    const double weight = cost_.weights[i];
    if (weight == 0) continue;
    const Index t = first_cost_ + (together ? 0 : i);
    add_row(Terms{{t, 1.0}, {i, -weight}}, -weight * cost_.reference[i], infinity);
    add_row(Terms{{t, 1.0}, {i, weight}}, weight * cost_.reference[i], infinity);
  }
}

void InputProgram::add_conditions(const TubeConditions& rows) {
  if (rows.b.size() == 0) return;
  const Index zeta = add_columns(rows.A.cols(), -1, 1);
  for (Index i = 0; i < rows.b.size(); ++i) {
    Terms row = terms_of(rows.A.row(i), zeta);
    row += terms_of(-rows.Omega.row(i), 0);
    add_row(row, rows.b[i], rows.b[i]);
  }
}

void InputProgram::limit_cost(double cost) {
  const double most = cost * (1 + 1e-9) + 1e-12;
  for (Index i = 0; i < inputs_; ++i) {
    if (cost_.weights[i] == 0 || program_.lower[i] == program_.upper[i]) continue;
    const double share = most / cost_.weights[i],
                 radius = cost_.kind == Cost::Kind::quadratic ? std::sqrt(share) : share;
    const double lower = std::max(program_.lower[i], cost_.reference[i] - radius),
                 upper = std::min(program_.upper[i], cost_.reference[i] + radius);
    if (lower > upper) continue;
    program_.lower[i] = lower;
    program_.upper[i] = upper;
  }
}

void InputProgram::add_tangents_between() {
  constexpr int parts = 8;
  for (int k = 0; k <= parts; ++k)
    add_tangents(lower() + (upper() - lower()) * (static_cast<double>(k) / parts));
}

void InputProgram::demand_cost(double cost) {
  Terms terms;
  for (Index t = first_cost_; t < first_cost_ + costs_; ++t) terms.emplace_back(t, 1.0);
  add_row(terms, cost, infinity);
}

void InputProgram::add_tangents(const Vector& u) {
  if (cost_.kind != Cost::Kind::quadratic) return;
  for (Index i = 0; i < inputs_; ++i) {
    const double weight = cost_.weights[i], apart = u[i] - cost_.reference[i];
    if (weight == 0 || apart == 0) continue;
    // t ≥ ω (d² + 2 d (u - u₀)), d = u₀ - r
    add_row(Terms{{first_cost_ + i, 1.0}, {i, -2 * weight * apart}},
            weight * apart * (apart - 2 * u[i]), infinity);
  }
}

PairColumns add_pair(InputProgram& inputs, const PairProgram& pair, double epsilon,
                     double kappa_most) {
  const Index m = pair.rows(), g = pair.G.cols();
  const Index kappa = inputs.add_columns(1, epsilon, kappa_most),
              xi = inputs.add_columns(g, -1 - kappa_most, 1 + kappa_most),
              lambda = inputs.add_columns(m, -infinity, infinity),
              mu_1 = inputs.add_columns(g, 0, 1), mu_2 = inputs.add_columns(g, 0, 1),
              p_1 = inputs.add_columns(g, 0, 1, true), p_2 = inputs.add_columns(g, 0, 1, true);
  for (Index i = 0; i < m; ++i) {
    Terms row = terms_of(pair.N.row(i), 0);
    row += terms_of(-pair.G.row(i), xi);
    inputs.add_row(row, pair.c[i], pair.c[i]);
  }
  Terms sum;
  const double far = 2 * (1 + kappa_most);
  for (Index j = 0; j < g; ++j) {
    Terms column = terms_of(pair.G.col(j), lambda);
    column += {{mu_1 + j, -1.0}, {mu_2 + j, 1.0}};
    inputs.add_row(column, 0, 0);
    sum += {{mu_1 + j, 1.0}, {mu_2 + j, 1.0}};
    inputs.add_row(Terms{{mu_1 + j, 1.0}, {p_1 + j, -1.0}}, -infinity, 0);
    inputs.add_row(Terms{{mu_2 + j, 1.0}, {p_2 + j, -1.0}}, -infinity, 0);
    inputs.add_row(Terms{{p_1 + j, 1.0}, {p_2 + j, 1.0}}, -infinity, 1);
    // ξ - 1 - κ ∈ [-2(1 + κ_m)(1 - p₁), 0],  ξ + 1 + κ ∈ [0, 2(1 + κ_m)(1 - p₂)]
    inputs.add_row(Terms{{xi + j, 1.0}, {kappa, -1.0}}, -infinity, 1);
    inputs.add_row(Terms{{xi + j, 1.0}, {kappa, -1.0}, {p_1 + j, -far}}, 1 - far, infinity);
    inputs.add_row(Terms{{xi + j, 1.0}, {kappa, 1.0}}, -1, infinity);
    inputs.add_row(Terms{{xi + j, 1.0}, {kappa, 1.0}, {p_2 + j, far}}, -infinity, far - 1);
  }
  inputs.add_row(sum, 1, 1);
  return {p_1, g};
}

}  // namespace cordon::designers
