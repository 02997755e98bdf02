// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with designers, and simulations that start in a set.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/study/data.hpp"
#include "study/design_pieces.hpp"
#include "study/fakes.hpp"
#include "study/mistake.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;
using namespace study_test::design_pieces;
using study_test::design_study;  // not the function

TEST_CASE("pipelines with designers are read with every default") {
  const Study study = read_text(design_study);
  REQUIRE(study.pipelines.size() == 2);
  const PipelineSpec &first = study.pipelines[0], &second = study.pipelines[1];
  REQUIRE(first.design());
  CHECK(first.design()->designer.type == "search");
  CHECK(first.design()->designer.params.integer("horizon") == 4);
  CHECK(first.design()->designer.params.real("epsilon") == 1e-4);
  CHECK(first.design()->designer.params.matrix("weights") == Matrix{{1.}, {2.}});
  CHECK(first.design()->designer.params.set_form("input_set").dim() == 1);
  REQUIRE(first.design()->diagnoser);
  CHECK(first.design()->diagnoser->type == "committee");
  CHECK(second.design()->designer.params.matrix("u") == Matrix{{1.}, {2.}, {-1.}});
  CHECK_FALSE(second.design()->diagnoser);
  const auto& simulate = std::get<SimulateSpec>(study.data);
  CHECK(simulate.seed == 7);
  CHECK(simulate.seeds == 20);
  CHECK(simulate.noise == Noise::vertex);
  CHECK_FALSE(simulate.x0);
  REQUIRE(simulate.x0_set);
  CHECK(simulate.x0_set->c == Vector{{0., 1.}});
  CHECK(simulate.x0_set->G == Matrix{{0.5, 0.}, {0., 0.25}});
  CHECK(simulate.input.empty());
}

TEST_CASE("a horizon may be written as the largest one") {
  const std::string fixed = "\"horizon\": 4", most = "\"horizon\": {\"at_most\": 7}";
  const Study study = read_text(exchanged(design_study, fixed, most));
  CHECK(study.pipelines[0].design()->designer.params.integer("longest") == 7);
  expect_round_trip(study);
  expect_reported(design_study,
                  {fixed, "\"horizon\": {\"at_most\": 21}", "/pipelines/0/designer/horizon/at_most",
                   "is too large", "must lie between 1 and 20"});
  expect_reported(design_study, {fixed, "\"horizon\": {}", "/pipelines/0/designer/horizon",
                                 "has no \"at_most\"", "write a number, or {\"at_most\": number}"});
  expect_reported(design_study, {fixed, "\"horizon\": {\"at_most\": 7, \"least\": 2}",
                                 "/pipelines/0/designer/horizon/least", "unknown bound",
                                 "there is only \"at_most\""});
  expect_reported(design_study, {fixed, most + ", \"longest\": 5", "/pipelines/0/designer/longest",
                                 "is given by \"horizon\" as well", "remove one of the two"});
}

TEST_CASE("without data, designers have the defaults") {
  const Study study = read_text(exchanged(design_study, data_text, ""));
  const auto& simulate = std::get<SimulateSpec>(study.data);
  CHECK(simulate.seed == 1);
  CHECK(simulate.seeds == 1);
  CHECK(simulate.noise == Noise::uniform);
  CHECK_FALSE(simulate.x0);
  CHECK_FALSE(simulate.x0_set);
  expect_round_trip(study);
  expect_round_trip(read_text(exchanged(design_study, data_text, "\"data\": {\"simulate\": {}},")));
}

TEST_CASE("there are no data where every pipeline has a designer") {
  const auto none = open_data(read_text(design_study));
  CHECK(none->size() == 0);
  CHECK_FALSE(none->next());
  CHECK(open_data(read_text(mixed()))->size() == 10);
}

TEST_CASE("resolved studies with designers are studies again") {
  expect_round_trip(read_text(design_study));
  expect_round_trip(read_text(mixed()));
  const auto resolved = nlohmann::json::parse(read_text(design_study).resolved);
  CHECK_FALSE(resolved["data"]["simulate"].contains("steps"));
  CHECK(resolved["data"]["simulate"]["x0"]["type"] == "zonotope");
  CHECK(resolved["pipelines"][0]["designer"]["outputs"] == "all");
  CHECK(resolved["pipelines"][0]["diagnoser"]["type"] == "committee");
  CHECK_FALSE(resolved["pipelines"][0].contains("observer"));
  const auto both = nlohmann::json::parse(read_text(mixed()).resolved);
  CHECK(both["data"]["simulate"]["steps"] == 9);
  CHECK_FALSE(both["pipelines"][1].contains("designer"));
}

TEST_CASE("the start of designers and of observers is compared with where each begins") {
  const std::string X0 =
      "\"X0\": {\"type\": \"zonotope\", \"center\": [0, 1], \"generators\": [[1, 0.5], [0, 1]]},\n";
  CHECK(problems_of(exchanged(design_study, X0, "")).empty());  // no X0: nothing to leave
  // the whole of a set is inside itself
  const std::string own = ", \"X0\": {\"type\": \"box\", \"lower\": [-1, 0], \"upper\": [1, 2]}";
  const std::string whole =
      exchanged(exchanged(design_study, start, X0.substr(6, X0.size() - 8)), own, "");
  for (const Diagnostic& d : problems_of(whole)) FAIL_CHECK(d.pointer << ": " << d.message);
  // what touches a facet from inside cannot be told from what crosses it by a rounding error
  const auto touching = problems_of(exchanged(
      exchanged(design_study, own, ""), start,
      "{\"type\": \"zonotope\", \"center\": [0.5, 1], \"generators\": [[0.5, 0.5], [0, 1]]}"));
  REQUIRE(touching.size() == 1);
  CHECK(touching[0].message == "could not be proven to lie inside X0");
  CHECK(touching[0].suggestion == "give a smaller or a simpler set");
  const auto with_set = [](const std::string& set) {
    return exchanged(design_study, "\"committee\"",
                     "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": {\"type\": "
                     "\"prediction_correction\", "
                     "\"initial_set\": " +
                         set + "}}");
  };
  CHECK(
      problems_of(with_set("{\"type\": \"box\", \"lower\": [-1, 0], \"upper\": [1, 2]}")).empty());
  const auto problems =
      problems_of(with_set("{\"type\": \"box\", \"lower\": [-0.25, 0], \"upper\": [1, 2]}"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/x0");
  CHECK(problems[0].message == "does not lie inside the initial_set of pipeline \"designed\"");
}

TEST_CASE("an initial_set beside a designer does not take the place of X0") {
  const std::string text = design_study;
  const std::size_t begin = text.find(",\n{\n\"name\": \"by hand\"");
  std::string alone = text.substr(0, begin) + "\n]\n}\n";
  alone =
      exchanged(alone, "\"committee\"",
                "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": {\"type\": "
                "\"prediction_correction\", "
                "\"initial_set\": {\"type\": \"box\", \"lower\": [-9, -9], \"upper\": [9, 9]}}}");
  CHECK(problems_of(alone).empty());
  const auto problems = problems_of(exchanged(alone, start, "[5, 5]"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message == "lies outside X0");
}

TEST_CASE("observers start in a set too") {
  const std::string text =
      exchanged(valid_study, "\"x0\": [0.5, 0.25]",
                "\"x0\": {\"type\": \"box\", \"lower\": [-0.5, 0.75], \"upper\": [0.5, 1.25]}");
  const Study study = read_text(text);
  expect_round_trip(study);
  const Vector first = *open_data(study)->next()->truth,
               other = *open_data(study, 1)->next()->truth;
  CHECK(first != other);
  expect_reported(valid_study,
                  {"\"x0\": [0.5, 0.25]", "\"x0\": {\"type\": \"point\", \"center\": [0.5, 3]}",
                   "/data/simulate/x0", "does not lie inside X0", "widen that set"});
}
