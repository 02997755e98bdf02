// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/growing_hull.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

namespace {

constexpr double flatness =
    1e-9;  ///< of the largest distance among points: nearer ones span no more dimensions

/// The columns that span the simplex of which each next corner is farthest from those before; fewer
/// than dim + 1 where the points are flat.
std::vector<Index> corners(const Matrix& points) {
  std::vector<Index> chosen{0};
  Matrix rest = points.colwise() - points.col(0);
  const double largest = rest.colwise().norm().maxCoeff();
  while (static_cast<Index>(chosen.size()) <= points.rows()) {
    Index farthest = 0;
    if (!(rest.colwise().norm().maxCoeff(&farthest) > flatness * largest)) break;
    chosen.push_back(farthest);
    const Vector direction = rest.col(farthest).normalized();
    rest -= direction * (direction.transpose() * rest);
  }
  return chosen;
}

/// Do the lines of a polygon, by angle, share a point with the next one each?
bool is_closed_polygon(const std::vector<GrowingHull::Facet>& facets) {
  std::vector<std::pair<double, const GrowingHull::Facet*>> by_angle;
  for (const auto& facet : facets)
    by_angle.emplace_back(std::atan2(facet.h[1], facet.h[0]), &facet);
  std::sort(by_angle.begin(), by_angle.end());
  for (std::size_t i = 0; i < by_angle.size(); ++i) {
    const auto& one = by_angle[i].second->on;
    const auto& next = by_angle[(i + 1) % by_angle.size()].second->on;
    if (std::none_of(one.begin(), one.end(),
                     [&](Index p) { return std::binary_search(next.begin(), next.end(), p); }))
      return false;
  }
  return by_angle.size() >= 3;
}

/// Removes the facets with these numbers, which increase, and appends others.
void replace(std::vector<GrowingHull::Facet>& facets, const std::vector<std::size_t>& removed,
             std::vector<GrowingHull::Facet> made) {
  std::size_t kept = 0, gone = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (gone < removed.size() && removed[gone] == f) {
      ++gone;
    } else if (kept++ != f) {
      facets[kept - 1] = std::move(facets[f]);
    }
  }
  facets.resize(kept);
  facets.insert(facets.end(), std::make_move_iterator(made.begin()),
                std::make_move_iterator(made.end()));
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
  std::vector<bool> seen(
      static_cast<std::size_t>(points_));  // the points of the facets that x is beyond
  for (const Facet& facet : facets_) {
    excess.push_back(beyond(facet, x));
    if (excess.back() <= tolerance(facet)) continue;
    for (const Index point : facet.on) seen[static_cast<std::size_t>(point)] = true;
  }
  std::vector<std::size_t> visible, near;  // those, and all that may share a ridge with them
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto& on = facets_[f].on;
    if (excess[f] > tolerance(facets_[f])) visible.push_back(f);
    if (std::count_if(on.begin(), on.end(), [&](Index point) {
          return seen[static_cast<std::size_t>(point)];
        }) >= ridge) {
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
      std::set_intersection(facets_[f].on.begin(), facets_[f].on.end(), facets_[g].on.begin(),
                            facets_[g].on.end(), std::back_inserter(common));
      if (static_cast<Index>(common.size()) < ridge) continue;
      if (over()) return false;
      const bool adjacent = std::none_of(near.begin(), near.end(), [&](std::size_t k) {
        return k != f && k != g &&
               std::includes(facets_[k].on.begin(), facets_[k].on.end(), common.begin(),
                             common.end());
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
  replace(facets_, visible, std::move(made));
  return true;
}

bool GrowingHull::is_closed() const {
  const Index r = centre_.size();
  if (r == 1) return facets_.size() == 2;
  if (r == 2) return is_closed_polygon(facets_);
  return std::all_of(facets_.begin(), facets_.end(),
                     [&](const Facet& facet) { return has_neighbours(facet); });
}

bool GrowingHull::has_neighbours(const Facet& facet) const {
  const Matrix basis = linalg::null_space(facet.h.transpose());
  Matrix points(basis.cols(), static_cast<Index>(facet.on.size()));
  for (Index i = 0; i < points.cols(); ++i) {
    points.col(i) = linalg::transposed_product(
        basis, offsets_[static_cast<std::size_t>(facet.on[static_cast<std::size_t>(i)])]);
  }
  if (basis.cols() != centre_.size() - 1 || points.cols() == 0) return false;
  std::vector<Index> order =
      corners(points);  // the points of the facet as its own hull numbers them
  const auto simplex = static_cast<Index>(order.size());
  if (simplex <= points.rows()) return false;
  GrowingHull hull(points(Eigen::all, order), accuracy_);
  for (Index i = 0; i < points.cols(); ++i) {
    if (std::find(order.begin(), order.begin() + simplex, i) != order.begin() + simplex) continue;
    hull.add(points.col(i), [] { return false; });
    order.push_back(i);
  }
  if (hull.facets().empty() || !hull.is_closed()) return false;
  return std::all_of(hull.facets().begin(), hull.facets().end(), [&](const Facet& part) {
    std::vector<Index> ridge;
    for (const Index i : part.on)
      ridge.push_back(facet.on[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])]);
    std::sort(ridge.begin(), ridge.end());
    return std::any_of(facets_.begin(), facets_.end(), [&](const Facet& other) {
      return &other != &facet &&
             std::includes(other.on.begin(), other.on.end(), ridge.begin(), ridge.end());
    });
  });
}

}  // namespace cordon::designers
