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

bool GrowingHull::adjacent(const Facet& a, const Facet& b, const std::vector<Index>& common) const {
  if (static_cast<Index>(common.size()) < centre_.size() - 1) return false;
  return std::none_of(facets_.begin(), facets_.end(), [&](const Facet& other) {
    return &other != &a && &other != &b && std::includes(other.on.begin(), other.on.end(), common.begin(), common.end());
  });
}

void GrowingHull::add(VectorIn x) {
  const Index number = points_++;
  std::vector<double> excess(facets_.size());
  std::vector<std::size_t> visible, hidden;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    excess[f] = beyond(facets_[f], x);
    const double tolerated = tolerance(facets_[f]);
    if (excess[f] > tolerated) visible.push_back(f);
    if (excess[f] < -tolerated) hidden.push_back(f);
  }
  std::vector<Facet> made;
  std::vector<Index> common;
  for (const std::size_t f : visible) {
    for (const std::size_t g : hidden) {
      common.clear();
      std::set_intersection(facets_[f].on.begin(), facets_[f].on.end(), facets_[g].on.begin(), facets_[g].on.end(),
                            std::back_inserter(common));
      if (!adjacent(facets_[f], facets_[g], common)) continue;
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
  for (auto f = visible.rbegin(); f != visible.rend(); ++f) facets_.erase(facets_.begin() + static_cast<std::ptrdiff_t>(*f));
  facets_.insert(facets_.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
}

}  // namespace cordon::designers
