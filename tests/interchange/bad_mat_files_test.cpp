// SPDX-License-Identifier: GPL-3.0-or-later
// MAT-files without a system that can be read: what is wrong is told by its field.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/experiments/interchange.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "interchange/mat_variables.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using namespace interchange_test;

TEST_CASE("two variables of one name are an error") {
  const Scratch scratch;
  const std::string again = mat::to_bytes({{"A", mat::matrix(Matrix{{5, 0}, {0, 5}})}});
  put(scratch / "in.mat", mat::to_bytes(plain()) + again.substr(128));  // without the header
  CHECK_THROWS_WITH_AS(mat_to_json(scratch / "in.mat", {scratch / "out.json"}),
                       doctest::Contains("stands there twice"), InputError);
  CHECK_FALSE(std::filesystem::exists(scratch / "out.json"));
}

TEST_CASE("which variable is taken") {
  const Scratch scratch;
  mat::Struct one, two;
  for (mat::Struct* s : {&one, &two}) {
    for (const mat::Variable& v : plain()) s->set(v.name, v.value);
  }
  one.set("C1", mat::number(1));
  const Value first = std::move(one).value(), second = std::move(two).value();
  const ImportedStudy imported = mat_to_json(
      mat_of(scratch, {{"plant", first}, {"x", mat::number(1)}}), {scratch / "out.json"});
  CHECK(imported.ignored == std::vector<std::string>{"C1"});
  const auto several = problems_of({{"plant", first}, {"other", second}});
  REQUIRE(several.size() == 1);
  CHECK(several[0].suggestion.find("--variable") != std::string::npos);
  CHECK(several[0].suggestion.find("plant") != std::string::npos);
  CHECK(problems_of({{"plant", first}, {"system", second}}).empty());
  CHECK(problems_of({{"plant", first}, {"other", second}}, "other").empty());
  CHECK(problems_of({{"plant", first}}, "plantt")[0].suggestion.find("plant") != std::string::npos);
  CHECK(problems_of({{"x", mat::number(1)}})[0].message.find("no system and no sets") !=
        std::string::npos);
  CHECK(problems_of({{"x", mat::number(1)}}, "x")[0].message.find("neither a system nor sets") !=
        std::string::npos);
}

TEST_CASE("what is wrong in a system is told by its field") {
  const double nan = std::nan("");
  expect_problem(with(plain(), "A", mat::matrix(Matrix{{1, nan}, {0, 1}})), "/A",
                 "holds NaN in row 1, column 2");
  expect_problem(with(plain(), "A", mat::matrix(Matrix{{1, infinity}, {0, 1}})), "/A",
                 "holds Inf in row 1, column 2");
  expect_problem(with(plain(), "A", mat::text("x")), "/A", "is a text");
  expect_problem(with(plain(), "C", mat::matrix(Matrix{{1, 0, 0}})), "/C", "must have 2 columns");
  expect_problem(with(plain(), "W", mat::number(1)), "/W",
                 "must be a struct with the fields of a set");
  expect_problem(with(plain(), "W", box(Matrix{{nan}, {1}}, Matrix{{2}, {2}})), "/W/lower",
                 "holds NaN");
  expect_problem(with(plain(), "W", box(Matrix{{3}, {1}}, Matrix{{2}, {2}})), "/W/lower/0",
                 "above the upper bound");
  expect_problem(with(plain(), "W", box(Matrix{{1, 1}, {1, 1}}, Matrix{{2}, {2}})), "/W/lower",
                 "must be a vector");
  expect_problem(with(plain(), "V", box(Matrix{{1}, {1}}, Matrix{{2}, {2}})), "/V",
                 "has dimension 2");
  expect_problem(with(plain(), "Ts", mat::number(0)), "/Ts", "continuous time");
  expect_problem(with(plain(), "type", mat::text("ltti")), "/type", "unknown choice");
  expect_problem(with(plain(), "modes", mat::number(1)), "/modes", "must be a struct array");
  CHECK(problems_of(with(plain(), "Ts", mat::number(0.1))).empty());
  mat::Struct set;
  set.set("type", mat::text("zonotope"))
      .set("c", mat::matrix(Matrix{{0}, {0}}))
      .set("A", mat::matrix(Matrix{{1}}))
      .set("b", mat::number(1));
  const auto problems = problems_of(with(plain(), "W", std::move(set).value()));
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].message.find("does not belong to a set of type") != std::string::npos);
  mat::Struct unknown;
  unknown.set("type", mat::text("zonotop")).set("c", mat::matrix(Matrix{{0}, {0}}));
  CHECK(problems_of(with(plain(), "W", std::move(unknown).value()))[0].suggestion.find(
            "zonotope") != std::string::npos);
}

TEST_CASE("data that are wrong") {
  const auto data = [](const char* name, Matrix numbers) {
    mat::Struct all;
    for (const auto& [key, value] : std::vector<std::pair<std::string, Matrix>>{
             {"u", Matrix{{1, 2}}}, {"y", Matrix{{1, 2}}}, {"mode", Matrix{{0, 0}}}}) {
      all.set(key, mat::matrix(key == name ? numbers : value));
    }
    return with(plain(), "data", std::move(all).value());
  };
  CHECK(problems_of(data("", Matrix())).empty());
  expect_problem(data("u", Matrix{{1, 2, 3}}), "/data/u", "has 3 samples, the others have 2");
  expect_problem(data("u", Matrix(0, 0)), "/data/u", "is missing");
  expect_problem(data("y", Matrix{{1, INFINITY}}), "/data/y", "holds Inf in sample 2");
  expect_problem(data("y", Matrix{{1, 2, 3}, {4, 5, 6}}), "/data/y", "is 2 × 3, must have 1 row");
  expect_problem(data("mode", Matrix{{0, 1}}), "/data/mode", "holds 1 in sample 2");
  expect_problem(data("mode", Matrix{{0, -2}}), "/data/mode", "holds -2 in sample 2");
  expect_problem(data("mode", Matrix{{0.5, 0}}), "/data/mode", "holds 0.5 in sample 1");
}
