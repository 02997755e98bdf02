// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/registry/schema.hpp"

using namespace cordon;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

ParamSchema everything() {
  ParamSchema schema;
  schema.integer("max_generators", "limit of the reduction", 30, 1, 1000)
      .real("epsilon", "threshold", 0.5, 0.0, 1.0)
      .flag("quiet", "no output", false)
      .choice("reduction", "method", {"girard", "combastel", "pca"}, "girard")
      .text("label", "name in tables")
      .vector("x0", "start")
      .matrix("gain", "observer gain")
      .set("X0", "initial set");
  return schema;
}

/// The one problem of these parameters.
Diagnostic only_problem(const ParamSchema& schema, Params params) {
  const auto problems = schema.complete(params);
  REQUIRE(problems.size() == 1);
  return problems[0];
}

Errc code_of(auto&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  FAIL("nothing was thrown");
  return Errc::internal;
}

}  // namespace

TEST_CASE("defaults are filled in; parameters without one stay absent") {
  Params params;
  CHECK(everything().complete(params).empty());
  CHECK(params.integer("max_generators") == 30);
  CHECK(params.real("epsilon") == 0.5);
  CHECK_FALSE(params.flag("quiet"));
  CHECK(params.text("reduction") == "girard");
  for (const char* absent : {"label", "x0", "gain", "X0"}) CHECK_FALSE(params.has(absent));
}

TEST_CASE("values that fit are kept") {
  Params params;
  params.set("max_generators", 1000)
      .set("epsilon", 1.0)
      .set("quiet", true)
      .set("reduction", "pca")
      .set("label", "a");
  params.set("x0", Vector(Vector::Ones(2)))
      .set("gain", Matrix(Matrix::Ones(2, 3)))
      .set("X0", make_space(2));
  CHECK(everything().complete(params).empty());
  CHECK(params.integer("max_generators") == 1000);
  CHECK(params.real("epsilon") == 1.0);
  CHECK(params.flag("quiet"));
  CHECK(params.text("reduction") == "pca");
  CHECK(params.vector("x0") == Vector::Ones(2));
  CHECK(params.matrix("gain") == Matrix::Ones(2, 3));
  CHECK(params.set_form("X0").lines() == 2);
}

TEST_CASE("every problem is reported at once, each with its place") {
  Params params;
  params.set("max_generators", 0)
      .set("epsilon", not_a_number)
      .set("quiet", 1)
      .set("reduction", "girad")
      .set("max_generatrs", 3)
      .set("a/b~c", 1);
  const auto problems = everything().complete(params);
  REQUIRE(problems.size() == 6);
  CHECK(problems[0].pointer == "/a~1b~0c");
  CHECK(problems[1].pointer == "/max_generatrs");
  CHECK(problems[1].message == "unknown parameter");
  CHECK(problems[1].suggestion == "did you mean \"max_generators\"?");
  CHECK(problems[2].pointer == "/max_generators");
  CHECK(problems[2].message == "is 0, must lie in [1, 1000]");
  CHECK(problems[3].pointer == "/epsilon");
  CHECK(problems[4].message == "is an integer, must be true or false");
  CHECK(problems[5].suggestion == "did you mean \"girard\"?");
}

TEST_CASE("an integer becomes real where a real is asked for, never the other way round") {
  Params params;
  params.set("epsilon", 1);
  CHECK(everything().complete(params).empty());
  CHECK(params.real("epsilon") == 1.0);
  const Diagnostic problem = only_problem(everything(), Params().set("max_generators", 30.0));
  CHECK(problem.message == "is a real number, must be an integer");
  CHECK(problem.suggestion == "write 30");
  CHECK(only_problem(everything(), Params().set("max_generators", 30.5)).suggestion.empty());

  ParamSchema wide;
  wide.real("x", "any number", {}, -infinity, infinity);
  Params exact, inexact;
  exact.set("x", std::int64_t{1} << 53);
  CHECK(wide.complete(exact).empty());
  CHECK(only_problem(wide, inexact.set("x", (std::int64_t{1} << 53) + 1)).pointer == "/x");
}

TEST_CASE("NaN and infinite numbers are refused everywhere, also without limits") {
  ParamSchema schema;
  schema.real("x", "any number", {}, -infinity, infinity)
      .vector("v", "vector")
      .matrix("m", "matrix")
      .set("s", "set");
  for (const double number : {not_a_number, infinity, -infinity}) {
    CHECK(only_problem(schema, Params().set("x", number)).pointer == "/x");
    CHECK(only_problem(schema, Params().set("v", Vector(Vector::Constant(2, number)))).pointer ==
          "/v");
    CHECK(only_problem(schema, Params().set("m", Matrix(Matrix::Constant(2, 2, number)))).pointer ==
          "/m");
    LineForm set = make_space(2);
    set.c[1] = number;
    CHECK(only_problem(schema, Params().set("s", set)).pointer == "/s");
  }
}

TEST_CASE("the limits belong to the range; one-sided limits are named as such") {
  ParamSchema schema;
  schema.real("above", "a", {}, 2.0, infinity).real("below", "b", {}, -infinity, 2.0);
  Params edge;
  CHECK(schema.complete(edge.set("above", 2.0).set("below", 2.0)).empty());
  CHECK(only_problem(schema, Params().set("above", 1.5)).message == "is 1.5, must be at least 2");
  CHECK(only_problem(schema, Params().set("below", 2.5)).message == "is 2.5, must be at most 2");
}

TEST_CASE("a required parameter must be there") {
  ParamSchema schema;
  schema.matrix("gain", "observer gain").required();
  const Diagnostic problem = only_problem(schema, {});
  CHECK(problem.pointer == "/gain");
  CHECK(problem.message == "is missing");
  CHECK(problem.suggestion == "give a matrix: observer gain");
}

TEST_CASE("a schema without parameters says so") {
  CHECK(only_problem({}, Params().set("x", 1)).suggestion == "there are none");
}

TEST_CASE("a schema that contradicts itself is refused where it is written") {
  const auto refused = [](auto&& write) {
    return code_of([&] {
             ParamSchema s;
             write(s);
           }) == Errc::invalid;
  };
  CHECK(refused([](ParamSchema& s) { s.flag("a", "x", true).flag("a", "x", true); }));
  CHECK(refused([](ParamSchema& s) { s.integer("a", "x", 11, 0, 10); }));
  CHECK(refused([](ParamSchema& s) { s.real("a", "x", not_a_number, 0, 10); }));
  CHECK(refused([](ParamSchema& s) { s.real("a", "x", {}, 1, 0); }));
  CHECK(refused([](ParamSchema& s) { s.real("a", "x", {}, not_a_number, 0); }));
  CHECK(refused([](ParamSchema& s) { s.choice("a", "x", {}, ""); }));
  CHECK(refused([](ParamSchema& s) { s.choice("a", "x", {"b"}, "c"); }));
  CHECK(refused([](ParamSchema& s) { s.flag("", "x", true); }));
  CHECK(refused([](ParamSchema& s) { s.flag("a", "x", true).required(); }));
  CHECK(refused([](ParamSchema& s) { s.required(); }));
  CHECK(refused([](ParamSchema& s) { s.or_at_most("b"); }));
  CHECK(refused([](ParamSchema& s) { s.real("a", "x", 0, 0, 1).or_at_most("b"); }));
}

TEST_CASE("asking for an absent name or another type throws") {
  Params params;
  params.set("n", 3);
  CHECK(code_of([&] { params.real("n"); }) == Errc::invalid);
  CHECK(code_of([&] { params.integer("m"); }) == Errc::invalid);
  CHECK_THROWS_WITH(params.real("n"), "parameter \"n\" is an integer, asked for as a real number");
}

TEST_CASE("property: complete parameters are complete, and completing again changes nothing") {
  CHECK(rc::check([](std::int64_t generators, double epsilon, bool quiet) {
    Params params;
    params.set("max_generators", generators).set("epsilon", epsilon).set("quiet", quiet);
    const auto problems = everything().complete(params);
    const std::size_t expected =
        (generators < 1 || generators > 1000) + !(epsilon >= 0 && epsilon <= 1);
    RC_ASSERT(problems.size() == expected);
    Params again = params;
    RC_ASSERT(everything().complete(again).size() == expected);
    RC_ASSERT(again.values().size() == params.values().size());
    RC_ASSERT(again.flag("quiet") == quiet);
  }));
}
