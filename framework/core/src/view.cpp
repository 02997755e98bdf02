// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/view.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/vectors.hpp"

namespace cordon {

void check(const View& X, const std::string& what) {
  check(X.form, what);
  const Inequalities& rows = X.rows;
  if (rows.H.rows() != rows.h.size() || (rows.rows() > 0 && rows.H.cols() != X.dim())) {
    throw Error(Errc::dimension, what + ": inequalities of " + std::to_string(rows.H.rows()) + "×" +
                                     std::to_string(rows.H.cols()) + " coefficients and " +
                                     std::to_string(rows.h.size()) +
                                     " bounds for a set of dimension " + std::to_string(X.dim()));
  }
  if (!vectors::all_finite(rows.H) || !vectors::all_finite(rows.h))
    throw Error(Errc::not_finite, what + ": an inequality has a NaN or infinite entry");
}

View with_rows(View X, const Inequalities& more) {
  if (more.H.rows() != more.h.size() || (more.H.rows() > 0 && more.H.cols() != X.dim())) {
    throw Error(Errc::dimension, "inequalities: H has " + std::to_string(more.H.rows()) +
                                     " rows of " + std::to_string(more.H.cols()) +
                                     " entries, h has " + std::to_string(more.h.size()) +
                                     " entries, and the set is of " + std::to_string(X.dim()) +
                                     " dimensions");
  }
  if (more.rows() == 0) return X;
  const Index old = X.rows.rows();
  X.rows.H.conservativeResize(old + more.rows(), X.dim());
  X.rows.h.conservativeResize(old + more.rows());
  X.rows.H.bottomRows(more.rows()) = more.H;
  X.rows.h.tail(more.rows()) = more.h;
  return X;
}

}  // namespace cordon
