// SPDX-License-Identifier: GPL-3.0-or-later
// Of which times estimates are that lag, what begins anew, and what the present state is needed
// for.
#include <algorithm>

#include <doctest/doctest.h>

#include "observers/smoothing.hpp"

using namespace cordon;
using namespace smoothing;

TEST_CASE("the times of estimates after a start and after a replacement") {
  const PlantData plant = plants()[2];
  const auto smoother = observer("fixed_lag", plant.model, "constrained_zonotope", 3);
  const auto times = [&](Index from, Index to) {
    std::vector<Index> found;
    for (Index k = from; k < to; ++k)
      found.push_back(smoother->step(plant.data[static_cast<std::size_t>(k)]).k);
    return found;
  };
  CHECK(smoother->lag() == 3);
  CHECK(times(0, 7) == std::vector<Index>{0, 0, 0, 0, 1, 2, 3});
  const Box box{Vector::Constant(3, -2), Vector::Constant(3, 2)};
  smoother->replace(smoother->step(plant.data[7]).set->backend().box(box));
  CHECK(times(8, 13) == std::vector<Index>{7, 7, 7, 8, 9});
  smoother->start();
  CHECK(times(20, 25) == std::vector<Index>{20, 20, 20, 20, 21});
}

TEST_CASE("what was known before a replacement or a new start is forgotten") {
  const PlantData plant = plants()[2];
  const Box box{Vector::Constant(3, -2), Vector::Constant(3, 2)};
  const auto backend = plugins().backend("constrained_zonotope");
  const auto replaced = observer("fixed_lag", plant.model, "constrained_zonotope", 2),
             fresh = observer("fixed_lag", plant.model, "constrained_zonotope", 2);
  for (Index k = 0; k < 10; ++k) replaced->step(plant.data[static_cast<std::size_t>(k)]);
  replaced->replace(backend->box(box));
  fresh->start(backend->box(box));
  // the set takes the place of one that knows the sample
  fresh->step(without_outputs(plant.data[9]));
  for (Index k = 10; k < 18; ++k) {
    const Sample& sample = plant.data[static_cast<std::size_t>(k)];
    const Estimate X = replaced->step(sample), Y = fresh->step(sample);
    CHECK(X.k == Y.k);
    CHECK(distance(X.set->interval_hull(), Y.set->interval_hull()) <= 1e-12);
  }
  replaced->start();
  const auto other = observer("fixed_lag", plant.model, "constrained_zonotope", 2);
  for (Index k = 0; k < 8; ++k) {
    const Sample& sample = plant.data[static_cast<std::size_t>(k)];
    CHECK(distance(replaced->step(sample).set->interval_hull(),
                   other->step(sample).set->interval_hull()) == 0);
  }
}

TEST_CASE("a contradiction is told with the sample that leaves no state, and lasts") {
  const PlantData plant = plants()[2];
  for (const Index at_sample : {1, 12}) {
    CAPTURE(at_sample);
    const auto smoother = observer("fixed_lag", plant.model, "constrained_zonotope", 5, 30, 10),
               filter = observer("prediction_correction", plant.model, "constrained_zonotope", 0);
    for (Index k = 0; k < 16; ++k) {
      Sample sample = plant.data[static_cast<std::size_t>(k)];
      if (k == at_sample) sample.y[1] += 5;
      const Estimate late = smoother->step(sample), present = filter->step(sample);
      CHECK(late.k == std::max<Index>(k - 5, 0));
      CHECK((late.consistent == Answer::no) == (k >= at_sample));
      CHECK(late.consistent == present.consistent);
      if (k != at_sample) continue;
      CHECK(late.why.kind != Certificate::Kind::none);
      REQUIRE(smoother->contradiction());
      CHECK(smoother->contradiction()->k == k);
      CHECK(smoother->contradiction()->output == 1);
      CHECK(smoother->contradiction()->distance ==
            doctest::Approx(filter->contradiction()->distance).epsilon(.2));
    }
  }
}

TEST_CASE("outliers are judged by the present state") {
  const PlantData plant = plants()[2];
  const auto smoother = observer("fixed_lag", plant.model, "constrained_zonotope", 3),
             filter = observer("prediction_correction", plant.model, "constrained_zonotope", 0);
  for (const auto& one : {smoother, filter}) one->leave_out_outliers(1, 5);
  bool any = false;
  for (Index k = 0; k < 25; ++k) {
    Sample sample = plant.data[static_cast<std::size_t>(k)];
    if (k == 6 || k == 14) sample.y[0] -= 3;
    const Estimate late = smoother->step(sample);
    filter->step(sample);
    CHECK(late.k == std::max<Index>(k - 3, 0));
    CHECK(late.consistent != Answer::no);
    CHECK(smoother->left_out() == filter->left_out());
    any = any || !smoother->left_out().empty();
  }
  CHECK(any);
}

TEST_CASE("a budget below the stack, a descriptor system and a bank are refused") {
  const Registry& registry = plugins().registry;
  const auto backend = plugins().backend("constrained_zonotope");
  const auto problems = [&](const Model& model, Params params) {
    const ComponentSpec spec{"fixed_lag", std::move(params)};
    return registry.check<ObserverEntry>(spec.type, {model, backend}, spec.params);
  };
  const auto few = problems(
      three_states(), Params().set("max_generators", std::int64_t{17}).set("lag", std::int64_t{5}));
  REQUIRE(few.size() == 1);
  CHECK(few[0].pointer == "/max_generators");
  CHECK(few[0].message.find("18 coordinates") != std::string::npos);
  Model descriptor = descriptor_example();
  descriptor.X0 = bounded_start();
  CHECK(problems(descriptor, {}).size() == 1);
  ModeBank bank;
  bank.modes.push_back({"nominal", three_states()});
  bank.modes.push_back({"other", three_states()});
  const std::shared_ptr<const ComponentSpec> late =
      std::make_shared<ComponentSpec>(ComponentSpec{"fixed_lag", {}});
  const auto refused = registry.check<DiagnoserEntry>("consistency_bank", {bank, backend},
                                                      Params().set("observer", late));
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].pointer == "/observer");
}
