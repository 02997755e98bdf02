// SPDX-License-Identifier: GPL-3.0-or-later
// Every observer for linear models goes on from a saved state with the same bits: with gaps,
// outliers, estimates that are proven empty, and gains that vary in time.
#include <cmath>
#include <limits>
#include <set>

#include "cordon/sets/sampling.hpp"
#include "input_design/plugins.hpp"
#include "saved_state/going_on.hpp"

using namespace cordon;
using namespace saved_state;

namespace {

constexpr Index steps = 60;
constexpr Index contradicted_at = 44, replaced_at = 47;
const std::vector<std::size_t> save_times{0, 1, 2, 9, 23, 31, 45, 47, 49, 60};

LineForm box(Index n, double half) {
  return make_box({Vector::Constant(n, -half), Vector::Constant(n, half)});
}

enum class Kind { plain, uncertain, ranges, thin, descriptor };

/// Three states, three outputs: any two of them determine the state together with E.
Model plant(Kind kind) {
  Model model;
  LinearModel& m = model.linear;
  const bool descriptor = kind == Kind::descriptor;
  m.A = Matrix{{.8, .2, 0}, {.1, .7, .1}, {.3, .1, descriptor ? 1. : .5}};
  if (descriptor) m.E = Matrix{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  m.B = Matrix{{1}, {0}, {.5}};
  m.Bw = Matrix::Identity(3, 3);
  m.C = Matrix{{1, 0, 1}, {0, 1, -1}, {1, 1, .5}};
  m.D = Matrix{{0}, {1}, {0}};
  m.Dv = Matrix{{1, 0, .5}, {0, 1, 0}, {.25, 0, 1}};
  const double size = kind == Kind::thin ? 1e-7 : .1;
  model.X0 = box(3, kind == Kind::thin ? 1e-6 : 1);
  if (kind == Kind::thin) model.X0.c.setConstant(1e4);
  model.W = box(3, size / 2);
  model.V = box(3, size);
  model.U = make_space(1);
  if (kind == Kind::uncertain) {
    m.A_radius = Matrix::Constant(3, 3, .01);
    m.C_radius = Matrix::Constant(3, 3, .01);
  }
  if (kind == Kind::ranges) {
    m.actuator = {Vector{{.9}}, Vector{{1.1}}};
    m.sensor = {Vector{{1, .9, 1}}, Vector{{1, 1, 1}}};
  }
  return model;
}

/// A trajectory, of which outputs are lost now and then, one is far off, and all are at one time.
std::vector<Sample> samples_of(const Model& model, std::uint64_t seed, bool has_gaps) {
  const LinearModel& m = model.linear;
  sets::Random random(seed);
  const auto from = [&](const LineForm& X) { return Vector(X.c + X.G * random.cube(3)); };
  std::vector<Sample> all;
  Vector x = from(model.X0);
  for (Index k = 0; k < steps; ++k) {
    const Vector u{{std::sin(static_cast<double>(k))}}, w = from(model.W);
    if (m.is_descriptor()) x[2] = -(m.A.row(2).head(2) * x.head(2) + m.B.row(2) * u + w.row(2))[0];
    Sample sample{k, u, m.C * x + m.D * u + m.Dv * from(model.V)};
    if (k == 20) sample.y[1] += 50;
    if (k == contradicted_at) sample.y[0] += 200;
    for (Index i = 0; has_gaps && i < 3; ++i) {
      if (k == contradicted_at || random.unit() > (k % 7 < 2 ? .5 : .05)) continue;
      sample.y[i] = std::numeric_limits<double>::quiet_NaN();
      sample.missing.push_back(i);
    }
    all.push_back(sample);
    x = m.A * x + m.B * u + m.Bw * w;
    if (m.is_descriptor()) x[2] = 0;
  }
  return all;
}

struct Choice {
  std::string observer;
  Params params;
};

std::shared_ptr<const ComponentSpec> spec(const std::string& type, Params params = {}) {
  return std::make_shared<ComponentSpec>(ComponentSpec{type, std::move(params)});
}

std::vector<Choice> choices() {
  const Matrix gain{{.4, .1, .2}, {0, .3, .1}, {.1, -.1, .1}};
  const std::string previous = "previous";
  const auto given = spec("given", Params().set("matrix", gain)), kalman = spec("kalman");
  const auto few = [] { return Params().set("max_generators", std::int64_t{12}); };
  const auto inner = [] { return Params().set("inner_samples", std::int64_t{3}); };
  std::vector<Choice> all;
  all.push_back({"prediction_correction", few()});
  all.push_back({"prediction_correction", few().set("admissible_set", box(3, 3))});
  all.push_back({"fixed_lag", few().set("lag", std::int64_t{2})});
  all.push_back({"luenberger", few().set("gain", given).set("widening_limit", 1.2)});
  all.push_back({"luenberger", few().set("gain", kalman)});
  all.push_back({"luenberger", few().set("admissible_set", box(3, 3))});
  all.push_back({"gain_correction", few()});
  all.push_back(
      {"gain_correction", few().set("gain", spec("given", Params().set("matrix", gain)))});
  all.push_back(
      {"zonotope_uncertain",
       few().set("gain", given).set("widening_limit", 1.1).set("inner_samples", std::int64_t{2})});
  all.push_back({"zonotope_uncertain", few().set("gain", kalman)});
  all.push_back({"interval_trajectory", inner().set("gain", given)});
  all.push_back(
      {"interval_trajectory", Params().set("upper_gain", given).set("lower_gain", kalman)});
  all.push_back({"integrated", inner()});
  all.push_back({"error_hull", Params().set("gain", given).set("measurement", previous)});
  all.push_back({"error_hull", Params()});
  all.push_back({"descriptor", few()});
  all.push_back({"descriptor", few().set("admissible_set", box(3, 50))});
  return all;
}

struct Place {
  std::string backend;
  Params params = {};
};

std::vector<Place> places() {
  std::vector<Place> all;
  for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    all.push_back({name});
    all.push_back({name, Params().set("rounding", std::string("outward"))});
  }
  all.push_back({"ellipsoid"});
  return all;
}

/// Nothing where the observer does not take the model.
std::optional<Trial<Observer>> trial_of(const Choice& choice, const Place& place, Kind kind,
                                        std::uint64_t seed) {
  const Registry& registry = examples::registry();
  Trial<Observer> trial;
  trial.backend = registry.make<BackendEntry>(place.backend, place.params);
  const Model model = plant(kind);
  const ObserverContext context{model, trial.backend};
  if (!registry.check<ObserverEntry>(choice.observer, context, choice.params).empty()) return {};
  // Without a set at all times the outputs have to determine the state.
  const bool may_lack = kind != Kind::descriptor || choice.params.has("admissible_set");
  const bool leaves_out = may_lack && seed % 2 == 0;
  trial.make = [=, &registry, backend = trial.backend] {
    auto made = registry.make<ObserverEntry>(choice.observer, {model, backend}, choice.params);
    if (leaves_out) made->leave_out_outliers(2, 10);
    return std::shared_ptr<Observer>(std::move(made));
  };
  trial.samples = samples_of(model, seed, may_lack && seed % 3 != 0);
  trial.after[replaced_at] = [backend = trial.backend, X0 = model.X0](Observer& observer) {
    LineForm wide = X0;
    wide.G *= 10;
    observer.replace(backend->import(wide));
  };
  return trial;
}

}  // namespace

TEST_CASE("observers go on from a saved state with the same bits") {
  std::set<std::string> seen;
  std::uint64_t seed = 0;
  int trials = 0;
  for (const Choice& choice : choices()) {
    for (const Place& place : places()) {
      for (const Kind kind :
           {Kind::plain, Kind::uncertain, Kind::ranges, Kind::thin, Kind::descriptor}) {
        CAPTURE(choice.observer);
        CAPTURE(choice.params.has("admissible_set"));
        CAPTURE(place.backend);
        CAPTURE(static_cast<int>(kind));
        CAPTURE(seed);
        const auto trial = trial_of(choice, place, kind, ++seed);
        if (!trial) continue;
        check_going_on(*trial, save_times);
        seen.insert(choice.observer);
        ++trials;
      }
    }
  }
  CHECK(seen.size() == 9);
  CHECK(trials > 200);
  MESSAGE(trials, " observers");
}

TEST_CASE("observers of polytopes go on from a saved state with the same bits") {
  const Params rounds = Params().set("digits", std::int64_t{0}).set("facets", std::int64_t{4}),
               late = Params().set("digits", std::int64_t{3000}).set("facets", std::int64_t{8});
  int trials = 0, refused = 0;
  for (const Params& params : {rounds, late}) {
    for (const Choice& choice : choices()) {
      const std::string& name = choice.observer;  // others take polytopes of more than four states
      if (name != "prediction_correction" && name != "luenberger" && name != "descriptor") continue;
      for (const Kind kind : {Kind::plain, Kind::descriptor}) {
        CAPTURE(name);
        auto trial = trial_of(choice, {"polytope", params}, kind, 2);
        if (!trial) continue;
        trial->samples.resize(10);
        const auto told = check_going_on(*trial, {0, 1, 6});
        refused += check_damage(*trial, told.saved.at(6), 6, 10, 1);
        ++trials;
      }
    }
  }
  CHECK(trials >= 8);
  CHECK(refused > 2 * trials);
  MESSAGE(trials, " observers");
}

TEST_CASE("damaged states of observers are refused, or lead somewhere") {
  std::uint64_t seed = 0;
  int refused = 0, all = 0;
  for (const Choice& choice : choices()) {
    for (const Place& place : places()) {
      for (const Kind kind : {Kind::plain, Kind::descriptor}) {
        CAPTURE(choice.observer);
        CAPTURE(place.backend);
        const auto trial = trial_of(choice, place, kind, ++seed);
        if (!trial) continue;
        const auto observer = trial->make();
        for (std::size_t at = 0; at < 12; ++at) trial->step(*observer, at);
        refused += check_damage(*trial, trial->saved(*observer), 12, 40, seed);
        all += 40;
      }
    }
  }
  CHECK(refused > all / 4);
  MESSAGE(refused, " of ", all, " damaged states refused");
}

TEST_CASE("a state of another observer is refused") {
  const Registry& registry = examples::registry();
  const auto backend = examples::backend("zonotope");
  const Model model = plant(Kind::plain);
  const auto saved = [&](const char* name) {
    const auto observer = registry.make<ObserverEntry>(name, {model, backend}, {});
    observer->step(samples_of(model, 1, false)[0]);
    Archive archive(backend);
    archive(*observer);
    return archive.bytes();
  };
  const auto other = registry.make<ObserverEntry>("interval_trajectory", {model, backend}, {});
  Archive archive(backend, saved("luenberger"));
  CHECK_THROWS_AS(archive(*other), Error);
}
