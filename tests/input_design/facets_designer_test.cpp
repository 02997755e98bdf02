// SPDX-License-Identifier: GPL-3.0-or-later
// The designer "facets" from parameters to certificates.
#include <chrono>
#include <cmath>
#include <thread>

#include <doctest/doctest.h>

#include "input_design/motor.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

namespace {

DesignOutcome designed(const ModeBank& bank, const Params& params) {
  REQUIRE(
      registry().check<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params).empty());
  DesignControl control;
  return registry()
      .make<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params)
      ->design(control);
}

Params published_parameters() {
  const Matrix reference = (Matrix(1, 2) << .5, -1).finished();
  return Params().set("reference", reference).set("first_input", Vector(reference.transpose()));
}

}  // namespace

TEST_CASE(
    "The published example: horizons 1 and 2 are refused by proof, 3 is optimal and certified") {
  const DesignOutcome outcome =
      designed(examples::four_descriptor_models(), published_parameters().set("epsilon", 1e-4));
  CHECK(outcome.status == DesignStatus::optimal);
  CHECK(outcome.horizon == 3);
  REQUIRE(outcome.tried.size() == 2);
  for (const HorizonTrial& trial : outcome.tried) CHECK(trial.status == DesignStatus::infeasible);
  REQUIRE(outcome.best);
  CHECK(outcome.best->cost == doctest::Approx(9.2005343602499).epsilon(1e-9));
  CHECK(outcome.gap() <= 1e-8);
  CHECK_FALSE(outcome.restriction);
  CHECK(outcome.best->separates() == Answer::yes);
  for (const PairSeparation& pair : outcome.best->pairs) CHECK(pair.kappa_lower > 1e-4 - 1e-8);
  CHECK(outcome.best->u.row(0).isApprox(numbers({.5, -1}).transpose()));
  CHECK(outcome.best->u.cwiseAbs().maxCoeff() <= 8);
  CHECK(outcome.nodes > 0);
  CHECK(outcome.reason.empty());
}

TEST_CASE("With ε = 0 the tubes of the optimum touch, and it is said") {
  const DesignOutcome outcome =
      designed(examples::four_descriptor_models(),
               published_parameters().set("epsilon", 0.0).set("horizon", std::int64_t{3}));
  CHECK(outcome.status == DesignStatus::optimal);
  CHECK(outcome.best->cost == doctest::Approx(9.19954).epsilon(1e-9));
  CHECK(outcome.best->separates() != Answer::yes);
  CHECK(outcome.reason.find("touch") != std::string::npos);
}

TEST_CASE("The time limit and a stop from outside hold before and after the search") {
  class Slow final : public DesignControl {
   public:
    bool stop() const noexcept override {
      ++asked;
      if (delay.count() > 0) std::this_thread::sleep_for(delay);
      return asked > most;
    }
    std::chrono::milliseconds delay{0};
    mutable int asked = 0;
    int most = 1000000;
  };
  for (const char* type : {"facets", "milp"}) {
    const Params params = published_parameters().set("horizon", std::int64_t{3});
    const auto designed_under = [&](const Params& all, DesignControl& control) {
      const ModeBank bank = examples::four_descriptor_models();
      return registry()
          .make<DesignerEntry>(type, {bank, backend("line_zonotope")}, all)
          ->design(control);
    };
    Slow late;
    late.delay = std::chrono::milliseconds(3);
    const DesignOutcome out_of_time = designed_under(Params(params).set("time_limit", .002), late);
    CHECK(out_of_time.status == DesignStatus::unknown);
    CHECK(out_of_time.stopped);
    CHECK(out_of_time.horizon == 3);
    CHECK(out_of_time.reason.find("equations of the tubes") != std::string::npos);
    CHECK(out_of_time.suggestion.find("time_limit") != std::string::npos);
    CHECK(late.asked < 3);

    for (const int most : {0, 3, 4, 9, 10}) {  // four tubes and six pairs, then the search
      Slow ended;
      ended.most = most;
      const DesignOutcome outcome = designed_under(params, ended);
      CHECK(outcome.status == DesignStatus::unknown);
      CHECK(outcome.stopped);
      CHECK_FALSE(outcome.best);
      CHECK(outcome.reason.find("equations of the tubes") != std::string::npos);
      CHECK(ended.asked == most + 1);
    }
  }
  // All that was found before the stop came is lost with it, however late that is.
  Slow whole;
  const ModeBank bank = examples::four_descriptor_models();
  const Params params = published_parameters().set("horizon", std::int64_t{3});
  const auto designer =
      registry().make<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params);
  REQUIRE(designer->design(whole).best);
  for (int before_end = 1; before_end <= 10; ++before_end) {  // six pairs and four hulls
    Slow ended;
    ended.most = whole.asked - before_end;
    const DesignOutcome outcome = designer->design(ended);
    CHECK(outcome.status == DesignStatus::unknown);
    CHECK(outcome.stopped);
    CHECK(outcome.reason.find("judged") != std::string::npos);
    CHECK(ended.asked == ended.most + 1);
  }
}

TEST_CASE("Parameters of the search reach it") {
  Params params = published_parameters().set("epsilon", 1e-4).set("horizon", std::int64_t{3});
  const DesignOutcome few =
      designed(examples::four_descriptor_models(), Params(params)
                                                       .set("max_facets", std::int64_t{4})
                                                       .set("cost", std::string("norm_inf"))
                                                       .set("time_limit", 1.0));
  CHECK(few.status == DesignStatus::feasible);
  REQUIRE(few.best);
  CHECK(few.best->separates() == Answer::yes);
  CHECK(few.lower_bound <= 4.2248815);
  CHECK(few.stopped);
  CHECK(few.reason.find("more than 4 facets") != std::string::npos);
  const DesignOutcome wide =
      designed(examples::four_descriptor_models(), Params(params).set("gap", .5));
  CHECK(wide.status == DesignStatus::optimal);
  CHECK(wide.lower_bound < 9.2005);
  const DesignOutcome last = designed(examples::four_descriptor_models(),
                                      Params(params).set("outputs", std::string("last")));
  CHECK(last.last_output_only);
  CHECK((!last.best || last.best->cost > 9.2005));
}

TEST_CASE("Of all horizons the cheapest, with the others told") {
  const auto up_to = [](std::int64_t horizon) { return Params().set("horizon_at_most", horizon); };
  const DesignOutcome six = designed(examples::motor_models(), up_to(6).set("epsilon", .001));
  CHECK(six.status == DesignStatus::optimal);
  CHECK(six.horizon == 6);
  REQUIRE(six.best);
  CHECK(six.best->cost == doctest::Approx(17.336914).epsilon(1e-6));
  CHECK(six.lower_bound >= six.best->cost * (1 - 1e-7));
  REQUIRE(six.tried.size() == 5);
  for (std::size_t k = 0; k < 5; ++k) CHECK(six.tried[k].horizon == static_cast<Index>(k) + 1);
  CHECK(six.tried[1].status == DesignStatus::infeasible);
  CHECK(six.tried[4].status == DesignStatus::optimal);
  CHECK(six.tried[4].reason == "cost 18.8461");

  // Every further step away from the reference costs .5 more.
  const DesignOutcome first =
      designed(examples::three_scalar_models(), up_to(4).set("reference", Matrix{{2.5}}));
  REQUIRE(first.best);
  CHECK(first.status == DesignStatus::optimal);
  const DesignOutcome alone =
      designed(examples::three_scalar_models(),
               Params()
                   .set("reference", Matrix{{2.5}})
                   .set("horizon", static_cast<std::int64_t>(first.horizon)));
  CHECK(first.best->cost == doctest::Approx(alone.best->cost));
  REQUIRE(first.tried.size() == 3);
  CHECK(first.tried.back().horizon == 4);
  for (const HorizonTrial& trial : first.tried) CHECK(trial.horizon != first.horizon);

  // What does not get cheaper stays short.
  const DesignOutcome same = designed(examples::three_scalar_models(), up_to(5));
  const DesignOutcome some =
      designed(examples::three_scalar_models(), Params().set("max_horizon", std::int64_t{5}));
  REQUIRE(same.best);
  REQUIRE(some.best);
  CHECK(same.best->cost <= some.best->cost * (1 + 1e-9));
  CHECK((same.horizon == some.horizon || same.best->cost < some.best->cost * (1 - 1e-7)));

  const auto both =
      registry().check<DesignerEntry>("facets", {examples::motor_models(), backend("zonotope")},
                                      up_to(3).set("horizon", std::int64_t{3}));
  REQUIRE(both.size() == 1);
  CHECK(both[0].pointer == "/horizon_at_most");
}
