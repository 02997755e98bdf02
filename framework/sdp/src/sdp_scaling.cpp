// SPDX-License-Identifier: GPL-3.0-or-later
// An equilibration in powers of two, and the way back.
#include "sdp_scaling.hpp"

#include <algorithm>
#include <cmath>

namespace cordon {

namespace {

double power_of_two(double value) { return std::exp2(std::round(std::log2(value))); }

/// Largest entries of every variable's matrices and of every row become 1, nearly: alternating, as
/// in an equilibration.
void equilibrate(const SemidefiniteProgram& program, ScaledProgram& scaled) {
  scaled.variable_scale = Vector::Ones(program.cost.size());
  for (const MatrixInequality& F : program.inequalities)
    scaled.row_scale.push_back(Vector::Ones(F.constant.rows()));
  for (int round = 0; round < 6; ++round) {
    Vector largest = Vector::Zero(program.cost.size());
    for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
      const Vector& d = scaled.row_scale[j];
      for (const auto& [i, term] : program.inequalities[j].terms) {
        largest[i] =
            std::max(largest[i], (d.asDiagonal() * term * d.asDiagonal()).cwiseAbs().maxCoeff());
      }
    }
    for (Index i = 0; i < largest.size(); ++i)
      scaled.variable_scale[i] = largest[i] > 0 ? 1 / largest[i] : 1;
    for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
      const MatrixInequality& F = program.inequalities[j];
      Vector& d = scaled.row_scale[j];
      Matrix magnitude = F.constant.cwiseAbs();
      for (const auto& [i, term] : F.terms)
        magnitude = magnitude.cwiseMax(scaled.variable_scale[i] * term.cwiseAbs());
      const Vector row = (d.asDiagonal() * magnitude * d.asDiagonal()).rowwise().maxCoeff();
      for (Index r = 0; r < d.size(); ++r) d[r] /= row[r] > 0 ? std::sqrt(row[r]) : 1;
    }
  }
  for (Vector& d : scaled.row_scale) d = d.unaryExpr([](double v) { return power_of_two(v); });
  scaled.variable_scale = scaled.variable_scale.unaryExpr([](double v) { return power_of_two(v); });
}

}  // namespace

ScaledProgram scale(const SemidefiniteProgram& program) {
  ScaledProgram scaled;
  equilibrate(program, scaled);
  Eigen::Matrix<Index, Eigen::Dynamic, 1> place =
      Eigen::Matrix<Index, Eigen::Dynamic, 1>::Constant(program.cost.size(), -1);
  for (const MatrixInequality& F : program.inequalities) {
    for (const auto& [i, term] : F.terms) {
      if (place[i] >= 0 || term.isZero(0)) continue;
      place[i] = static_cast<Index>(scaled.variables.size());
      scaled.variables.push_back(i);
    }
  }
  for (Index i = 0; i < place.size(); ++i)
    scaled.without_bound = scaled.without_bound || (place[i] < 0 && program.cost[i] != 0);
  scaled.program.cost.resize(static_cast<Index>(scaled.variables.size()));
  for (std::size_t i = 0; i < scaled.variables.size(); ++i) {
    const Index original = scaled.variables[i];
    scaled.program.cost[static_cast<Index>(i)] =
        program.cost[original] * scaled.variable_scale[original];
  }
  const double largest =
      scaled.program.cost.size() == 0 ? 0 : scaled.program.cost.cwiseAbs().maxCoeff();
  if (largest > 0) scaled.cost_scale = 1024 * power_of_two(1 / largest);
  scaled.program.cost *= scaled.cost_scale;
  for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
    const auto d = scaled.row_scale[j].asDiagonal();
    const auto scaled_by = [&](const Matrix& F, double factor) {
      Matrix other = factor * (d * F * d);
      scaled.exact = scaled.exact && (d.inverse() * other * d.inverse()) / factor == F;
      return other;
    };
    MatrixInequality F{scaled_by(program.inequalities[j].constant, 1), {}};
    for (const auto& [i, term] : program.inequalities[j].terms) {
      if (place[i] >= 0) F.terms.emplace_back(place[i], scaled_by(term, scaled.variable_scale[i]));
    }
    scaled.program.inequalities.push_back(std::move(F));
  }
  return scaled;
}

std::vector<Matrix> unscaled(const ScaledProgram& scaled, std::vector<Matrix> Y, double factor) {
  for (std::size_t j = 0; j < scaled.row_scale.size(); ++j) {
    const auto d = scaled.row_scale[j].asDiagonal();
    Y[j] = factor * (d * Y[j] * d);
  }
  return Y;
}

}  // namespace cordon
