// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/separation_problem.hpp"

#include <fmt/format.h>

namespace cordon::designers {

double Cost::at(VectorIn u) const {
  const Vector apart = (u - reference).cwiseAbs();
  if (u.size() == 0) return 0;
  switch (kind) {
    case Kind::norm_1:
      return weights.dot(apart);
    case Kind::norm_inf:
      return weights.cwiseProduct(apart).maxCoeff();
    case Kind::quadratic:
      return weights.dot(apart.cwiseAbs2());
  }
  return 0;
}

Matrix by_time(VectorIn u, Index inputs) {
  return u.reshaped(inputs, inputs > 0 ? u.size() / inputs : 0).transpose();
}

Vector stacked(const Matrix& u) { return u.transpose().reshaped(); }

std::string modes_of(const SeparationProblem& problem, const PairProgram& pair) {
  const auto& names = problem.modes;
  if (static_cast<Index>(names.size()) <= pair.j)
    return fmt::format("modes {} and {}", pair.i + 1, pair.j + 1);
  return fmt::format("\"{}\" and \"{}\"", names[static_cast<std::size_t>(pair.i)],
                     names[static_cast<std::size_t>(pair.j)]);
}

}  // namespace cordon::designers
