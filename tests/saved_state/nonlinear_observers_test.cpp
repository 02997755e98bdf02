// SPDX-License-Identifier: GPL-3.0-or-later
// Observers of models by formulas go on from a saved state with the same bits, whatever their
// estimates are held as.
#include <cmath>
#include <limits>

#include "input_design/plugins.hpp"
#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"
#include "saved_state/going_on.hpp"

using namespace cordon;
using namespace saved_state;

namespace {

Model formulas_model() {
  test::Json system = {{"states", {"x1", "x2"}},
                       {"inputs", {"u"}},
                       {"disturbances", {"w1", "w2"}},
                       {"noises", {"v1", "v2"}}};
  system["f"] = {"0.8*x1 + 0.1*x1*x2 + 0.1*u + w1", "0.7*x2 + 0.1*sin(x1) + w2"};
  system["g"] = {"x1 + v1", "x2 + 0.1*x1^2 + v2"};
  system["X0"] = {{"center", {0.5, 0}}, {"generators", {{0.2, 0.1}, {0.0, 0.2}}}};
  system["W"] = system["V"] = {{"center", {0, 0}}, {"generators", {{0.01, 0.0}, {0.0, 0.02}}}};
  return test::model_of(system);
}

std::vector<Sample> trajectory(const Model& model, bool has_gaps) {
  test::Trajectory plant(model, 3);
  std::mt19937_64 random(5);
  std::vector<Sample> all;
  for (Index k = 0; k < 40; ++k) {
    const Vector u{{std::sin(static_cast<double>(k))}};
    Sample sample{k, u, plant.output(u, k)};
    if (k == 14) sample.y[1] += 5;
    if (k == 30) sample.y[0] += 20;
    if (has_gaps && k != 30 && random() % 5 == 0) {
      sample.missing.push_back(static_cast<Index>(random() % 2));
      sample.y[sample.missing.front()] = std::numeric_limits<double>::quiet_NaN();
    }
    all.push_back(sample);
    plant.advance(u, k);
  }
  return all;
}

struct Formulas {
  std::string backend, observer;
  Params params;
};

std::vector<Formulas> formulas_choices() {
  std::vector<Formulas> all;
  const auto few = [] { return Params().set("max_generators", std::int64_t{12}); };
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    for (const char* method : {"first_order", "mean_value", "dc", "interval", "lifted"})
      all.push_back({backend, "nonlinear", few().set("method", std::string(method))});
    all.push_back({backend, "nonlinear", few().set("parts", std::int64_t{3})});
    all.push_back({backend, "nonlinear", few().set("contraction", false).set("box", false)});
  }
  for (const char* backend : {"constrained_zonotope", "line_zonotope"})
    all.push_back({backend, "nonlinear", few().set("method", std::string("relaxation"))});
  for (const char* variant : {"frad_a", "frad_b", "frad_c", "vol_min_a", "vol_min_b"})
    all.push_back({"zonotope", "nonlinear_strips", few().set("variant", std::string(variant))});
  return all;
}

std::optional<Trial<Observer>> trial_of(const Formulas& choice, bool leaves_out) {
  const Registry& registry = examples::registry();
  Trial<Observer> trial;
  trial.backend = registry.make<BackendEntry>(choice.backend, {});
  const Model model = formulas_model();
  if (!registry.check<ObserverEntry>(choice.observer, {model, trial.backend}, choice.params)
           .empty())
    return {};
  trial.make = [=, &registry, backend = trial.backend] {
    auto made = registry.make<ObserverEntry>(choice.observer, {model, backend}, choice.params);
    if (leaves_out) made->leave_out_outliers(2, 10);
    return std::shared_ptr<Observer>(std::move(made));
  };
  trial.samples = trajectory(model, leaves_out);
  trial.after[33] = [backend = trial.backend, X0 = model.X0](Observer& observer) {
    observer.replace(backend->import(X0));
  };
  return trial;
}

}  // namespace

TEST_CASE("observers of formulas go on from a saved state with the same bits") {
  int trials = 0;
  for (const Formulas& choice : formulas_choices()) {
    for (const bool leaves_out : {false, true}) {
      CAPTURE(choice.backend);
      CAPTURE(choice.observer);
      CAPTURE(leaves_out);
      const auto trial = trial_of(choice, leaves_out);
      if (!trial) continue;
      check_going_on(*trial, {0, 1, 8, 15, 31, 33, 34, 36});
      ++trials;
    }
  }
  CHECK(trials > 50);
  MESSAGE(trials, " observers of formulas");
}

TEST_CASE("damaged states of observers of formulas are refused, or lead somewhere") {
  std::uint64_t seed = 0;
  int refused = 0;
  for (const Formulas& choice : formulas_choices()) {
    CAPTURE(choice.backend);
    CAPTURE(choice.observer);
    const auto trial = trial_of(choice, false);
    if (!trial) continue;
    const auto observer = trial->make();
    for (std::size_t at = 0; at < 8; ++at) trial->step(*observer, at);
    refused += check_damage(*trial, trial->saved(*observer), 8, 60, ++seed);
  }
  CHECK(refused > 300);
}
