// SPDX-License-Identifier: GPL-3.0-or-later
// What the observers of uncertain systems refuse, and in which words; and what happens at the ends
// of their range.
#include <doctest/doctest.h>

#include "comparison_plants.hpp"

using namespace comparison;
using banks::backend;
using banks::registry;

namespace {

const char* const observers[] = {"zonotope_uncertain", "interval_trajectory", "integrated"};

std::vector<Diagnostic> check(const std::string& name, const Model& model, const Params& params,
                              const std::string& sets = "line_zonotope") {
  return registry().check<cordon::ObserverEntry>(name, {model, backend(sets)}, params);
}

void expect_one(const std::vector<Diagnostic>& problems, const std::string& pointer,
                const std::string& words) {
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == pointer);
  CAPTURE(problems[0].message);
  CHECK(problems[0].message.find(words) != std::string::npos);
  CHECK_FALSE(problems[0].suggestion.empty());
}

Params monotone() { return with_gain(Matrix{{.3}, {.2}, {.8}}); }

Sample sample(Index k, double y) { return {k, Vector::Zero(1), Vector::Constant(1, y)}; }

}  // namespace

TEST_CASE("a model that fits is taken on every backend") {
  for (const char* name : observers) {
    for (const char* sets : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"})
      CHECK(check(name, plant("68"), monotone(), sets).empty());
  }
}

TEST_CASE("gains of other shapes and gains that do not stabilise") {
  for (const char* name : observers) {
    CAPTURE(name);
    expect_one(check(name, plant("68"), with_gain(Matrix{{.3, .2, .8}})), "/gain",
               "is 1 × 3, must be 3 × 1");
    expect_one(check(name, plant("68"), with_gain(Matrix{{-1.1376}, {-1.9167}, {-1.2604}})),
               "/gain", "eigenvalue");
  }
}

TEST_CASE("sets without bounds, of another dimension, empty") {
  Model model = plant("68");
  for (const char* name : observers) {
    CAPTURE(name);
    Model without = model;
    without.X0 = make_space(3);
    expect_one(check(name, without, monotone()), "", "the system's X0 is unbounded");
    CHECK(check(name, without, monotone().set("initial_set", model.X0)).empty());
    const LineForm slab = make_box({Vector{{0, 0, -infinity}}, Vector{{1, 1, infinity}}});
    expect_one(check(name, model, monotone().set("initial_set", slab)), "/initial_set",
               "unbounded");
    expect_one(check(name, model, monotone().set("initial_set", make_point(Vector::Zero(2)))),
               "/initial_set", "dimension 2");
    without = model;
    without.W = make_space(3);
    auto problems = check(name, without, monotone());
    expect_one(problems, "", "the system's W is unbounded");
    without = model;
    without.V = make_empty(1);
    expect_one(check(name, without, monotone()), "", "the system's V is empty");
  }
}

TEST_CASE("a model with exact A and C may start anywhere, with sets") {
  Model model = plant("68 exact");
  model.linear.B_radius = Matrix{{0}, {0}, {.1}};
  model.X0 = make_space(3);
  CHECK(check("zonotope_uncertain", model, monotone()).empty());
  CHECK(check("zonotope_uncertain", model, monotone(), "zonotope").size() == 1);
  const auto observer = registry().make<cordon::ObserverEntry>(
      "zonotope_uncertain", {model, backend("line_zonotope")}, monotone());
  observer->step(sample(0, 1));
  CHECK(observer->step(sample(1, 1)).set->is_bounded() == Answer::no);
}

TEST_CASE("descriptor systems") {
  Model model = plant("68");
  model.linear.E = Matrix::Identity(3, 3);
  for (const char* name : observers) {
    const auto problems = check(name, model, monotone());
    REQUIRE_FALSE(problems.empty());
    CHECK(problems[0].pointer == "/type");
    CHECK(problems[0].suggestion.find("descriptor") != std::string::npos);
  }
}

TEST_CASE("gains of the bounds: both, or one for both") {
  const std::shared_ptr<const ComponentSpec> gain =
      std::get<std::shared_ptr<const ComponentSpec>>(monotone().values().at("gain"));
  const Model model = plant("68");
  expect_one(check("interval_trajectory", model, Params().set("upper_gain", gain)), "/upper_gain",
             "without \"lower_gain\"");
  expect_one(check("interval_trajectory", model, Params().set("lower_gain", gain)), "/lower_gain",
             "without \"upper_gain\"");
  expect_one(
      check("interval_trajectory", model, Params().set("gain", gain).set("lower_gain", gain)),
      "/gain", "beside");
  const Params both = Params().set("upper_gain", gain).set("lower_gain", gain);
  CHECK(check("interval_trajectory", model, both).empty());
  expect_one(
      check("interval_trajectory", model, Params(both).set("inner_samples", std::int64_t{2})),
      "/inner_samples", "one gain");
  const auto observer = registry().make<cordon::ObserverEntry>("interval_trajectory",
                                                               {model, backend("interval")}, both);
  REQUIRE(observer->gains().size() == 2);
  CHECK(observer->gains()[0].name == "upper_gain");
  CHECK(observer->gains()[1].name == "lower_gain");
  Params wrong =
      Params(both).set("lower_gain", std::get<std::shared_ptr<const ComponentSpec>>(
                                         with_gain(Matrix{{1}, {2}}).values().at("gain")));
  expect_one(check("interval_trajectory", model, wrong), "/lower_gain", "is 2 × 1");
  CHECK_FALSE(check("interval_trajectory", model,
                    Params(monotone()).set("inner_samples", std::int64_t{10'001}))
                  .empty());
  CHECK_FALSE(
      check("interval_trajectory", model, Params(monotone()).set("inner_samples", std::int64_t{-1}))
          .empty());
}

TEST_CASE("integrated: every negative entry of A - L C is named") {
  expect_one(check("integrated", plant("70"), monotone()), "/gain",
             "A - L C is negative at row 1, column 2: -0.1");
  const auto problems = check("integrated", plant("70"), monotone());
  CHECK(problems[0].suggestion.find(
            "no monotone gain exists: column 2 of C is zero and A(1,2) < 0") != std::string::npos);
  expect_one(check("integrated", plant("68"), with_gain(Matrix{{.35}, {.25}, {.8}})), "/gain",
             "A - L C is negative at row 1, column 3: -0.05; at row 2, column 3: -0.05");
  CHECK(check("integrated", plant("68"), with_gain(Matrix{{.35}, {.2}, {.8}}))[0].suggestion.find(
            "peak") != std::string::npos);
  // negative by rounding only: 1e-9 of the largest entry
  CHECK(check("integrated", plant("68"), with_gain(Matrix{{.3 + 7e-10}, {.2}, {.8}})).empty());
  CHECK(check("integrated", plant("68"), with_gain(Matrix{{.3 + 9e-10}, {.2}, {.8}})).size() == 1);
}

TEST_CASE("an unbounded set that is handed over at run time") {
  const auto sets = backend("line_zonotope");
  for (const char* name : {"interval_trajectory", "integrated"}) {
    const auto observer =
        registry().make<cordon::ObserverEntry>(name, {plant("68"), sets}, monotone());
    observer->start(sets->space(3));
    CHECK_THROWS_AS(observer->step(sample(0, 0)), Error);
  }
  const auto observer =
      registry().make<cordon::ObserverEntry>("zonotope_uncertain", {plant("68"), sets}, monotone());
  observer->start(sets->space(3));
  observer->step(sample(0, 0));
  CHECK_FALSE(observer->step(sample(1, 0)).set->interval_hull().is_bounded());
}

TEST_CASE("bounds that grow without limit end in an error, not in numbers that are none") {
  Model model = plant("68");
  model.linear.A_radius.setConstant(3);
  const auto observer = registry().make<cordon::ObserverEntry>(
      "interval_trajectory", {model, backend("interval")}, monotone());
  std::string words;
  try {
    for (Index k = 0; k < 2000; ++k) observer->step(sample(k, 0));
  } catch (const Error& error) {
    words = error.what();
  }
  CHECK(words.find("grown beyond all numbers") != std::string::npos);
}

TEST_CASE("where no gain is given") {
  const Model model = plant("68");
  for (const char* name : {"zonotope_uncertain", "interval_trajectory"}) {
    CHECK(check(name, model, {}).empty());
    const auto observer =
        registry().make<cordon::ObserverEntry>(name, {model, backend("zonotope")}, {});
    REQUIRE(observer->gains().size() == 1);
    CHECK(observer->gains()[0].type == "kalman");
    CHECK(observer->gains()[0].name == "gain");
  }
}

TEST_CASE("integrated designs a monotone gain, or tells why there is none") {
  for (const char* name : {"68", "72"}) {
    const Model model = plant(name);
    CHECK(check("integrated", model, {}).empty());
    const auto observer =
        registry().make<cordon::ObserverEntry>("integrated", {model, backend("interval")}, {});
    CHECK(observer->gains()[0].type == "h_infinity_monotone");
    CHECK((model.linear.A - observer->gains()[0].L * model.linear.C).minCoeff() >= -1e-9);
  }
  expect_one(check("integrated", plant("70"), {}), "",
             "no monotone gain exists: column 2 of C is zero and A(1,2) < 0");
  const auto peak = std::make_shared<const ComponentSpec>(ComponentSpec{"peak", {}});
  CHECK(check("integrated", plant("68"), Params().set("gain", peak)).empty());
  expect_one(check("integrated", plant("70"), Params().set("gain", peak)), "/gain",
             "no monotone gain exists");
}

TEST_CASE("a gain that varies in time is the one for the carried set") {
  const Model model = plant("68");
  const auto kalman = std::make_shared<const ComponentSpec>(ComponentSpec{"kalman", {}});
  const Params params = Params().set("gain", kalman).set("max_generators", std::int64_t{3});
  const auto zonotopes = backend("zonotope");
  const auto observer =
      registry().make<cordon::ObserverEntry>("zonotope_uncertain", {model, zonotopes}, params);
  const auto designer = registry().make<cordon::GainEntry>("kalman", {});
  observer->step(sample(0, .3));
  Enclosure X = observer->step(sample(1, .5)).set;
  for (Index k = 1; k < 6; ++k) {
    const LineForm carried = zonotopes->reduce(X, {3, 5})->line_form();
    const Matrix L = designer->update(model, carried.G * carried.G.transpose());
    const auto fixed =
        registry().make<cordon::ObserverEntry>("zonotope_uncertain", {model, zonotopes},
                                               with_gain(L).set("max_generators", std::int64_t{3}));
    fixed->start(X);
    fixed->step(sample(k, .5));
    const Box expected = fixed->step(sample(k + 1, .5)).set->interval_hull();
    X = observer->step(sample(k + 1, .5)).set;
    CHECK((X->interval_hull().upper - expected.upper).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((X->interval_hull().lower - expected.lower).cwiseAbs().maxCoeff() < 1e-13);
  }
  expect_one(
      check("zonotope_uncertain", model, Params(params).set("inner_samples", std::int64_t{2})),
      "/inner_samples", "vary in time");
  // trajectories take the steady gain
  const auto steady =
      registry().make<cordon::ObserverEntry>("interval_trajectory", {model, zonotopes}, {});
  const auto trajectories = registry().make<cordon::ObserverEntry>(
      "interval_trajectory", {model, zonotopes}, Params().set("gain", kalman));
  CHECK(trajectories->gains()[0].L == steady->gains()[0].L);
}

TEST_CASE("two gains: bounds that cross prove that the data contradict the model, and only then") {
  Model model = plant("68 exact");
  Params both;
  const auto component = [](const Matrix& L) { return with_gain(L).values().at("gain"); };
  both.set("upper_gain", component(Matrix{{.3}, {.2}, {.8}}))
      .set("lower_gain", component(Matrix{{.1}, {.1}, {.3}}));
  for (const char* sets : {"interval", "zonotope", "constrained_zonotope"}) {
    CAPTURE(sets);
    const auto observer =
        registry().make<cordon::ObserverEntry>("interval_trajectory", {model, backend(sets)}, both);
    observer->step(sample(0, 0));
    observer->step(sample(1, -100));  // lower by .8 · 100, but only .3 · 100
    const Estimate estimate = observer->step(sample(2, 0));
    CHECK(estimate.consistent == Answer::no);
    CHECK(observer->step(sample(3, 0)).consistent == Answer::no);
    observer->replace(backend(sets)->box({Vector::Zero(3), Vector::Ones(3)}));
    CHECK(observer->step(sample(4, 0)).consistent != Answer::no);
  }
  // no noise, a known start: both bounds are the trajectory, and differ by rounding errors
  model.linear.A_radius = {};
  model.W = make_point(Vector::Zero(3));
  model.V = make_point(Vector::Zero(1));
  model.X0 = make_point(Vector{{.1, .7, -.3}});
  const auto observer = registry().make<cordon::ObserverEntry>("interval_trajectory",
                                                               {model, backend("interval")}, both);
  Vector x = model.X0.c;
  for (Index k = 0; k < 300; ++k) {
    const Vector u = input("68", k);
    const Estimate estimate = observer->step({k, u, model.linear.C * x});
    CHECK(estimate.consistent != Answer::no);
    CHECK((estimate.set->interval_hull().center() - x).cwiseAbs().maxCoeff() < 1e-12);
    x = model.linear.A * x + model.linear.B * u;
  }
}

TEST_CASE("measurements off by less than the margin of a proof are not called a contradiction") {
  Model model = plant("68 exact");
  model.W = make_point(Vector::Zero(3));
  model.V = make_point(Vector::Zero(1));
  model.X0 = make_point(Vector::Zero(3));
  Params both;
  const auto component = [](const Matrix& L) { return with_gain(L).values().at("gain"); };
  both.set("upper_gain", component(Matrix{{.3}, {.2}, {.8}}))
      .set("lower_gain", component(Matrix{{.1}, {.1}, {.3}}));
  const auto consistent = [&](double off) {
    const auto observer = registry().make<cordon::ObserverEntry>(
        "interval_trajectory", {model, backend("interval")}, both);
    observer->step({0, Vector::Constant(1, 1), Vector::Zero(1)});
    observer->step({1, Vector::Constant(1, 1), Vector::Constant(1, 1 + off)});
    return observer->step({2, Vector::Constant(1, 1), Vector::Constant(1, 1.8)});
  };
  for (const double off : {-1e-11, 1e-11}) {
    const Estimate estimate = consistent(off);
    CHECK(estimate.consistent != Answer::no);
    const Box hull = estimate.set->interval_hull();
    CHECK_FALSE(hull.is_empty());
    CHECK((hull.center() - Vector{{.3, .2, 1.8}}).cwiseAbs().maxCoeff() < 1e-10);
  }
  CHECK(consistent(-1e-6).consistent == Answer::no);  // .8 off below .3 off
  CHECK(consistent(1e-6).consistent != Answer::no);   // the upper bound rises by more
}
