// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/exact_questions.hpp"

#include <limits>
#include <string>

#include "cordon/core/error.hpp"
#include "solvers/exact_program.hpp"

namespace cordon::exact {

namespace {

using Status = ExactProgram::Status;
constexpr double infinity = std::numeric_limits<double>::infinity();

void check_size(Index columns, Index rows, const char* question) {
  if (columns <= max_columns && rows <= max_rows) return;
  throw Error(Errc::unsupported, std::string(question) + ": " + std::to_string(columns) + " lines and generators with " +
                                     std::to_string(rows) + " constraints; in rational arithmetic at most " +
                                     std::to_string(max_columns) + " with " + std::to_string(max_rows) + " are supported");
}

ExactProgram feasibility(const LineForm& X) { return {X.S, X.A, X.b, Vector::Zero(X.lines()), Vector::Zero(X.generators())}; }

}  // namespace

Answer is_empty(const LineForm& X) {
  check(X, "exact::is_empty");
  check_size(X.lines() + X.generators(), X.constraints(), "exact::is_empty");
  return feasibility(X).maximum().status == Status::infeasible ? Answer::yes : Answer::no;
}

Answer contains(const LineForm& X, VectorIn x) {
  check(X, "exact::contains");
  const Index n = X.dim(), m = X.constraints(), l = X.lines(), g = X.generators();
  if (x.size() != n) throw Error(Errc::dimension, "exact::contains: the point has another dimension than the set");
  if (!x.allFinite()) throw Error(Errc::not_finite, "exact::contains: the point has a NaN or infinite entry");
  check_size(l + g, m, "exact::contains");
  // Mδ + Gξ + c·η = x with the constant factor η = 1: the difference x - c would be rounded
  ExactProgram program;
  program.S.resize(m + n + 1, l);
  program.A = Matrix::Zero(m + n + 1, g + 1);
  program.b.resize(m + n + 1);
  program.S << X.S, X.M, Matrix::Zero(1, l);
  program.A.topLeftCorner(m, g) = X.A;
  program.A.block(m, 0, n, g) = X.G;
  program.A.block(m, g, n, 1) = X.c;
  program.A(m + n, g) = 1;
  program.b << X.b, x, 1.0;
  program.f = Vector::Zero(l);
  program.g = Vector::Zero(g + 1);
  return program.maximum().status == Status::infeasible ? Answer::no : Answer::yes;
}

rounding::Range support(const LineForm& X, VectorIn d) {
  check(X, "exact::support");
  const Index n = X.dim(), m = X.constraints(), l = X.lines(), g = X.generators();
  if (d.size() != n) throw Error(Errc::dimension, "exact::support: the direction has another dimension than the set");
  if (!d.allFinite()) throw Error(Errc::not_finite, "exact::support: the direction has a NaN or infinite entry");
  check_size(l + g, m, "exact::support");
  // max dᵀy over free y = Mδ + Gξ: the products Mᵀd and Gᵀd would be rounded
  ExactProgram program;
  program.S = Matrix::Zero(m + n, l + n);
  program.A.resize(m + n, g);
  program.S.topLeftCorner(m, l) = X.S;
  program.S.block(m, 0, n, l) = X.M;
  program.S.block(m, l, n, n) = -Matrix::Identity(n, n);
  program.A << X.A, X.G;
  program.b = Vector::Zero(m + n);
  program.b.head(m) = X.b;
  program.f = Vector::Zero(l + n);
  program.f.tail(n) = d;
  program.g = Vector::Zero(g);
  const ExactProgram::Result result = program.maximum();
  if (result.status == Status::infeasible) return {-infinity, -infinity};
  if (result.status == Status::unbounded) return {infinity, infinity};
  return rational::enclose(result.value + rational::dot(rational::exact(d), rational::exact(X.c)));
}

}  // namespace cordon::exact
