// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/tubes/line_proof.hpp"

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/tubes/output_tube.hpp"

namespace cordon {

TermsOfLines::TermsOfLines(MatrixIn S, const LinesEliminated& rest, Index inputs) {
  const Matrix size = S.cwiseAbs(), by = rest.lines_by_factors.cwiseAbs();
  const Vector reach =
      rest.lines_offset.cwiseAbs() + by.leftCols(by.cols() - inputs).rowwise().sum();
  terms = linalg::product(size, reach);
  input_terms = linalg::product(size, by.rightCols(inputs));
}

bool proves_empty_through_lines(const LineForm& rows, const Vector& terms, const Vector& y,
                                const LinesReached& lines) {
  if (y.size() != rows.constraints() || !y.allFinite()) return false;
  const double margin = farkas_margin(rows.A, rows.b, y, tube_row_noise * terms);
  if (!(margin > 0)) return false;
  if (is_quickly_proven_empty(rows))
    return proves_empty(rows, {Certificate::Kind::farkas, y, margin});
  const Vector open = linalg::transposed_product(rows.S, y).cwiseAbs() +
                      rounding::product_error(rows.S.transpose(), y);
  for (const Index j : lines.free) {
    if (!rows.S.col(j).isZero(0)) return false;
  }
  return margin > 2 * open.dot(lines.reach);
}

}  // namespace cordon
