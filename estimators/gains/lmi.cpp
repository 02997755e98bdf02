// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/lmi.hpp"

#include <algorithm>
#include <numeric>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/detectability.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

Matrix unit(Index rows, Index cols, Index i, Index j) {
  Matrix one = Matrix::Zero(rows, cols);
  one(i, j) = 1;
  return one;
}

}  // namespace

Matrix MatrixVariable::value(const Vector& x) const {
  if (basis.empty()) return Matrix::Zero(rows, cols);
  Matrix sum = x[first] * basis[0];
  for (std::size_t k = 1; k < basis.size(); ++k) sum += x[first + static_cast<Index>(k)] * basis[k];
  return sum;
}

MatrixVariable symmetric_variable(Index first, Index n) {
  MatrixVariable V{first, {}, n, n};
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i <= j; ++i) {
      Matrix one = unit(n, n, i, j);
      one(j, i) = 1;
      V.basis.push_back(std::move(one));
    }
  }
  return V;
}

MatrixVariable diagonal_variable(Index first, Index n) {
  MatrixVariable V{first, {}, n, n};
  for (Index i = 0; i < n; ++i) V.basis.push_back(unit(n, n, i, i));
  return V;
}

MatrixVariable full_variable(Index first, Index rows, Index cols) {
  MatrixVariable V{first, {}, rows, cols};
  for (Index j = 0; j < cols; ++j) {
    for (Index i = 0; i < rows; ++i) V.basis.push_back(unit(rows, cols, i, j));
  }
  return V;
}

BlockInequality::BlockInequality(std::vector<Index> sizes)
    : sizes_(std::move(sizes)), begins_(sizes_.size(), 0) {
  std::partial_sum(sizes_.begin(), sizes_.end() - 1, begins_.begin() + 1);
  const Index size = begins_.back() + sizes_.back();
  inequality_.constant = Matrix::Zero(size, size);
}

void BlockInequality::place(Matrix& whole, std::size_t i, std::size_t j,
                            const Matrix& block) const {
  whole.block(begins_[i], begins_[j], sizes_[i], sizes_[j]) += block;
  if (i != j) whole.block(begins_[j], begins_[i], sizes_[j], sizes_[i]) += block.transpose();
}

void BlockInequality::add(std::size_t i, std::size_t j, const MatrixVariable& V,
                          const Matrix& right) {
  auto& terms = inequality_.terms;
  for (std::size_t k = 0; k < V.basis.size(); ++k) {
    const Index variable = V.first + static_cast<Index>(k);
    auto at = std::find_if(terms.begin(), terms.end(),
                           [&](const auto& term) { return term.first == variable; });
    if (at == terms.end()) {
      at = terms.emplace(terms.end(), variable,
                         Matrix::Zero(inequality_.constant.rows(), inequality_.constant.cols()));
    }
    place(at->second, i, j, linalg::product(V.basis[k], right));
  }
}

void BlockInequality::add(std::size_t i, std::size_t j, const Matrix& constant) {
  place(inequality_.constant, i, j, constant);
}

ErrorDynamics error_dynamics(const Model& model, const Matrix& theta, GainForm form) {
  const LinearModel& m = model.linear;
  ErrorDisturbances d = error_disturbances(model, theta, form);
  ErrorDynamics errors{m.A, shown_errors(m, form).value, std::move(d.E.value),
                       std::move(d.N.value)};
  for (const Matrix* part : {&errors.E, &errors.N}) {
    if (part->size() > 0) errors.unit = std::max(errors.unit, part->cwiseAbs().maxCoeff());
  }
  if (errors.unit > 0) {
    errors.E /= errors.unit;
    errors.N /= errors.unit;
  }
  return errors;
}

std::vector<Diagnostic> check_design(const GainContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  check_theta(context.model, params, problems);
  for (const auto& [set, name] :
       {std::pair{&context.model.W, "W"}, std::pair{&context.model.V, "V"}}) {
    try {
      invariant::enclosing_zonotope(*set, name);
    } catch (const Error& error) {
      problems.push_back({"/type", error.what(), "a bounded set, which is not empty"});
    }
  }
  return problems;
}

GainDesign no_gain(Answer feasible, std::string reason, std::string suggestion) {
  GainDesign design;
  design.feasible = feasible;
  design.reason = std::move(reason);
  design.suggestion = std::move(suggestion);
  return design;
}

GainDesign unsolved(const SdpSolution& s) {
  return no_gain(
      Answer::unknown,
      "the matrix inequality was not solved: " +
          (s.status == SdpStatus::infeasible ? "it has no solution with variables up to 1e8"
                                             : s.why),
      "other units for states and disturbances, or another gain");
}

std::optional<GainDesign> without_gain(const Model& model, const ErrorDynamics& errors) {
  if (const std::optional<Obstacle> hidden =
          undetectable_mode(errors.A, shown_outputs(model.linear))) {
    return no_gain(hidden->gain_exists, not_detectable(*hidden), "measure what shows this mode");
  }
  if (errors.unit == 0) {
    return no_gain(Answer::unknown,
                   "nothing disturbs the errors (Bw W, Dv V and theta are zero), so that there is "
                   "nothing to minimise",
                   "another gain, such as \"kalman\"");
  }
  return std::nullopt;
}

}  // namespace cordon::estimators
