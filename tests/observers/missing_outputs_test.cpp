// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that lack outputs. A sample says what the complete sample of its other outputs says in
// the model of these outputs: an observer of samples that always lack the same output gives the
// sets of an observer of the smaller model.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"

using namespace cordon;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

LineForm box(const Vector& half) { return make_box({-half, half}); }

/// Three states, three outputs: any two of them determine the state together with E.
Model plant(bool descriptor) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.8, .2, 0}, {-.1, .7, .1}, {.3, .1, descriptor ? 1. : .5}};
  if (descriptor) m.E = Matrix{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  m.B = Matrix{{1}, {0}, {.5}};
  m.Bw = Matrix::Identity(3, 3);
  m.C = Matrix{{1, 0, 1}, {0, 1, -1}, {1, 1, .5}};
  m.D = Matrix{{0}, {1}, {0}};
  m.Dv = Matrix{{1, 0, .5}, {0, 1, 0}, {.25, 0, 1}};
  model.X0 = box(Vector{{1, 1, 1}});
  model.W = box(Vector{{.1, .05, .02}});
  model.V = box(Vector{{.1, .2, .1}});
  model.U = make_space(1);
  return model;
}

/// Of the plant without disturbances and noise.
std::vector<Sample> samples(const Model& model) {
  const LinearModel& m = model.linear;
  std::vector<Sample> all;
  Vector x = Vector::Zero(3);
  for (Index k = 0; k < 12; ++k) {
    const Vector u{{std::sin(static_cast<double>(k))}};
    const Vector next = m.A * x + m.B * u;
    if (m.is_descriptor()) x[2] -= next[2];  // its static row
    all.push_back({k, u, m.C * x + m.D * u});
    x = m.A * x + m.B * u;
    if (m.is_descriptor()) x[2] = 0;
  }
  return all;
}

Sample without(Sample sample, const std::vector<Index>& missing) {
  for (const Index i : missing) sample.y[i] = nan;
  sample.missing = missing;
  return sample;
}

struct Choice {
  std::string backend, observer;
  Params params;
  bool descriptor = false;
};

std::shared_ptr<const ComponentSpec> spec(const std::string& type, Params params = {}) {
  return std::make_shared<ComponentSpec>(ComponentSpec{type, std::move(params)});
}

/// Every observer on every backend; `gain` for those that take one.
std::vector<Choice> choices(const Matrix& gain) {
  std::vector<Choice> all;
  const auto given = spec("given", Params().set("matrix", gain)), kalman = spec("kalman");
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    const bool bounded_exact = std::string(backend) == "constrained_zonotope";
    all.push_back({backend, "prediction_correction", {}});
    all.push_back({backend, "fixed_lag", Params().set("lag", std::int64_t{1})});
    all.push_back({backend, "luenberger", Params().set("gain", given)});
    all.push_back({backend, "luenberger", Params().set("gain", kalman)});
    all.push_back({backend, "gain_correction", Params().set("gain", given)});
    all.push_back({backend, "gain_correction", {}});
    all.push_back({backend, "zonotope_uncertain", Params().set("gain", given)});
    all.push_back({backend, "interval_trajectory", Params().set("gain", given)});
    Params descriptor;
    if (bounded_exact) descriptor.set("admissible_set", box(Vector{{50, 50, 50}}));
    all.push_back({backend, "descriptor", descriptor, true});
    all.push_back({backend, "descriptor", {}, false});
  }
  return all;
}

std::shared_ptr<Observer> made(const Choice& choice, const Model& model) {
  const auto backend = banks::registry().make<BackendEntry>(choice.backend, {});
  return banks::registry().make<ObserverEntry>(choice.observer, {model, backend}, choice.params);
}

bool same(const Box& X, const Box& Y) {
  return (X.lower - Y.lower).cwiseAbs().maxCoeff() <= 1e-12 &&
         (X.upper - Y.upper).cwiseAbs().maxCoeff() <= 1e-12;
}

}  // namespace

TEST_CASE("an output that is always missing might as well not be there") {
  const Matrix gain{{.4, .1, .2}, {0, .3, .1}, {.1, -.1, .1}};
  const std::vector<Index> missing{1}, present{0, 2};
  const std::vector<Choice> full = choices(gain), smaller = choices(gain(Eigen::all, present));
  for (std::size_t i = 0; i < full.size(); ++i) {
    CAPTURE(full[i].backend);
    CAPTURE(full[i].observer);
    CAPTURE(i);
    const Model model = plant(full[i].descriptor), others = with_outputs(model, present);
    const auto observer = made(full[i], model), reference = made(smaller[i], others);
    CHECK(observer->takes_missing_outputs());
    for (const Sample& sample : samples(model)) {
      const Estimate X = observer->step(without(sample, missing)),
                     Y = reference->step({sample.k, sample.u, sample.y(present)});
      CHECK(same(X.set->interval_hull(), Y.set->interval_hull()));
      CHECK(X.set.tightness == Y.set.tightness);
    }
  }
}

TEST_CASE("gaps come and go, and later samples count again") {
  const Matrix gain{{.4, .1, .2}, {0, .3, .1}, {.1, -.1, .1}};
  for (const Choice& choice : choices(gain)) {
    CAPTURE(choice.backend);
    CAPTURE(choice.observer);
    const Model model = plant(choice.descriptor);
    Choice with_room = choice;
    if (choice.observer == "descriptor")
      with_room.params.set("admissible_set", box(Vector{{50, 50, 50}}));
    const auto gaps = made(with_room, model), complete = made(with_room, model);
    std::vector<double> wider;
    for (const Sample& sample : samples(model)) {
      const std::vector<Index> missing = sample.k == 3   ? std::vector<Index>{0, 1, 2}
                                         : sample.k == 4 ? std::vector<Index>{0, 2}
                                                         : std::vector<Index>{};
      const Box X = gaps->step(without(sample, missing)).set->interval_hull(),
                Y = complete->step(sample).set->interval_hull();
      wider.push_back(((X.upper - X.lower) - (Y.upper - Y.lower)).maxCoeff());
    }
    CHECK(wider[2] == 0);
    const double widest = *std::max_element(wider.begin(), wider.end());
    CHECK(widest > 1e-3);
    CHECK(std::abs(wider.back()) < .2 * widest);
  }
}

TEST_CASE("where outputs are missing that determine the state, a bound of it takes their place") {
  const Model model = plant(true);
  for (const char* backend : {"interval", "zonotope"}) {
    CAPTURE(backend);
    const Choice bare{backend, "descriptor", {}},
        bounded{backend, "descriptor", Params().set("admissible_set", box(Vector{{50, 50, 50}}))};
    const auto refuses = made(bare, model), takes = made(bounded, model);
    const std::vector<Sample> all = samples(model);
    const Sample nothing = without(all[1], {0, 1, 2});
    refuses->step(all[0]);
    takes->step(all[0]);
    CHECK_THROWS_AS_MESSAGE(refuses->step(nothing), Error, "admissible_set");
    const Box hull = takes->step(nothing).set->interval_hull();
    CHECK(hull.upper[0] < 5);  // of E x
    CHECK(hull.upper[2] >= 50);
    CHECK(hull.upper[2] < 50 + 1e-9);
  }
}

namespace {

/// An observer from outside, which knows of no gaps.
class Unaware final : public Observer {
 public:
  explicit Unaware(const ObserverContext& context) : Observer(context.model, context.backend) {}

 private:
  Enclosure do_start(const std::optional<Enclosure>&, const Sample&) override {
    return backend().space(3);
  }
  Enclosure do_step(const Sample&, const Sample&) override { return backend().space(3); }
  void do_replace(const Enclosure&) override {}
};

}  // namespace

TEST_CASE(
    "samples with gaps are refused by observers that do not take them, and so are wrong ones") {
  const Model model = plant(false);
  Unaware observer({model, banks::registry().make<BackendEntry>("line_zonotope", {})});
  const std::vector<Sample> all = samples(model);
  observer.step(all[0]);
  const auto code = [&](const Sample& sample) {
    try {
      observer.step(sample);
    } catch (const Error& error) {
      return error.code();
    }
    return Errc::io;
  };
  CHECK(code(without(all[1], {1})) == Errc::unsupported);
  const auto aware = made({"line_zonotope", "prediction_correction", {}}, model);
  const auto aware_code = [&](const Sample& sample) {
    try {
      aware->start();
      aware->step(sample);
    } catch (const Error& error) {
      return error.code();
    }
    return Errc::io;
  };
  Sample unmarked = all[0], unordered = without(all[0], {0, 1}), beyond = all[0], valued = all[0];
  unmarked.y[1] = nan;
  std::swap(unordered.missing[0], unordered.missing[1]);
  beyond.missing = {3};
  valued.missing = {1};
  CHECK(aware_code(unmarked) == Errc::not_finite);
  for (const Sample& wrong : {unordered, beyond, valued}) CHECK(aware_code(wrong) == Errc::invalid);
  CHECK(aware_code(without(all[0], {0, 1, 2})) == Errc::io);  // that is, none
}
