// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/box_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cordon::estimators {

namespace {

/// The ends of the parts, in order: both ends of the side are among them.
std::vector<double> ends_of(double lower, double upper, Index count) {
  std::vector<double> ends{lower};
  for (Index j = 1; j < count; ++j) {
    const double share = static_cast<double>(j) / static_cast<double>(count);
    ends.push_back(std::clamp((1 - share) * lower + share * upper, ends.back(), upper));
  }
  ends.push_back(upper);
  return ends;
}

}  // namespace

Index BoxCuts::parts() const {
  Index all = 1;
  for (const Index count : counts) all *= count;
  return all;
}

BoxCuts cuts_of(const Box& B, VectorIn doubts, Index most) {
  constexpr double largest = std::numeric_limits<double>::max();
  BoxCuts cuts{std::vector<Index>(as_size(B.dim()), 1)};
  const auto weight = [&](Index i) {
    const double r = 0.5 * B.upper[i] - 0.5 * B.lower[i];
    const double doubt = std::isnan(doubts[i]) ? infinity : doubts[i];
    return doubt > 0 && r > 0
               ? std::min(doubt * r, largest) / static_cast<double>(cuts.counts[as_size(i)])
               : 0.0;
  };
  while (2 * cuts.parts() <= most) {
    Index widest = 0;
    for (Index i = 1; i < B.dim(); ++i)
      if (weight(i) > weight(widest)) widest = i;
    if (B.dim() == 0 || weight(widest) == 0) break;
    cuts.counts[as_size(widest)] *= 2;
  }
  return cuts;
}

std::vector<Box> parts_of(const Box& B, const BoxCuts& cuts) {
  std::vector<Box> parts{B};
  for (Index i = 0; i < B.dim(); ++i) {
    if (cuts.counts[as_size(i)] == 1) continue;
    const std::vector<double> ends = ends_of(B.lower[i], B.upper[i], cuts.counts[as_size(i)]);
    std::vector<Box> cut;
    for (const Box& part : parts) {
      for (std::size_t j = 0; j + 1 < ends.size(); ++j) {
        cut.push_back(part);
        cut.back().lower[i] = ends[j];
        cut.back().upper[i] = ends[j + 1];
      }
    }
    parts = std::move(cut);
  }
  return parts;
}

Box intersected(const Box& a, const Box& b) {
  return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)};
}

Box hull_of(const Box& a, const Box& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

}  // namespace cordon::estimators
