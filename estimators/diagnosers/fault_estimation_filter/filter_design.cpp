// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/fault_estimation_filter/filter_design.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "left_inverse.hpp"

namespace cordon::estimators {

using linalg::product;

namespace {

/// A response below this part of the numbers that it is made of is none.
constexpr double response_tolerance = 1e-12;
/// An equation that the design rests on holds to this.
constexpr double identity_tolerance = 1e-11;
/// Of a fault, by which estimates may be wrong: rounding.
constexpr double negligible_share = 1e-9;
/// Relative size of a direction's entries that messages name.
constexpr double visible_entry = 1e-6;

Matrix stacked(const Matrix& top, const Matrix& bottom) {
  Matrix both(top.rows() + bottom.rows(), top.cols());
  both << top, bottom;
  return both;
}

std::string text_of(VectorIn direction) {
  std::string text = "(";
  for (Index i = 0; i < direction.size(); ++i) {
    char number[32];
    const double entry = std::abs(direction[i]) < visible_entry ? 0.0 : direction[i];
    std::snprintf(number, sizeof number, "%s%.3g", i ? ", " : "", entry);
    text += number;
  }
  return text + ")";
}

/// "faults 1, 2 and 4", counted from 1 as people do.
std::string names_of(const std::vector<Index>& faults) {
  std::string text = faults.size() == 1 ? "fault " : "faults ";
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (i > 0) text += i + 1 == faults.size() ? " and " : ", ";
    text += std::to_string(faults[i] + 1);
  }
  return text;
}

bool is_identity(const Matrix& A) {
  return (A - Matrix::Identity(A.rows(), A.cols())).cwiseAbs().maxCoeff() <= identity_tolerance;
}

/// How a fault first shows in the outputs.
struct Response {
  Index delay;      ///< ρ
  Vector state;     ///< (TA)^(ρ-1) T f
  Vector left_out;  ///< of the responses before
};

/// After n steps of silence there is never a response.
std::optional<Response> first_response(const Matrix& T, const Matrix& A, const Matrix& C,
                                       VectorIn f) {
  const Matrix TA = product(T, A), TA_size = product(T.cwiseAbs(), A.cwiseAbs());
  Vector state = product(T, f);
  Vector size = product(T.cwiseAbs(), f.cwiseAbs()), left_out = Vector::Zero(C.rows());
  for (Index delay = 1; delay <= state.size(); ++delay) {
    const Vector response = product(C, state);
    if ((response.cwiseAbs().array() > response_tolerance * product(C.cwiseAbs(), size).array())
            .any())
      return Response{delay, state, left_out};
    left_out += response.cwiseAbs();
    state = product(TA, state);
    size = product(TA_size, size);
  }
  return {};
}

/// T and N of the design.
bool find_T_and_N(const Matrix& E, const Matrix& C, const Matrix& S, FilterDesign& design,
                  std::vector<Diagnostic>& problems) {
  const Index n = E.cols(), m = C.rows();
  const Matrix theta = stacked(E, C);
  if (const Matrix unseen = linalg::null_space(theta); unseen.cols() > 0) {
    problems.push_back({"/type",
                        "rank [E; C] is " + std::to_string(n - unseen.cols()) + ", the state has " +
                            std::to_string(n) +
                            ", as far as doubles tell: neither E nor C sees the direction " +
                            text_of(unseen.col(0)),
                        "measure it, or describe its dynamics in E"});
    return false;
  }
  Matrix rest;
  const Matrix inverse = left_inverse(theta, &rest);
  const Matrix both = inverse + product(S, rest);
  design.T = both.leftCols(n);
  design.N = both.rightCols(m);
  if (is_identity(product(design.T, E) + product(design.N, C))) return true;
  problems.push_back(
      {"/type",
       "[E; C] is so near to a smaller rank that T E + N C = I cannot be solved in doubles",
       "scale states and outputs to like sizes"});
  return false;
}

bool find_responses(const LinearModel& model, FilterDesign& design,
                    std::vector<Diagnostic>& problems) {
  const Matrix TA = product(design.T, model.A);
  const Index q = model.faults();
  design.Psi = Matrix(model.states(), q);
  design.left_out = Matrix::Zero(model.outputs(), q);
  std::vector<Index> silent;
  for (Index i = 0; i < q; ++i) {
    const auto response = first_response(design.T, model.A, model.C, model.F.col(i));
    if (!response) {
      silent.push_back(i);
      continue;
    }
    design.delays.push_back(response->delay);
    design.Psi.col(i) = response->state;
    design.left_out.col(i) = response->left_out;
  }
  design.Upsilon = product(model.C, design.Psi);
  design.Phi = product(TA, design.Psi);
  if (silent.empty()) return true;
  problems.push_back(
      {"/free_matrix",
       names_of(silent) + (silent.size() == 1 ? " does" : " do") +
           " not show in the outputs: C (TA)^j T f = 0 for all j, as far as doubles tell",
       "measure what it acts on; if it acts in rows where E is 0 only, give a free_matrix S with T "
       "f ≠ 0"});
  return false;
}

/// The faults that cancel each other in the outputs; none if rank Υ = q.
std::vector<Index> alike(const Matrix& normalised) {
  const Matrix unseen = linalg::null_space(normalised);
  std::vector<Index> faults;
  for (Index i = 0; i < unseen.rows(); ++i) {
    if (unseen.cols() > 0 && unseen.row(i).cwiseAbs().maxCoeff() > visible_entry)
      faults.push_back(i);
  }
  return faults;
}

bool find_M_and_Omega(FilterDesign& design, std::vector<Diagnostic>& problems) {
  const Index m = design.Upsilon.rows(), q = design.Upsilon.cols();
  if (q > m) {
    problems.push_back({"/type",
                        "the system has " + std::to_string(q) + " faults, which " +
                            std::to_string(m) + (m == 1 ? " output" : " outputs") +
                            " cannot tell apart",
                        "give F no more columns than there are outputs"});
    return false;
  }
  const Vector scale = design.Upsilon.colwise().norm().cwiseInverse();
  const Matrix normalised = design.Upsilon * scale.asDiagonal();
  if (const auto faults = alike(normalised); !faults.empty()) {
    problems.push_back({"/type",
                        names_of(faults) + " act alike on the outputs: their first responses C "
                                           "(TA)^(ρ-1) T f are linearly dependent, "
                                           "as far as doubles tell",
                        "take one of them out of F, or measure more"});
    return false;
  }
  design.M = scale.asDiagonal() * linalg::pseudo_inverse(normalised);
  const Matrix Omega = linalg::null_space(normalised.transpose()).transpose();
  // entries that are rounding, and times the noise of their outputs all there is of it
  const Vector least = tolerances::product_noise * Omega.cwiseAbs().rowwise().maxCoeff();
  design.Omega = (Omega.array().abs() <= least.replicate(1, m).array()).select(0.0, Omega);
  return true;
}

/// Estimates n̂ = M (y - …) hold M times what faults show before their first response: where that is
/// no rounding, they would be wrong by it, whatever the size of the fault.
bool is_first_response_clear(const FilterDesign& design, std::vector<Diagnostic>& problems) {
  const Matrix wrong = product(design.M.cwiseAbs(), design.left_out);
  Index estimate = 0, fault = 0;
  const double share = wrong.maxCoeff(&estimate, &fault);
  if (!(share > negligible_share)) return true;
  char number[32];
  std::snprintf(number, sizeof number, "%.3g", share);
  problems.push_back({"/type",
                      names_of({fault}) +
                          " shows in the outputs before the response that it is told by, so weakly "
                          "that it is taken for none: bounds of " +
                          names_of({estimate}) + " would be wrong by " + number + " of it",
                      "measure it better, or scale states and outputs to like sizes"});
  return false;
}

}  // namespace

std::optional<FilterDesign> design_filter(const LinearModel& model, const Matrix& S,
                                          std::vector<Diagnostic>& problems) {
  const Index n = model.states();
  FilterDesign design;
  if (!find_T_and_N(model.is_descriptor() ? model.E : Matrix(Matrix::Identity(n, n)), model.C, S,
                    design, problems))
    return {};
  if (!find_responses(model, design, problems)) return {};
  if (!find_M_and_Omega(design, problems)) return {};
  if (!is_first_response_clear(design, problems)) return {};
  return design;
}

}  // namespace cordon::estimators
