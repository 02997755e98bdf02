// SPDX-License-Identifier: GPL-3.0-or-later
// The Luenberger observer on sets: it encloses the truth on every backend, also where effectiveness
// is known by ranges only.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

double number(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 1'000'001)) * 1e-6;
}

Matrix random_matrix(Index rows, Index cols, double size) {
  Matrix A(rows, cols);
  for (Index i = 0; i < A.size(); ++i) A(i) = number(-size, size);
  return A;
}

Box random_ranges(Index size) {
  Box box{Vector(size), Vector(size)};
  for (Index i = 0; i < size; ++i) {
    box.lower[i] = number(0, 1);
    box.upper[i] = *rc::gen::inRange(0, 3) == 0 ? box.lower[i] : number(box.lower[i], 1);
  }
  return box;
}

/// A stable model with up to three inputs and outputs; ranges of effectiveness as asked for.
Model random_model(bool actuators, bool sensors) {
  const Index n = *rc::gen::inRange(1, 4), inputs = *rc::gen::inRange(1, 4),
              outputs = *rc::gen::inRange(1, 3);
  Model model;
  LinearModel& m = model.linear;
  m.A = random_matrix(n, n, 1);
  m.A *= .8 / std::max(.8, m.A.cwiseAbs().rowwise().sum().maxCoeff());
  m.B = random_matrix(n, inputs, 1);
  m.C = random_matrix(outputs, n, 1);
  m.D = random_matrix(outputs, inputs, .3);
  m.Bw = random_matrix(n, 2, .2);
  m.Dv = random_matrix(outputs, 2, .2);
  if (actuators) m.actuator = random_ranges(inputs);
  if (sensors) m.sensor = random_ranges(outputs);
  model.linear = with_exact_effectiveness_applied(m);
  model.X0 = make_zonotope(random_matrix(n, 1, 1).col(0), random_matrix(n, n + 1, 1));
  model.W = box_around(random_matrix(2, 1, .3).col(0), Vector::Constant(2, .2));
  model.V = box_around(random_matrix(2, 1, .3).col(0), Vector::Constant(2, .1));
  model.U = make_space(inputs);
  return model;
}

void expect_truth_inside(const std::string& name, const Model& model) {
  const auto observer = registry().make<ObserverEntry>("luenberger", {model, backend(name)}, {});
  Draw draw{std::mt19937_64(static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000))),
            *rc::gen::arbitrary<bool>()};
  Vector x = draw.from(model.X0);
  for (Index k = 0; k < 12; ++k) {
    const Vector u = random_matrix(model.linear.inputs(), 1, 3).col(0), now = x;
    const Vector y = simulate(model, x, u, draw);
    const Estimate estimate = observer->step({k, u, y});
    const Vector slack = Vector::Constant(now.size(), 1e-9 * (1 + now.cwiseAbs().maxCoeff()));
    const Enclosure around = estimate.set->backend().box({now - slack, now + slack});
    RC_ASSERT(estimate.set->is_disjoint_from(*around) != Answer::yes);
  }
}

}  // namespace

TEST_CASE("the truth is never outside, effectiveness by ranges or not, on every backend") {
  for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    for (const bool actuators : {false, true}) {
      for (const bool sensors : {false, true}) {
        CHECK(rc::check("the truth stays inside",
                        [&] { expect_truth_inside(name, random_model(actuators, sensors)); }));
      }
    }
  }
}

TEST_CASE("the recursion of the published reactor, one step by hand") {
  const Model model = reactor()[1].model;
  const auto zonotopes = backend("zonotope");
  Params p;
  p.set("gain", Matrix{{.1582}, {11.6106}});
  const auto observer = registry().make<ObserverEntry>("luenberger", {model, zonotopes}, p);
  observer->step({0, Vector::Constant(1, 10), Vector::Constant(1, .02)});
  const Estimate next = observer->step({1, Vector::Constant(1, 0), Vector::Constant(1, 0)});
  // A - L C = [.7394 -.0002; -12.1 .7606], B mid(F) u = (0, .0048), L y = (.003164, .232212), ωc =
  // .015, B rad(F) u = .0024
  const LineForm X = next.set->line_form();
  CHECK(X.c[0] == doctest::Approx(.003164 + .015).epsilon(1e-12));
  CHECK(X.c[1] == doctest::Approx(.0048 + .232212 + .015).epsilon(1e-12));
  const Box hull = next.set->interval_hull();
  // |A_o G| 1: rows of G are (.05 0 0 .05) and (.05 0 .05 0)
  CHECK(hull.radius()[0] == doctest::Approx(.05 * (.7392 + .0002 + .7394) + .002).epsilon(1e-12));
  CHECK(hull.radius()[1] ==
        doctest::Approx(.05 * (11.3394 + .7606 + 12.1) + .0024 + .002).epsilon(1e-12));
}

TEST_CASE("a gain that does not stabilise is refused, with the eigenvalue") {
  Model model = reactor()[0].model;
  Params p;
  p.set("gain", Matrix{{2.5}, {0}});
  auto problems = registry().check<ObserverEntry>("luenberger", {model, backend("zonotope")}, p);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/gain");
  CHECK(problems[0].message.find("eigenvalue") != std::string::npos);
  p.set("gain", Matrix{{.1582, 11.6106}});
  problems = registry().check<ObserverEntry>("luenberger", {model, backend("zonotope")}, p);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("is 1 × 2, must be 2 × 1") != std::string::npos);
}

TEST_CASE("a designed gain stabilises an unstable plant, and is refused where none can") {
  Model model = reactor()[0].model;
  model.linear.A(0, 0) = 1.3;
  const auto observer =
      registry().make<ObserverEntry>("luenberger", {model, backend("zonotope")}, {});
  double radius = 0;
  for (Index k = 0; k < 200; ++k)
    radius = observer->step({k, Vector::Zero(1), Vector::Zero(1)})
                 .set->interval_hull()
                 .longest_half_edge();
  CHECK(radius < 1);
  model.linear.A = Matrix{{.5, 0}, {0, 1.2}};  // the unstable state is not seen
  const auto problems =
      registry().check<ObserverEntry>("luenberger", {model, backend("zonotope")}, {});
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("detectable") != std::string::npos);
}

TEST_CASE("a stable plant always has a designed gain, however ill-conditioned its noises make it") {
  Model model = reactor()[0].model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.22, -.04}, {-.07, .06}};
  m.C = Matrix{{-1, .4}, {-1, -.02}};
  m.D = Matrix::Zero(2, 1);
  m.Dv = Matrix{{1}, {1}};
  model.W = make_point(Vector::Zero(2));
  Draw draw{std::mt19937_64(1)};
  for (int k = 0; k < 300; ++k) {
    m.C += Matrix{{.1 * draw(), .1 * draw()}, {.1 * draw(), .1 * draw()}};
    m.Dv = Matrix{{draw()}, {draw()}};
    model.V = box_around(Vector::Zero(1), Vector::Constant(1, std::pow(10, draw())));
    CHECK(registry().check<ObserverEntry>("luenberger", {model, backend("zonotope")}, {}).empty());
  }
}

TEST_CASE("the designed gain is the steady zonotopic Kalman gain") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.9}};
  m.B = Matrix(1, 0);
  m.Bw = m.C = m.Dv = Matrix{{1}};
  m.D = Matrix(1, 0);
  model.X0 = make_point(Vector{{0}});
  model.W = box_around(Vector::Zero(1), Vector::Constant(1, .5));
  model.V = box_around(Vector::Zero(1), Vector::Constant(1, .2));
  model.U = make_space(0);
  // P = .81 P R / (P + R) + Q with Q = .25, R = .04 (1e-6 of .25 larger): L = .9 P / (P + R)
  const double Q = .25 + .25e-6, R = .04 + .25e-6, half = (Q - R + .81 * R) / 2;
  const double P = half + std::sqrt(half * half + Q * R), L = .9 * P / (P + R);
  const auto observer =
      registry().make<ObserverEntry>("luenberger", {model, backend("zonotope")}, {});
  observer->step({0, Vector(0), Vector::Constant(1, 1)});
  const LineForm X = observer->step({1, Vector(0), Vector::Constant(1, 0)}).set->line_form();
  CHECK(X.c[0] == doctest::Approx(L).epsilon(1e-9));
}

TEST_CASE("descriptor systems and ranges are refused by those who do not take them") {
  Model model = reactor()[0].model;
  model.linear.E = Matrix::Identity(2, 2);
  const auto problems =
      registry().check<ObserverEntry>("luenberger", {model, backend("zonotope")}, {});
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].suggestion.find("descriptor") != std::string::npos);
}

TEST_CASE("a range of a sensor needs a bounded start, an exact sensor does not") {
  Model model = reactor()[0].model;
  model.X0 = make_space(2);
  for (const char* type : {"luenberger", "zonotope_uncertain"}) {
    CAPTURE(type);
    const auto problems = [&] {
      return registry().check<ObserverEntry>(type, {model, backend("line_zonotope")}, {});
    };
    model.linear.sensor = Box{Vector{{.5}}, Vector{{1}}};
    REQUIRE(problems().size() == 1);
    CHECK(problems()[0].message.find("unbounded") != std::string::npos);
    model.linear.sensor = Box{Vector{{1}}, Vector{{1}}};
    CHECK(problems().empty());
    const auto observer =
        registry().make<ObserverEntry>(type, {model, backend("line_zonotope")}, {});
    for (Index k = 0; k < 3; ++k)
      CHECK(observer->step({k, Vector::Zero(1), Vector::Zero(1)}).consistent != Answer::no);
  }
}
