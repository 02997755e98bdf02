// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/cdd_oracle.hpp"

#include <algorithm>
#include <memory>
#include <string>

// cdd.h needs the other header before it
// clang-format off
#include <setoper.h>
#include <cdd.h>
// clang-format on

#include "cordon/core/error.hpp"

namespace cordon::cdd {

namespace {

void initialize_once() {
  static const bool done = (dd_set_global_constants(), true);
  static_cast<void>(done);
}

using OwnMatrix = std::unique_ptr<dd_MatrixType, decltype(&dd_FreeMatrix)>;
using OwnPolyhedron = std::unique_ptr<dd_PolyhedraType, decltype(&dd_FreePolyhedra)>;

Description convert(const Description& in, dd_RepresentationType from) {
  initialize_once();
  const auto rows = static_cast<Index>(in.rows.size());
  const OwnMatrix matrix(dd_CreateMatrix(rows, in.dim + 1), dd_FreeMatrix);
  if (!matrix) throw Error(Errc::solver, "cddlib: the conversion ran out of memory");
  matrix->representation = from;
  matrix->numbtype = dd_Rational;
  for (Index i = 0; i < rows; ++i) {
    const rational::RationalVector& row = in.rows[static_cast<std::size_t>(i)];
    for (Index j = 0; j <= in.dim; ++j)
      mpq_set(matrix->matrix[i][j], row[static_cast<std::size_t>(j)].get_mpq_t());
    if (in.linear[static_cast<std::size_t>(i)]) set_addelem(matrix->linset, i + 1);
  }
  dd_ErrorType error = dd_NoError;
  const OwnPolyhedron polyhedron(dd_DDMatrix2Poly(matrix.get(), &error), dd_FreePolyhedra);
  if (!polyhedron || error != dd_NoError) {
    throw Error(Errc::solver, "cddlib: the conversion failed with error " +
                                  std::to_string(static_cast<int>(error)));
  }
  const OwnMatrix result(from == dd_Inequality ? dd_CopyGenerators(polyhedron.get())
                                               : dd_CopyInequalities(polyhedron.get()),
                         dd_FreeMatrix);
  if (!result) throw Error(Errc::solver, "cddlib: the conversion gave no result");
  Description out{in.dim, {}, {}};
  for (Index i = 0; i < result->rowsize; ++i) {
    rational::RationalVector row;
    for (Index j = 0; j <= in.dim; ++j) row.emplace_back(result->matrix[i][j]);
    out.add(std::move(row), set_member(i + 1, result->linset) != 0);
  }
  return out;
}

rational::RationalVector unit_row(Index dim, int first) {
  rational::RationalVector row(static_cast<std::size_t>(dim + 1));
  row[0] = first;
  return row;
}

}  // namespace

Description generators_of(const Description& inequalities) {
  const Index n = inequalities.dim;
  // rows without x are decided here: cddlib need not see them
  Description real{n, {}, {}};
  for (std::size_t i = 0; i < inequalities.rows.size(); ++i) {
    const rational::RationalVector& row = inequalities.rows[i];
    const bool constant =
        std::all_of(row.begin() + 1, row.end(), [](const auto& x) { return sgn(x) == 0; });
    if (!constant) {
      real.add(row, inequalities.linear[i]);
    } else if (inequalities.linear[i] ? sgn(row[0]) != 0 : sgn(row[0]) < 0) {
      return {n, {}, {}};
    }
  }
  if (real.rows.empty()) {
    Description space{n, {unit_row(n, 1)}, {false}};
    for (Index i = 0; i < n; ++i) {
      space.add(unit_row(n, 0), true);
      space.rows.back()[static_cast<std::size_t>(i + 1)] = 1;
    }
    return space;
  }
  Description out = convert(real, dd_Inequality);
  // cddlib leaves out the apex of a cone at the origin
  const bool has_point = std::any_of(out.rows.begin(), out.rows.end(),
                                     [](const auto& row) { return sgn(row[0]) != 0; });
  const bool homogeneous = std::all_of(real.rows.begin(), real.rows.end(),
                                       [](const auto& row) { return sgn(row[0]) == 0; });
  if (!has_point && homogeneous) out.add(unit_row(n, 1), false);
  return out;
}

Description inequalities_of(const Description& generators) {
  const Index n = generators.dim;
  if (generators.rows.empty()) return {n, {unit_row(n, -1)}, {false}};
  if (n == 0) return {n, {}, {}};
  const Description all = convert(generators, dd_Generator);
  Description out{n, {}, {}};
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    // the hyperplane at infinity, 1 ≥ 0, is no inequality
    const bool constant = std::all_of(all.rows[i].begin() + 1, all.rows[i].end(),
                                      [](const auto& x) { return sgn(x) == 0; });
    if (!constant) out.add(all.rows[i], all.linear[i]);
  }
  return out;
}

}  // namespace cordon::cdd
