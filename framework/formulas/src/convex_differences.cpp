// SPDX-License-Identifier: GPL-3.0-or-later
// What a row's affine function leaves out, e(z) = F(z) - F(h) - J(h) (z - h), as a difference of
// convex functions [Alamo2008], [Adjiman1998]. With z = h + diag(r) s and the eigenvalues of
// diag(r) [H] diag(r) between -λ and λ', e + ½ λ |s|² and ½ λ' |s|² - e are convex over the box, so
// that for its vertices v and the n variables in which the row is not affine
//   max(-½ λ n, min_v e(v) - ½ λ' n) ≤ e ≤ min(½ λ' n, max_v e(v) + ½ λ n).
#include <algorithm>

#include "cordon/formulas/box_enclosure.hpp"
#include "eigenvalue_bounds.hpp"
#include "operations.hpp"

namespace cordon::formulas {

namespace {

double half_sum(double eigenvalue, std::size_t count) {
  return directed::times(std::max(0.0, eigenvalue), 0.5 * static_cast<double>(count)).upper;
}

}  // namespace

std::vector<Index> BoxEnclosure::bent_variables(Index row) const {
  std::vector<Index> found;
  for (Index i = 0; i < center_.size(); ++i)
    if (!function().is_affine_in(row, i)) found.push_back(i);
  if (found.size() > static_cast<std::size_t>(SmallSymmetric::most)) found.clear();
  return found;
}

void BoxEnclosure::take_curvature(Index row) {
  const std::vector<Index>& bent = bent_[as_size(row)];
  SmallSymmetric scaled{static_cast<int>(bent.size()), {}};
  const auto position = [&](int variable) {
    return static_cast<std::size_t>(std::ranges::find(bent, Index{variable}) - bent.begin());
  };
  for (std::size_t e = 0; e < evaluator_.second_partials(row); ++e) {
    const Evaluator::SecondPartial partial = evaluator_.second_partial(row, e);
    const std::size_t i = position(partial.i), j = position(partial.j);
    scaled.entries[i][j] = scaled.entries[j][i] =
        partial.value * directed::times(radius_[partial.i], radius_[partial.j]);
  }
  SmallSymmetric mirrored = scaled;
  for (auto& entries : mirrored.entries)
    for (Interval& entry : entries) entry = -entry;
  curvatures_[as_size(row)] = {half_sum(-least_eigenvalue(scaled), bent.size()),
                               half_sum(-least_eigenvalue(mirrored), bent.size())};
}

void BoxEnclosure::take_vertices(std::span<const Interval> variables, Index row) {
  const std::vector<Index>& bent = bent_[as_size(row)];
  const auto [below, above] = curvatures_[as_size(row)];
  Interval at_vertices{infinity, -infinity};
  for (unsigned vertex = 0; vertex < 1U << bent.size(); ++vertex) {
    for (std::size_t i = 0; i < bent.size(); ++i) {
      const Interval side = variables[as_size(bent[i])];
      point_[as_size(bent[i])] = point((vertex >> i & 1U) != 0 ? side.upper : side.lower);
    }
    Interval left_out = evaluator_.evaluate_row(point_, row) - at_center_[as_size(row)];
    for (std::size_t e = 0; e < evaluator_.partials(row); ++e) {
      const Index i = evaluator_.partial(row, e).variable;
      left_out = left_out - gradient_at_center_[first_entry(row) + e] *
                                (point_[as_size(i)] - point(center_[i]));
    }
    at_vertices = hull(at_vertices, left_out);
  }
  for (const Index i : bent) point_[as_size(i)] = point(center_[i]);
  const Interval bounds{std::max(-below, directed::plus(at_vertices.lower, -above).lower),
                        std::min(above, directed::plus(at_vertices.upper, below).upper)};
  Interval& remainder = remainders_[as_size(row)];
  if (const Interval both = intersection(remainder, bounds); !both.is_empty()) remainder = both;
}

}  // namespace cordon::formulas
