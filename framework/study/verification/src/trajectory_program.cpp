// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/trajectory_program.hpp"

#include <algorithm>
#include <cmath>

#include "trajectory_proof.hpp"

namespace cordon::verification {

namespace {

/// Is the set the box of its hull?
bool is_box(const LineForm& set) {
  if (set.lines() > 0 || set.constraints() > 0) return false;
  for (Index i = 0; i < set.dim(); ++i)
    if ((set.G.row(i).array() != 0).count() > 1) return false;
  for (Index j = 0; j < set.generators(); ++j)
    if ((set.G.col(j).array() != 0).count() > 1) return false;
  return true;
}

/// Rⁿ, as it is written most simply?
bool is_space(const LineForm& set) {
  return set.generators() == 0 && set.constraints() == 0 && set.M.isIdentity(0);
}

std::vector<Interval> points(VectorIn values) {
  std::vector<Interval> all;
  for (const double value : values) all.push_back({value, value});
  return all;
}

Vector vector(const std::vector<double>& numbers) {
  return Eigen::Map<const Vector>(numbers.data(), std::ssize(numbers));
}

}  // namespace

Index TrajectoryProgram::columns(const Box& bounds) {
  const Index first = columns();
  for (Index i = 0; i < bounds.dim(); ++i) {
    lower_.push_back(bounds.lower[i]);
    upper_.push_back(bounds.upper[i]);
  }
  return first;
}

Index TrajectoryProgram::rows(const std::vector<Term>& terms, std::span<const Interval> values) {
  const Index first = std::ssize(values_);
  values_.insert(values_.end(), values.begin(), values.end());
  for (const Term& term : terms) {
    for (Index i = 0; i < term.block.rows(); ++i)
      for (Index j = 0; j < term.block.cols(); ++j)
        if (term.block(i, j) != 0)
          entries_.push_back({first + i, term.first + j, term.block(i, j)});
  }
  return first;
}

void TrajectoryProgram::element(const LineForm& set, Index first) {
  if (is_box(set) || is_space(set)) return;
  const Index g = set.generators(), l = set.lines();
  const Index factors = columns({Vector::Constant(g, -1), Vector::Constant(g, 1)}),
              lines = columns({Vector::Constant(l, -infinity), Vector::Constant(l, infinity)});
  rows({{first, Matrix::Identity(set.dim(), set.dim())}, {factors, -set.G}, {lines, -set.M}},
       points(set.c));
  rows({{factors, set.A}, {lines, set.S}}, points(set.b));
}

SparseProgram TrajectoryProgram::plain() const {
  const Index m = std::ssize(values_);
  SparseProgram program;
  program.entries = entries_;
  program.cost = Vector::Zero(columns());
  program.lower = vector(lower_);
  program.upper = vector(upper_);
  program.lower = (program.lower.array() < -unbounded).select(-infinity, program.lower);
  program.upper = (program.upper.array() > unbounded).select(infinity, program.upper);
  program.row_lower.resize(m);
  program.row_upper.resize(m);
  for (Index i = 0; i < m; ++i) {
    program.row_lower[i] = values_[as_size(i)].lower;
    program.row_upper[i] = values_[as_size(i)].upper;
  }
  return program;
}

namespace {

void extend(Vector& vector, Index by, double value) {
  vector.conservativeResize(vector.size() + by);
  vector.tail(by).setConstant(value);
}

/// Size of what each row adds up.
Vector sizes_of(const SparseProgram& program) {
  Vector size = Vector::Zero(program.row_lower.size());
  for (const SparseProgram::Entry& entry : program.entries) {
    const double width = program.upper[entry.col] - program.lower[entry.col];
    size[entry.row] =
        std::max(size[entry.row], std::abs(entry.value) * (std::isfinite(width) ? width : 1));
  }
  return (size.array() > 0).select(size, 1.0);
}

}  // namespace

/// Rows may be missed, each at a cost of what it amounts to.
bool TrajectoryProgram::proves_none(double seconds) const {
  constexpr double negligible = 1e-9;
  const Index m = std::ssize(values_), n = columns();
  for (std::size_t j = 0; j < lower_.size(); ++j)
    if (lower_[j] > upper_[j]) return true;
  SparseProgram program = plain();
  const Vector size = sizes_of(program);
  extend(program.cost, 2 * m, 1.0);
  extend(program.lower, 2 * m, 0.0);
  extend(program.upper, 2 * m, infinity);
  for (Index i = 0; i < m; ++i) {
    program.entries.push_back({i, n + i, size[i]});
    program.entries.push_back({i, n + m + i, -size[i]});
  }
  const LinearProgram::Solution solution = minimize(program, seconds);
  if (solution.status != LinearProgram::Status::optimal) return false;
  const Vector weights = solution.y.cwiseProduct(size).cwiseAbs();
  const double most = weights.size() ? weights.maxCoeff() : 0;
  const Vector kept = (weights.array() > negligible * most).select(solution.y, 0.0);
  TrajectoryProof proof(*this, kept, -1, 0);
  if (const auto least = proof.least(); least && *least > 0) return true;
  const bool is_closed = proof.leaves_out_states();
  const auto least = is_closed ? proof.least() : std::nullopt;
  return least && *least > 0;
}

double TrajectoryProgram::proven_bound(Index column, double sign, double seconds) const {
  SparseProgram program = plain();
  program.cost[column] = -sign;
  const LinearProgram::Solution solution = minimize(program, seconds);
  double bound = infinity;
  if (solution.status != LinearProgram::Status::optimal) return bound;
  TrajectoryProof proof(*this, solution.y, column, -sign);
  if (const auto least = proof.least()) bound = rational::enclose(-*least).upper;
  if (proof.leaves_out_states()) {
    if (const auto least = proof.least()) bound = std::min(bound, rational::enclose(-*least).upper);
  }
  return bound;
}

}  // namespace cordon::verification
