// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory_proof.hpp"

#include <cmath>

#include "solvers/rational_system.hpp"

namespace cordon::verification {

using rational::exact;
using rational::RationalMatrix;
using rational::RationalVector;

TrajectoryProof::TrajectoryProof(const TrajectoryProgram& program, VectorIn multipliers,
                                 Index column, double sign)
    : program_(program),
      entries_of_row_(program.values_.size()),
      multipliers_(program.values_.size()),
      left_(program.lower_.size()) {
  if (column >= 0) left_[as_size(column)] = exact(sign);
  for (std::size_t e = 0; e < program.entries_.size(); ++e)
    entries_of_row_[as_size(program.entries_[e].row)].push_back(e);
  for (Index i = 0; i < multipliers.size(); ++i)
    if (multipliers[i] != 0) move(i, exact(multipliers[i]));
}

void TrajectoryProof::move(Index row, const Rational& by) {
  multipliers_[as_size(row)] += by;
  for (const std::size_t e : entries_of_row_[as_size(row)]) {
    const SparseProgram::Entry& entry = program_.entries_[e];
    left_[as_size(entry.col)] -= by * exact(entry.value);
  }
}

std::optional<rational::Rational> TrajectoryProof::least() const {
  Rational sum = 0;
  for (std::size_t i = 0; i < multipliers_.size(); ++i) {
    const Rational& y = multipliers_[i];
    if (y == 0) continue;
    const double bound = y > 0 ? program_.values_[i].lower : program_.values_[i].upper;
    if (!std::isfinite(bound)) return std::nullopt;
    sum += y * exact(bound);
  }
  for (std::size_t j = 0; j < left_.size(); ++j) {
    if (left_[j] == 0) continue;
    const double bound = left_[j] > 0 ? program_.lower_[j] : program_.upper_[j];
    if (!std::isfinite(bound)) return std::nullopt;
    sum += left_[j] * exact(bound);
  }
  return sum;
}

bool TrajectoryProof::is_open(Index column) const {
  const auto j = as_size(column);
  return program_.lower_[j] < -TrajectoryProgram::unbounded ||
         program_.upper_[j] > TrajectoryProgram::unbounded;
}

bool TrajectoryProof::follow_states() {
  const auto& states = program_.states_;
  for (std::size_t t = states.size(); t-- > 1;) {
    const TrajectoryProgram::States& now = states[t];
    for (Index i = 0; i < now.seen.cols(); ++i) {
      const Rational part = left_[as_size(now.column + i)];
      if (part == 0 || !is_open(now.column + i)) continue;
      if (now.row < 0) return false;
      move(now.row + i, part);
    }
  }
  return true;
}

bool TrajectoryProof::leaves_out_states() {
  const auto& states = program_.states_;
  return follow_states() && (states.empty() || (close(states.front()) && follow_states()));
}

/// Of an output's multiplier, on the parts of the first states once those behind are left out.
RationalVector TrajectoryProof::influence(std::size_t stage, Index output) const {
  const auto& states = program_.states_;
  RationalVector v = exact(Vector(states[stage].seen.row(output).transpose()));
  for (Rational& entry : v) entry = -entry;
  for (std::size_t t = stage; t > 0; --t) {
    const Matrix& slopes = states[t].slopes;
    RationalVector before(as_size(slopes.cols()));
    for (Index i = 0; i < slopes.rows(); ++i)
      for (Index j = 0; j < slopes.cols(); ++j)
        if (slopes(i, j) != 0 && v[as_size(i)] != 0 && is_open(states[t].column + i))
          before[as_size(j)] += exact(slopes(i, j)) * v[as_size(i)];
    v = std::move(before);
  }
  return v;
}

bool TrajectoryProof::close(const TrajectoryProgram::States& first) {
  const auto& states = program_.states_;
  const Index n = first.seen.cols();
  std::vector<Index> open;
  for (Index i = 0; i < n; ++i)
    if (is_open(first.column + i)) open.push_back(i);
  if (open.empty()) return true;
  std::vector<std::pair<std::size_t, Index>> outputs;
  for (std::size_t t = 0; t < states.size() && std::ssize(outputs) < 2 * n; ++t)
    for (Index i = 0; i < states[t].seen.rows(); ++i) outputs.push_back({t, i});
  RationalMatrix K(std::ssize(open), std::ssize(outputs));
  for (Index at = 0; at < K.cols(); ++at) {
    const RationalVector effect =
        influence(outputs[as_size(at)].first, outputs[as_size(at)].second);
    for (Index i = 0; i < K.rows(); ++i) K(i, at) = effect[as_size(open[as_size(i)])];
  }
  RationalVector target;
  for (const Index i : open) target.push_back(-left_[as_size(first.column + i)]);
  const auto moves = rational::solve(K, target, Vector::Ones(K.cols()));
  if (!moves) return false;
  for (Index at = 0; at < K.cols(); ++at) {
    const auto& [stage, output] = outputs[as_size(at)];
    if ((*moves)[as_size(at)] != 0) move(states[stage].outputs + output, (*moves)[as_size(at)]);
  }
  return true;
}

}  // namespace cordon::verification
