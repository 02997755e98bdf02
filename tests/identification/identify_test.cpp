// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/identify.hpp"

#include <cstdlib>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "study/identification/scaling_proof.hpp"

using namespace cordon;

namespace {

LineForm ball(Index n, double radius) {
  return make_zonotope(Vector::Zero(n), radius * Matrix::Identity(n, n));
}

Model model_of(const Matrix& A, const Matrix& C, double w, double v) {
  const Index n = A.rows(), p = C.rows();
  Model model;
  model.linear.A = A;
  model.linear.B = Matrix(n, 0);
  model.linear.Bw = Matrix::Identity(n, n);
  model.linear.C = C;
  model.linear.D = Matrix(p, 0);
  model.linear.Dv = Matrix::Identity(p, p);
  model.X0 = make_space(n);
  model.W = ball(n, w);
  model.V = ball(p, v);
  return model;
}

std::vector<Sample> samples_of(const std::vector<double>& outputs) {
  std::vector<Sample> samples;
  for (const double y : outputs)
    samples.push_back({std::ssize(samples), Vector(0), Vector::Constant(1, y)});
  return samples;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Matrix matrix(Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& entry : A.reshaped()) entry = (*this)();
    return A;
  }
  /// c + Gξ, ξ at a vertex or not.
  Vector point(const LineForm& set) {
    Vector xi = matrix(set.generators(), 1);
    if ((*this)() > 0) xi = xi.cwiseSign();
    return set.c + set.G * xi;
  }
  bool rarely() { return (*this)() > 0.4; }

 private:
  std::mt19937_64 engine_;
};

/// A random system and data that its bounds explain.
struct Plant {
  Model model;
  std::vector<Sample> samples;
};

Plant plant_of(std::uint64_t seed, Index steps) {
  Random random(seed);
  const Index n = 1 + static_cast<Index>(seed % 3), p = 1 + static_cast<Index>(seed % 2);
  Matrix A = random.matrix(n, n);
  A *= (seed % 7 == 0 ? 1.05 : 0.9) / A.cwiseAbs().rowwise().sum().maxCoeff();
  Plant plant{model_of(A, random.matrix(p, n), 0.1, 0.05), {}};
  Model& model = plant.model;
  model.linear.B = random.matrix(n, 1);
  model.linear.D = random.matrix(p, 1);
  model.W.c = random.matrix(n, 1);
  if (seed % 2 == 0) model.W.G = 0.1 * random.matrix(n, n + 1);
  if (seed % 3 != 0) model.X0 = ball(n, 1);
  if (seed % 5 == 0) {  // one coordinate is not known at all
    model.X0.M = Matrix::Identity(n, 1);
    model.X0.S = Matrix(0, 1);
  }
  Vector x = random.matrix(n, 1);
  for (Index k = 0; k < steps; ++k) {
    const Vector u = random.matrix(1, 1);
    Sample sample{k, u, model.linear.C * x + model.linear.D * u + random.point(model.V)};
    if (seed % 4 == 1 && random.rarely()) sample = missing_outputs(sample, {0});
    plant.samples.push_back(sample);
    x = model.linear.A * x + model.linear.B * u + random.point(model.W);
  }
  return plant;
}

constexpr Scaled all[] = {Scaled::both, Scaled::disturbances, Scaled::noises, Scaled::each};

}  // namespace

TEST_CASE("two outputs of a state that hardly moves: by hand") {
  const Model model = model_of(Matrix::Identity(1, 1), Matrix::Identity(1, 1), 1, 1);
  const auto samples = samples_of({0, 1});
  const auto factor = [&](Scaled scaled, const Model& of) {
    const BoundFactors found = identify_bounds(of, samples, {scaled});
    REQUIRE(found.status == BoundFactors::Status::found);
    CHECK(found.cost == doctest::Approx(found.proven).epsilon(1e-9));
    CHECK(found.required_by == std::vector<Index>{0, 1});
    return found;
  };
  CHECK(factor(Scaled::both, model).cost == doctest::Approx(1.0 / 3));  // 1 ≤ s + 2 s
  const BoundFactors each = factor(Scaled::each, model);
  CHECK(each.noises[0] == doctest::Approx(0.5));
  CHECK(std::abs(each.disturbances[0]) < 1e-9);
  Model narrow = model;
  narrow.W = ball(1, 0.1);
  const BoundFactors noises = factor(Scaled::noises, narrow);
  CHECK(noises.cost == doctest::Approx(0.45));
  CHECK(noises.disturbances[0] == 1);
  narrow.V = ball(1, 0.2);
  CHECK(factor(Scaled::disturbances, narrow).cost == doctest::Approx(6));
}

TEST_CASE("data of known bounds: no factor is above them, and a smaller one is refuted") {
  const char* const wanted = std::getenv("CORDON_IDENTIFIED_PLANTS");
  const std::uint64_t plants = wanted ? std::strtoull(wanted, nullptr, 10) : 200;
  for (std::uint64_t seed = 1; seed <= plants; ++seed) {
    CAPTURE(seed);
    const Plant plant = plant_of(seed, 30);
    for (const Scaled scaled : all) {
      CAPTURE(static_cast<int>(scaled));
      const BoundFactors found = identify_bounds(plant.model, plant.samples, {scaled});
      REQUIRE(found.status == BoundFactors::Status::found);
      const double of_truth =
          scaled == Scaled::each
              ? static_cast<double>(plant.model.W.generators() + plant.model.V.generators())
              : 1;
      CHECK(found.cost <= of_truth * (1 + 1e-7));
      CHECK(found.proven <= of_truth * (1 + 1e-11));  // data are rounded
      CHECK(found.proven <= found.cost * (1 + 1e-6) + 1e-9);
      CHECK(found.proven >= found.cost * (1 - 1e-5) - 1e-9);
    }
  }
}

TEST_CASE("whatever the multipliers, nothing above the smallest factor is called proven") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const Plant plant = plant_of(seed, 12);
    Random random(seed);
    Matrix multipliers = random.matrix(plant.model.linear.outputs(), 12);
    for (const Sample& sample : plant.samples)
      for (const Index i : sample.missing) multipliers(i, sample.k) = 0;
    for (const Scaled scaled : all) {
      const auto factors = identification::factors_of(plant.model, scaled);
      const auto proof = identification::scaling_proof(plant.model, plant.samples, factors,
                                                       {multipliers, Matrix()});
      if (proof) CHECK(proof->least <= (scaled == Scaled::each ? 10 : 1));
    }
  }
}

TEST_CASE("data that leave no room need no bounds, and what is fixed may explain nothing") {
  const Model still = model_of(Matrix::Identity(1, 1), Matrix::Identity(1, 1), 1, 1);
  const BoundFactors none = identify_bounds(still, samples_of({2, 2, 2}));
  REQUIRE(none.status == BoundFactors::Status::found);
  CHECK(none.cost < 1e-9);
  CHECK(none.proven <= none.cost + 1e-12);
  Model exact = still;
  exact.V = make_point(Vector::Zero(1));
  exact.linear.Bw = Matrix::Zero(1, 1);
  CHECK(identify_bounds(exact, samples_of({0, 1})).status == BoundFactors::Status::none);
}

TEST_CASE("samples that spoil the bounds are left out, as few as is proven") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Plant plant = plant_of(seed, 40);
    plant.samples[12].y.array() += 2;
    plant.samples[30].y.array() -= 2;
    const BoundFactors spoilt = identify_bounds(plant.model, plant.samples);
    if (spoilt.cost < 3) continue;  // an output that was missing, or that says little
    const LeftOutSamples found = leave_out(plant.model, plant.samples, 1.001, 8, {});
    CHECK(found.is_enough);
    CHECK(found.at_least >= 1);
    CHECK(found.at_least <= 2);
    REQUIRE(!found.steps.empty());
    CHECK(found.steps.back().factors.cost <= 1.001);
  }
  const Model still = model_of(Matrix::Identity(1, 1), Matrix::Identity(1, 1), 0.01, 0.1);
  const LeftOutSamples found =
      leave_out(still, samples_of({0, 0, 5, 0, 0, 0, 0, -5, 0, 0}), 1, 5, {});
  REQUIRE(found.steps.size() == 2);
  CHECK(found.steps[0].k + found.steps[1].k == 9);
  CHECK(found.at_least == 2);
  CHECK(found.is_enough);
}

TEST_CASE("the fewest samples, where one after the other takes too many or proves too little") {
  int by_hand = 0, exact = 0, checked = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    CAPTURE(seed);
    Plant plant = plant_of(seed, 14);
    for (const std::size_t k : {4u, 5u, 9u}) plant.samples[k].y.array() += k % 2 == 0 ? 1 : -1;
    const LeftOutSamples found = leave_out(plant.model, plant.samples, 1.001, 8, {});
    if (!found.is_enough || found.steps.empty()) continue;
    ++checked;
    const auto count = static_cast<Index>(found.steps.size());
    CHECK(found.at_least <= count);
    exact += found.at_least == count;
    // All sets of fewer samples, by hand where these are no more than two.
    if (count > 3 || found.at_least < count) continue;
    const auto n = static_cast<Index>(plant.samples.size());
    for (Index a = 0; a < n; ++a) {
      for (Index b = a; b < (count == 3 ? n : a + 1); ++b) {
        if (count == 1) continue;
        std::vector<Sample> rest = plant.samples;
        for (const Index k : {a, b}) {
          Sample& sample = rest[static_cast<std::size_t>(k)];
          sample = missing_outputs(sample, present_outputs(sample));
        }
        CHECK(identify_bounds(plant.model, rest).cost > 1.001 * (1 - 1e-9));
      }
    }
    ++by_hand;
  }
  CHECK(checked >= 15);
  CHECK(exact >= checked - 1);
  CHECK(by_hand >= 5);
}

TEST_CASE("what has no generators with factors is refused") {
  Model model = model_of(Matrix::Identity(1, 1), Matrix::Identity(1, 1), 1, 1);
  CHECK(why_not_identified(model).empty());
  model.linear.E = Matrix::Identity(1, 1);
  CHECK(why_not_identified(model).empty());
  model.linear.E = Matrix();
  model.linear.A_radius = Matrix::Ones(1, 1);
  CHECK(!why_not_identified(model).empty());
  model.linear.A_radius = Matrix();
  model.W = make_space(1);
  CHECK(!why_not_identified(model).empty());
  model.W = ball(1, 1);
  auto samples = samples_of({0, 1});
  samples[1].k = 5;
  CHECK_THROWS_AS(identify_bounds(model, samples), Error);
}
