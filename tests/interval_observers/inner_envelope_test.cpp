// SPDX-License-Identifier: GPL-3.0-or-later
// The inner estimate: exact where it can be checked, inside every observer's hull in any case.
#include "observers/inner_envelope.hpp"

#include <doctest/doctest.h>

#include "comparison_plants.hpp"
#include "published_widths.hpp"
#include "uncertain_models.hpp"

using namespace uncertain;
using comparison::with_gain;
using cordon::estimators::InnerEnvelope;

namespace {

Params samples(std::int64_t count, std::int64_t seed = 1) {
  return Params().set("inner_samples", count).set("inner_seed", seed);
}
Params with_samples(Params params, std::int64_t count) {
  return params.set("inner_samples", count);
}

bool lies_in(const Box& inner, const Box& outer, double slack) {
  slack *= 1 + outer.longest_half_edge() + outer.lower.cwiseAbs().maxCoeff();
  return (inner.lower.array() >= outer.lower.array() - slack).all() &&
         (inner.upper.array() <= outer.upper.array() + slack).all();
}

double distance(const Box& a, const Box& b) {
  return std::max((a.lower - b.lower).cwiseAbs().maxCoeff(),
                  (a.upper - b.upper).cwiseAbs().maxCoeff());
}

/// Reach of the observer's recursion for one A, its generators listed one by one.
Box reach(const Model& model, const Matrix& A, const Matrix& L, const std::vector<Sample>& data) {
  const LinearModel& m = model.linear;
  Vector c = model.X0.c;
  Matrix G = model.X0.G;
  for (const Sample& now : data) {
    const Matrix closed = A - L * m.C, noise = m.Bw * model.W.G, measured = L * m.Dv * model.V.G;
    c = (closed * c + (m.B - L * m.D) * now.u + L * now.y + m.Bw * model.W.c - L * m.Dv * model.V.c)
            .eval();
    Matrix next(G.rows(), G.cols() + noise.cols() + measured.cols());
    next << closed * G, noise, measured;
    G = next;
  }
  const Vector radius = G.cwiseAbs().rowwise().sum();
  return {c - radius, c + radius};
}

/// All hulls of an observer over random data, each with the inner estimate beside it.
void expect_inside(const std::string& observer_name, const std::string& sets) {
  const Model model = random_model(true);
  const Matrix L = random_gain(model.linear);
  const auto observer = registry().make<cordon::ObserverEntry>(
      observer_name, {model, backend(sets)}, with_samples(with_gain(L), 20));
  InnerEnvelope inner(model, L, samples(20));
  Truth truth(model, random_draw(), *rc::gen::arbitrary<bool>());
  inner.start(model.X0);
  Sample before;
  for (Index k = 0; k < 10; ++k) {
    const Vector u = random_matrix(model.linear.inputs(), 1, 3).col(0);
    const Sample now{k, u, truth.step(u)};
    const Box hull = observer->step(now).set->interval_hull();
    if (k > 0) inner.step(before);
    before = now;
    RC_ASSERT(inner.hull().has_value());
    RC_ASSERT(lies_in(*inner.hull(), hull, 1e-11));
    const std::optional<Box> told = observer->inner_estimate();
    RC_ASSERT(told.has_value());
    RC_ASSERT(distance(*told, *inner.hull()) == 0);
  }
}

}  // namespace

TEST_CASE("inside the hull of every observer") {
  for (const char* name : backends()) {
    CAPTURE(name);
    CHECK(rc::check("sets", [&] { expect_inside("zonotope_uncertain", name); }));
    CHECK(rc::check("trajectories", [&] { expect_inside("interval_trajectory", name); }));
  }
}

TEST_CASE("an admissible set that leaves nothing ends the inner estimate: it knows nothing of it") {
  const auto one = [](double x) { return Matrix::Constant(1, 1, x); };
  Model model;
  model.linear = {{}, one(.5), one(1), one(1), one(1), one(0), one(1)};
  model.X0 = cordon::make_box({Vector::Zero(1), Vector::Ones(1)});
  model.W = cordon::make_box({-one(.125).col(0), one(.125).col(0)});
  model.V = cordon::make_box({-Vector::Ones(1), Vector::Ones(1)});
  const cordon::LineForm admissible = cordon::make_box({one(-4).col(0), one(4).col(0)});
  for (const char* name : {"interval_trajectory", "integrated", "zonotope_uncertain"}) {
    CAPTURE(name);
    const auto observer = registry().make<cordon::ObserverEntry>(
        name, {model, backend("interval")},
        with_samples(with_gain(one(.5)), 3).set("admissible_set", admissible));
    const auto step = [&](Index k, double u) {
      return observer->step({k, Vector::Constant(1, u), Vector::Constant(1, .5)});
    };
    CHECK(step(0, 10).consistent == Answer::yes);
    CHECK(observer->inner_estimate());
    CHECK(step(1, 0).consistent == Answer::no);  // x_1 is 10 or so
    CHECK(!observer->inner_estimate());
    CHECK(step(2, 0).consistent == Answer::no);
    CHECK(!observer->inner_estimate());
    observer->start();
    CHECK(step(0, 0).consistent == Answer::yes);
    CHECK(observer->inner_estimate());
  }
}

TEST_CASE("exact matrices and a monotone gain: the inner estimate is the estimate") {
  for (const comparison::PublishedWidths& published : comparison::trajectories()) {
    const Model model = comparison::plant(published.plant);
    if (model.linear.is_uncertain() ||
        (model.linear.A - published.L * model.linear.C).minCoeff() < -1e-12)
      continue;
    CAPTURE(published.plant);
    for (const char* name : {"interval_trajectory", "integrated", "zonotope_uncertain"}) {
      const auto observer = registry().make<cordon::ObserverEntry>(
          name, {model, backend(name[0] == 'z' ? "zonotope" : "interval")},
          with_samples(with_gain(published.L), 1));
      comparison::Truth truth(published.plant, {std::mt19937_64(3), false});
      for (Index k = 0; k <= 200; ++k) {
        const Vector u = comparison::input(published.plant, k);
        const Box hull = observer->step({k, u, truth.step(u)}).set->interval_hull();
        const auto inner = observer->inner_estimate();
        REQUIRE(inner.has_value());
        CHECK(hull.contains(inner->lower));
        CHECK(hull.contains(inner->upper));
        CHECK(distance(*inner, hull) <=
              1e-12 * (1 + hull.upper.cwiseAbs().maxCoeff() + hull.lower.cwiseAbs().maxCoeff()));
      }
    }
  }
}

TEST_CASE(
    "a positive system: both ends of the interval matrix give what a grid of matrices gives") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, .2}, {.1, .6}};
  m.A_radius = Matrix{{.05, .1}, {.02, .04}};
  m.B = Matrix{{1}, {.5}};
  m.C = Matrix{{1, 0}};
  m.D = Matrix{{.25}};
  m.Bw = Matrix{{.1, 0}, {.05, .1}};
  m.Dv = Matrix{{.1}};
  model.X0 = box_around(Vector{{5, 4}}, Vector{{.5, 1}});
  model.W = box_around(Vector{{.5, .2}}, Vector{{1, .5}});
  model.V = box_around(Vector::Constant(1, -.3), Vector::Constant(1, 1));
  const Matrix L{{.1}, {.05}};
  InnerEnvelope inner(model, L, samples(1));
  inner.start(model.X0);
  std::vector<Sample> data;
  for (Index k = 0; k < 5; ++k) {
    Box grid{Vector::Constant(2, 1e9), Vector::Constant(2, -1e9)};
    for (int entry = 0; entry < 5 * 5 * 5 * 5; ++entry) {
      Matrix A = m.A;
      for (int i = 0, rest = entry; i < 4; ++i, rest /= 5)
        A(i) += m.A_radius(i) * (.5 * (rest % 5) - 1);
      const Box one = reach(model, A, L, data);
      grid = {grid.lower.cwiseMin(one.lower), grid.upper.cwiseMax(one.upper)};
    }
    CHECK(distance(*inner.hull(), grid) < 1e-12);
    data.push_back({k, Vector::Constant(1, 2.0 + static_cast<double>(k)), Vector::Constant(1, 6)});
    inner.step(data.back());
  }
}

TEST_CASE("radii of B and C are drawn too, and the seed decides") {
  Model model = comparison::plant("68 exact");
  const Matrix L{{.3}, {.2}, {.8}};
  const auto widths = [&](std::int64_t count, std::int64_t seed) {
    InnerEnvelope inner(model, L, samples(count, seed));
    inner.start(model.X0);
    for (Index k = 0; k < 6; ++k) inner.step({k, Vector::Constant(1, 2), Vector::Constant(1, 3)});
    return Vector(inner.hull()->radius());
  };
  const Vector exact = widths(100, 1);
  CHECK(widths(1, 1) == exact);
  model.linear.B_radius = Matrix{
      {0}, {0}, {.1}};  // x3⁺ = … ± .1 · 2 in each of the steps, of which A - L C keeps nothing
  CHECK(widths(1, 1)[2] == doctest::Approx(exact[2] + .2));
  model.linear.B_radius = {};
  model.linear.C_radius = Matrix{{0, 0, .1}};
  CHECK(widths(1, 1)[2] > exact[2] + .1);
  CHECK(widths(1, 1)[0] > exact[0] + .01);
}

TEST_CASE("random matrices add to the reach where ends do not attain it; the seed decides which") {
  const Model model =
      comparison::plant("70");  // A(1,2) < 0: ends of the interval attain neither bound
  const auto radius = [&](std::int64_t count, std::int64_t seed) {
    InnerEnvelope inner(model, Matrix{{.2754}, {1.0571}, {.7724}}, samples(count, seed));
    inner.start(model.X0);
    for (Index k = 0; k < 20; ++k)
      inner.step({k, Vector::Constant(1, k % 7 < 4 ? 2 : -3), Vector::Constant(1, k % 5 - 2.0)});
    return Vector(inner.hull()->radius());
  };
  CHECK((radius(50, 1) - radius(1, 1)).maxCoeff() > 1e-3);
  CHECK(radius(50, 1) != radius(50, 2));
  CHECK(radius(50, 1) == radius(50, 1));
  CHECK((radius(200, 1) - radius(50, 1)).minCoeff() >= 0);
}

TEST_CASE(
    "it is offered where it is asked for and where the sets have generators, until a set is "
    "replaced") {
  Model model = comparison::plant("68");
  const Params params = with_gain(Matrix{{.3}, {.2}, {.8}});
  const Sample first{0, Vector::Zero(1), Vector::Zero(1)},
      second{1, Vector::Zero(1), Vector::Zero(1)};
  for (const char* name : {"interval_trajectory", "integrated", "zonotope_uncertain"}) {
    CAPTURE(name);
    const auto sets = backend("constrained_zonotope");
    const auto off = registry().make<cordon::ObserverEntry>(name, {model, sets}, params);
    off->step(first);
    CHECK_FALSE(off->inner_estimate().has_value());

    const auto observer =
        registry().make<cordon::ObserverEntry>(name, {model, sets}, with_samples(params, 3));
    CHECK_FALSE(observer->inner_estimate().has_value());
    observer->step(first);
    CHECK(observer->inner_estimate().has_value());
    const Estimate estimate = observer->step(second);
    CHECK(observer->inner_estimate().has_value());
    observer->replace(estimate.set);
    CHECK_FALSE(observer->inner_estimate().has_value());
    observer->step({2, Vector::Zero(1), Vector::Zero(1)});
    CHECK_FALSE(observer->inner_estimate().has_value());

    observer->start(sets->box({Vector::Constant(3, 2), Vector::Constant(3, 3)}));
    observer->step(first);
    REQUIRE(observer->inner_estimate().has_value());
    CHECK(observer->inner_estimate()->lower[0] == doctest::Approx(2));
    const Matrix half{{1, 0, 0}};
    observer->start(
        sets->correct(sets->box({Vector::Constant(3, 2), Vector::Constant(3, 3)}),
                      {half,
                       Vector::Constant(1, 2),
                       {Matrix::Identity(1, 1),
                        sets->box({Vector::Constant(1, -.5), Vector::Constant(1, .5)})}}));
    observer->step(first);
    CHECK_FALSE(observer->inner_estimate().has_value());
  }
}

TEST_CASE("an inner estimate is offered of sets that are known exactly only") {
  Model model = comparison::plant("68");
  const Params params = with_gain(Matrix{{.3}, {.2}, {.8}});
  const Sample first{0, Vector::Zero(1), Vector::Zero(1)};
  for (const char* name : {"interval_trajectory", "integrated", "zonotope_uncertain"}) {
    CAPTURE(name);
    const auto sets = backend("constrained_zonotope");
    const auto outward = registry().make<cordon::BackendEntry>(
        "interval", Params().set("rounding", std::string("outward")));
    const auto rounded =
        registry().make<cordon::ObserverEntry>(name, {model, outward}, with_samples(params, 3));
    rounded->step(first);
    CHECK(rounded->inner_estimate().has_value());
    rounded->start(outward->box({Vector::Constant(3, 2), Vector::Constant(3, 3)}));
    rounded->step(first);
    CHECK(rounded->inner_estimate().has_value());
    rounded->start(outward->box(
        {Vector::Constant(3, .1), Vector::Constant(3, .3)}));  // whose exchange form encloses it
    rounded->step(first);
    CHECK_FALSE(rounded->inner_estimate().has_value());

    Model cut = model;
    cut.X0.A = Matrix{{1, 1, 0}};
    cut.X0.b = Vector::Zero(1);
    auto problems =
        registry().check<cordon::ObserverEntry>(name, {cut, sets}, with_samples(params, 3));
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == "/inner_samples");
    CHECK(registry().check<cordon::ObserverEntry>(name, {cut, sets}, params).empty());
  }
}
