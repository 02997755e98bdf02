// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of the three observers on random uncertain models.
#include <doctest/doctest.h>

#include "comparison_plants.hpp"
#include "observers/interval_recursion.hpp"
#include "uncertain_models.hpp"

using namespace uncertain;
using comparison::with_gain;

namespace {

std::shared_ptr<const SetBackend> backend_of(const std::string& name) {
  return name == "outward interval"
             ? registry().make<cordon::BackendEntry>(
                   "interval", Params().set("rounding", std::string("outward")))
             : backend(name);
}

void expect_truth_inside(const std::string& observer_name, const std::string& sets,
                         bool two_gains) {
  const Model model = random_model(true);
  Params params = with_gain(random_gain(model.linear), two_gains ? "upper_gain" : "gain");
  if (two_gains) params.set("lower_gain", with_gain(random_gain(model.linear)).values().at("gain"));
  const auto observer =
      registry().make<cordon::ObserverEntry>(observer_name, {model, backend_of(sets)}, params);
  RC_ASSERT(observer->gains().size() == (two_gains ? 2U : 1U));
  Truth truth(model, random_draw(), *rc::gen::arbitrary<bool>());
  for (Index k = 0; k < 12; ++k) {
    const Vector u = random_matrix(model.linear.inputs(), 1, 3).col(0), x = truth.x;
    const Estimate estimate = observer->step({k, u, truth.step(u)});
    RC_ASSERT(may_contain(estimate.set, x));
    RC_ASSERT(estimate.consistent != Answer::no);
    RC_ASSERT(estimate.set.tightness == Tightness::outer);
    if (k == 7) observer->replace(estimate.set);
  }
}

/// A model with A - L C ≥ 0 whose generators have entries of one sign, and its gain.
std::pair<Model, Matrix> monotone_model() {
  Model model = random_model(false);
  LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  const Matrix L = random_matrix(n, p, 1).cwiseAbs();
  m.A = m.A.cwiseAbs() + L * m.C;
  m.Bw = m.Bw.cwiseAbs();
  m.Dv = m.Dv.cwiseAbs();
  for (LineForm* set : {&model.X0, &model.W, &model.V}) set->G = set->G.cwiseAbs();
  return {model, L};
}

using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

double largest(const Vector& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("the truth is never outside, on every backend, with one gain or two") {
  std::vector<std::string> sets(backends().begin(), backends().end());
  sets.push_back("outward interval");
  for (const std::string& name : sets) {
    CAPTURE(name);
    CHECK(rc::check("sets", [&] { expect_truth_inside("zonotope_uncertain", name, false); }));
    CHECK(rc::check("trajectories",
                    [&] { expect_truth_inside("interval_trajectory", name, false); }));
    CHECK(rc::check("trajectories with two gains",
                    [&] { expect_truth_inside("interval_trajectory", name, true); }));
  }
}

TEST_CASE("monotone gain, generators of one sign: three observers, the same hull") {
  CHECK(rc::check("the same", [] {
    const auto [model, L] = monotone_model();
    const auto interval = backend("interval"), zonotope = backend("zonotope");
    const Params params = with_gain(L);
    const auto bounds = registry().make<cordon::ObserverEntry>("interval_trajectory",
                                                               {model, interval}, params),
               centred =
                   registry().make<cordon::ObserverEntry>("integrated", {model, interval}, params),
               sets = registry().make<cordon::ObserverEntry>("zonotope_uncertain",
                                                             {model, zonotope}, params);
    Truth truth(model, random_draw(), true);
    for (Index k = 0; k < 12; ++k) {
      const Vector u = random_matrix(model.linear.inputs(), 1, 3).col(0);
      const Sample now{k, u, truth.step(u)};
      const Box a = bounds->step(now).set->interval_hull();
      for (const auto& other : {centred, sets}) {
        const Box b = other->step(now).set->interval_hull();
        const double slack = 1e-12 * (1 + largest(a.lower) + largest(a.upper));
        RC_ASSERT(largest(a.lower - b.lower) <= slack && largest(a.upper - b.upper) <= slack);
      }
    }
  }));
}

/// A generator with entries of both signs, mapped by a monotone matrix: its box is mapped to a
/// larger one.
TEST_CASE("a generator with two signs: the interval observer is strictly wider") {
  Model model = comparison::plant("68");
  model.X0 = make_zonotope(Vector::Zero(3), Matrix{{1}, {-1}, {0}});
  const Params params = with_gain(Matrix{{.3}, {.2}, {.8}});
  const auto bounds = registry().make<cordon::ObserverEntry>("integrated",
                                                             {model, backend("interval")}, params),
             sets = registry().make<cordon::ObserverEntry>("zonotope_uncertain",
                                                           {model, backend("zonotope")}, params);
  for (Index k = 0; k < 20; ++k) {
    const Sample now{k, Vector::Zero(1), Vector::Zero(1)};
    const Box a = bounds->step(now).set->interval_hull(), b = sets->step(now).set->interval_hull();
    CHECK((a.upper - b.upper).minCoeff() > -1e-12);
    CHECK((b.lower - a.lower).minCoeff() > -1e-12);
    if (k > 0) CHECK(a.upper[0] > b.upper[0] + 1e-3);  // .8 + .1 against .8 - .1 at k = 1
  }
}

/// The recursion of the bounds in the form lo, hi, with signs split, for unit boxes W and V.
TEST_CASE("centre and radius are the split recursion of both bounds") {
  CHECK(rc::check("the same", [] {
    Model model = random_model(false);
    model.W = box_around(Vector::Zero(2), Vector::Ones(2));
    model.V = box_around(Vector::Zero(2), Vector::Ones(2));
    const LinearModel& m = model.linear;
    const Matrix upper = random_gain(m), lower = random_gain(m);
    Params params = with_gain(upper, "upper_gain");
    params.set("lower_gain", with_gain(lower).values().at("gain"));
    const auto observer = registry().make<cordon::ObserverEntry>(
        "interval_trajectory", {model, backend("interval")}, params);
    Truth truth(model, random_draw(), true);
    const Vector radius = model.X0.G.cwiseAbs().rowwise().sum();
    Vector lo = model.X0.c - radius, hi = model.X0.c + radius;
    for (Index k = 0; k < 10; ++k) {
      const Vector u = random_matrix(m.inputs(), 1, 3).col(0), y = truth.step(u);
      const Box hull = observer->step({k, u, y}).set->interval_hull();
      const double slack = 1e-11 * (1 + largest(lo) + largest(hi));
      RC_ASSERT(largest(hull.lower - lo) <= slack && largest(hull.upper - hi) <= slack);
      const auto bound = [&](const Matrix& L, const Vector& near, const Vector& far, double sign) {
        const Matrix closed = m.A - L * m.C;
        const Vector size = lo.cwiseAbs().cwiseMax(hi.cwiseAbs());
        Vector open = m.Bw.cwiseAbs().rowwise().sum() + (L * m.Dv).cwiseAbs().rowwise().sum();
        if (m.A_radius.size() != 0) open += m.A_radius * size;
        if (m.B_radius.size() != 0) open += m.B_radius * u.cwiseAbs();
        if (m.C_radius.size() != 0) open += L.cwiseAbs() * (m.C_radius * size);
        return Vector(closed.cwiseMax(0) * near + closed.cwiseMin(0) * far + (m.B - L * m.D) * u +
                      L * y + sign * open);
      };
      const Vector hi_next = bound(upper, hi, lo, 1), lo_next = bound(lower, lo, hi, -1);
      if ((hi_next - lo_next).minCoeff() < 1e-6) return;  // crossing is another test
      hi = hi_next;
      lo = lo_next;
    }
  }));
}

TEST_CASE("ranges of sensors and actuators, one step by hand") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, 0}, {.25, .5}};
  m.B = Matrix{{1}, {2}};
  m.C = Matrix{{1, 1}};
  m.D = Matrix{{.5}};
  m.Bw = Matrix(2, 0);
  m.Dv = Matrix(1, 0);
  m.C_radius = Matrix{{.1, 0}};
  m.B_radius = Matrix{{0}, {.5}};
  m.actuator = range(.5, 1);   // .75 ± .25
  m.sensor = range(.25, .75);  // .5 ± .25
  model.X0 = box_around(Vector{{1, 2}}, Vector{{.5, 1}});
  model.W = model.V = make_point(Vector(0));
  const auto observer = registry().make<cordon::ObserverEntry>(
      "interval_trajectory", {model, backend("interval")}, with_gain(Matrix{{.5}, {-.5}}));
  observer->step({0, Vector::Constant(1, 2), Vector::Constant(1, 3)});
  const Box next = observer->step({1, Vector::Zero(1), Vector::Zero(1)}).set->interval_hull();
  // C̄ = [.5 .5], D̄ = .25: Ao = [.25 -.25; .5 .75], B - L D̄ = (.875, 2.125)
  const Vector c{{.25 - .5 + .875 * 1.5 + 1.5, .5 + 1.5 + 2.125 * 1.5 - 1.5}};
  // δ = .25 (|3 + .75| + 1.5 + .5 · .5) + .75 · .1 · 1.5
  const double delta = .25 * (3.75 + 1.5 + .25) + .1125;
  const Vector r{
      {.125 + .25 + .875 * .5 + .5 * delta, .25 + .75 + 2.125 * .5 + .5 * 2 + .5 * delta}};
  CHECK(largest(next.center() - c) < 1e-13);
  CHECK(largest(next.radius() - r) < 1e-13);
}

/// Without noise and uncertainty the box has the width of its rounding errors: the exact
/// trajectory, computed with longer numbers, is inside without any slack.
TEST_CASE("rounding errors are inside the bounds") {
  CHECK(rc::check("the exact trajectory is inside", [] {
    Model model = random_model(false);
    LinearModel& m = model.linear;
    m.A_radius = m.B_radius = m.C_radius = {};
    const Index n = m.states();
    const double unstable = *rc::gen::arbitrary<bool>() ? .99 / .6 : 1;
    m.A *= unstable;  // |A| of rows up to .99
    model.W = model.V = make_point(Vector::Zero(2));
    model.X0 = make_point(model.X0.c);
    const auto observer =
        registry().make<cordon::ObserverEntry>("interval_trajectory", {model, backend("interval")},
                                               with_gain(Matrix::Zero(n, m.outputs())));
    Long x = model.X0.c.cast<long double>();
    for (Index k = 0; k < 60; ++k) {
      const Vector u = random_matrix(m.inputs(), 1, 1e-3).col(0);
      const Box hull =
          observer->step({k, u, random_matrix(m.outputs(), 1, 1).col(0)}).set->interval_hull();
      for (Index i = 0; i < n; ++i) RC_ASSERT(hull.lower[i] <= x[i] && x[i] <= hull.upper[i]);
      RC_ASSERT(hull.longest_half_edge() <= 1e-11 * (1 + largest(hull.lower)));
      x = (m.A.cast<long double>() * x + m.B.cast<long double>() * u.cast<long double>()).eval();
    }
  }));
}

TEST_CASE("rounding errors of the radii are inside the bounds") {
  CHECK(rc::check("products of radii and inputs", [] {
    Model model = random_model(false);
    LinearModel& m = model.linear;
    const Index n = m.states();
    m.A.setZero();
    m.B.setZero();
    m.A_radius = m.C_radius = {};
    m.B_radius = random_matrix(n, m.inputs(), .1).cwiseAbs();
    model.W = model.V = make_point(Vector::Zero(2));
    const Vector u = random_matrix(m.inputs(), 1, 1).col(0);
    cordon::estimators::IntervalRecursion recursion(model, Matrix::Zero(n, m.outputs()));
    Vector c(n), r(n);
    recursion.next(Vector::Zero(n), Vector::Zero(n), {0, u, Vector::Zero(m.outputs())}, c, r);
    const Long most = m.B_radius.cast<long double>() * u.cwiseAbs().cast<long double>();
    for (Index i = 0; i < n; ++i)
      RC_ASSERT(r[i] >= most[i] && r[i] <= (1 + 1e-13L) * most[i] + 1e-300L);
  }));
  CHECK(rc::check("a box by centre and radius", [] {
    const double a = number(-3, 3), b = a + number(0, 1e-3);
    const auto [c, r] = cordon::estimators::around(
        {Vector::Constant(1, std::min(a, b)), Vector::Constant(1, std::max(a, b))});
    const long double center = c[0], radius = r[0];
    RC_ASSERT(center - radius <= a && b <= center + radius);
  }));
}

TEST_CASE("a set that replaces the estimate is where the observer goes on from") {
  const Model model = comparison::plant("68");
  const Params params = with_gain(Matrix{{.3}, {.2}, {.8}});
  for (const char* name : {"interval_trajectory", "integrated", "zonotope_uncertain"}) {
    CAPTURE(name);
    const auto sets = backend("zonotope");
    const auto replaced = registry().make<cordon::ObserverEntry>(name, {model, sets}, params),
               begun = registry().make<cordon::ObserverEntry>(name, {model, sets}, params);
    const Enclosure X = sets->box({Vector{{2, 3, 4}}, Vector{{3, 5, 4.5}}});
    const auto sample = [](Index k) {
      return Sample{k, Vector::Constant(1, .5), Vector::Constant(1, 4.2)};
    };
    replaced->step(sample(0));
    replaced->replace(X);
    begun->start(X);
    CHECK(begun->step(sample(0)).set->interval_hull().upper[1] == doctest::Approx(5));
    const Box a = replaced->step(sample(1)).set->interval_hull(),
              b = begun->step(sample(1)).set->interval_hull();
    CHECK(a.lower == b.lower);
    CHECK(a.upper == b.upper);
    begun->start();
    CHECK(begun->step(sample(0)).set->interval_hull().upper[1] == doctest::Approx(.1));
  }
}
