// SPDX-License-Identifier: GPL-3.0-or-later
#include "direction_apart.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon {

namespace {

constexpr int most_directions = 40;

/// A support function: its value, and a point that reaches it, of size 0 if none is known.
using Oracle = std::function<double(VectorIn d, Vector* at)>;

Oracle oracle_of(const Set& X) {
  return [&X](VectorIn d, Vector* at) { return X.support(d, at); };
}
Oracle oracle_of(const Vector& y) {
  return [&y](VectorIn d, Vector* at) {
    if (at) *at = y;
    return rounding::dot(d, y).upper;
  };
}

class Search {
 public:
  Search(Oracle X, Oracle Y) : X_(std::move(X)), Y_(std::move(Y)) {}

  std::optional<Certificate> along_axes(Index n) {
    size_ = Vector::Ones(n);
    for (Index i = 0; i < n; ++i) {
      double reach = 0;
      for (const double sign : {1.0, -1.0}) {
        const Vector d = sign * Vector::Unit(n, i);
        if (auto found = excluded(d, nullptr, nullptr)) return found;
        reach = std::max({reach, std::abs(last_.first), std::abs(last_.second)});
      }
      if (std::isfinite(reach) && reach > 0) size_[i] = reach;
    }
    return std::nullopt;
  }

  /// In coordinates divided by the sizes that the axes have told.
  std::optional<Certificate> along_nearest_points() {
    Vector x, y, v;
    Vector d = size_.cwiseInverse();
    for (int i = 0; i < most_directions && d.allFinite() && !d.isZero(0); ++i) {
      if (auto found = excluded(d, &x, &y)) return found;
      if (x.size() == 0 || y.size() == 0) return std::nullopt;
      const Vector w = (x - y).cwiseQuotient(size_);  // of X ⊖ Y, farthest along d
      if (v.size() == 0) {
        v = w;
      } else {
        const Vector step = w - v;
        const double length = step.squaredNorm();
        if (!(length > 0)) return std::nullopt;
        const double share = -v.dot(step) / length;
        if (!(share > 0)) return std::nullopt;  // v is the nearest point: the sets meet, or nearly
        v += std::min(share, 1.0) * step;
      }
      d = -v.cwiseQuotient(size_);
    }
    return std::nullopt;
  }

 private:
  std::optional<Certificate> excluded(const Vector& d, Vector* x, Vector* y) {
    last_ = {X_(d, x), Y_(-d, y)};
    const double sum = rounding::up(last_.first + last_.second);
    const double terms = std::abs(last_.first) + std::abs(last_.second);
    if (!std::isfinite(terms) || !(sum < -tolerances::proof_margin * terms)) return std::nullopt;
    return Certificate{Certificate::Kind::direction, d, -sum};
  }

  Oracle X_, Y_;
  std::pair<double, double> last_;
  Vector size_;
};

std::optional<Certificate> searched(Index n, Oracle X, Oracle Y) {
  Search search(std::move(X), std::move(Y));
  if (auto found = search.along_axes(n)) return found;
  return search.along_nearest_points();
}

}  // namespace

std::optional<Certificate> direction_apart(const Set& X, const Set& Y) {
  return searched(X.dim(), oracle_of(X), oracle_of(Y));
}

std::optional<Certificate> direction_apart(const Set& X, VectorIn y) {
  const Vector point = y;
  return searched(X.dim(), oracle_of(X), oracle_of(point));
}

}  // namespace cordon
