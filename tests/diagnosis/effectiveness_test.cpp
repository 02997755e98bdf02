// SPDX-License-Identifier: GPL-3.0-or-later
// Observers with actuators and sensors whose effectiveness is known by ranges: the truth is never
// proven outside, whatever the effectiveness is in each step.
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/sampling.hpp"
#include "published/study_models.hpp"

using namespace cordon;

namespace {

const char* const backends[] = {"interval", "zonotope", "constrained_zonotope", "line_zonotope"};

/// A random model with its truth. Descriptor systems have static rows below, solved for the last
/// states.
class RandomPlant {
 public:
  RandomPlant(std::uint64_t seed, bool descriptor) : random_(seed) {
    LinearModel& m = model.linear;
    const Index n = 1 + upto(2), p = 1 + upto(2), q = 1 + upto(2);
    statics_ = descriptor ? upto(std::min<Index>(1, n - 1)) : 0;
    m.A = matrix(n, n);
    m.A *= .9 / std::max(.9, m.A.cwiseAbs().rowwise().sum().maxCoeff());
    m.B = matrix(n, p);
    m.Bw = .1 * matrix(n, 1 + upto(2));
    m.C = matrix(q, n);
    m.D = random_.unit() < .5 ? Matrix(Matrix::Zero(q, p)) : matrix(q, p);
    m.Dv = .1 * matrix(q, 1 + upto(1));
    if (descriptor) {
      m.E = Matrix::Identity(n, n);
      if (statics_ > 0) {
        m.E.row(n - 1).setZero();
        m.A(n - 1, n - 1) = 2;
        m.C(0, n - 1) = 1;
      }
    }
    m.actuator = ranges(p);
    m.sensor = ranges(q);
    model.X0 = make_zonotope(random_.cube(n), matrix(n, n));
    model.W = make_box(cube(m.disturbances(), 1));
    model.V = make_box(cube(m.noises(), 1));
    x_ = model.X0.c + model.X0.G * factors(n);
    w_ = factors(m.disturbances());
  }

  /// The sample and the state of the next time. The effectiveness of a time is the same in all
  /// equations of that time.
  Sample step(Vector& state) {
    const LinearModel& m = model.linear;
    const Vector u = 3 * random_.cube(m.inputs());
    const Vector fu = effectiveness(m.actuator).cwiseProduct(u);
    if (statics_ > 0) {
      const Index s = m.states() - 1;
      x_[s] = 0;
      x_[s] = -(m.A.row(s).dot(x_) + m.B.row(s).dot(fu) + m.Bw.row(s).dot(w_)) / m.A(s, s);
      // at k = 0 the initial set has to hold it
      if (k_ == 0)
        model.X0 = minkowski_sum(model.X0, make_zonotope(Vector::Zero(m.states()), widening(s)));
    }
    state = x_;
    const Vector y =
        effectiveness(m.sensor).cwiseProduct(m.C * x_ + m.D * fu) + m.Dv * factors(m.noises());
    x_ = m.A * x_ + m.B * fu + m.Bw * w_;
    w_ = factors(m.disturbances());
    return {k_++, u, y};
  }

  Model model;

 private:
  Index upto(Index largest) {
    return static_cast<Index>(random_.unit() * static_cast<double>(largest + 1));
  }
  Matrix matrix(Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) a = random_.unit() < .2 ? 0 : random_.between(-1, 1);
    return A;
  }
  Vector factors(Index n) {
    const bool vertex = random_.unit() < .5;
    const Vector xi = random_.cube(n);
    return vertex ? Vector((xi.array() < 0).select(Vector::Constant(n, -1), Vector::Ones(n))) : xi;
  }
  Matrix widening(Index s) const {
    Matrix G = Matrix::Zero(model.linear.states(), 1);
    G(s, 0) = std::abs(x_[s] - model.X0.c[s]) + model.X0.G.row(s).cwiseAbs().sum();
    return G;
  }
  /// Some known exactly, some in a part of [0,1], some in all of it.
  Box ranges(Index size) {
    if (random_.unit() < .2) return {};
    Box box{Vector(size), Vector(size)};
    for (Index i = 0; i < size; ++i) {
      const double a = random_.unit(), b = random_.unit(), kind = random_.unit();
      box.lower[i] = kind < .2 ? 0 : std::min(a, b);
      box.upper[i] = kind > .8 ? box.lower[i] : std::max(a, b);
    }
    return box;
  }
  Vector effectiveness(const Box& box) {
    if (box.dim() == 0)
      return Vector::Ones(&box == &model.linear.actuator ? model.linear.inputs()
                                                         : model.linear.outputs());
    return box.center() + box.radius().cwiseProduct(factors(box.dim()));
  }

  sets::Random random_;
  Index statics_ = 0, k_ = 0;
  Vector x_, w_;
};

}  // namespace

TEST_CASE("the truth is never proven outside") {
  const Plugins plugins;
  for (const std::string name : backends) {
    const auto backend = plugins.backend(name);
    for (const std::string type : {"prediction_correction", "descriptor"}) {
      int tried = 0;
      const std::string what = type + " on " + name;
      CHECK(rc::check(what, [&] {
        const bool is_descriptor = type == "descriptor";
        RandomPlant plant(*rc::gen::arbitrary<std::uint64_t>(), is_descriptor);
        std::vector<Sample> samples;
        std::vector<Vector> states;
        for (int k = 0; k < 6; ++k) {
          Vector x;
          samples.push_back(plant.step(x));
          states.push_back(x);
        }
        Params params;
        params.set("max_generators", std::int64_t{12}).set("max_constraints", std::int64_t{4});
        if (is_descriptor && backend->info().intersections) {
          params.set("admissible_set", make_box(cube(plant.model.linear.states(), 1000)));
        }
        if (!plugins.registry.check<ObserverEntry>(type, {plant.model, backend}, params).empty())
          return;
        ++tried;
        const auto observer = plugins.observer(type, plant.model, backend, params);
        observer->start();
        for (std::size_t k = 0; k < samples.size(); ++k) {
          const Estimate estimate = observer->step(samples[k]);
          RC_ASSERT(estimate.consistent != Answer::no);
          RC_ASSERT(estimate.set->contains(states[k]) != Answer::no);
        }
      }));
      CAPTURE(what);
      CHECK(3 * tried >= 100);
    }
  }
}

namespace {

/// x⁺ = B diag(f) u without memory, y = diag(g) C x.
Model static_gain(Index p, Index q) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix::Zero(p, p);
  m.B = Matrix::Identity(p, p);
  m.Bw = Matrix(p, 0);
  m.C = Matrix::Identity(q, p);
  m.D = Matrix::Zero(q, p);
  m.Dv = Matrix(q, 0);
  model.X0 = make_point(Vector::Zero(p));
  model.W = make_point(Vector(0));
  model.V = make_point(Vector(0));
  return model;
}

}  // namespace

TEST_CASE("every actuator has a factor of its own, and the set is exact") {
  const Plugins plugins;
  Model model = static_gain(2, 0);
  model.linear.actuator = {Vector{{.25, 0}}, Vector{{.75, 1}}};
  for (const std::string name : backends) {
    CAPTURE(name);
    for (const char* type : {"prediction_correction", "descriptor"}) {
      const auto observer = plugins.observer(type, model, plugins.backend(name));
      observer->start();
      observer->step({0, Vector{{4, -2}}, Vector(0)});
      const Estimate estimate = observer->step({1, Vector{{0, 0}}, Vector(0)});
      const Box hull = estimate.set->interval_hull();
      CHECK(hull.contains(Vector{{1, -2}}));
      CHECK(hull.contains(Vector{{3, 0}}));
      CHECK((hull.upper - hull.lower - Vector{{2, 2}}).maxCoeff() <= 1e-12);
      CHECK(estimate.set->contains(Vector{{3, -2}}) != Answer::no);
      CHECK(estimate.set->contains(Vector{{1, -2}}) != Answer::no);
      if (name == "line_zonotope") CHECK(estimate.set.tightness == Tightness::exact);
    }
  }
}

TEST_CASE("an input that enters state and output by a range makes the recursion an outer one") {
  const Plugins plugins;
  Model model = static_gain(1, 1);
  model.linear.actuator = {Vector{{.25}}, Vector{{.75}}};
  model.linear.D = Matrix{{1.0}};
  for (const char* type : {"prediction_correction", "descriptor"}) {
    const auto observer = plugins.observer(type, model, plugins.backend("line_zonotope"));
    observer->start();
    CHECK(observer->step({0, Vector{{4}}, Vector{{2}}}).set.tightness == Tightness::outer);
  }
}

TEST_CASE("a sensor with a range: its measurement bounds what the prediction does not") {
  const Plugins plugins;
  for (const char* type : {"prediction_correction", "descriptor"}) {
    Model model = static_gain(1, 1);
    model.X0 = make_space(1);
    model.linear.sensor = {Vector{{.5}}, Vector{{1}}};
    const auto observer = plugins.observer(type, model, plugins.backend("line_zonotope"));
    observer->start();
    // y = g x = 1 and g ∈ [.5, 1]: x ∈ [1, 2]
    const Estimate estimate = observer->step({0, Vector{{0}}, Vector{{1}}});
    CHECK(estimate.set.tightness == Tightness::outer);
    const Box hull = estimate.set->interval_hull();
    CHECK(hull.upper[0] == doctest::Approx(2));
    CHECK(hull.upper[0] >= 2);
    CHECK(hull.lower[0] <= 1);
    CHECK(hull.lower[0] > .5);
  }
}

TEST_CASE("a sensor that can fail altogether says nothing about an unbounded prediction") {
  const Plugins plugins;
  for (const char* type : {"prediction_correction", "descriptor"}) {
    CAPTURE(type);
    Model model = static_gain(2, 2);
    model.X0 = make_space(2);
    model.linear.sensor = {Vector{{0, 1}}, Vector{{1, 1}}};
    const auto observer = plugins.observer(type, model, plugins.backend("line_zonotope"));
    observer->start();
    const Estimate estimate = observer->step({0, Vector{{0, 0}}, Vector{{0, 1}}});
    const Box hull = estimate.set->interval_hull();
    CHECK(std::isinf(hull.upper[0]));
    CHECK(hull.upper[1] == doctest::Approx(1));
    CHECK(estimate.set->contains(Vector{{1e9, 1}}) == Answer::yes);
    // of a bounded prediction it says that it is not too far away: y = g x with |x| ≤ 4 gives |y| ≤
    // 4
    model.X0 = make_box(cube(2, 4));
    const auto bounded = plugins.observer(type, model, plugins.backend("line_zonotope"));
    bounded->start();
    CHECK(bounded->step({0, Vector{{0, 0}}, Vector{{3.9, 1}}}).consistent == Answer::yes);
    bounded->start();
    CHECK(bounded->step({0, Vector{{0, 0}}, Vector{{8.1, 1}}}).consistent == Answer::no);
  }
}

TEST_CASE("without the outputs that can fail altogether there may be no T, N with T E + N C = I") {
  const Plugins plugins;
  Model model = static_gain(1, 1);
  model.linear.E = Matrix{{0.0}};
  model.linear.A = Matrix{{1.0}};
  model.linear.sensor = {Vector{{0}}, Vector{{1}}};
  const auto backend = plugins.backend("zonotope");
  const auto problems = plugins.registry.check<ObserverEntry>("descriptor", {model, backend}, {});
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("sensors can fail altogether") != std::string::npos);
  model.linear.sensor.lower[0] = .1;
  CHECK(plugins.registry.check<ObserverEntry>("descriptor", {model, backend}, {}).empty());
}
