// SPDX-License-Identifier: GPL-3.0-or-later
// Images whose squares and products of factors are kept: points of the set stay inside with the
// factors that they have, and what is narrower than the box of all remainders is so.
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/set_questions.hpp"
#include "input_design/plugins.hpp"
#include "nonlinear/methods.hpp"
#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"
#include "observers/nonlinear/lifted_image.hpp"

using namespace cordon;
using namespace cordon::test;
using namespace cordon::estimators;

namespace {

/// Rows over x1 … xn, without w, u and k.
std::shared_ptr<const formulas::Function> rows_over(const std::vector<std::string>& states,
                                                    const std::vector<std::string>& rows) {
  return function_of({{"states", states}}, "disturbances", rows);
}

struct Image {
  Image(const std::vector<std::string>& states, const std::vector<std::string>& formulas,
        const LineForm& set, bool outward = false)
      : Z(set),
        f(rows_over(states, formulas), set.dim(), formulas::AffineForm::first_order,
          outward ? Rounding::outward : Rounding::nominal) {
    const Box hull = interval_hull(Z);
    std::vector<Interval> variables;
    for (Index i = 0; i < hull.dim(); ++i) variables.push_back({hull.lower[i], hull.upper[i]});
    variables.push_back({0, 0});  // k
    f.set_box(variables);
    made = lifted_image(f, affine_rows(f, all_rows(f.function().rows())), Z, outward);
  }
  /// The values of the formulas.
  Vector at(const Vector& x) const {
    formulas::Evaluator evaluator(std::make_shared<formulas::Function>(f.function()),
                                  Rounding::nominal);
    std::vector<Interval> point;
    for (const double each : x) point.push_back({each, each});
    point.push_back({0, 0});
    evaluator.evaluate(point);
    Vector values(evaluator.function().rows());
    for (Index q = 0; q < values.size(); ++q) values[q] = evaluator.value(q).lower;
    return values;
  }
  Box hull() const {
    Box box = interval_hull(made->set);
    box.lower -= made->radius;
    box.upper += made->radius;
    return box;
  }

  LineForm Z;
  formulas::BoxEnclosure f;
  std::optional<LiftedImage> made;
};

/// ξ, its squares as 2 ξ² - 1, and its products.
Vector lifted_factors(const Vector& xi, Index count) {
  Vector all = Vector::Zero(count);
  Index at = 0;
  for (const double each : xi) all[at++] = each;
  for (const double each : xi) all[at++] = 2 * each * each - 1;
  for (Index i = 0; i < xi.size(); ++i)
    for (Index j = i + 1; j < xi.size(); ++j) all[at++] = xi[i] * xi[j];
  return all;
}

const std::vector<std::vector<std::string>> examples_of_rows = {
    {"x1*(3 - x1/7 - 4*x2/(4 + x1))", "x2*(-2 + 3*x1/(4 + x1))"},
    {"x1*x2", "x1^2 - x2^2"},
    {"sin(x1)*x2 + exp(x2/2)", "x1 + 0.25*x2"},
    {"abs(x1 - 5) + x2", "sqrt(x1)*x2^3"}};

/// <(5, 0.5), G> with a row through one of its points.
LineForm random_set(std::mt19937_64& random, Index generators, Index constraints, Vector& inside) {
  std::uniform_real_distribution<double> number(-1, 1);
  const auto fill = [&](Index rows, Index columns) {
    return Matrix::NullaryExpr(rows, columns, [&] { return number(random); }).eval();
  };
  inside = fill(generators, 1);
  LineForm set = make_zonotope(Vector{{5, 0.5}}, 0.2 * fill(2, generators));
  set.A = fill(constraints, generators);
  set.S = Matrix(constraints, 0);
  set.b = set.A * inside;
  return set;
}

}  // namespace

TEST_CASE("points keep their factors: values are within the radius, constraints hold") {
  std::mt19937_64 random(3);
  for (const auto& rows : examples_of_rows) {
    for (int i = 0; i < 200; ++i) {
      Vector xi;
      const Index generators = 2 + i % 6, constraints = i % 3;
      const bool outward = i % 2 == 1;
      const LineForm Z = random_set(random, generators, constraints, xi);
      const Image image({"x1", "x2"}, rows, Z, outward);
      REQUIRE(image.made);
      const LineForm& set = image.made->set;
      const Vector factors = lifted_factors(xi, set.generators());
      const Vector value = image.at(Z.c + Z.G * xi), kept = set.c + set.G * factors;
      CAPTURE(rows[0]);
      CAPTURE(i);
      for (Index q = 0; q < value.size(); ++q)
        CHECK(std::abs(value[q] - kept[q]) <= image.made->radius[q] + 1e-13);
      CHECK((set.A * factors - set.b).lpNorm<1>() <= 1e-12);
      const Index products = outward ? constraints * (constraints + 1) / 2 : 0;
      CHECK(set.constraints() == constraints + products);
      CHECK(set.generators() == generators * (generators + 3) / 2 + products);
    }
  }
}

TEST_CASE("a square is exact: where boxes of remainders are on both sides, it is on one") {
  // Along x1 = x2 = ξ the product is ξ² in [0, 1], and the difference of squares 0.
  const Image image({"x1", "x2"}, {"x1*x2", "x1^2 - x2^2"},
                    make_zonotope(Vector{{0, 0}}, Matrix{{1}, {1}}));
  REQUIRE(image.made);
  const Box hull = image.hull();
  CHECK(hull.lower[0] == doctest::Approx(0).epsilon(1e-14));
  CHECK(hull.upper[0] == doctest::Approx(1));
  CHECK(hull.upper[1] - hull.lower[1] <= 1e-13);
  CHECK(image.f.range(0).lower <= -0.99);
}

TEST_CASE("products of constraints say what squares and products are") {
  // ξ1 = ξ2 / 2: x1 x2 = ξ1 ξ2 = 2 ξ1².
  LineForm Z = make_zonotope(Vector{{0, 0}}, Matrix::Identity(2, 2));
  Z.A = Matrix{{1, -0.5}};
  Z.S = Matrix(1, 0);
  Z.b = Vector{{0}};
  const Image with({"x1", "x2"}, {"x1*x2", "x2"}, Z, true);
  REQUIRE(with.made);
  LineForm alone = with.made->set;
  alone.A.conservativeResize(1, Eigen::NoChange);
  alone.S.conservativeResize(1, Eigen::NoChange);
  alone.b.conservativeResize(1);
  // ½ ζ_1 + ⅛ ζ_2 - ζ_12 = -⅝
  CHECK(interval_hull(with.made->set).lower[0] >= -1e-9);
  CHECK(interval_hull(alone).lower[0] <= -0.9);
}

TEST_CASE("what cannot be lifted is said, and rows without second derivatives are affine") {
  LineForm lines = make_space(1);
  formulas::BoxEnclosure f(rows_over({"x1"}, {"x1^2"}), 1, formulas::AffineForm::first_order,
                           Rounding::nominal);
  f.set_box(std::vector<Interval>{{-1, 1}, {0, 0}});
  const AffineRows rows = affine_rows(f, all_rows(1));
  CHECK_FALSE(lifted_image(f, rows, lines, false));
  CHECK_FALSE(lifted_image(f, rows, make_zonotope(Vector{{0}}, Matrix::Ones(1, 201)), false));
  const Image kink({"x1"}, {"abs(x1)"}, make_zonotope(Vector{{0.5}}, Matrix{{1}}));
  REQUIRE(kink.made);
  CHECK(kink.made->set.G.rightCols(1).isZero());
  CHECK(kink.hull().lower[0] <= 0);
  CHECK(kink.hull().upper[0] >= 1.5);
}

TEST_CASE("linear formulas have the set of the first order") {
  const Image image({"x1", "x2"}, {"0.5*x1 - x2 + 1", "x1/3"},
                    make_zonotope(Vector{{1, 2}}, Matrix{{1, 0.5, 0}, {0, 0.25, 1}}));
  REQUIRE(image.made);
  const LineForm& set = image.made->set;
  CHECK(set.G.rightCols(set.generators() - 3).isZero());
  CHECK((set.c - Vector{{-0.5, 1.0 / 3}}).cwiseAbs().maxCoeff() <= 1e-15);
  CHECK(image.made->radius.maxCoeff() <= 1e-14);
}

TEST_CASE(
    "where constraints cut most of the factors away, lifted sets do not grow beside the box") {
  // The outputs share one noise: sets become a millionth of their factors' box.
  const Json system = {
      {"states", {"x", "y"}},
      {"disturbances", {"w"}},
      {"noises", {"v"}},
      {"f", {"0.9*x + 0.1*sin(1/x) + w", "0.5*y + 0.3*atan(tan(x)) + 0.1*exp(-x^-2)"}},
      {"g", {"atan(1/x) + v", "x*y + v"}},
      {"X0", {{"center", {0.5, 0}}, {"generators", {{1.5, 0}, {0, 1}}}}},
      {"W", {{"center", {0}}, {"generators", {{0.05}}}}},
      {"V", {{"center", {0}}, {"generators", {{0.1}}}}}};
  Model model = model_of(system);
  auto assumed = std::make_shared<NonlinearModel>(*model.nonlinear);
  assumed->undefined = formulas::Undefined::assumed;
  model.nonlinear = assumed;
  for (const char* backend : {"constrained_zonotope", "line_zonotope"}) {
    for (const Budget budget : {Budget{30, 10}, Budget{15, 4}}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(std::string(backend));
        CAPTURE(seed);
        NonlinearOptions chosen = options(AffineForm::first_order, true, true, false);
        chosen.lifts = true;
        chosen.budget = budget;
        const auto made = examples::backend(backend);
        NonlinearRecursion recursion(model, made, chosen);
        Trajectory trajectory(model, seed);
        recursion.start(made->import(model.X0));
        for (Index k = 0; k < 20; ++k) {
          REQUIRE(recursion.correct({k, Vector(), trajectory.output(Vector(), k)}));
          recursion.reduce();
          REQUIRE(recursion.box().contains(trajectory.x()));
          REQUIRE(recursion.set()->contains(trajectory.x()) != Answer::no);
          const LineForm set = recursion.set()->line_form();
          REQUIRE(set.G.cwiseAbs().rowwise().sum().maxCoeff() <= 100);
          recursion.predict(Vector(), k);
          trajectory.advance(Vector(), k);
        }
      }
    }
  }
}

TEST_CASE("trajectories stay inside of lifted sets, whose budgets are small") {
  const Json all = reference();
  int enclosed = 0;
  for (const Json& example : all["examples"]) {
    if (example["name"] == "heading") continue;  // disturbances leave its invariant
    const auto model = model_of(example["system"]);
    for (const char* backend : {"zonotope", "constrained_zonotope", "line_zonotope"}) {
      for (const char* rounding : {"nominal", "outward"}) {
        NonlinearOptions chosen = options(AffineForm::first_order, true, true, true);
        chosen.row_by_row = std::string(backend) == "zonotope";
        chosen.lifts = true;
        chosen.budget = {10, 3};
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          CAPTURE(example["name"].get<std::string>());
          CAPTURE(std::string(backend));
          CAPTURE(seed);
          Params params;
          params.set("rounding", rounding);
          const auto made = examples::registry().make<BackendEntry>(backend, params);
          NonlinearRecursion recursion(model, made, chosen);
          Trajectory trajectory(model, seed);
          recursion.start(made->import(model.X0));
          for (Index k = 0; k < 8; ++k) {
            const Vector u = vector_of(example["u"][as_size(k) % example["u"].size()]);
            REQUIRE(recursion.correct({k, u, trajectory.output(u, k)}));
            recursion.reduce();
            REQUIRE(recursion.box().contains(trajectory.x()));
            REQUIRE(recursion.set()->contains(trajectory.x()) != Answer::no);
            ++enclosed;
            recursion.predict(u, k);
            trajectory.advance(u, k);
          }
        }
      }
    }
  }
  CHECK(enclosed > 300);
}
