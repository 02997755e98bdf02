// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/monotone.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/lp.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/rounded_products.hpp"

namespace cordon::estimators {

namespace {

constexpr double equal = 1e-10, margin = 1e-8, noise = 1e-9;
constexpr int most_rounds = 10;

std::string direction(const Vector& x) {
  std::string text = "(";
  for (Index i = 0; i < x.size(); ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4g", i ? ", " : "", x[i]);
    text += number;
  }
  return text + ")";
}

bool is_zero(const Matrix& C, const Vector& x) {
  return ((C * x).cwiseAbs().array() <= equal * (C.cwiseAbs() * x.cwiseAbs()).array()).all();
}

/// Is max{costᵀx : K x = 0, 0 ≤ x_j ≤ 2^bits_j} positive? In rational arithmetic; `unknown` if that
/// is too much.
Answer is_positive(const Vector& cost, const Matrix& K, const std::vector<int>& bits) {
  try {
    return exact::maximum(cost, K, Vector::Zero(K.rows()), bits).lower > 0 ? Answer::yes
                                                                           : Answer::no;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported && error.code() != Errc::invalid) throw;
    return Answer::unknown;
  }
}

Obstacle obstacle(Answer proof, const std::string& why) {
  if (proof == Answer::yes) return {Answer::no, "no monotone gain exists: " + why};
  return {Answer::unknown, "no monotone gain was sought: but for rounding, " + why};
}

/// What outputs show of the errors: C, or C A of a filter.
struct ShownErrors {
  Rounded C;
  Matrix outputs;  ///< C itself
  GainForm form = GainForm::predictor;

  bool is_exact() const { return C.error.isZero(0); }
  /// Is column j zero, whatever the numbers are that are not 0?
  bool hides(const Matrix& A, Index j) const {
    if (form == GainForm::predictor) return outputs.col(j).isZero(0);
    for (Index k = 0; k < A.rows(); ++k) {
      if (A(k, j) != 0 && !outputs.col(k).isZero(0)) return false;
    }
    return true;
  }
  const char* name() const { return form == GainForm::predictor ? "C" : "C A"; }
};

std::optional<Obstacle> by_structure(const Matrix& A, const ShownErrors& shown) {
  for (Index j = 0; j < A.cols(); ++j) {
    if (!shown.hides(A, j)) continue;
    for (Index i = 0; i < A.rows(); ++i) {
      if (A(i, j) >= 0) continue;
      const std::string row = std::to_string(i + 1), column = std::to_string(j + 1);
      return obstacle(Answer::yes, "column " + column + " of " + shown.name() + " is zero and A(" +
                                       row + "," + column + ") < 0");
    }
  }
  return std::nullopt;
}

/// Entries are scaled to 1, and what is below `noise` of that is none.
Vector without_noise(const Vector& x) {
  const double size = x.cwiseAbs().maxCoeff();
  if (!(size > 0)) return x;
  return (x / size).unaryExpr([](double value) { return value < noise ? 0.0 : value; });
}

/// Is there μ with 0 ≤ μ ≤ 1, C A μ = 0 and A_i μ < 0? By ν = A μ in two parts, C ν = 0.
Answer is_negative_row_proven(const Matrix& A, const ShownErrors& shown, Index i) {
  const Index n = A.rows(), p = shown.outputs.rows();
  std::vector<int> bits(static_cast<std::size_t>(n), 0);
  if (shown.is_exact()) return is_positive(-A.row(i).transpose(), shown.C.value, bits);
  Matrix K = Matrix::Zero(n + p, 3 * n);
  K.topLeftCorner(n, n) = A;
  K.block(0, n, n, n) = -Matrix::Identity(n, n);
  K.block(0, 2 * n, n, n).setIdentity();
  K.block(n, n, p, n) = shown.outputs;
  K.block(n, 2 * n, p, n) = -shown.outputs;
  const double largest = A.cwiseAbs().rowwise().sum().maxCoeff();
  bits.resize(static_cast<std::size_t>(3 * n), std::max(0, std::ilogb(std::max(largest, 1.)) + 2));
  Vector cost = Vector::Zero(3 * n);
  cost.head(n) = -A.row(i).transpose();
  return is_positive(cost, K, bits);
}

std::optional<Obstacle> by_row(const Matrix& A, const ShownErrors& shown) {
  const Matrix& C = shown.C.value;
  const Index n = A.rows();
  LinearProgram program(C, Vector::Zero(C.rows()), Vector::Zero(n), Vector::Ones(n));
  for (Index i = 0; i < n; ++i) {
    const Vector row = A.row(i).transpose();
    const LinearProgram::Solution solution = program.maximize(-row);
    if (solution.status != LinearProgram::Status::optimal || !(solution.objective > 0)) continue;
    const Vector mu = without_noise(solution.x);
    if (!(row.dot(mu) < -margin * row.cwiseAbs().dot(mu)) || !is_zero(C, mu)) continue;
    const Answer proof = is_negative_row_proven(A, shown, i);
    return obstacle(proof, "the outputs do not show the direction " + direction(mu) +
                               ", to four digits, and row " + std::to_string(i + 1) +
                               " of A makes a negative number of it");
  }
  return std::nullopt;
}

/// x, y_1, …, y_n and a slack s per row with A_i x - A_i y_i - x_i - s_i = 0 and C x - C y_i = 0, x
/// ≤ 1 and y, s at most twice as large as the largest of a solution. x enters twice, as A_ii - 1
/// need not be a double.
Answer is_growth_proven(const Matrix& A, const Matrix& C, double largest) {
  const Index n = A.rows(), p = C.rows(), columns = n + n * n + n + n;
  Matrix K = Matrix::Zero(2 * n + n * p, columns);
  for (Index i = 0; i < n; ++i) {
    K.block(i, 0, 1, n) = A.row(i);
    K.block(i, n + i * n, 1, n) = -A.row(i);
    K(i, n + n * n + i) = K(i, n + n * n + n + i) = -1;
    K(n + i, i) = 1;
    K(n + i, n + n * n + n + i) = -1;
    K.block(2 * n + i * p, 0, p, n) = C;
    K.block(2 * n + i * p, n + i * n, p, n) = -C;
  }
  std::vector<int> bits(static_cast<std::size_t>(columns), std::max(1, std::ilogb(largest) + 2));
  for (Index i = 0; i < n; ++i)
    bits[static_cast<std::size_t>(i)] = bits[static_cast<std::size_t>(columns - 1 - i)] = 0;
  Vector sum = Vector::Zero(columns);
  sum.head(n).setOnes();
  return is_positive(sum, K, bits);
}

std::optional<Obstacle> by_growth(const Matrix& A, const ShownErrors& shown) {
  const Matrix& C = shown.C.value;
  const Index n = A.rows(), p = C.rows(), columns = n + n * n + n;
  Matrix M = Matrix::Zero(n + n * p, columns);
  for (Index i = 0; i < n; ++i) {
    M.block(i, 0, 1, n) = A.row(i);
    M(i, i) -= 1;
    M.block(i, n + i * n, 1, n) = -A.row(i);
    M(i, n + n * n + i) = -1;
    M.block(n + i * p, 0, p, n) = C;
    M.block(n + i * p, n + i * n, p, n) = -C;
  }
  Vector upper = Vector::Constant(columns, infinity), objective = Vector::Zero(columns);
  upper.head(n).setOnes();
  objective.head(n).setOnes();
  LinearProgram program(M, Vector::Zero(M.rows()), Vector::Zero(columns), upper);
  const LinearProgram::Solution solution = program.maximize(objective);
  if (solution.status != LinearProgram::Status::optimal) return std::nullopt;
  const Vector x = solution.x.head(n).cwiseMax(0);
  if (!(x.maxCoeff() > margin)) return std::nullopt;
  for (Index i = 0; i < n; ++i) {
    const Vector y = solution.x.segment(n + i * n, n).cwiseMax(0), size = x + y;
    if (((C * (x - y)).cwiseAbs().array() > equal * (C.cwiseAbs() * size).array()).any())
      return std::nullopt;
    const double terms = x[i] + A.row(i).cwiseAbs().dot(size);
    if (A.row(i).dot(x - y) < x[i] - equal * terms) return std::nullopt;
  }
  const Answer proof = shown.is_exact()
                           ? is_growth_proven(A, C, std::max(1.0, solution.x.maxCoeff()))
                           : Answer::unknown;
  return obstacle(proof, std::string("every monotone ") + name_of_loop(shown.form) +
                             " leaves the states " + direction(without_noise(x)) +
                             ", to four digits, as large as they are, and is not stable");
}

}  // namespace

namespace {

std::optional<Obstacle> why_not_monotone(const Matrix& A, const ShownErrors& shown) {
  std::optional<Obstacle> why = by_structure(A, shown);
  if (!why) why = by_row(A, shown);
  if (!why) why = by_growth(A, shown);
  return why;
}

}  // namespace

std::optional<Obstacle> no_monotone_gain(const Matrix& A, const Matrix& C) {
  return why_not_monotone(A, {exactly(C), C});
}

std::optional<Obstacle> no_monotone_gain(const LinearModel& model, GainForm form) {
  const Matrix C = shown_outputs(model);
  if (form == GainForm::predictor) return no_monotone_gain(model.A, C);
  return why_not_monotone(model.A, {times(C, exactly(model.A)), C, form});
}

namespace {

/// ‖d‖₁ least with A_i - (L_i + d) C ≥ 0. In units of the violation, since the tolerances of linear
/// programs are absolute; entries that are far from 0 in them do not matter.
Matrix projected(const Matrix& A, const Matrix& C, Matrix L) {
  const Index n = A.rows(), p = C.rows();
  Matrix rows(n, 2 * p + n);
  rows << C.transpose(), -C.transpose(), Matrix::Identity(n, n);
  const Vector lower = Vector::Zero(2 * p + n), upper = Vector::Constant(2 * p + n, infinity);
  Vector cost = Vector::Zero(2 * p + n);
  cost.head(2 * p).setConstant(-1);
  for (Index i = 0; i < n; ++i) {
    const Vector closed = (A.row(i) - L.row(i) * C).transpose();
    const double violation = -closed.minCoeff();
    if (violation <= 0) continue;
    LinearProgram program(rows, (closed / violation).cwiseMin(1e6), lower, upper);
    const LinearProgram::Solution s = program.maximize(cost);
    if (s.status != LinearProgram::Status::optimal) continue;
    L.row(i) += violation * (s.x.head(p) - s.x.segment(p, p)).transpose();
  }
  return L;
}

}  // namespace

Matrix raised_to_monotone(const Matrix& A, const Matrix& C, Matrix L) {
  if (A.size() == 0 || L.cols() == 0) return L;
  const double size = A.cwiseAbs().maxCoeff();
  for (Index i = 0; i < A.rows(); ++i) {
    double extra = std::numeric_limits<double>::epsilon() * size / 4;
    Matrix row = L.row(i), closed = A.row(i) - linalg::product(row, C);
    double best = closed.minCoeff();
    for (int round = 0; round < most_rounds && best < 0; ++round, extra *= 2) {
      std::vector<Index> low;
      for (Index j = 0; j < A.cols(); ++j) {
        if (closed(0, j) <= extra && closed(0, j) >= -noise * size && !C.col(j).isZero(0))
          low.push_back(j);
      }
      if (low.empty()) break;
      const Vector lift = (-closed(0, low).transpose()).array() + extra;
      row -= linalg::transposed_product(lift, linalg::pseudo_inverse(C(Eigen::all, low)));
      closed = A.row(i) - linalg::product(row, C);
      if (closed.minCoeff() <= best) continue;
      best = closed.minCoeff();
      L.row(i) = row;
    }
  }
  return L;
}

Matrix made_monotone(const Matrix& A, const Matrix& C, Matrix L) {
  return raised_to_monotone(A, C, projected(A, C, std::move(L)));
}

bool is_monotone(const Matrix& A, const Matrix& C, const Matrix& L) {
  const Matrix closed = A - linalg::product(L, C);
  const Matrix terms = A.cwiseAbs() + linalg::product(L.cwiseAbs(), C.cwiseAbs());
  return (closed.array() >= -1e-12 * terms.array()).all();
}

}  // namespace cordon::estimators
