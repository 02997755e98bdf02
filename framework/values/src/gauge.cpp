// SPDX-License-Identifier: GPL-3.0-or-later
// The gauge: how far a ray from 0 stays in a set. Every question is about s x for a double s, and
// exactly about that: a product that is no vector of doubles is asked for as {x δ : δ = s}, or
// enclosed.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/solvers/view_questions.hpp"
#include "cordon/values/convex_set.hpp"

namespace cordon {

namespace {

class Ray {
 public:
  Ray(const ConvexSet& X, VectorIn x)
      : X_(X),
        view_(X.view()),
        point_{
            x,        Matrix(x.size(), 0), Vector::Zero(x.size()), Matrix::Ones(1, 1), Matrix(1, 0),
            Vector(1)},
        first_(std::clamp(-std::ilogb(x.lpNorm<Eigen::Infinity>()), -most, most)) {}

  /// 2ᵏ times the s of s x of size 1.
  double power(int k) const { return std::ldexp(1.0, std::clamp(first_ + k, -most, most)); }
  double nearest() const { return power(-reach); }
  double farthest() const { return power(reach); }

  /// s x ∈ X?
  Answer at(double s) {
    const Box product = enclosed(s);
    if (product.lower == product.upper) return X_.contains(product.lower);
    if (view_.claim != Tightness::exact) return by_enclosure(product);
    point_.b[0] = s;
    const Answer apart = is_disjoint(view_, View{point_});
    return apart == Answer::yes ? Answer::no : apart == Answer::no ? Answer::yes : Answer::unknown;
  }

  /// Goes from an s with this answer towards one without; the last s with it.
  double last(Answer answer, double proven, double open) {
    constexpr double relative = 1e-12;
    while (std::abs(open - proven) > relative * std::max(open, proven)) {
      const double s = between(std::min(open, proven), std::max(open, proven));
      if (s == open || s == proven) break;
      (at(s) == answer ? proven : open) = s;
    }
    return proven;
  }

  /// Powers of two about which the ray leaves the set, or 0 and infinity.
  Interval bracket() {
    Interval found{0, infinity};
    note(power(0), found);
    for (int k = 1; k <= reach && found.upper == infinity; k *= 2) note(power(k), found);
    for (int k = 1; k <= reach && found.lower == 0; k *= 2) note(power(-k), found);
    return found;
  }

 private:
  /// Exponents of s, and how far they go from where s x is of size 1.
  static constexpr int most = 1000, reach = 256;

  static double between(double lower, double upper) {
    return upper > 2 * lower ? std::ldexp(1.0, (std::ilogb(lower) + std::ilogb(upper)) / 2)
                             : lower + (upper - lower) / 2;
  }

  void note(double s, Interval& found) {
    const Answer inside = at(s);
    if (inside == Answer::yes) found.lower = std::max(found.lower, s);
    if (inside == Answer::no) found.upper = std::min(found.upper, s);
  }

  Box enclosed(double s) const {
    Box product{Vector(X_.dim()), Vector(X_.dim())};
    for (Index i = 0; i < X_.dim(); ++i) {
      const Interval entry = directed::times(s, point_.M(i, 0));
      product.lower[i] = entry.lower;
      product.upper[i] = entry.upper;
    }
    return product;
  }

  /// Of sets that are known by their answers alone: a box that holds s x is outside, or all of its
  /// corners are inside.
  Answer by_enclosure(const Box& box) const {
    if (!box.is_bounded()) return Answer::unknown;
    if (X_.is_disjoint(ConvexSet::box(box.lower, box.upper)) == Answer::yes) return Answer::no;
    constexpr std::size_t most_wide = 6;
    std::vector<Index> wide;
    for (Index i = 0; i < box.dim(); ++i) {
      if (box.lower[i] < box.upper[i]) wide.push_back(i);
    }
    if (wide.size() > most_wide) return Answer::unknown;
    for (std::size_t corner = 0; corner < std::size_t{1} << wide.size(); ++corner) {
      Vector x = box.lower;
      for (std::size_t j = 0; j < wide.size(); ++j) {
        if (corner >> j & 1) x[wide[j]] = box.upper[wide[j]];
      }
      if (X_.contains(x) != Answer::yes) return Answer::unknown;
    }
    return Answer::yes;
  }

  const ConvexSet& X_;
  View view_;
  LineForm point_;  ///< {x δ : δ = s}
  int first_;
};

/// inf{t ≥ 0 : x ∈ t X} from bounds of sup{s : s x ∈ X}.
Interval inverse(double inside, double outside) {
  return {outside < infinity ? directed::over(1, outside).lower : 0,
          inside > 0 ? directed::over(1, inside).upper : infinity};
}

}  // namespace

Interval ConvexSet::gauge(VectorIn x) const {
  if (x.size() != dim()) {
    throw Error(Errc::dimension, "gauge: a vector of size " + std::to_string(x.size()) +
                                     " for a set of dimension " + std::to_string(dim()));
  }
  if (!x.allFinite())
    throw Error(Errc::not_finite, "gauge: the vector has a NaN or infinite entry");
  if (contains(Vector::Zero(dim())) != Answer::yes)
    throw Error(Errc::unsupported, "gauge: that the set holds 0 could not be proven");
  if ((x.array() == 0).all()) return {0, 0};
  Ray ray(*this, x);
  const Interval powers = ray.bracket();
  double inside = powers.lower, outside = powers.upper;
  if (inside > 0) inside = ray.last(Answer::yes, inside, std::min(outside, ray.farthest()));
  if (outside < infinity) outside = ray.last(Answer::no, outside, std::max(inside, ray.nearest()));
  return inverse(inside, outside);
}

}  // namespace cordon
