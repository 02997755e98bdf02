// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/static_rows.hpp"

#include <algorithm>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"
#include "cordon/interfaces/semi_explicit.hpp"

namespace cordon::estimators {

StaticRows::StaticRows(const LinearModel& m, bool keep_states) {
  const Index n = m.states();
  const SemiExplicitForm form = m.is_descriptor() ? SemiExplicitForm(m.E) : SemiExplicitForm(n);
  const auto take = [](const SemiExplicitForm::Part& part, bool& exact) {
    exact = exact && part.is_exact;
    return part.rows;
  };
  static_A =
      take(keep_states ? form.static_part(m.A) : form.static_part_of_state(m.A), static_exact);
  static_B = take(form.static_part(m.B), static_exact);
  static_Bw = take(form.static_part(m.Bw), static_exact);
  static_rows_map = take(form.static_part(Matrix::Identity(n, n)), static_exact);
  const Vector scale = linalg::row_scales(static_A);
  for (Matrix* part : {&static_A, &static_B, &static_Bw, &static_rows_map})
    *part = scale.asDiagonal() * *part;
  if (keep_states && m.is_descriptor()) {
    T = T_inverse = Matrix::Identity(n, n);
    std::vector<Index> pivots = DescriptorMatrix::pivots_of(m.E).rows;
    std::sort(pivots.begin(), pivots.end());
    E = m.E(pivots, Eigen::all);
    A = m.A(pivots, Eigen::all);
    B = m.B(pivots, Eigen::all);
    Bw = m.Bw(pivots, Eigen::all);
    rows = Matrix::Identity(n, n)(pivots, Eigen::all);
    C = m.C;
    is_exact = static_exact;
    return;
  }
  T = form.T();
  T_inverse = form.T_inverse();
  is_exact = form.is_exact() && static_exact;
  A = take(form.dynamic_part_of_state(m.A), is_exact);
  B = take(form.dynamic_part(m.B), is_exact);
  Bw = take(form.dynamic_part(m.Bw), is_exact);
  rows = take(form.dynamic_part(Matrix::Identity(n, n)), is_exact);
  C = take(form.outputs_of_state(m.C), outputs_exact);
  free_part = Matrix::Zero(n, n - rank());
  free_part.bottomRows(n - rank()).setIdentity();
}

bool StaticRows::share_disturbances(const LineForm& W) const {
  const auto enters = [](const Matrix& entries, const Matrix& columns, Index j) {
    return !linalg::product(entries, columns.col(j)).isZero(0);
  };
  bool any_dynamic = false, any_static = false, both = false;
  for (const Matrix* columns : {&W.G, &W.M}) {
    for (Index j = 0; j < columns->cols(); ++j) {
      const bool dynamic = enters(Bw, *columns, j), fixed = enters(static_Bw, *columns, j);
      any_dynamic = any_dynamic || dynamic;
      any_static = any_static || fixed;
      both = both || (dynamic && fixed);
    }
  }
  return both || (W.constraints() > 0 && any_dynamic && any_static);
}

}  // namespace cordon::estimators
