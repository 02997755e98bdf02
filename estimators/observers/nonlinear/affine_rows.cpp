// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/affine_rows.hpp"

#include <algorithm>
#include <numeric>

namespace cordon::estimators {

AffineRows affine_rows(const formulas::BoxEnclosure& enclosure, const std::vector<Index>& rows) {
  const auto count = static_cast<Index>(rows.size());
  AffineRows made{Matrix(count, enclosure.center().size()), Vector(count), Vector(count)};
  Eigen::RowVectorXd slope(enclosure.center().size());
  for (Index i = 0; i < count; ++i) {
    const formulas::BoxEnclosure::Affine form = enclosure.affine(rows[as_size(i)], slope);
    made.slope.row(i) = slope;
    Interval offset{form.value, form.value};
    for (Index j = 0; j < slope.size(); ++j)
      offset = offset - directed::times(slope[j], enclosure.center()[j]);
    made.offset[i] = 0.5 * offset.lower + 0.5 * offset.upper;
    const double rest = std::max(directed::plus(offset.upper, -made.offset[i]).upper,
                                 directed::plus(made.offset[i], -offset.lower).upper);
    made.radius[i] = directed::plus(form.radius, rest).upper;
  }
  return made;
}

std::vector<Index> all_rows(Index count) {
  std::vector<Index> rows(as_size(count));
  std::iota(rows.begin(), rows.end(), Index{0});
  return rows;
}

}  // namespace cordon::estimators
