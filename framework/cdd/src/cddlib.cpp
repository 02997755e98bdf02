// SPDX-License-Identifier: GPL-3.0-or-later
#include "cdd/cddlib.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

// cdd.h needs the other header before it.
// clang-format off
#include <setoper.h>
#include <cdd.h>
// clang-format on

#include "cordon/core/error.hpp"

namespace cordon::cdd {

namespace {

using rational::Rational;
using rational::RationalVector;
using CddMatrix = std::unique_ptr<dd_MatrixType, decltype(&dd_FreeMatrix)>;
using CddPolyhedron = std::unique_ptr<dd_PolyhedraType, decltype(&dd_FreePolyhedra)>;
using CddProgram = std::unique_ptr<dd_LPType, decltype(&dd_FreeLPData)>;
using Status = ExactProgram::Status;

/// Held during every call: cddlib's constants and its counters are global.
std::unique_lock<std::mutex> locked() {
  static std::mutex mutex;
  std::unique_lock lock(mutex);
  static const bool has_constants = (dd_set_global_constants(), true);
  static_cast<void>(has_constants);
  return lock;
}

[[noreturn]] void give_up(const char* what, dd_ErrorType error) {
  throw Error(Errc::solver, std::string("cddlib: ") + what + " failed with error " +
                                std::to_string(static_cast<int>(error)));
}

CddMatrix make_matrix(Index rows, Index columns) {
  CddMatrix matrix(dd_CreateMatrix(rows, columns), dd_FreeMatrix);
  if (!matrix) throw Error(Errc::solver, "cddlib: a matrix could not be allocated");
  matrix->numbtype = dd_Rational;
  return matrix;
}

bool is_constant(const RationalVector& row) {
  return std::all_of(row.begin() + 1, row.end(), [](const Rational& x) { return sgn(x) == 0; });
}

/// The other description, as cddlib gives it.
Description converted(const Description& in, dd_RepresentationType from) {
  const auto lock = locked();
  const CddMatrix matrix = make_matrix(static_cast<Index>(in.rows.size()), in.dim + 1);
  matrix->representation = from;
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    for (std::size_t j = 0; j < in.rows[i].size(); ++j)
      mpq_set(matrix->matrix[i][j], in.rows[i][j].get_mpq_t());
    if (in.linear[i]) set_addelem(matrix->linset, static_cast<long>(i + 1));
  }
  dd_ErrorType error = dd_NoError;
  const CddPolyhedron polyhedron(dd_DDMatrix2Poly(matrix.get(), &error), dd_FreePolyhedra);
  if (!polyhedron || error != dd_NoError) give_up("a conversion", error);
  const CddMatrix result(from == dd_Inequality ? dd_CopyGenerators(polyhedron.get())
                                               : dd_CopyInequalities(polyhedron.get()),
                         dd_FreeMatrix);
  if (!result) throw Error(Errc::solver, "cddlib: a conversion gave no result");
  Description out{in.dim, {}, {}};
  for (Index i = 0; i < result->rowsize; ++i) {
    RationalVector row;
    for (Index j = 0; j <= in.dim; ++j) row.emplace_back(result->matrix[i][j]);
    out.add(std::move(row), set_member(i + 1, result->linset) != 0);
  }
  return out;
}

RationalVector unit_row(Index dim, Index place) {
  RationalVector row(as_size(dim + 1));
  row[as_size(place)] = 1;
  return row;
}

Description whole_space(Index n) {
  Description space{n, {unit_row(n, 0)}, {false}};
  for (Index i = 1; i <= n; ++i) space.add(unit_row(n, i), true);
  return space;
}

/// As equations, and two inequalities for each boxed variable; the objective without `value` is 0.
CddMatrix matrix_of(const ExactProgram& p, bool with_objective) {
  const Index lines = p.S.cols(), boxed = p.A.cols(), equations = static_cast<Index>(p.b.size());
  CddMatrix matrix = make_matrix(equations + 2 * boxed, 1 + lines + boxed);
  matrix->representation = dd_Inequality;
  const auto set = [&](Index row, Index column, const Rational& value) {
    mpq_set(matrix->matrix[row][column], value.get_mpq_t());
  };
  for (Index i = 0; i < equations; ++i) {
    set(i, 0, p.b[as_size(i)]);
    for (Index j = 0; j < lines; ++j) set(i, 1 + j, -rational::exact(p.S(i, j)));
    for (Index j = 0; j < boxed; ++j) set(i, 1 + lines + j, -rational::exact(p.A(i, j)));
    set_addelem(matrix->linset, i + 1);
  }
  for (Index j = 0; j < boxed; ++j) {
    for (const int sign : {0, 1}) {
      const Index row = equations + 2 * j + sign;
      set(row, 0, 1);
      set(row, 1 + lines + j, sign == 0 ? 1 : -1);
    }
  }
  matrix->objective = dd_LPmax;
  if (!with_objective) return matrix;
  for (std::size_t j = 0; j < p.f.size(); ++j) mpq_set(matrix->rowvec[1 + j], p.f[j].get_mpq_t());
  for (std::size_t j = 0; j < p.g.size(); ++j)
    mpq_set(matrix->rowvec[as_size(1 + lines) + j], p.g[j].get_mpq_t());
  return matrix;
}

/// Under the lock.
ExactEngine::Optimum solved(const ExactProgram& p, bool with_objective) {
  const CddMatrix matrix = matrix_of(p, with_objective);
  dd_ErrorType error = dd_NoError;
  const CddProgram program(dd_Matrix2LP(matrix.get(), &error), dd_FreeLPData);
  if (!program || error != dd_NoError) give_up("a linear program", error);
  // dd_LPSolve would solve in floating point first, which corrupts memory in version 0.94m.
  dd_LPSolve0(program.get(), dd_DualSimplex, &error);
  if (error != dd_NoError) give_up("a linear program", error);
  switch (program->LPS) {
    case dd_Optimal:
      return {Status::optimal, Rational(program->optvalue)};
    case dd_Inconsistent:
    case dd_StrucInconsistent:
      return {Status::infeasible, 0};
    case dd_Unbounded:
    case dd_DualInconsistent:
    case dd_StrucDualInconsistent:
      // Unbounded, if there is a point at all.
      if (with_objective)
        return {
            solved(p, false).status == Status::infeasible ? Status::infeasible : Status::unbounded,
            0};
      [[fallthrough]];
    default:
      throw Error(Errc::solver, "cddlib: a linear program was left undecided");
  }
}

}  // namespace

Description Cddlib::generators_of(const Description& inequalities) {
  const Index n = inequalities.dim;
  // Rows without x are decided here, since cddlib need not see them.
  Description rows{n, {}, {}};
  for (std::size_t i = 0; i < inequalities.rows.size(); ++i) {
    const RationalVector& row = inequalities.rows[i];
    if (!is_constant(row)) {
      rows.add(row, inequalities.linear[i]);
    } else if (inequalities.linear[i] ? sgn(row[0]) != 0 : sgn(row[0]) < 0) {
      return {n, {}, {}};
    }
  }
  if (rows.rows.empty()) return whole_space(n);
  Description out = converted(rows, dd_Inequality);
  const auto has_constant = [](const RationalVector& row) { return sgn(row[0]) != 0; };
  if (std::any_of(out.rows.begin(), out.rows.end(), has_constant)) return out;
  // cddlib leaves out the apex of a cone at the origin; else there is no point.
  if (std::any_of(rows.rows.begin(), rows.rows.end(), has_constant)) return {n, {}, {}};
  out.add(unit_row(n, 0), false);
  return out;
}

Description Cddlib::inequalities_of(const Description& generators) {
  const Index n = generators.dim;
  Description out{n, {}, {}};
  if (generators.rows.empty()) {
    out.add(unit_row(n, 0), false);
    out.rows[0][0] = -1;
    return out;
  }
  if (n == 0) return out;
  Description all = converted(generators, dd_Generator);
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    // The hyperplane at infinity, 1 ≥ 0, is no inequality.
    if (!is_constant(all.rows[i])) out.add(std::move(all.rows[i]), all.linear[i]);
  }
  return out;
}

ExactEngine::Optimum Cddlib::maximum(const ExactProgram& program) {
  const auto lock = locked();
  return solved(program, true);
}

std::string version() {
  const std::string_view text = dd_DDVERSION;
  constexpr std::string_view before = "Version ";
  return std::string(text.substr(text.starts_with(before) ? before.size() : 0));
}

}  // namespace cordon::cdd
