// SPDX-License-Identifier: GPL-3.0-or-later
// A bounded set behind a support oracle, seen in other coordinates.
#pragma once

#include "cordon/sets/vertices.hpp"

namespace cordon::sets {

/// {y : center + W (shift + B y) ∈ X}: the diagonal W maps X into [-1,1]ⁿ, B (at first the
/// identity) is any regular matrix.
class ScaledSet {
 public:
  /// `operation` names the caller in messages. Throws Errc::unsupported if X is unbounded along an
  /// axis.
  ScaledSet(const SupportOracle& X, Index n, const char* operation);

  bool is_empty() const { return empty_; }
  /// Some coordinate is constant over X (up to rounding).
  bool is_flat() const { return flat_; }
  /// Support value and point in the new coordinates.
  SupportPoint query(const Vector& d) const;
  /// The direction of the original coordinates that d is.
  Vector direction(const Vector& d) const;
  /// Upper bound of the width along d, h(d) + h(-d), with room for the rounding of both.
  double thickness(const Vector& d) const;
  /// Sets B and the shift. Nothing happens and the answer is false if B is numerically singular.
  bool transform(const Vector& shift, const Matrix& B);
  /// Points (columns) in the coordinates of X.
  Matrix restore(const Matrix& points) const;
  /// Volume of X divided by the volume in the new coordinates.
  double volume_factor() const;

 private:
  SupportPoint ask(const Vector& d) const;

  const SupportOracle& oracle_;
  const char* operation_;
  Vector center_, width_, shift_;
  Matrix B_, inverse_;
  bool empty_ = false, flat_ = false;
};

}  // namespace cordon::sets
