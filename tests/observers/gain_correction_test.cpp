// SPDX-License-Identifier: GPL-3.0-or-later
// Predicted sets corrected by a gain: hulls that were found independently, what they must enclose,
// and samples that contradict them.
#include <cmath>

#include <doctest/doctest.h>

#include "observers/noisy_runs.hpp"
#include "published/gain_plants.hpp"

using namespace cordon;
using namespace gain_plants;
using namespace noisy_runs;

namespace {

/// Steps at which the truth was lost, over the seeds.
int losses(const Model& model, const Params& params, const std::string& backend, int seeds,
           bool gaps) {
  const auto observer =
      plugins().observer("gain_correction", model, plugins().backend(backend), params);
  int lost = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    Run run(model, static_cast<std::uint64_t>(seed) + 1, seed % 3 != 0);
    observer->start();
    for (Index k = 0; k < 12; ++k) {
      const Sample sample = run.sample(k);
      const Estimate estimate = observer->step(gaps ? with_gaps(sample, run) : sample);
      lost += estimate.consistent == Answer::no || !holds(estimate.set, run.x);
      run.move_on();
    }
  }
  return lost;
}

}  // namespace

TEST_CASE("hulls of given gains, those of the toolbox among them") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    for (const auto& [name, c] : plant.reference["given"].items()) {
      CAPTURE(name);
      if (c["observer"] == "error_hull") continue;
      const std::vector<Box> found =
          hulls(plant, c["observer"], unreduced(given(matrix(c["gain"]))));
      CHECK(distance(found, c["hulls"]) < 1e-8);
    }
    for (const char* name : {"w_radius_filter_rho_0.5", "w_radius_filter_rho_0.9",
                             "h_infinity_filter", "kalman_steady_filter"}) {
      CAPTURE(name);
      const json c = plant.reference["designs"][name];
      const std::vector<Box> found =
          hulls(plant, "gain_correction", unreduced(given(matrix(c["gain"]))));
      CHECK(distance(found, c["hulls"]) < 1e-8);
    }
  }
}

TEST_CASE("hulls of designed gains") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const json designs = plant.reference["designs"];
    CHECK(distance(hulls(plant, "gain_correction", unreduced({})),
                   designs["gain_correction_kalman"]["hulls"]) < 1e-8);
    const Params steady = gain("kalman", Params().set("steady", true));
    CHECK(distance(hulls(plant, "gain_correction", unreduced(steady)),
                   designs["kalman_steady_filter"]["hulls"]) < 2e-4);
    const Params half = gain("w_radius", Params().set("rho", .5));
    CHECK(distance(hulls(plant, "gain_correction", unreduced(half)),
                   designs["w_radius_filter_rho_0.5"]["hulls"]) < 1e-3);
  }
}

TEST_CASE("representations that hold zonotopes give the same, boxes enclose it") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const std::vector<Box> zonotopes = hulls(plant, "gain_correction", unreduced({}));
    for (const char* backend : {"constrained_zonotope", "line_zonotope"}) {
      CAPTURE(backend);
      CHECK(distance(hulls(plant, "gain_correction", unreduced({}), backend), zonotopes) < 1e-8);
    }
    const Params same = given(matrix(plant.reference["designs"]["kalman_steady_filter"]["gain"]));
    const std::vector<Box> finer = hulls(plant, "gain_correction", unreduced(same)),
                           boxes = hulls(plant, "gain_correction", unreduced(same), "interval");
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      CHECK((boxes[k].lower.array() <= finer[k].lower.array() + 1e-12).all());
      CHECK((boxes[k].upper.array() >= finer[k].upper.array() - 1e-12).all());
    }
  }
}

TEST_CASE("with one output the gain that follows the set cuts strips of least F-radius") {
  for (const Example& plant : {plants()[0], plants()[1]}) {
    CAPTURE(plant.name);
    const auto observer = plugins().observer(
        "prediction_correction", plant.model,
        plugins().backend("zonotope", Params().set("strip", std::string("segment"))),
        unreduced({}));
    std::vector<Box> strips;
    for (const Sample& sample : plant.samples)
      strips.push_back(observer->step(sample).set->interval_hull());
    CHECK(distance(hulls(plant, "gain_correction", unreduced({})), strips) < 1e-9);
  }
}

TEST_CASE("no other gain leaves shorter generators after the first correction") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const LinearModel& m = plant.model.linear;
    const auto size = [&](const Params& params) {
      const auto observer = plugins().observer("gain_correction", plant.model,
                                               plugins().backend("zonotope"), unreduced(params));
      return observer->step(plant.samples[0]).set->line_form().G.norm();
    };
    // of every Λ that (I - Λ C) A is stable for
    sets::Random random(1);
    const double least = size({});
    const Matrix steady = matrix(plant.reference["designs"]["kalman_steady_filter"]["gain"]);
    for (int i = 0; i < 100; ++i) {
      const double share = i % 2 == 0 ? .02 : .002;
      Matrix other = steady;
      for (double& entry : other.reshaped()) entry += share * random.between(-1, 1);
      const Params params = given(other);
      if (!plugins()
               .registry
               .check<ObserverEntry>("gain_correction",
                                     {plant.model, plugins().backend("zonotope")}, params)
               .empty())
        continue;
      CHECK(size(params) >= least * (1 - 1e-12));
    }
    CHECK(m.outputs() > 0);
  }
}

TEST_CASE("hulls enclose those of the exact sets") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const json exact = plant.reference["designs"]["exact"]["hulls"];
    for (const char* type : {"kalman", "w_radius", "h_infinity"}) {
      for (const std::int64_t most : {10, 30}) {
        CAPTURE(type);
        const std::vector<Box> found =
            hulls(plant, "gain_correction", gain(type).set("max_generators", most));
        for (const auto& [k, bounds] : exact.items()) {
          CAPTURE(k);
          const Box& hull = found.at(static_cast<std::size_t>(std::stoi(k)));
          const Matrix told = matrix(bounds);
          CHECK((hull.lower.array() <= told.row(0).transpose().array() + 1e-8).all());
          CHECK((hull.upper.array() >= told.row(1).transpose().array() - 1e-8).all());
        }
      }
    }
  }
}

TEST_CASE("the truth stays inside, with and without gaps") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    for (const char* type : {"kalman", "w_radius", "h_infinity"}) {
      CAPTURE(type);
      CHECK(losses(plant.model, gain(type), "zonotope", 150, false) == 0);
      CHECK(losses(plant.model, gain(type), "zonotope", 50, true) == 0);
    }
    for (const char* backend : {"interval", "constrained_zonotope", "line_zonotope"}) {
      CAPTURE(backend);
      CHECK(losses(plant.model, {}, backend, 30, true) == 0);
    }
  }
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    for (const char* backend : {"interval", "zonotope"}) {
      CHECK(losses(random_model(seed), Params().set("max_generators", std::int64_t{6}), backend, 3,
                   seed % 2 == 0) == 0);
    }
  }
}

TEST_CASE("with rounding outwards as well") {
  const Params outward = Params().set("rounding", std::string("outward"));
  const Example& plant = plants()[2];
  const auto observer =
      plugins().observer("gain_correction", plant.model, plugins().backend("zonotope", outward));
  const std::vector<Box> nominal = hulls(plant, "gain_correction", {});
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const Box hull = observer->step(plant.samples[k]).set->interval_hull();
    CHECK((hull.lower - nominal[k].lower).cwiseAbs().maxCoeff() < 1e-3);
    CHECK((hull.upper - nominal[k].upper).cwiseAbs().maxCoeff() < 1e-3);
  }
}

TEST_CASE("an output outside what the prediction allows is a contradiction, one inside is none") {
  const Model model = plants()[2].model;
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    // |C_1 x + Dv_1 v| ≤ 1.15
    const auto at = [&](double y) {
      const auto observer =
          plugins().observer("gain_correction", model, plugins().backend(backend));
      return observer->step({0, Vector{{0}}, Vector{{y, 0}}}).consistent;
    };
    CHECK(at(1.15 + 1e-6) == Answer::no);
    CHECK(at(1.15) != Answer::no);
    CHECK(at(-1.15 - 1e-6) == Answer::no);
    const auto observer = plugins().observer("gain_correction", model, plugins().backend(backend));
    observer->step({0, Vector{{0}}, Vector{{0, 0}}});
    const Estimate after = observer->step({1, Vector{{0}}, Vector{{50, 0}}});
    CHECK(after.consistent == Answer::no);
    REQUIRE(observer->contradiction());
    CHECK(observer->contradiction()->output == 0);
    CHECK(observer->step({2, Vector{{0}}, Vector{{0, 0}}}).consistent == Answer::no);
  }
}

TEST_CASE("a sample without outputs predicts") {
  const Example& plant = plants()[0];
  const auto observer =
      plugins().observer("gain_correction", plant.model, plugins().backend("zonotope"));
  const auto predicting =
      plugins().observer("prediction_correction", plant.model, plugins().backend("zonotope"));
  for (const Sample& sample : {plant.samples[0], plant.samples[1], plant.samples[2]}) {
    const Sample none = missing_outputs(sample, {0});
    const Box hull = observer->step(none).set->interval_hull(),
              expected = predicting->step(none).set->interval_hull();
    CHECK(hull.lower == expected.lower);
    CHECK(hull.upper == expected.upper);
  }
}

TEST_CASE("what it does not take is said") {
  const auto problems = [](const Model& model, const Params& params) {
    return plugins().registry.check<ObserverEntry>("gain_correction",
                                                   {model, plugins().backend("zonotope")}, params);
  };
  const auto descriptor = problems(descriptor_example(), {});
  REQUIRE(!descriptor.empty());
  CHECK(descriptor.back().message.find("\"lti\"") != std::string::npos);
  CHECK(descriptor.back().suggestion.find("descriptor") != std::string::npos);
  CHECK(problems(plants()[2].model, Params().set("max_generators", std::int64_t{2}))[0].pointer ==
        "/max_generators");
  Model unbounded = plants()[2].model;
  unbounded.V = make_space(2);
  CHECK(!problems(unbounded, {}).empty());
}

TEST_CASE("all problems are told at once") {
  const Params wrong = given(Matrix::Constant(3, 2, 10)).set("max_generators", std::int64_t{1});
  CHECK(plugins()
            .registry
            .check<ObserverEntry>("gain_correction",
                                  {plants()[2].model, plugins().backend("zonotope")}, wrong)
            .size() == 2);
}

TEST_CASE("what a set without bounds leaves open of outputs is left out, and the rest is used") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, 0}, {0, .9}};
  m.B = Matrix(2, 0);
  m.C = Matrix::Identity(2, 2);
  m.D = Matrix(2, 0);
  m.Bw = m.Dv = .1 * Matrix::Identity(2, 2);
  model.X0 = model.W = model.V = make_box({Vector{{-1, -1}}, Vector{{1, 1}}});
  for (const bool by_range : {false, true}) {
    CAPTURE(by_range);
    m.C_radius = by_range ? Matrix() : Matrix{{0, 0}, {0, .1}};
    m.sensor = by_range ? Box{Vector{{1, .5}}, Vector{{1, .7}}} : Box{};
    for (const char* backend : {"interval", "line_zonotope"}) {
      CAPTURE(backend);
      const auto sets = plugins().backend(backend);
      const auto observer =
          plugins().observer("gain_correction", model, sets, given(Matrix{{.9, .05}, {0, .9}}));
      Box start = Box::space(2);
      start.lower[0] = -9;
      start.upper[0] = 9;
      for (const bool bounded : {true, false}) {
        observer->start(bounded ? sets->box(start) : sets->space(2));
        Run run(model, 4, false);
        for (Index k = 0; k < 10; ++k) {
          Sample now = run.sample(k);
          if (by_range) now.y[1] -= .4 * run.x[1];
          const Box hull = observer->step(now).set->interval_hull();
          CHECK(hull.lower[0] <= run.x[0]);
          CHECK(run.x[0] <= hull.upper[0]);
          if (bounded) CHECK(hull.upper[0] - hull.lower[0] < 2.1);
          CHECK(std::isinf(hull.upper[1]));
          run.move_on();
        }
      }
    }
  }
}

TEST_CASE("where one output alone makes the estimate empty, it is the one that is named") {
  Model model;  // the prediction is narrower before it is reduced
  LinearModel& m = model.linear;
  m.A = Matrix{{.6, .5}, {-.5, .6}};
  m.B = Matrix(2, 0);
  m.C = Matrix{{1, 1}};
  m.D = Matrix(1, 0);
  m.Bw = Matrix::Identity(2, 2);
  m.Dv = Matrix{{.01}};
  model.X0 = make_box({Vector{{-1, -1}}, Vector{{1, 1}}});
  model.W = make_box({Vector{{-.1, -.1}}, Vector{{.1, .1}}});
  model.V = make_box({Vector{{-1}}, Vector{{1}}});
  for (const bool second : {false, true}) {
    CAPTURE(second);
    if (second) {  // an output that says nothing
      m.C = Matrix{{0, 0}, {1, 1}};
      m.D = Matrix(2, 0);
      m.Dv = Matrix{{.01}, {.01}};
    }
    const auto observer =
        plugins().observer("gain_correction", model, plugins().backend("zonotope"),
                           Params().set("max_generators", std::int64_t{2}));
    const Index p = m.C.rows();
    const auto is_empty_by = [&](double last) {
      observer->start();
      Vector y = Vector::Zero(p);
      for (Index k = 0; k < 6; ++k) observer->step({k, Vector(0), y});
      y[p - 1] = last;
      return observer->step({6, Vector(0), y}).consistent == Answer::no;
    };
    double inside = 0, outside = 5;
    while (outside - inside > 1e-6) {
      const double middle = (inside + outside) / 2;
      (is_empty_by(middle) ? outside : inside) = middle;
    }
    for (const double y : {outside, 5.}) {
      REQUIRE(is_empty_by(y));
      REQUIRE(observer->contradiction());
      CHECK(observer->contradiction()->output == p - 1);
      CHECK((observer->contradiction()->distance > 0) == (y == 5));
    }
  }
}
