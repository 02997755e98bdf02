// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/theta.hpp"

namespace cordon::estimators {

void add_theta_parameter(ParamSchema& schema) {
  schema.matrix("theta",
                "Eθ, directions in which parameter uncertainty acts in the design, a row per "
                "state; absent: a diagonal matrix of "
                "the row sums of A's radius, none where A is exact");
}

std::optional<Matrix> theta_from(const Params& params) {
  return params.has("theta") ? std::optional(params.matrix("theta")) : std::nullopt;
}

void check_theta(const Model& model, const Params& params, std::vector<Diagnostic>& problems) {
  if (!params.has("theta")) return;
  const Index rows = params.matrix("theta").rows(), n = model.linear.states();
  if (rows == n) return;
  problems.push_back(
      {"/theta",
       "has " + std::to_string(rows) + " rows, there are " + std::to_string(n) + " states",
       "a row per state, a column per direction"});
}

Matrix theta_of(const Model& model, const std::optional<Matrix>& given) {
  if (given) return *given;
  const LinearModel& m = model.linear;
  if (m.A_radius.size() == 0 || m.A_radius.maxCoeff() <= 0) return Matrix(m.states(), 0);
  return m.A_radius.rowwise().sum().asDiagonal();
}

}  // namespace cordon::estimators
