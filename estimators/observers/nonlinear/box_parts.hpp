// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/core/box.hpp"

namespace cordon::estimators {

/// How a box is cut: along its coordinate i into `counts[i]` parts of one width.
struct BoxCuts {
  std::vector<Index> counts;

  Index parts() const;
};

/// At most `most` parts: sides are halved one after the other, the one with the largest
/// doubt_i r_i / count_i first, r_i half of the side. Sides without doubt are left whole, and those
/// of infinite doubt come first.
BoxCuts cuts_of(const Box& B, VectorIn doubts, Index most);

/// Boxes whose union is B, bounded.
std::vector<Box> parts_of(const Box& B, const BoxCuts& cuts);

Box intersected(const Box& a, const Box& b);

/// The smallest box that holds both; one that is empty holds nothing.
Box hull_of(const Box& a, const Box& b);

}  // namespace cordon::estimators
