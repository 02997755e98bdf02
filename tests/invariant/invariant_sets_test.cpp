// SPDX-License-Identifier: GPL-3.0-or-later
// Invariant sets and supports of minimal ones, against the series that defines them.
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/invariant/minimal.hpp"
#include "cordon/invariant/rpi.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "random_systems.hpp"

using namespace invariant_test;

namespace {

/// The largest share of h_Y(d) - dᵀc_Y by which X goes beyond Y, over random directions.
double excess(const Zonotope& X, const Zonotope& Y, std::mt19937_64& engine) {
  double worst = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < 60; ++k) {
    const Vector d = uniform(engine, X.dim(), 1, 1);
    const double width = sets::support(Y, d) - d.dot(Y.c);
    worst = std::max(worst, (sets::support(X, d) - sets::support(Y, d)) / std::max(width, 1e-12));
  }
  return worst;
}

Zonotope image(const System& system, const Zonotope& X) {
  return sets::minkowski_sum(sets::affine_map(X, system.A, Vector::Zero(X.dim())), system.D);
}

/// h of Σ_{k<T} AᵏD by the definition.
double partial_support(const System& system, Vector d, int terms) {
  double sum = 0;
  for (int k = 0; k < terms; ++k) {
    sum += d.dot(system.D.c) + (system.D.G.transpose() * d).cwiseAbs().sum();
    d = system.A.transpose() * d;
  }
  return sum;
}

}  // namespace

TEST_CASE("the published invariant set of the reactor") {
  const Matrix A{{.7394, -.0002}, {-12.1, .7606}};
  const Matrix G{{0, 0, 0, 0, 0, 0, .002, 0, .001, 0},
                 {.0096, .0048, 0, .048, 0, 0, 0, .002, 0, .001}};
  const Zonotope set = rpi_set(A, {Vector{{.015, .015}}, G});
  CHECK((set.c - Vector{{0.059832269537370475, -2.9614472071937463}}).cwiseAbs().maxCoeff() <
        1e-12);
  REQUIRE(set.generators() == 2);
  Matrix H{{-0.006479444190666094, 0.006580612807847029},
           {-1.2869005386815593, -2.0045388784178497}};
  for (Index k = 0; k < 2; ++k) {  // columns in any order and with any sign
    double best = 1;
    for (Index l = 0; l < 2; ++l) {
      best = std::min({best, (set.G.col(l) - H.col(k)).cwiseAbs().maxCoeff(),
                       (set.G.col(l) + H.col(k)).cwiseAbs().maxCoeff()});
    }
    CHECK(best < 1e-11);
  }
}

TEST_CASE("closed-form sets are invariant, iterations shrink them towards the minimal set") {
  CHECK(rc::check([](unsigned seed) {
    std::mt19937_64 engine(seed);
    const System system =
        random_system(engine, std::uniform_real_distribution<double>(.2, .97)(engine));
    const Zonotope set = rpi_set(system.A, system.D);
    RC_ASSERT(excess(image(system, set), set, engine) <= 1e-10);
    const Zonotope smaller = iterate(system.A, system.D, set, 5);
    RC_ASSERT(excess(image(system, smaller), smaller, engine) <= 1e-10);
    RC_ASSERT(excess(smaller, set, engine) <= 1e-10);
    const Zonotope reduced = iterate(system.A, system.D, set, 5, set.dim() + 3);
    RC_ASSERT(reduced.generators() <= set.dim() + 3);
    RC_ASSERT(excess(smaller, reduced, engine) <= 1e-10);
    for (int k = 0; k < 5; ++k) {
      const Vector d = uniform(engine, set.dim(), 1, 1);
      const SupportPair h = minimal_support(system.A, system.D, d, 1e-9);
      const double width = sets::support(set, d) - d.dot(set.c);
      RC_ASSERT(h.plus.upper <= sets::support(smaller, d) + 1e-7 * width);
      RC_ASSERT(h.minus.upper <= sets::support(smaller, -d) + 1e-7 * width);
    }
  }));
}

TEST_CASE("complex pairs: the polygon is at most a quarter wider than the disc") {
  for (const double radius : {.3, .9, .99, .999}) {
    const double angle = .7;
    const Matrix A =
        radius * Matrix{{std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}};
    const Zonotope D{Vector::Zero(2), Matrix{{1}, {0}}};
    const Zonotope set = rpi_set(A, D);
    const double disc = 1 / (1 - radius);
    for (double direction = 0; direction < 3.2; direction += .01) {
      const double h = sets::support(set, Vector{{std::cos(direction), std::sin(direction)}});
      CHECK(h >= disc * (1 - 1e-12));
      CHECK(h <= 1.36 * disc);  // corners of the octagon besides
    }
    std::mt19937_64 engine(1);
    CHECK(excess(image({A, D}, set), set, engine) <= 1e-12);
  }
}

TEST_CASE("supports of minimal sets enclose the series") {
  CHECK(rc::check([](unsigned seed) {
    std::mt19937_64 engine(seed);
    const System system =
        random_system(engine, std::uniform_real_distribution<double>(.1, .97)(engine));
    const double accuracy = std::pow(10.0, -std::uniform_int_distribution<int>(2, 11)(engine));
    const Vector d = uniform(engine, system.A.rows(), 1, 1);
    const SupportPair h = minimal_support(system.A, system.D, d, accuracy);
    const double plus = partial_support(system, d, 2500), minus = partial_support(system, -d, 2500);
    const double size = std::max(std::abs(plus), std::abs(minus));
    RC_ASSERT(h.plus.lower <= plus + 1e-13 * size && plus - 1e-13 * size <= h.plus.upper);
    RC_ASSERT(h.minus.lower <= minus + 1e-13 * size && minus - 1e-13 * size <= h.minus.upper);
    const double radius = .5 * (plus + minus), center = .5 * std::abs(plus - minus);
    RC_ASSERT(h.plus.upper - h.plus.lower <=
              2.1 * accuracy * (radius + center) + 1e-9 * size * accuracy + 1e-11 * size);
  }));
}

TEST_CASE("known minimal sets, also of defective matrices") {
  // x⁺ = x/2 + d, |d| ≤ 1: [-2,2]
  const SupportPair line =
      minimal_support(Matrix{{.5}}, {Vector{{0}}, Matrix{{1}}}, Vector{{1}}, 1e-12);
  CHECK(line.plus.lower <= 2);
  CHECK(line.plus.upper >= 2);
  CHECK(line.plus.upper - line.plus.lower < 1e-10);
  // [1/2 1; 0 1/2]ᵏ = [2⁻ᵏ k 2¹⁻ᵏ; 0 2⁻ᵏ]: Σ |2⁻ᵏ| + Σ k 2¹⁻ᵏ = 2 + 4 for D = [-1,1]²; c = (1, 1)
  // gives (I - A)⁻¹c = (6, 2)
  const Matrix jordan{{.5, 1}, {0, .5}};
  const Zonotope D{Vector{{1, 1}}, Matrix::Identity(2, 2)};
  const SupportPair h = minimal_support(jordan, D, Vector{{1, 0}}, 1e-10);
  CHECK(h.plus.upper == doctest::Approx(12).epsilon(1e-8));
  CHECK(h.plus.upper >= 12);
  CHECK(h.plus.lower <= 12);
  CHECK(std::abs(h.minus.upper) < 1e-8);
  CHECK(h.minus.upper >= 0);
  const std::string text = message([&] { rpi_set(jordan, D); }, Errc::invalid);
  CHECK(has(text, "defective"));
  CHECK(has(text, "condition"));
}

TEST_CASE("units of the states do not matter") {
  std::mt19937_64 engine(3);
  System system = random_system(engine, .8);
  while (system.A.rows() < 4) system = random_system(engine, .8);
  const Vector scale{{1, 1e-6, 1e5, 1e9, 1}};
  const Vector own = scale.head(system.A.rows());
  const Matrix S = own.asDiagonal(), inverse = own.cwiseInverse().asDiagonal();
  const System scaled{S * system.A * inverse, {S * system.D.c, S * system.D.G}};
  for (Index k = 0; k < own.size(); ++k) {
    const SupportPair a = minimal_support(system.A, system.D, Vector::Unit(own.size(), k), 1e-10);
    const SupportPair b = minimal_support(scaled.A, scaled.D, Vector::Unit(own.size(), k), 1e-10);
    CHECK(b.plus.upper == doctest::Approx(a.plus.upper * own[k]).epsilon(1e-8));
  }
  const Zonotope X = rpi_set(system.A, system.D), Y = rpi_set(scaled.A, scaled.D);
  for (Index k = 0; k < own.size(); ++k) {
    CHECK(sets::interval_hull(Y).upper[k] ==
          doctest::Approx(sets::interval_hull(X).upper[k] * own[k]).epsilon(.3));
  }
}

TEST_CASE("reachable states under switching disturbances") {
  CHECK(rc::check([](unsigned seed) {
    std::mt19937_64 engine(seed);
    const System first =
        random_system(engine, std::uniform_real_distribution<double>(.3, .95)(engine));
    const Index n = first.A.rows();
    const std::vector<Zonotope> D{first.D,
                                  {uniform(engine, n, 1, 2), uniform(engine, n, 2, .5)},
                                  {Vector::Zero(n), Matrix(n, 0)}};
    const std::vector<Zonotope> starts{{uniform(engine, n, 1, 3), uniform(engine, n, 2, 1)},
                                       {Vector::Zero(n), Matrix(n, 0)}};
    const Vector d = uniform(engine, n, 1, 1);
    const Decay decay(first.A, Vector::Ones(n));
    const SwitchedSupports h = switched_supports(decay, D, starts, d, 1e-8);
    // the definition, for the first times
    double sum_plus = 0, sum_minus = 0, plus = -1e300, minus = -1e300;
    Vector r = d;
    for (int t = 0; t < 3000; ++t) {
      double start_plus = -1e300, start_minus = -1e300, drive_plus = -1e300, drive_minus = -1e300;
      for (const Zonotope& Z : starts) {
        start_plus = std::max(start_plus, r.dot(Z.c) + (Z.G.transpose() * r).cwiseAbs().sum());
        start_minus = std::max(start_minus, -r.dot(Z.c) + (Z.G.transpose() * r).cwiseAbs().sum());
      }
      plus = std::max(plus, start_plus + sum_plus);
      minus = std::max(minus, start_minus + sum_minus);
      for (const Zonotope& Z : D) {
        drive_plus = std::max(drive_plus, r.dot(Z.c) + (Z.G.transpose() * r).cwiseAbs().sum());
        drive_minus = std::max(drive_minus, -r.dot(Z.c) + (Z.G.transpose() * r).cwiseAbs().sum());
      }
      sum_plus += drive_plus;
      sum_minus += drive_minus;
      r = first.A.transpose() * r;
    }
    const double size = std::max(std::abs(plus), std::abs(minus));
    RC_ASSERT(h.plus >= plus - 1e-13 * size);
    RC_ASSERT(h.minus >= minus - 1e-13 * size);
    RC_ASSERT(h.plus <= plus + 1e-6 * size);
    RC_ASSERT(h.minus <= minus + 1e-6 * size);
    for (std::size_t i = 0; i < D.size(); ++i) {
      RC_ASSERT(h.minimal[i].plus.upper >=
                partial_support({first.A, D[i]}, d, 3000) - 1e-13 * size);
    }
  }));
}

TEST_CASE("partial sums enclose, and are enclosed by, the image of the minimal set") {
  CHECK(rc::check([](unsigned seed) {
    std::mt19937_64 engine(seed);
    const System system =
        random_system(engine, std::uniform_real_distribution<double>(.1, .95)(engine));
    const Index n = system.A.rows(), q = 2;
    const Matrix T = uniform(engine, q, n, 1);
    const Decay decay(system.A, Vector::Ones(n));
    const PartialSum sum =
        partial_sum(decay, system.D, T, 1e-6, std::uniform_int_distribution<Index>(0, 60)(engine));
    for (int k = 0; k < 10; ++k) {
      const Vector d = uniform(engine, q, 1, 1);
      const double h = partial_support(system, T.transpose() * d, 4000),
                   part = sets::support(sum.part, d), rest = sum.rest.dot(d.cwiseAbs());
      RC_ASSERT(h <= part + rest + 1e-13 * std::abs(h));
      RC_ASSERT(part - rest <= h + 1e-13 * std::abs(h));
    }
  }));
}

TEST_CASE("degenerate systems and wrong arguments") {
  const Zonotope point{Vector{{1, 1}}, Matrix(2, 0)};
  const Matrix A{{.5, 0}, {0, .25}};
  CHECK(rpi_set(A, point).generators() == 0);
  CHECK((rpi_set(A, point).c - Vector{{2, 4. / 3}}).norm() < 1e-14);
  const SupportPair h = minimal_support(A, point, Vector{{1, 0}}, 1e-9);
  CHECK(h.plus.upper == doctest::Approx(2));
  CHECK(h.minus.upper == doctest::Approx(-2));
  const SupportPair none =
      minimal_support(A, {Vector::Zero(2), Matrix(2, 0)}, Vector{{1, 0}}, 1e-9);
  CHECK(none.plus.upper < 1e-300);
  CHECK(minimal_support(Matrix(0, 0), {Vector(0), Matrix(0, 0)}, Vector(0), 1e-9).plus.upper <
        1e-300);
  CHECK(rpi_set(Matrix(0, 0), {Vector(0), Matrix(0, 0)}).dim() == 0);
  // a flat set: no width in the second coordinate
  CHECK(minimal_support(A, {Vector::Zero(2), Matrix{{1}, {0}}}, Vector{{0, 1}}, 1e-9).plus.upper <
        1e-9);
  CHECK(iterate(A, point, point, 0).c == point.c);
  message([&] { rpi_set(2 * Matrix::Identity(2, 2), point); }, Errc::invalid);
  message(
      [&] {
        minimal_support(2 * Matrix::Identity(2, 2), point, Vector{{1, 0}}, 1e-9);
      },
      Errc::invalid);
  message([&] { minimal_support(A, point, Vector{{1}}, 1e-9); }, Errc::dimension);
  message([&] { minimal_support(A, point, Vector{{1, 0}}, 0); }, Errc::invalid);
  message(
      [&] {
        minimal_support(A, {Vector{{0}}, Matrix(1, 0)}, Vector{{1, 0}}, 1e-9);
      },
      Errc::dimension);
  message([&] { iterate(A, point, point, -1); }, Errc::invalid);
  message([&] { iterate(A, point, point, 1, 1); }, Errc::invalid);
  message([&] { rpi_set(Matrix(2, 3), point); }, Errc::dimension);
  const Matrix slow{{1 - 1e-9}};
  message(
      [&] {
        minimal_support(slow, {Vector{{0}}, Matrix{{1}}}, Vector{{1}}, 1e-9);
      },
      Errc::unsupported);
}

TEST_CASE("zonotopes around given sets") {
  const LineForm zonotope = make_zonotope(Vector{{1, 2}}, Matrix{{1, 0, 2}, {0, 0, 1}});
  CHECK(enclosing_zonotope(zonotope).G == Matrix{{1, 2}, {0, 1}});
  const LineForm cut = intersection(zonotope, Matrix{{1, 0}}, make_box({Vector{{1}}, Vector{{9}}}));
  const Zonotope around = enclosing_zonotope(cut);
  CHECK(sets::interval_hull(around).lower[0] == doctest::Approx(1));
  CHECK(sets::interval_hull(around).upper[0] == doctest::Approx(4));
  CHECK(has(message([] { enclosing_zonotope(make_space(2), "W"); }, Errc::unsupported),
            "W is unbounded"));
  CHECK(has(message([] { enclosing_zonotope(make_empty(2), "W"); }, Errc::invalid), "W is empty"));
}
