// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/bounded_program.hpp"

#include <algorithm>

#include "cordon/core/rounding.hpp"

namespace cordon::designers {

namespace {

/// min of d x for d in the range and l ≤ x ≤ u, rounded down.
double least_product(Interval d, double l, double u) {
  return rounding::down(std::min({d.lower * l, d.lower * u, d.upper * l, d.upper * u}));
}

}  // namespace

double roomy(double bound) { return bound * (1 + 1e-9) + 1e-300; }

Index BoundedProgram::add_column(double from, double to, double price) {
  const Index j = lower.size();
  A.conservativeResize(b.size(), j + 1);
  A.col(j).setZero();
  for (Vector* v : {&lower, &upper, &cost}) v->conservativeResize(j + 1);
  lower[j] = from;
  upper[j] = to;
  cost[j] = price;
  return j;
}

Index BoundedProgram::add_row(const Vector& row, double right, double row_error) {
  const Index i = b.size();
  A.conservativeResize(i + 1, lower.size());
  A.row(i).setZero();
  A.row(i).head(row.size()) = row.transpose();
  for (Vector* v : {&b, &error}) v->conservativeResize(i + 1);
  b[i] = right;
  error[i] = row_error;
  return i;
}

void BoundedProgram::add_row_above(Vector row, double right, double row_error, double most) {
  const Index slack = add_column(0, roomy(std::max(0.0, most)), 0);
  row.conservativeResizeLike(Vector::Zero(slack + 1));
  row[slack] = -1;
  add_row(row, right, row_error);
}

double proven_minimum(const BoundedProgram& program, VectorIn y) {
  if (!y.allFinite()) return -infinity;
  const Index n = program.lower.size();
  Vector parts(n + 2);
  for (Index j = 0; j < n; ++j) {
    const Interval reduced =
        rounding::subtract({program.cost[j], program.cost[j]}, rounding::dot(program.A.col(j), y));
    parts[j] = least_product(reduced, program.lower[j], program.upper[j]);
  }
  parts[n] = rounding::dot(program.b, y).lower;
  parts[n + 1] = -rounding::dot(program.error, y.cwiseAbs()).upper;
  return rounding::sum(parts).lower;
}

}  // namespace cordon::designers
