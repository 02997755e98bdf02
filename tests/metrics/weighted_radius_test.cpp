// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/weighted_radius.hpp"

#include <cmath>
#include <filesystem>
#include <functional>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/registry/registry.hpp"

using namespace cordon;
using estimators::f_w_radius;
using estimators::w_radius;

namespace {

Matrix random_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index i = 0; i < A.size(); ++i) A(i) = *rc::gen::inRange(-1000, 1001) * 1e-3;
  return A;
}

Matrix random_weight(Index n) {
  const Matrix A = random_matrix(n, n);
  return A * A.transpose() + .1 * Matrix::Identity(n, n);
}

double by_enumeration(const Matrix& R, const Matrix& W) {
  double largest = 0;
  for (unsigned bits = 0; bits < (1u << R.cols()); ++bits) {
    Vector b(R.cols());
    for (Index j = 0; j < R.cols(); ++j) b[j] = bits >> j & 1 ? 1 : -1;
    const Vector z = R * b;
    largest = std::max(largest, z.dot(W * z));
  }
  return largest;
}

TEST_CASE("both radii of zonotopes that can be seen") {
  const Matrix I = Matrix::Identity(2, 2), square{{3, 0}, {0, 4}}, W{{4, 0}, {0, 1}};
  CHECK(f_w_radius(square, I) == doctest::Approx(5));
  CHECK(f_w_radius(square, W) == doctest::Approx(std::sqrt(4. * 9 + 16)));
  CHECK(w_radius(square, I).value == doctest::Approx(25));
  CHECK(w_radius(square, W).value == doctest::Approx(4. * 9 + 16));
  CHECK(w_radius(Matrix{{1, 1, -2}}, Matrix{{2}}).value ==
        doctest::Approx(32));  // signs are chosen, not taken
  CHECK(w_radius(Matrix{{1, 1}, {1, -1}}, I).value == doctest::Approx(4));
  CHECK(w_radius(Matrix{{1, 1}, {1, -1}}, Matrix{{2, 1}, {1, 2}}).value == doctest::Approx(8));
  CHECK(w_radius(Matrix(2, 0), I).value == 0);
  CHECK(f_w_radius(Matrix(2, 0), I) == 0);
}

TEST_CASE("generators whose squares are no double numbers") {
  const Matrix I = Matrix::Identity(2, 2), square{{3, 0}, {0, 4}};
  for (const double size : {1e-300, 1e-281, 1e-170, 1e170, 1e300})
    CHECK(f_w_radius(size * square, I) / size == doctest::Approx(5));
}

TEST_CASE("the W-radius is the largest over all vertices, or above it") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange(1, 5), g = *rc::gen::inRange(1, 12);
    const Matrix R = random_matrix(n, g), W = random_weight(n);
    const auto found = w_radius(R, W);
    RC_ASSERT(found.exact);
    RC_ASSERT(std::abs(found.value - by_enumeration(R, W)) <= 1e-10 * (1 + found.value));
    RC_ASSERT(f_w_radius(R, W) * f_w_radius(R, W) <=
              found.value * (1 + 1e-10));  // the mean over the vertices is at most the largest
  }));
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange(1, 5);
    const Matrix R = random_matrix(n, estimators::most_enumerated + 1), W = random_weight(n);
    const auto found = w_radius(R, W);
    const double exact = by_enumeration(R, W);
    RC_ASSERT(!found.exact);
    RC_ASSERT(found.value >= exact * (1 - 1e-10));
    RC_ASSERT(found.value <= exact * 2);
  }));
}

TEST_CASE("what cannot be measured is refused") {
  CHECK_THROWS_AS(w_radius(Matrix{{1}, {0}}, Matrix{{1, 2}, {2, 1}}), Error);
  CHECK_THROWS_AS(w_radius(Matrix::Ones(20, 30), Matrix::Identity(20, 20)), Error);
  CHECK(w_radius(Matrix::Ones(20, 3), Matrix::Identity(20, 20)).value == doctest::Approx(180));
}

struct Seen {
  std::vector<MetricValue> step, summary;
};

struct Loaded {
  Loaded() {
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  }
  Registry registry;
};

Seen see(const Registry& registry, const char* metric, const char* backend, const LineForm& X,
         const Params& params) {
  const auto made = registry.make<MetricEntry>(metric, params);
  Estimate estimate;
  estimate.set = registry.make<BackendEntry>(backend, {})->import(X);
  const Box hull = estimate.set->interval_hull();
  const PhaseTimes times;
  Seen seen;
  seen.step = made->step({estimate, hull, nullptr, true, times});
  seen.summary = made->summary();
  return seen;
}

TEST_CASE("the metrics say what they measured") {
  const Loaded plugins;
  const Registry& registry = plugins.registry;
  const auto number = [](const MetricValue& value) { return std::get<double>(value.value); };
  const auto word = [](const MetricValue& value) { return std::get<std::string>(value.value); };
  const LineForm square = make_zonotope(Vector{{7, -7}}, Matrix{{3, 0}, {0, 4}});
  const Params weight = Params().set("weight", Matrix{{4, 0}, {0, 1}});

  Seen seen = see(registry, "f_w_radius", "zonotope", square, {});
  CHECK(seen.step[0].name == "f_w_radius");
  CHECK(number(seen.step[0]) == doctest::Approx(5));
  CHECK(word(seen.step[1]) == "set");
  CHECK(seen.summary[0].name == "f_w_radius_mean");
  CHECK(number(seen.summary[1]) == doctest::Approx(5));
  CHECK(number(see(registry, "w_radius", "zonotope", square, weight).step[0]) ==
        doctest::Approx(52));

  LineForm cut = square;  // ξ₁ = ξ₂: a diagonal of the square, whose hull is the square
  cut.A = Matrix{{1, -1}};
  cut.b = Vector{{0}};
  cut.S = Matrix(1, 0);
  seen = see(registry, "w_radius", "constrained_zonotope", cut, {});
  CHECK(number(seen.step[0]) == doctest::Approx(25));
  CHECK(word(seen.step[1]) == "hull");
  CHECK(word(see(registry, "w_radius", "zonotope",
                 make_zonotope(Vector{{0, 0}}, Matrix::Random(2, 20)), {})
                 .step[1]) == "reduced set");
  seen = see(registry, "w_radius", "line_zonotope", make_space(2), {});
  CHECK(word(seen.step[1]) == "none");
  CHECK(std::isnan(number(seen.step[0])));
  CHECK(std::isnan(number(seen.summary[0])));
}

TEST_CASE("what a run would find out of a weight is told before") {
  const Loaded plugins;
  const Registry& registry = plugins.registry;
  const LineForm square = make_zonotope(Vector{{7, -7}}, Matrix{{3, 0}, {0, 4}});
  Model model;
  model.linear.A = Matrix::Identity(2, 2);
  const auto told = [&](const Matrix& W) {
    const auto problems =
        registry.check<MetricEntry>("w_radius", {model}, Params().set("weight", W));
    return problems.empty() ? "" : problems.at(0).pointer + " " + problems.at(0).message;
  };
  CHECK(registry.check<MetricEntry>("w_radius", {model}, {}).empty());
  CHECK(told(Matrix{{2, 1}, {1, 2}}) == "");
  CHECK(told(Matrix{{1}}) == "/weight is 1 × 1, the state has 2 entries");
  CHECK(told(Matrix{{1, 2}, {2, 1}}) == "/weight is not symmetric and positive definite");
  CHECK_THROWS_AS(
      registry.make<MetricEntry>("w_radius", Params().set("weight", Matrix{{1, 2}, {2, 1}})),
      Error);
  CHECK_THROWS_AS(
      registry.make<MetricEntry>("w_radius", Params().set("weight", Matrix{{1, .5}, {0, 1}})),
      Error);
  CHECK_THROWS_AS(
      see(registry, "w_radius", "zonotope", square, Params().set("weight", Matrix{{1}})), Error);
}

}  // namespace
