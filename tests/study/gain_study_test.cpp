// SPDX-License-Identifier: GPL-3.0-or-later
// Components inside components that may be written as a matrix: gains.
#include <doctest/doctest.h>

#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;

namespace {

const std::string matrix = "[[0.5, 0], [0, 0.25]]";

std::string with_gain(const std::string& gain) {
  return exchanged(uncertain_study, "\"gain\": " + matrix,
                   gain.empty() ? "\"$comment\": 0" : "\"gain\": " + gain);
}

void expect_problem(const std::string& gain, const std::string& pointer, const std::string& message,
                    const std::string& suggestion) {
  CAPTURE(gain);
  const auto problems = problems_of(with_gain(gain));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/observer" + pointer);
  CAPTURE(problems[0].message);
  CAPTURE(problems[0].suggestion);
  CHECK(problems[0].message.find(message) != std::string::npos);
  CHECK(problems[0].suggestion.find(suggestion) != std::string::npos);
  CHECK(problems[0].line == 28);
}

}  // namespace

TEST_CASE("a gain that is written as a matrix is the component that holds it") {
  const Study as_matrix = read_text(uncertain_study);
  const Study as_component =
      read_text(with_gain("{\"matrix\": " + matrix + ", \"type\": \"given\"}"));
  CHECK(same(as_matrix, as_component));
  CHECK(as_matrix.resolved == as_component.resolved);
  const ComponentSpec& gain =
      as_matrix.pipelines[0].estimation()->observer.params.component("gain");
  CHECK(gain.type == "given");
  CHECK(gain.params.matrix("matrix") == Matrix{{0.5, 0.}, {0., 0.25}});
  CHECK(as_matrix.resolved.find("\"type\": \"given\"") != std::string::npos);
  expect_round_trip(as_matrix);
}

TEST_CASE("a gain by its name has every default, and one that is left out stays out") {
  const Study named = read_text(with_gain("\"optimal\""));
  const ComponentSpec& gain = named.pipelines[0].estimation()->observer.params.component("gain");
  CHECK(gain.params.real("weight") == 0.5);
  CHECK_FALSE(gain.params.has("theta"));
  CHECK(same(named, read_text(with_gain("{\"type\": \"optimal\"}"))));
  expect_round_trip(named);
  CHECK_FALSE(read_text(with_gain("")).pipelines[0].estimation()->observer.params.has("gain"));
}

TEST_CASE("mistakes in gains have their places in the file") {
  expect_problem("\"givn\"", "/gain", "no gain \"givn\"", "did you mean \"given\"?");
  expect_problem("{\"type\": \"optimum\"}", "/gain/type", "no gain \"optimum\"",
                 "did you mean \"optimal\"?");
  expect_problem("{\"type\": \"optimal\", \"wight\": 1}", "/gain/wight",
                 "unknown parameter of gain \"optimal\"", "\"weight\"");
  expect_problem("{\"type\": \"optimal\", \"weight\": 2}", "/gain/weight",
                 "is 2, must lie in [0, 1]", "");
  expect_problem("\"given\"", "/gain/matrix", "is missing", "a matrix");
  expect_problem("3", "/gain", "is a number, must be a matrix, a text or an object",
                 "write a matrix, the name of a gain");
  expect_problem("[[1, 2], [3]]", "/gain/1", "has 1 number, the first row has 2", "equal length");
  expect_problem("[[1, null]]", "/gain/0/1", "is null, must be a number", "");
  expect_problem("[[1, NaN]]", "/gain/0/1", "NaN is not a number", "");
  expect_problem("[1, 2]", "/gain/0", "is a number, must be a list", "list of rows");
}

TEST_CASE("what a gain says of its matrix is told where the matrix stands") {
  expect_problem("[[1, 2]]", "/gain", "has a wrong number of rows", "one per state");
  expect_problem("{\"type\": \"given\", \"matrix\": [[1, 2]]}", "/gain/matrix",
                 "has a wrong number of rows", "one per state");
  expect_problem("[[-1, 0], [0, 0]]", "/gain/0/0", "is negative", "");
  expect_problem("{\"type\": \"given\", \"matrix\": [[-1, 0], [0, 0]]}", "/gain/matrix/0/0",
                 "is negative", "");
}

TEST_CASE("a gain for a descriptor system is refused by its type, which a matrix does not have") {
  const std::string descriptor = exchanged(uncertain_study, "\"type\": \"interval_lti\",",
                                           "\"type\": \"descriptor\", \"E\": [[1, 0], [0, 0]],");
  auto problems = problems_of(descriptor);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/observer/gain");
  CHECK(problems[0].message == "\"given\" designs gains for systems without E");
  problems = problems_of(exchanged(descriptor, matrix, "{\"type\": \"optimal\"}"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/observer/gain/type");
}

TEST_CASE("a matrix stands for a component that may be missing") {
  const Scratch scratch;
  Registry registry;
  registry.add([](Registrar& registrar) {
    registrar.add(ObserverEntry{
        {"luenberger", "a fake", "",
         ParamSchema().component("gain", "a gain", "gain").or_matrix("given")},
        nullptr,
        [](const ObserverContext&, const Params&) { return std::unique_ptr<Observer>(); }});
  });
  try {
    read_study(scratch.write("s.json", uncertain_study), registry, SearchPath{});
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::plugin);
    const std::string what = error.what();
    CHECK(what.find("/pipelines/0/observer/gain (line 28): no gain \"given\": no plugin of any "
                    "gain was found") != std::string::npos);
  }
}
