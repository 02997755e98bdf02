// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/strip_recursion.hpp"

#include <doctest/doctest.h>

#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"
#include "observers/nonlinear/least_volume_gain.hpp"

using namespace cordon;
using namespace cordon::test;
using estimators::StripRecursion;
using estimators::StripVariant;

namespace {

Json six_tanks() {
  std::ifstream in(CORDON_SOURCE_DIR "/tests/nonlinear/six_tanks.json");
  REQUIRE(in.good());
  return Json::parse(in);
}

constexpr std::pair<const char*, StripVariant> variants[] = {{"FRad-A", StripVariant::frad_a},
                                                             {"FRad-B", StripVariant::frad_b},
                                                             {"FRad-C", StripVariant::frad_c},
                                                             {"VolMin-B", StripVariant::vol_min_b},
                                                             {"VolMin-A", StripVariant::vol_min_a}};

Sample sample(const Json& data, Index k) {
  return {k, vector_of(data["u"][as_size(k)]), vector_of(data["y"][as_size(k)])};
}

}  // namespace

TEST_CASE("six tanks: hulls of an independent computation, without any reduction") {
  const Json data = six_tanks();
  const Model model = model_of(data["system"]);
  for (const auto& [name, variant] : variants) {
    if (variant == StripVariant::vol_min_a) continue;  // six states
    StripRecursion recursion(model, variant, 100'000);
    recursion.start(model.X0);
    for (Index k = 0; k < std::ssize(data["y"]); ++k) {
      CAPTURE(std::string(name));
      CAPTURE(k);
      if (k > 0) recursion.predict(sample(data, k - 1));
      REQUIRE(recursion.correct(sample(data, k)));
      const Json& wanted = data["hulls"][name][as_size(k)];
      const Vector radius = recursion.generators().cwiseAbs().rowwise().sum();
      for (Index i = 0; i < 6; ++i) {
        CAPTURE(i);
        CHECK(std::abs(recursion.center()[i] - radius[i] - wanted[as_size(i)][0].get<double>()) <
              2e-9);
        CHECK(std::abs(recursion.center()[i] + radius[i] - wanted[as_size(i)][1].get<double>()) <
              2e-9);
      }
    }
  }
}

TEST_CASE("a reduction by components encloses, and keeps the largest columns") {
  std::mt19937_64 random(2);
  for (int i = 0; i < 50; ++i) {
    const Index n = 2 + i % 3;
    Matrix G(n, 12);
    for (double& entry : G.reshaped())
      entry = std::uniform_real_distribution<double>(-1, 1)(random);
    G.col(3) *= 100;
    G.col(4).setZero();
    const Matrix reduced = estimators::reduced_by_components(G, n + 2);
    REQUIRE(reduced.cols() == n + 2);
    CHECK((reduced.col(1) == G.col(3) || reduced.col(0) == G.col(3)));
    for (int d = 0; d < 20; ++d) {
      Vector direction(n);
      for (double& x : direction) x = std::uniform_real_distribution<double>(-1, 1)(random);
      CHECK((direction.transpose() * reduced).cwiseAbs().sum() >=
            (direction.transpose() * G).cwiseAbs().sum() - 1e-12);
    }
  }
}

TEST_CASE("the gain of least volume: no other has less") {
  std::mt19937_64 random(3);
  const auto any = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  for (int i = 0; i < 30; ++i) {
    Matrix G(2, 6);
    for (double& entry : G.reshaped()) entry = any();
    Eigen::RowVectorXd C(2);
    C << any(), any();
    const double sigma = 0.1 + std::abs(any());
    const auto volume = [&](const Vector& lambda) {
      Matrix cut(2, 7);
      cut << G - lambda * (C * G), sigma * lambda;
      double sum = 0;
      for (Index a = 0; a < 7; ++a)
        for (Index b = a + 1; b < 7; ++b) {
          sum += std::abs(cut(0, a) * cut(1, b) - cut(1, a) * cut(0, b));
        }
      return sum;
    };
    const auto best = estimators::least_volume_gain(G, C, sigma);
    REQUIRE(best);
    const double least = volume(*best);
    CHECK(least <= volume(Vector::Zero(2)) + 1e-9);
    for (int other = 0; other < 200; ++other)
      CHECK(least <= volume(*best + Vector{{any(), any()}} * std::pow(10.0, -other % 5)) + 1e-9);
  }
}

TEST_CASE("trajectories stay inside the sets of all variants") {
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    if (example["name"] == "heading") continue;  // disturbances leave its invariant
    const Model model = model_of(example["system"]);
    for (const auto& [name, variant] : variants) {
      CAPTURE(example["name"].get<std::string>());
      CAPTURE(std::string(name));
      int enclosed = 0;
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        StripRecursion recursion(model, variant, 20);
        Trajectory trajectory(model, seed);
        recursion.start(model.X0);
        Sample before;
        for (Index k = 0; k < 20; ++k) {
          const Vector u = vector_of(example["u"][as_size(k) % example["u"].size()]);
          try {
            if (k > 0) recursion.predict(before);
          } catch (const Error& error) {
            CHECK(error.code() == Errc::not_enclosed);
            break;
          }
          if (k > 0) trajectory.advance(before.u, before.k);
          before = {k, u, trajectory.output(u, k)};
          REQUIRE(recursion.correct(before));
          const LineForm set = make_zonotope(recursion.center(), recursion.generators());
          REQUIRE(contains(set, trajectory.x()) != Answer::no);
          ++enclosed;
        }
      }
      CHECK(enclosed > 60);
    }
  }
}

TEST_CASE("a known start without disturbances: sets of all variants start as points") {
  Json system = {{"states", {"a", "b"}}, {"disturbances", {"w"}}, {"noises", {"v"}}};
  system["f"] = {"0.451*a - 0.128*atan(b) + w", "0.46*b + 0.044*sin(a) - w"};
  system["g"] = {"a + 0.3*sin(b) + v"};
  system["W"] = system["V"] = {{"center", {0}}, {"generators", {{0}}}};
  system["X0"] = {{"center", {0.926, 0.408}}, {"generators", {{0.0}, {0.0}}}};
  Model model = model_of(system);
  model.X0.G.resize(2, 0);
  for (const auto& [name, variant] : variants) {
    CAPTURE(std::string(name));
    StripRecursion recursion(model, variant, 10);
    Trajectory trajectory(model, 1);
    recursion.start(model.X0);
    Sample before;
    for (Index k = 0; k < 40; ++k) {
      CAPTURE(k);
      if (k > 0) {
        recursion.predict(before);
        trajectory.advance(before.u, before.k);
      }
      before = {k, Vector(0), trajectory.output(Vector(0), k)};
      REQUIRE(recursion.correct(before));
      const LineForm set = make_zonotope(recursion.center(), recursion.generators());
      CHECK(contains(set, trajectory.x()) != Answer::no);
    }
  }
}
