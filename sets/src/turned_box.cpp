// SPDX-License-Identifier: GPL-3.0-or-later
// A box along directions of the set's own: narrow where the set is thin, however it lies.
#include "cordon/core/linalg.hpp"
#include "cordon/sets/vertices.hpp"
#include "support_query.hpp"

namespace cordon::sets {

namespace {

/// x without its parts along the first k columns of Q, which are orthonormal.
Vector beside(const Matrix& Q, Index k, Vector x) {
  for (int pass = 0; pass < 2; ++pass) {  // the second time for what rounding has left
    for (Index j = 0; j < k; ++j) x -= Q.col(j).dot(x) * Q.col(j);
  }
  return x;
}

/// The longest difference of two support points beside the first k columns of Q, of length 1; any
/// direction there if the points differ by rounding only.
Vector longest_beside(const ScaledSet& set, const Matrix& Q, Index k) {
  Vector longest = Vector::Zero(Q.rows()), any = longest;
  for (Index i = 0; i < Q.rows(); ++i) {
    const Vector axis = beside(Q, k, Vector::Unit(Q.rows(), i));
    if (axis.norm() > any.norm()) any = axis;
    if (axis.norm() < .3) continue;  // some axis has more beside two of three directions
    const Vector gap = beside(Q, k, set.query(axis).x - set.query(-axis).x);
    if (gap.norm() > longest.norm()) longest = gap;
  }
  constexpr double none = 1e-200;
  const Vector direction = beside(Q, k, longest.norm() > none ? Vector(longest.normalized()) : any);
  return direction.norm() > .5 ? direction.normalized() : any.normalized();
}

}  // namespace

TurnedBox turned_box(const SupportOracle& X, Index n) {
  const ScaledSet set(X, n, "volume");
  TurnedBox box{Matrix::Identity(n, n), Vector::Zero(n), 0};
  if (set.is_empty()) return box;
  constexpr double skew = 1e-12;  // above what the directions' angles lack of right ones
  box.volume = set.volume_factor() * (1 + skew);
  Matrix Q(n, n);
  for (Index k = 0; k < n; ++k) {
    Q.col(k) = longest_beside(set, Q, k);
    box.directions.col(k) = set.direction(Q.col(k));
    box.widths[k] = set.thickness(Q.col(k));
    box.volume *= box.widths[k];
  }
  return box;
}

}  // namespace cordon::sets
