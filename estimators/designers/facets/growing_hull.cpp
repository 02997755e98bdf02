// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/growing_hull.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

namespace {

constexpr double on_ridge = 1e-9;  ///< of a point's distance from the centre
constexpr int most_ridges = 5000;  ///< candidates per facet

/// The next subset of `size` numbers below `all`, in order; false after the last one.
bool next_subset(std::vector<std::size_t>& subset, std::size_t all) {
  for (std::size_t i = subset.size(); i-- > 0;) {
    if (subset[i] + (subset.size() - i) >= all) continue;
    ++subset[i];
    for (std::size_t j = i + 1; j < subset.size(); ++j) subset[j] = subset[j - 1] + 1;
    return true;
  }
  return false;
}

}  // namespace

GrowingHull::GrowingHull(const Matrix& simplex, double accuracy)
    : centre_(simplex.rowwise().mean()), accuracy_(accuracy), points_(simplex.cols()) {
  const Index r = simplex.rows();
  for (Index point = 0; point <= r; ++point) offsets_.push_back(simplex.col(point) - centre_);
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
  offsets_.push_back(x - centre_);
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

bool GrowingHull::is_closed() const {
  const auto r = static_cast<std::size_t>(centre_.size());
  if (r < 3) return true;  // two ends, or a polygon whose edges close up one by one
  for (const Facet& facet : facets_) {
    const std::size_t on = facet.on.size();
    if (on < r) return false;
    Matrix rows(static_cast<Index>(on), centre_.size());
    for (std::size_t i = 0; i < on; ++i) {
      const Vector& offset = offsets_[static_cast<std::size_t>(facet.on[i])];
      rows.row(static_cast<Index>(i)) = offset.transpose() / offset.norm();
    }
    std::vector<std::size_t> subset(r - 1);
    for (std::size_t i = 0; i < subset.size(); ++i) subset[i] = i;
    int candidates = 0;
    std::size_t ridges = 0;
    do {
      if (++candidates > most_ridges) return false;
      const Matrix along = linalg::null_space(rows(subset, Eigen::all));
      if (along.cols() != 1) continue;  // these points span less than a ridge
      const Vector turn = rows * along.col(0);
      if (turn.maxCoeff() > on_ridge && turn.minCoeff() < -on_ridge) continue;  // through the inside of the facet
      std::vector<Index> ridge;
      for (std::size_t i = 0; i < on; ++i) {
        if (std::abs(turn[static_cast<Index>(i)]) <= on_ridge) ridge.push_back(facet.on[i]);
      }
      const bool shared = std::any_of(facets_.begin(), facets_.end(), [&](const Facet& other) {
        return &other != &facet && std::includes(other.on.begin(), other.on.end(), ridge.begin(), ridge.end());
      });
      if (!shared) return false;
      ++ridges;
    } while (next_subset(subset, on));
    if (ridges < r) return false;
  }
  return true;
}

}  // namespace cordon::designers
