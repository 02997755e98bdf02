// SPDX-License-Identifier: GPL-3.0-or-later
// Input sequences as seen from the cheapest one.
#pragma once

#include "designers/separation_problem.hpp"

namespace cordon::designers {

/// The box around all input sequences U, seen from its point z nearest to the reference: an
/// input sequence is u = z + v, -down ≤ v ≤ up, in the n entries that vary, and costs what |v|
/// says: each |u_i - r_i| is apart_i + |v_i|. Rounded so that the box encloses U.
struct Star {
  explicit Star(const SeparationProblem& problem);

  Index size() const { return static_cast<Index>(free.size()); }
  Vector input(VectorIn v) const;  ///< z + v
  Vector way(VectorIn u) const;    ///< u - z in the entries that vary
  /// Its multiple that just reaches the end of the box; nothing changes where v = 0.
  Vector stretched(const Vector& v) const;

  Vector centre;            ///< z, all entries
  std::vector<Index> free;  ///< those that vary
  Vector up, down;          ///< n, ≥ 0
  Vector neglected;         ///< n: how far entries may go beside `up` and `down` where one is 0
  Vector apart, weights;    ///< n
  double fixed = 0;         ///< the cost of the entries that do not vary
  double most = 0;          ///< no input of the box costs more
};

}  // namespace cordon::designers
