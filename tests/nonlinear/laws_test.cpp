// SPDX-License-Identifier: GPL-3.0-or-later
// What every method has to keep to: linear models are estimated as by linear observers, scaled
// states and permuted ones alike, and larger sets have larger images.
#include <cstdint>
#include <cstdio>
#include <random>
#include <regex>

#include <doctest/doctest.h>

#include "cordon/solvers/set_questions.hpp"
#include "input_design/plugins.hpp"
#include "nonlinear/methods.hpp"
#include "nonlinear/reference.hpp"
#include "observers/nonlinear/affine_rows.hpp"

using namespace cordon;
using namespace cordon::test;
using estimators::NonlinearRecursion;

namespace {

using Random = std::mt19937_64;

Matrix random_matrix(Random& random, Index rows, Index columns) {
  Matrix made(rows, columns);
  for (double& entry : made.reshaped())
    entry = std::uniform_real_distribution<double>(-1, 1)(random);
  return made;
}

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

/// "0.5*x1 + -2*x2 + 1*w1"
std::string sum(const Eigen::RowVectorXd& coefficients, const std::vector<std::string>& names) {
  std::string text;
  for (Index i = 0; i < coefficients.size(); ++i)
    text += (i > 0 ? " + " : "") + ("(" + number(coefficients[i]) + ")*" + names[as_size(i)]);
  return text;
}

std::vector<std::string> numbered(const char* letter, Index count) {
  std::vector<std::string> names;
  for (Index i = 1; i <= count; ++i) names.push_back(letter + std::to_string(i));
  return names;
}

Json zonotope_json(const Vector& center, const Matrix& generators) {
  Json set = {{"center", std::vector<double>(center.begin(), center.end())}};
  for (Index i = 0; i < generators.rows(); ++i) {
    const Eigen::RowVectorXd row = generators.row(i);
    set["generators"].push_back(std::vector<double>(row.begin(), row.end()));
  }
  return set;
}

struct Linear {
  Matrix A, Bw, C, Dv;
  Json system;
};

Linear random_linear(Random& random, Index n, Index outputs) {
  Linear made{random_matrix(random, n, n),
              random_matrix(random, n, 2),
              random_matrix(random, outputs, n),
              Matrix::Identity(outputs, outputs),
              {}};
  std::vector<std::string> x = numbered("x", n), w = numbered("w", 2), v = numbered("v", outputs);
  made.system = {{"states", x}, {"disturbances", w}, {"noises", v}};
  const auto joined = [](std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  for (Index i = 0; i < n; ++i) {
    Eigen::RowVectorXd row(n + 2);
    row << made.A.row(i), made.Bw.row(i);
    made.system["f"].push_back(sum(row, joined(x, w)));
  }
  for (Index i = 0; i < outputs; ++i) {
    Eigen::RowVectorXd row(n + outputs);
    row << made.C.row(i), made.Dv.row(i);
    made.system["g"].push_back(sum(row, joined(x, v)));
  }
  made.system["X0"] = zonotope_json(random_matrix(random, n, 1), random_matrix(random, n, n + 1));
  made.system["W"] = zonotope_json(random_matrix(random, 2, 1), 0.1 * random_matrix(random, 2, 2));
  made.system["V"] = zonotope_json(Vector::Zero(outputs), 0.1 * Matrix::Identity(outputs, outputs));
  return made;
}

/// Methods that carry a set of their backend, without contraction and box.
std::vector<Method> set_methods() {
  std::vector<Method> made;
  for (const Method& method : methods())
    if (!method.options.boxes_only && !method.options.contracts) made.push_back(method);
  made.push_back(
      {"zonotope_first_order", "zonotope", options(AffineForm::first_order, false, false, true)});
  return made;
}

}  // namespace

TEST_CASE("linear models written as formulas have the sets of linear recursions") {
  Random random(5);
  for (int seed = 0; seed < 20; ++seed) {
    const Index n = 2 + seed % 3, outputs = 1 + seed % 2;
    const Linear linear = random_linear(random, n, outputs);
    const Model model = model_of(linear.system);
    for (const Method& method : set_methods()) {
      CAPTURE(seed);
      CAPTURE(std::string(method.reference));
      const auto backend = examples::backend(method.backend);
      const Enclosure W = backend->import(model.W), V = backend->import(model.V);
      NonlinearRecursion recursion(model, backend, method.options);
      Enclosure X = backend->import(model.X0);
      Vector x = model.X0.c;
      recursion.start(X);
      for (Index k = 0; k < 5; ++k) {
        const Vector y = linear.C * x;
        if (k > 0) {
          recursion.predict(Vector(), k - 1);
          const Term terms[] = {{linear.Bw, W}};
          X = backend->predict(X, {linear.A, Vector::Zero(n), terms});
        }
        REQUIRE(recursion.correct({k, Vector(), y}));
        for (Index row = 0; row < outputs; ++row) {
          const bool all = !method.options.row_by_row;
          if (all && row > 0) break;
          const Matrix C = all ? linear.C : Matrix(linear.C.row(row)),
                       D = all ? linear.Dv : Matrix(linear.Dv.row(row));
          X = backend->correct(X, {C, all ? y : Vector(y.segment(row, 1)), {D, V}});
        }
        for (int i = 0; i < 20; ++i) {
          const Vector d = random_matrix(random, n, 1);
          const double wanted = X->support(d), terms = 1 + std::abs(wanted);
          CAPTURE(k);
          CHECK(std::abs(recursion.set()->support(d) - wanted) <= 1e-12 * terms);
        }
        x = linear.A * x + linear.Bw * model.W.c;
      }
    }
  }
}

TEST_CASE("linear models written as formulas have the boxes of interval arithmetic") {
  Random random(7);
  for (int seed = 0; seed < 20; ++seed) {
    const Index n = 2 + seed % 3;
    const Linear linear = random_linear(random, n, 1);
    const Model model = model_of(linear.system);
    const Box W = interval_hull(model.W);
    for (const Method& method : methods()) {
      if (!method.options.boxes_only) continue;
      CAPTURE(seed);
      CAPTURE(std::string(method.reference));
      const auto backend = examples::backend(method.backend);
      NonlinearRecursion recursion(model, backend, method.options);
      recursion.start(backend->import(model.X0));
      Box box = recursion.box();
      for (Index k = 0; k < 5; ++k) {
        REQUIRE(recursion.predict(Vector(), k));
        const Vector center = linear.A * box.center() + linear.Bw * W.center(),
                     radius =
                         linear.A.cwiseAbs() * box.radius() + linear.Bw.cwiseAbs() * W.radius();
        box = {center - radius, center + radius};
        const double size = 1 + box.center().cwiseAbs().maxCoeff() + box.radius().maxCoeff();
        CHECK((recursion.box().lower - box.lower).cwiseAbs().maxCoeff() <= 1e-12 * size);
        CHECK((recursion.box().upper - box.upper).cwiseAbs().maxCoeff() <= 1e-12 * size);
      }
    }
  }
}

namespace {

/// The system in states that are `scale` times as large.
Json scaled(Json system, const std::vector<double>& scale) {
  const std::vector<std::string> names = system["states"];
  const auto replaced = [&](std::string formula) {
    for (std::size_t i = 0; i < names.size(); ++i)
      formula = std::regex_replace(formula, std::regex("\\b" + names[i] + "\\b"),
                                   "(" + names[i] + "/" + number(scale[i]) + ")");
    return formula;
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    system["f"][i] = number(scale[i]) + "*(" + replaced(system["f"][i]) + ")";
    system["X0"]["center"][i] = scale[i] * system["X0"]["center"][i].get<double>();
    for (Json& entry : system["X0"]["generators"][i]) entry = scale[i] * entry.get<double>();
  }
  for (const char* rows : {"g", "invariants"}) {
    if (!system.contains(rows)) continue;
    for (Json& row : system[rows]) row = replaced(row);
  }
  return system;
}

/// The hulls of the example's first steps.
std::vector<Box> hulls_of(const Model& model, const Json& example, const Method& method) {
  const auto backend = examples::backend(method.backend);
  NonlinearRecursion recursion(model, backend, method.options);
  std::vector<Box> hulls;
  recursion.start(backend->import(model.X0));
  for (std::size_t k = 0; k < 6; ++k) {
    if (k > 0) recursion.predict(vector_of(example["u"][k - 1]), static_cast<Index>(k) - 1);
    REQUIRE(recursion.correct(
        {static_cast<Index>(k), vector_of(example["u"][k]), vector_of(example["y"][k])}));
    hulls.push_back(recursion.box());
  }
  return hulls;
}

}  // namespace

TEST_CASE("states in other units have the same sets in other units") {
  const std::vector<double> scale{3e4, 7e-4};
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    const Model model = model_of(example["system"]),
                other = model_of(scaled(example["system"], scale));
    for (const Method& method : methods()) {
      // Strips of smallest size are those of their unit.
      if (std::string(method.backend) == "zonotope") continue;
      CAPTURE(example["name"].get<std::string>());
      CAPTURE(std::string(method.reference));
      const std::vector<Box> hulls = hulls_of(model, example, method),
                             others = hulls_of(other, example, method);
      for (std::size_t k = 0; k < hulls.size(); ++k) {
        for (Index i = 0; i < 2; ++i) {
          CAPTURE(k);
          CAPTURE(i);
          const double size = 1 + std::abs(hulls[k].upper[i]);
          CHECK(std::abs(others[k].upper[i] / scale[as_size(i)] - hulls[k].upper[i]) <=
                1e-9 * size);
          CHECK(std::abs(others[k].lower[i] / scale[as_size(i)] - hulls[k].lower[i]) <=
                1e-9 * size);
        }
      }
    }
  }
}

TEST_CASE("a smaller start has smaller boxes at the next step") {
  Random random(6);
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    const Model model = model_of(example["system"]);
    const Box outer = interval_hull(model.X0);
    formulas::Evaluator f(model.nonlinear->f, Rounding::nominal);
    for (int i = 0; i < 200; ++i) {
      std::vector<Interval> box, within;
      for (Index j = 0; j < outer.dim(); ++j) {
        box.push_back({outer.lower[j], outer.upper[j]});
        double a = std::uniform_real_distribution<double>(outer.lower[j], outer.upper[j])(random),
               b = std::uniform_real_distribution<double>(outer.lower[j], outer.upper[j])(random);
        within.push_back({std::min(a, b), std::max(a, b)});
      }
      for (Index j = outer.dim(); j < model.nonlinear->f->variables(); ++j) {
        box.push_back({-0.1, 0.1});
        within.push_back({-0.05, 0.1});
      }
      f.evaluate(box);
      std::vector<Interval> values;
      for (Index row = 0; row < outer.dim(); ++row) values.push_back(f.value(row));
      f.evaluate(within);
      for (Index row = 0; row < outer.dim(); ++row) {
        CHECK(f.value(row).lower >= values[as_size(row)].lower);
        CHECK(f.value(row).upper <= values[as_size(row)].upper);
      }
    }
  }
}

TEST_CASE("affine rows hold what the rounding of their offset is off by") {
  // (x - k) x at x = k is 0 with slope k: k² + offset is off by no more than the radius, in
  // integers.
  const auto product = function_of({{"states", {"x"}}}, "disturbances", {"(x - k)*x"});
  formulas::BoxEnclosure enclosure(product, 1, AffineForm::first_order, Rounding::outward);
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t x =
        2 * std::uniform_int_distribution<std::int64_t>(1 << 29, (1 << 30) - 1)(random) + 1;
    const auto at = static_cast<double>(x);
    enclosure.set_box(std::vector<Interval>{{at, at}, {at, at}});
    const estimators::AffineRows rows = estimators::affine_rows(enclosure, {0});
    REQUIRE(rows.slope(0, 0) == at);
    const std::int64_t off = x * x + static_cast<std::int64_t>(rows.offset[0]);
    CAPTURE(x);
    CHECK(std::abs(off) <= static_cast<std::int64_t>(rows.radius[0]));
    CHECK(rows.radius[0] <= 0x1p-50 * at * at);
  }
}
