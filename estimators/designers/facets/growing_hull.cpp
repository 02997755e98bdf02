// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/growing_hull.hpp"

#include <algorithm>
#include <iterator>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

GrowingHull::GrowingHull(const Matrix& simplex, double accuracy)
    : centre_(simplex.rowwise().mean()), accuracy_(accuracy), points_(simplex.cols()) {
  const Index r = simplex.rows();
  for (Index left_out = 0; left_out <= r; ++left_out) {
    Facet facet;
    Matrix rows(r, r);
    for (Index point = 0; point <= r; ++point) {
      if (point == left_out) continue;
      rows.row(static_cast<Index>(facet.on.size())) = (simplex.col(point) - centre_).transpose();
      facet.on.push_back(point);
    }
    const auto h = linalg::solve(rows, Matrix::Ones(r, 1));
    if (!h || !h->allFinite()) {
      facets_.clear();
      return;
    }
    facet.h = h->col(0);
    facets_.push_back(std::move(facet));
  }
}

bool GrowingHull::add(VectorIn x, const std::function<bool()>& over) {
  const Index number = points_++, ridge = centre_.size() - 1;
  std::vector<double> excess;
  std::vector<bool> seen(static_cast<std::size_t>(points_));  // the points of the facets that x is beyond
  for (const Facet& facet : facets_) {
    excess.push_back(beyond(facet, x));
    if (excess.back() <= tolerance(facet)) continue;
    for (const Index point : facet.on) seen[static_cast<std::size_t>(point)] = true;
  }
  std::vector<std::size_t> visible, near;  // those, and all that may share a ridge with them
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto& on = facets_[f].on;
    if (excess[f] > tolerance(facets_[f])) visible.push_back(f);
    if (std::count_if(on.begin(), on.end(), [&](Index point) { return seen[static_cast<std::size_t>(point)]; }) >= ridge) {
      near.push_back(f);
    }
  }
  std::vector<Facet> made;
  std::vector<Index> common;
  for (const std::size_t f : visible) {
    if (over()) return false;
    for (const std::size_t g : near) {
      if (excess[g] >= -tolerance(facets_[g])) continue;
      common.clear();
      std::set_intersection(facets_[f].on.begin(), facets_[f].on.end(), facets_[g].on.begin(), facets_[g].on.end(),
                            std::back_inserter(common));
      if (static_cast<Index>(common.size()) < ridge) continue;
      if (over()) return false;
      const bool adjacent = std::none_of(near.begin(), near.end(), [&](std::size_t k) {
        return k != f && k != g && std::includes(facets_[k].on.begin(), facets_[k].on.end(), common.begin(), common.end());
      });
      if (!adjacent) continue;
      Facet facet;
      facet.h = (excess[f] * facets_[g].h - excess[g] * facets_[f].h) / (excess[f] - excess[g]);
      facet.on = common;
      facet.on.push_back(number);
      made.push_back(std::move(facet));
    }
  }
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (std::abs(excess[f]) <= tolerance(facets_[f])) facets_[f].on.push_back(number);
  }
  std::size_t kept = 0, gone = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (gone < visible.size() && visible[gone] == f) {
      ++gone;
    } else if (kept++ != f) {
      facets_[kept - 1] = std::move(facets_[f]);
    }
  }
  facets_.resize(kept);
  facets_.insert(facets_.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
  return true;
}

}  // namespace cordon::designers
