// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the inequalities of a program.
#include "sdp_products.hpp"

namespace cordon {

namespace {

double inner(const Matrix& F, const Matrix& Y) { return F.cwiseProduct(Y).sum(); }

}  // namespace

Vector inner_products(const SemidefiniteProgram& program, const std::vector<Matrix>& Y) {
  Vector sums = Vector::Zero(program.cost.size());
  for (std::size_t j = 0; j < Y.size(); ++j) {
    for (const auto& [i, term] : program.inequalities[j].terms) sums[i] += inner(term, Y[j]);
  }
  return sums;
}

double inner_constant(const SemidefiniteProgram& program, const std::vector<Matrix>& Y) {
  double sum = 0;
  for (std::size_t j = 0; j < Y.size(); ++j) sum += inner(program.inequalities[j].constant, Y[j]);
  return sum;
}

}  // namespace cordon
