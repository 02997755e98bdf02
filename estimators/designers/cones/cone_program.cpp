// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/cones/cone_program.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/solvers/lp.hpp"

namespace cordon::designers {

namespace {

constexpr double missing_price =
    1e3;  ///< of what a sum misses, in units of the largest cost: an input that needs it is none
constexpr double cost_rounding = 1e-12;  ///< what rounding of the terms of a cost can take from it
constexpr int most_touches = 12;         ///< of tangents
constexpr double closed_tangents = 1e-10,
                 little = .01;  ///< of the bound: what a round raises it by

}  // namespace

ConeProgram::ConeProgram(const Star& star, Cost::Kind kind, Vector slack, double rounding)
    : star_(star), kind_(kind), slack_(std::move(slack)), rounding_(rounding) {}

BoundedProgram ConeProgram::program(const std::vector<const Ray*>& rays) const {
  const auto count = static_cast<Index>(rays.size());
  BoundedProgram program;
  program.A.resize(0, 0);
  for (Index j = 0; j < count; ++j) program.add_column(0, roomy(1), 0);
  for (Index q = 0; q < slack_.size(); ++q) program.add_column(0, roomy(1), missing_price);
  for (Index q = 0; q < slack_.size(); ++q) {
    Vector row = Vector::Zero(count + slack_.size());
    for (Index j = 0; j < count; ++j) row[j] = rays[static_cast<std::size_t>(j)]->inverse[q];
    const double most = row.sum() + 1 + slack_[q];
    row[count + q] = 1;
    program.add_row_above(row, 1 - slack_[q], 0, most);
  }
  for (Index i = 0; i < star_.size(); ++i) {
    Vector row = Vector::Zero(count);
    for (Index j = 0; j < count; ++j) {
      const double v = rays[static_cast<std::size_t>(j)]->v[i];
      if (v != 0) row[j] = -std::abs(v) / (v > 0 ? star_.up[i] : star_.down[i]);
    }
    program.add_row_above(row, -1 - cost_rounding - rounding_, 0, 1);
  }
  return program;
}

void ConeProgram::add_cost(BoundedProgram& program, const Matrix& sizes, double goal) const {
  const Index count = sizes.cols();
  const double unit = star_.most;
  if (kind_ == Cost::Kind::norm_1) {
    program.cost.head(count) = sizes.transpose() * star_.weights / unit;
  } else if (kind_ == Cost::Kind::norm_inf) {
    const Index largest = program.add_column(0, roomy(1), 1);
    for (Index i = 0; i < star_.size(); ++i) {
      Vector row = Vector::Zero(largest + 1);
      row.head(count) = -star_.weights[i] / unit * sizes.row(i).transpose();
      row[largest] = 1;
      program.add_row_above(row, star_.weights[i] * star_.apart[i] / unit, 0, 2);
    }
  } else {
    for (Index i = 0; i < star_.size(); ++i) {
      const double reach = star_.apart[i] + std::max(star_.up[i], star_.down[i]);
      program.add_column(0, roomy(1), star_.weights[i] * reach * reach / unit);
    }
    for (Index i = 0; i < star_.size(); ++i) {
      // at the sizes that matter to a cost up to the goal
      const double reach = star_.apart[i] + std::max(star_.up[i], star_.down[i]);
      const double weight = star_.weights[i] * reach * reach;
      const double far = weight > goal ? std::sqrt(goal / weight) : 1;
      for (const double share : {.25, .5, 1.0}) touch(program, sizes, i, share * far);
    }
  }
}

/// t_i ≥ 2 τ x - τ² for x = (apart_i + |v_i|) / reach_i
void ConeProgram::touch(BoundedProgram& program, const Matrix& sizes, Index i, double at) const {
  const double reach = star_.apart[i] + std::max(star_.up[i], star_.down[i]);
  if (!(reach > 0)) return;
  Vector row = Vector::Zero(program.lower.size());
  row.head(sizes.cols()) = -2 * at / reach * sizes.row(i).transpose();
  row[sizes.cols() + 2 * slack_.size() + star_.size() + i] = 1;
  program.add_row_above(row, 2 * at * star_.apart[i] / reach - at * at, 0, 4);
}

ConeProgram::Answer ConeProgram::solve(const std::vector<const Ray*>& rays, double goal,
                                       bool exact) const {
  const auto count = static_cast<Index>(rays.size());
  Matrix sizes(star_.size(), count);
  for (Index j = 0; j < count; ++j) sizes.col(j) = rays[static_cast<std::size_t>(j)]->v.cwiseAbs();
  BoundedProgram program = this->program(rays);
  add_cost(program, sizes, goal);
  const double shrunk = 1 - cost_rounding - 2 * rounding_;
  double constant = star_.fixed;
  if (kind_ == Cost::Kind::norm_1) constant += star_.weights.dot(star_.apart);
  Answer answer;
  for (int round = 0; round < most_touches; ++round) {
    const LinearProgram::Solution solution =
        LinearProgram(program.A, program.b, program.lower, program.upper).maximize(-program.cost);
    if (solution.status != LinearProgram::Status::optimal) return answer;
    const double least = proven_minimum(program, -solution.y), before = answer.bound;
    answer.solved = true;
    answer.lambda = solution.x.head(count);
    answer.impossible = least > 1 + 1e-6;
    const double variable = shrunk * star_.most * least;
    const double bound = kind_ == Cost::Kind::norm_inf ? std::max(constant, variable)
                                                       : shrunk * (constant + variable);
    answer.bound = std::max(answer.bound, bound);
    if (kind_ != Cost::Kind::quadratic || answer.impossible) break;
    const double raised = answer.bound - before;
    const bool may_reach = exact || answer.bound + 4 * raised >= goal;
    if (round > 0 && answer.bound > 0 &&
        raised <= (may_reach ? closed_tangents : little) * answer.bound)
      break;
    const Vector x = sizes * answer.lambda;
    for (Index i = 0; i < star_.size(); ++i) {
      const double reach = star_.apart[i] + std::max(star_.up[i], star_.down[i]);
      if (reach > 0) touch(program, sizes, i, (star_.apart[i] + x[i]) / reach);
    }
  }
  return answer;
}

}  // namespace cordon::designers
