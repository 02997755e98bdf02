// SPDX-License-Identifier: GPL-3.0-or-later
// What the designer of a third party says is proven by the host, or called a claim; what is false
// is a violated guarantee.
#include <doctest/doctest.h>

#include "claims/program.hpp"

using namespace claims;

namespace {

/// x⁺ = .5 x ± u + w, y = x + v: y_1 of the modes differ by 2 u_0, W, V and x_0 account for 1.4.
Json study(const Json& designer = Json::object(), bool experiments = true) {
  Json made = Json::parse(R"({
    "cordon": 1, "title": "two signs",
    "system": {"type": "lti", "A": [[0.5]], "B": [[1]], "C": [[1]], "X0": {"type": "box", "lower": [-1], "upper": [1]},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]}, "V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "U": {"type": "box", "lower": [-4], "upper": [4]},
      "modes": [{"name": "opposite", "system": {"type": "lti", "A": [[0.5]], "B": [[-1]], "C": [[1]],
        "W": {"type": "box", "lower": [-0.1], "upper": [0.1]}, "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}}}]},
    "data": {"simulate": {"seed": 1, "seeds": 3}},
    "pipelines": [{"name": "P", "backend": "interval", "designer": {"type": "lying"}}]})");
  for (const auto& [name, value] : designer.items()) made["pipelines"][0]["designer"][name] = value;
  if (experiments)
    made["pipelines"][0]["diagnoser"] = Json{{"type", "tube_membership"}, {"horizon", 2}};
  return made;
}

/// A violation, by both commands: in the message, in the results, and as the first thing that a
/// check of the results repeats.
Outcome check_violated(const Json& designer, const std::string& why) {
  CAPTURE(designer.dump());
  const Program program(study(designer));
  const Outcome designed = program.design(), run = program.run();
  CHECK(designed.code == 4);
  CHECK_MESSAGE(designed.complains("pipeline \"P\" violates its guarantee: "), designed.err);
  CHECK_MESSAGE(designed.complains(why), designed.err);
  CHECK(run.code == 4);
  CHECK_MESSAGE(run.complains(why), run.err);
  const Json pipeline = program.results()["pipelines"][0];
  CHECK_FALSE(pipeline["summary"]["refuted"].empty());
  CHECK(pipeline["numbers"]["refuted_claims"].get<double>() >= 1);
  CHECK(program.file("report.html").find("proven false") != std::string::npos);
  CHECK(program.file("benchmarks.csv").find(",0,") != std::string::npos);
  CHECK(program.verify().code == 4);
  return run;
}

}  // namespace

TEST_CASE("what is true is proven, although the designer proves nothing") {
  const Program program(study());
  const Outcome designed = program.design("--verify"), run = program.run();
  CHECK(designed.code == 0);
  CHECK_MESSAGE(designed.says("disjoint (proven)"), designed.out);
  CHECK(designed.says("In exact arithmetic: the modes are separated"));
  CHECK(run.code == 0);
  CHECK(run.says("disjoint (proven)"));
  const Json pipeline = program.results()["pipelines"][0];
  CHECK(pipeline["exact"]["separates"] == "yes");
  CHECK(pipeline["exact"]["pairs"][0]["disjoint"] == "yes");
  CHECK(pipeline["exact"]["pairs"][0]["kappa_lower"].get<double>() >
        .5);  // the designer's word is .5
  CHECK_FALSE(pipeline["exact"].contains("wall_s"));
  CHECK(pipeline["summary"]["refuted"].empty());
  CHECK(program.verify().code == 0);
}

TEST_CASE("a separation without a proof, or with a false one") {
  for (const char* lie : {"nothing", "certificate"}) {
    const Json designer{{"lie", lie}, {"first", .1}};
    CHECK(check_violated(designer,
                         "the output tubes of healthy and opposite are called disjoint, and meet")
              .code == 4);
    const Outcome said = Program(study(designer)).design();
    CHECK(said.says("meet (proven)"));
    CHECK_FALSE(said.says("disjoint (proven)"));
  }
}

TEST_CASE("a certificate that does not prove what it is given for") {
  CHECK(
      check_violated({{"lie", "void_certificate"}}, "disjoint by a certificate that proves nothing")
          .code == 4);
  CHECK(check_violated({{"lie", "point"}}, "disjoint by a certificate that proves that they meet")
            .code == 4);
}

TEST_CASE("an input that is found separates, whatever is said of the pairs") {
  CHECK(check_violated(
            {{"lie", "silent"}, {"first", .1}},
            "it calls its input feasible, and the outputs of healthy and opposite can be the same")
            .code == 4);
  CHECK(check_violated({{"lie", "meet"}}, "are said to meet, and are disjoint").code == 4);
  CHECK(Program(study({{"lie", "silent"}})).design().says("disjoint (proven)"));
}

TEST_CASE("an input outside the input set") {
  CHECK(check_violated({{"first", 4.5}},
                       "u_k is proven to lie outside the input set U of the study at k = 0")
            .code == 4);
  CHECK(Program(study({{"first", 4}})).design().code == 0);          // on its boundary
  CHECK(Program(study({{"first", 4 + 1e-10}})).design().code == 0);  // outside by rounding
  CHECK(check_violated({{"first", 4 + 1e-7}}, "outside the input set U").code == 4);
  const Json narrow{{"type", "box"}, {"lower", {-2}}, {"upper", {2}}};
  CHECK(
      check_violated({{"input_set", narrow}}, "u_k is proven to lie outside \"input_set\" at k = 0")
          .code == 4);
  CHECK(check_violated({{"lie", "given"}, {"first", 4.5}}, "outside the input set U").code ==
        4);  // the study gives no input
}

TEST_CASE("a first input that is not kept to") {
  CHECK(check_violated({{"first_input", {2.5}}}, "u_0 is another than the study's \"first_input\"")
            .code == 4);
  CHECK(Program(study({{"first_input", {3}}})).design().code == 0);
}

TEST_CASE("another horizon, another question") {
  CHECK(check_violated({{"lie", "horizon"}}, "it answers for the horizon 1, and \"horizon\" is 2")
            .code == 4);
  CHECK(check_violated({{"lie", "last"}},
                       "it compares the last output only, and \"outputs\" is \"all\"")
            .code == 4);
  CHECK(
      check_violated({{"lie", "assumes"}}, "it assumes an admissible set, and the study gives none")
          .code == 4);
  CHECK(check_violated({{"epsilon", .2}}, "it asks for κ ≥ 0.1, and \"epsilon\" is 0.2").code == 4);
  CHECK(check_violated({{"lie", "bound"}}, "its input costs 3, less than its lower bound 6").code ==
        4);
  CHECK(
      check_violated({{"lie", "empty"}}, "the output tube of opposite is called empty, and is not")
          .code == 4);
}

TEST_CASE("answers that do not fit the bank end the pipeline, as a violation") {
  for (const auto& [lie, why] :
       {std::pair("length", "its input is 2 × 1, must be 3 × 1"),
        std::pair("order", "pair 1 is not that of \"healthy\" and \"opposite\""),
        std::pair("nan", "its bound of κ is not a number")}) {
    const Program program(study({{"lie", lie}}));
    const Outcome designed = program.design(), run = program.run();
    CHECK(designed.code == 4);
    CHECK_MESSAGE(designed.complains(why), designed.err);
    CHECK(designed.complains("violates its contract"));
    CHECK(run.code == 4);
    CHECK_MESSAGE(run.complains(why), run.err);
  }
}

TEST_CASE("that nothing is cheaper, or that there is no input, is a claim") {
  Outcome said = Program(study({{"lie", "optimal"}})).design();
  CHECK(said.code == 0);
  CHECK_MESSAGE(said.says("Optimal (claimed by lying): cost 3, claimed lower bound 3"), said.out);
  const Program infeasible(study({{"lie", "infeasible"}}));
  said = infeasible.design();
  CHECK(said.code == 0);
  CHECK_MESSAGE(said.says("Infeasible (claimed by lying)"), said.out);
  CHECK(infeasible.design("--json").says("\"lower_bound\": \"inf\""));
}

TEST_CASE(
    "beyond the limits of the exact proof there are claims only, which experiments can refute") {
  const int horizon = 60;
  const Json far{{"horizon", horizon}};
  const Program open(study(far, false));
  const Outcome said = open.design(), strict = open.design("--verify"), run = open.run();
  CHECK(said.code == 0);
  CHECK_MESSAGE(said.says("disjoint (claimed)"), said.out);
  CHECK_FALSE(said.says("disjoint (proven)"));
  CHECK(strict.code == 5);
  CHECK(strict.complains("leaves a question open"));
  CHECK(run.code == 0);
  CHECK(run.says("disjoint (claimed)"));
  CHECK(open.file("report.html").find("claimed to be disjoint") != std::string::npos);
  CHECK(open.file("summary.csv").find(",unknown") != std::string::npos);
  Json lie = study({{"horizon", horizon}, {"first", 0}});
  lie["pipelines"][0]["diagnoser"]["horizon"] = 8;
  const Program refuted(lie);
  const Outcome found = refuted.run();
  CHECK(found.code == 4);
  CHECK_MESSAGE(
      found.complains(
          "are called disjoint, and in the experiment with mode \"healthy\" and seed 1 of 3"),
      found.err);
}

TEST_CASE(
    "the optimum of a narrower problem is no optimum, and its bound no bound of the problem") {
  const Json noise{{"type", "box"}, {"lower", {-0.3}}, {"upper", {0.3}}},
      push{{"type", "box"}, {"lower", {-0.01}}, {"upper", {0.01}}};
  Json motor = Json::parse(R"({"cordon": 1, "title": "a motor", "system": {"type": "lti",
    "A": [[0.12068803200777645, -0.042281095904099994], [0.4228109590410001, 0.9620818404993664]],
    "B": [[0.42561846320018526], [0.28075041591852995]], "Bw": [[0.28075041591852995], [-9.843117908780599]], "C": [[0, 1]],
    "X0": {"type": "box", "lower": [-0.2, -0.5], "upper": [0.2, 0.5]}, "U": {"type": "box", "lower": [-24], "upper": [24]},
    "modes": [{"name": "supply 70 %", "actuator": [0.7]}, {"name": "friction", "system": {"type": "lti",
      "A": [[0.12114472828865985, -0.040388201188592335], [0.40388201188592343, 0.8965981911096327]],
      "B": [[0.4257562420211521], [0.2734278766903595]], "Bw": [[0.2734278766903594], [-9.507377652666422]], "C": [[0, 1]]}}]},
    "data": {"simulate": {"seed": 1}},
    "pipelines": [{"name": "reduced", "backend": "zonotope", "designer": {"type": "milp", "horizon": 4, "epsilon": 0.001}},
      {"name": "whole", "backend": "zonotope", "designer": {"type": "facets", "horizon": 4, "epsilon": 0.001}}]})");
  for (const char* place : {"/system/modes/1/system", "/system"}) {
    Json& system = motor[Json::json_pointer(place)];
    system["W"] = push;
    system["V"] = noise;
  }
  const Program program(motor);
  const Outcome said = program.design();
  CHECK_MESSAGE(said.code == 0, said.err);
  CHECK_MESSAGE(said.says("Feasible: cost 22.9233, no lower bound is known"), said.out);
  CHECK(
      said.says("Searched in place of the problem: the program with at most 8 generators per pair, "
                "as GLPK bounds it; that one costs "
                "at least 22.9233, the problem itself may cost less"));
  CHECK_FALSE(said.says("gap"));
  const Json pipelines = Json::parse(program.design("--json").out)["pipelines"],
             reduced = pipelines[0]["design"], whole = pipelines[1]["design"];
  CHECK(reduced["lower_bound"] == "-inf");
  CHECK(reduced["gap"].is_null());
  CHECK(reduced["restriction"]["lower_bound"].get<double>() > whole["cost"].get<double>());
  CHECK(whole["status"] == "optimal");
  CHECK(whole["cost"].get<double>() == doctest::Approx(21.8186).epsilon(1e-5));
  CHECK(whole["restriction"].is_null());
}
