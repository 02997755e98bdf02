// SPDX-License-Identifier: GPL-3.0-or-later
// Where a formula is not defined for all of an estimate: the method says so, or goes on under what
// the study assumes, and what it then says holds.
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "input_design/plugins.hpp"
#include "nonlinear/methods.hpp"
#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"

using namespace cordon;
using namespace cordon::test;
using estimators::NonlinearRecursion;

namespace {

/// One state in [lower, upper] that goes where `formula` of x says, with w and v of ± 0.01.
Model model_of_formula(const std::string& formula, double lower, double upper) {
  Json system = {{"states", {"x"}}, {"disturbances", {"w"}}, {"noises", {"v"}}};
  system["f"] = {formula + " + w"};
  system["g"] = {"x + v"};
  system["X0"] = system["W"] = system["V"] = {{"center", {0}}, {"generators", {{0.01}}}};
  Model model = model_of(system);
  model.X0 = make_box({Vector{{lower}}, Vector{{upper}}});
  return model;
}

Model with(Model model, formulas::Undefined undefined, std::optional<LineForm> admissible) {
  auto formulas = std::make_shared<NonlinearModel>(*model.nonlinear);
  formulas->undefined = undefined;
  formulas->admissible = std::move(admissible);
  model.nonlinear = std::move(formulas);
  return model;
}

/// The box of x at the next time, without a sample of it.
Box successor(const Model& model, const Method& method, const char* rounding = "nominal") {
  Params params;
  params.set("rounding", rounding);
  const auto backend = examples::registry().make<BackendEntry>(method.backend, params);
  NonlinearRecursion recursion(model, backend, method.options);
  REQUIRE(recursion.start(backend->import(model.X0)));
  REQUIRE(recursion.predict(Vector(), 0));
  REQUIRE(recursion.correct(missing_outputs({1, Vector(), Vector{{0.0}}}, {0})));
  return recursion.box();
}

}  // namespace

TEST_CASE("formulas that are not defined for all of a set: refused with the place, never a box") {
  struct Undefined {
    const char* formula;
    double lower, upper;
    const char* part;
  };
  const Undefined all[] = {{"sqrt(x)", -1e-300, 1, "sqrt(x)"},
                           {"1/x", -1, 1, "1/x"},
                           {"log(x)", 0, 1, "log(x)"},
                           {"tan(x)", 1.5, 1.6, "tan(x)"},
                           {"asin(x)", 0, 1 + 0x1p-40, "asin(x)"},
                           {"x^-2", -1, 0, "x^-2"},
                           {"x^0.7", -1, 1, "x^0.7"},
                           {"exp(1000*x)", 0, 1, "overflow"}};
  for (const Undefined& each : all) {
    const Model model = model_of_formula(each.formula, each.lower, each.upper);
    for (const Method& method : methods()) {
      CAPTURE(std::string(each.formula));
      CAPTURE(std::string(method.reference));
      const auto backend = examples::backend(method.backend);
      NonlinearRecursion recursion(model, backend, method.options);
      REQUIRE(recursion.start(backend->import(model.X0)));
      try {
        recursion.predict(Vector(), 0);
        recursion.correct({1, Vector(), Vector{{0.5}}});
        FAIL_CHECK("a box of what is not defined");
      } catch (const Error& error) {
        CHECK(error.code() == Errc::not_enclosed);
        CHECK(std::string(error.what()).find(each.part) != std::string::npos);
      }
    }
  }
}

TEST_CASE("domains that are assumed make formulas defined, and hold their values there") {
  struct Assumed {
    const char* formula;
    double lower, upper;  ///< of the start
    double from, to;      ///< the values on the part of it where the formula is defined
  };
  const double quarter = 0.5 * 3.141592653589793;
  const Assumed all[] = {{"sqrt(x)", -1e-300, 1, 0, 1},
                         {"sqrt(x)", -4, 9, 0, 3},
                         {"asin(x)", 0.5, 1 + 0x1p-40, std::asin(0.5), quarter},
                         {"acos(x)", -2, 0.5, std::acos(0.5), 2 * quarter},
                         {"x^1.5", -1, 4, 0, 8}};
  for (const Assumed& each : all) {
    const Model model = with(model_of_formula(each.formula, each.lower, each.upper),
                             formulas::Undefined::assumed, std::nullopt);
    for (const Method& method : methods()) {
      CAPTURE(std::string(each.formula));
      CAPTURE(std::string(method.reference));
      const Box box = successor(model, method);
      CHECK(box.lower[0] <= each.from - 0.01);
      CHECK(box.upper[0] >= each.to + 0.01);
      CHECK(box.upper[0] - box.lower[0] <= 3 * (each.to - each.from) + 0.02);
    }
  }
}

TEST_CASE("an admissible set within the domain does the same, and cuts what follows") {
  for (const char* formula : {"sqrt(x)", "x^1.5", "log(x) + 2"}) {
    const Model whole = model_of_formula(formula, -1, 2);
    const Model model =
        with(whole, formulas::Undefined::refused, make_box({Vector{{0.25}}, Vector{{1.5}}}));
    formulas::Evaluator f(whole.nonlinear->f, Rounding::outward);
    const auto value = [&](double x) {
      return f.evaluate_row(std::vector<Interval>{{x, x}, {0, 0}, {0, 0}}, 0);
    };
    for (const Method& method : methods()) {
      CAPTURE(std::string(formula));
      CAPTURE(std::string(method.reference));
      const Box box = successor(model, method);
      CHECK(box.lower[0] <= std::max(value(0.25).lower - 0.01, 0.25));
      CHECK(box.upper[0] >= std::min(value(1.5).upper + 0.01, 1.5));
      CHECK(box.lower[0] >= 0.25 - 1e-6);
      CHECK(box.upper[0] <= 1.5 + 1e-6);
    }
  }
}

TEST_CASE("an admissible set may end where a formula's domain ends") {
  struct Ends {
    const char* formula;
    double lower, upper;  ///< of what is admissible
  };
  const Ends all[] = {{"sqrt(x)", 0, 1},         {"sqrt(x)", 0, 1e9},  {"sqrt(1 - x)", -3, 1},
                      {"sqrt(x - 0.5)", 0.5, 9}, {"asin(x)", -1, 1},   {"acos(x) - 2", -1, 0.25},
                      {"x^1.5", 0, 4},           {"sqrt(x) - x", 0, 2}};
  for (const Ends& each : all) {
    const Box admissible{Vector{{each.lower}}, Vector{{each.upper}}};
    const Model model = with(model_of_formula(each.formula, each.lower - 1e-300, each.upper),
                             formulas::Undefined::refused, make_box(admissible));
    formulas::Evaluator f(model.nonlinear->f, Rounding::outward);
    for (const Method& method : methods()) {
      for (const char* rounding : {"nominal", "outward"}) {
        CAPTURE(std::string(each.formula));
        CAPTURE(std::string(method.reference));
        CAPTURE(std::string(rounding));
        const Box box = successor(model, method, rounding);
        for (int i = 0; i <= 16; ++i) {
          const double x = each.lower + i * (each.upper - each.lower) / 16;
          const Interval y = f.evaluate_row(std::vector<Interval>{{x, x}, {0, 0}, {0, 0}}, 0);
          if (y.lower > each.upper || y.upper < each.lower) continue;
          CHECK(box.lower[0] <= y.upper);
          CHECK(box.upper[0] >= y.lower);
        }
      }
    }
  }
}

TEST_CASE("a start outside of all that is admissible is no state, and proven to be none") {
  const Model model = with(model_of_formula("sqrt(x)", -4, -2), formulas::Undefined::refused,
                           make_box({Vector{{0.0}}, Vector{{9.0}}}));
  for (const Method& method : methods()) {
    CAPTURE(std::string(method.reference));
    const auto backend = examples::backend(method.backend);
    NonlinearRecursion recursion(model, backend, method.options);
    CHECK_FALSE(recursion.start(backend->import(model.X0)));
  }
}

TEST_CASE("a kink within the set: all methods go on, and hold both of its sides") {
  const Model model = model_of_formula("abs(x)", -2, 1);
  for (const Method& method : methods()) {
    CAPTURE(std::string(method.reference));
    const Box box = successor(model, method);
    CHECK(box.lower[0] <= -0.01);
    CHECK(box.upper[0] >= 2.01);
    CHECK(box.upper[0] <= 4.02);
  }
}
