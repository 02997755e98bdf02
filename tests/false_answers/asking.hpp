// SPDX-License-Identifier: GPL-3.0-or-later
// The questions of the list, asked of the exchange form and of every representation of this build.
#pragma once

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "exact_proof.hpp"
#include "published/study_models.hpp"

namespace cordon::false_answers {

struct Represented {
  std::string name;
  Enclosure set;
  bool is_exact() const { return set.tightness == Tightness::exact; }
};

inline std::vector<std::shared_ptr<const SetBackend>> backends(const std::string& rounding) {
  static const Plugins plugins;
  std::vector<std::shared_ptr<const SetBackend>> all;
  for (const char* name :
       {"interval", "zonotope", "constrained_zonotope", "line_zonotope", "ellipsoid", "polytope"}) {
    Params params;
    if (name != std::string("polytope")) {
      params.set("rounding", rounding);
    } else if (rounding == "outward") {
      params.set("digits", std::int64_t{0});
    }
    all.push_back(plugins.backend(name, params));
  }
  return all;
}

/// X in every representation that can enclose it, with nominal and with outward rounding.
inline std::vector<Represented> represented(const LineForm& X) {
  std::vector<Represented> all;
  for (const char* rounding : {"nominal", "outward"}) {
    for (const auto& backend : backends(rounding)) {
      try {
        all.push_back({backend->info().name + ", " + rounding, backend->import(X)});
      } catch (const Error& error) {  // unbounded sets in bounded representations
        CHECK(error.code() == Errc::unsupported);
      }
    }
  }
  REQUIRE(all.size() >= 2);
  return all;
}

/// Sets that only enclose X may keep what X has not, they must not lose what it has.
inline void check_emptiness(const LineForm& X, Answer right) {
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    if (r.is_exact()) CHECK(r.set->is_empty() == right);
    if (right == Answer::no) CHECK(r.set->is_empty() != Answer::yes);
  }
}

inline void check_membership(const LineForm& X, const Vector& x, Answer right) {
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    if (r.is_exact()) CHECK(r.set->contains(x) == right);
    if (right == Answer::yes) CHECK(r.set->contains(x) != Answer::no);
  }
}

inline void check_disjointness(const LineForm& X, const LineForm& Y, Answer right) {
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    const Enclosure other = r.set->backend().import(Y);
    // "no" is said about exchange forms that are the sets
    const bool is_told = right == Answer::yes || r.set->backend().info().exact_exchange;
    if (r.is_exact() && other.tightness == Tightness::exact && is_told)
      CHECK(r.set->is_disjoint_from(*other) == right);
    if (right == Answer::no) CHECK(r.set->is_disjoint_from(*other) != Answer::yes);
  }
}

/// Proven empty, proven not empty, and the same of points and pairs: the answer, its proof in
/// rational arithmetic, and the answers of all representations.
inline void expect_empty(const LineForm& X) {
  Certificate why;
  CHECK(is_empty(X, &why) == Answer::yes);
  CHECK(exact_proof::refuted(exact_proof::rows_of(X), why));
  check_emptiness(X, Answer::yes);
}
inline void expect_not_empty(const LineForm& X) {
  Certificate why;
  CHECK(is_empty(X, &why) == Answer::no);
  CHECK(exact_proof::solved(exact_proof::rows_of(X), why));
  check_emptiness(X, Answer::no);
}
inline void expect_inside(const LineForm& X, const Vector& x) {
  Certificate why;
  CHECK(contains(X, x, &why) == Answer::yes);
  CHECK(exact_proof::solved(exact_proof::rows_of(X, x), why));
  check_membership(X, x, Answer::yes);
}
inline void expect_outside(const LineForm& X, const Vector& x) {
  Certificate why;
  CHECK(contains(X, x, &why) == Answer::no);
  CHECK(exact_proof::refuted(exact_proof::rows_of(X, x), why));
  check_membership(X, x, Answer::no);
}
inline void expect_disjoint(const LineForm& X, const LineForm& Y) {
  Certificate why;
  CHECK(is_disjoint(X, Y, &why) == Answer::yes);
  CHECK(exact_proof::refuted(exact_proof::rows_of(X, Y), why));
  check_disjointness(X, Y, Answer::yes);
}
inline void expect_meeting(const LineForm& X, const LineForm& Y) {
  Certificate why;
  CHECK(is_disjoint(X, Y, &why) == Answer::no);
  CHECK(exact_proof::solved(exact_proof::rows_of(X, Y), why));
  check_disjointness(X, Y, Answer::no);
}

/// The value of the support function, its proof, and that no representation lies below.
inline void expect_support(const LineForm& X, const Vector& d, double right) {
  Certificate why;
  const double h = support(X, d, &why);
  CHECK(h == doctest::Approx(right).epsilon(1e-12));
  CHECK(exact_proof::proves_support(X, d, h, why));
  CHECK(lower_support(X, d) <= right);
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    CHECK(r.set->support(d) >= right * (1 - 1e-12 * (right > 0 ? 1 : -1)));
  }
}

/// A bound along d and its proof; infinite ones need none.
inline void expect_bound(const LineForm& X, const Vector& d, double right, double bound,
                         const Certificate& why) {
  if (right == infinity) {
    CHECK(bound == infinity);
  } else {
    CHECK(bound == doctest::Approx(right).epsilon(1e-12));
    CHECK(exact_proof::proves_support(X, d, bound, why));
  }
}

/// The bounds of the hull, two proofs for each coordinate.
inline void expect_hull(const LineForm& X, const Box& right) {
  std::vector<Certificate> why;
  const Box hull = interval_hull(X, &why);
  REQUIRE(why.size() == 2 * exact_proof::size_of(X.dim()));
  for (Index i = 0; i < X.dim(); ++i) {
    CAPTURE(i);
    const Vector e = Vector::Unit(X.dim(), i);
    const std::size_t k = 2 * exact_proof::size_of(i);
    expect_bound(X, e, right.upper[i], hull.upper[i], why[k]);
    expect_bound(X, -e, -right.lower[i], -hull.lower[i], why[k + 1]);
  }
}

inline LineForm segment(double lower, double upper) {
  return make_box({Vector{{lower}}, Vector{{upper}}});
}

/// X ∩ Y.
inline LineForm both(const LineForm& X, const LineForm& Y) {
  return intersection(X, Matrix::Identity(X.dim(), X.dim()), Y);
}

/// {x : h - 2 r ≤ H x ≤ h}, exactly as stored: H δ + r ξ + r ζ = h and ζ = 1. Half-spaces, where a
/// slack of 2 r is more than the set has.
inline LineForm half_spaces(const Matrix& H, const Vector& h, double r) {
  const Index n = H.cols(), m = H.rows();
  LineForm X{Matrix::Identity(n, n), Matrix::Zero(n, m + 1),     Vector::Zero(n),
             Matrix::Zero(m + 1, n), Matrix::Zero(m + 1, m + 1), Vector(m + 1)};
  X.S.topRows(m) = H;
  X.A.topLeftCorner(m, m) = r * Matrix::Identity(m, m);
  X.A.col(m).setConstant(r);
  X.A(m, m) = 1;
  X.b << h, 1;
  return X;
}

}  // namespace cordon::false_answers
