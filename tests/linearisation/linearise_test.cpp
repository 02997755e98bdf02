// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/linearisation/linearise.hpp"

#include <cstdlib>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/study.hpp"
#include "linearisation/systems.hpp"

using namespace cordon;

namespace {

struct Example {
  const char* system;
  Box states, inputs;
};

std::vector<Example> examples() {
  return {{tanks, {Vector{{3, 4}}, Vector{{5, 6}}}, {Vector{{1}}, Vector{{1.2}}}},
          {reaction, {Vector{{0.45, 347}}, Vector{{0.55, 353}}}, {Vector{{298}}, Vector{{302}}}},
          {bent, {Vector{{3, 0}}, Vector{{7, 3}}}, {Vector{{-1}}, Vector{{2}}}}};
}

int points() {
  const char* wanted = std::getenv("CORDON_LINEARISED_POINTS");
  return wanted ? std::atoi(wanted) : 20'000;
}

/// Rows of a function at a point, and of the linear model; do they differ by what is left out?
void check_rows(formulas::Evaluator& evaluator, const std::vector<Interval>& point,
                const Matrix& slopes, const std::vector<LinearisedRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<Index>(i);
    Interval left = evaluator.evaluate_row(point, row);
    for (Index j = 0; j < slopes.cols(); ++j)
      left = left - slopes(row, j) * point[static_cast<std::size_t>(j)];
    const double rounding = 1e-12 * (1 + std::abs(evaluator.evaluate_row(point, row).upper));
    const Interval bounds = rows[i].remainder;
    const bool inside = left.upper >= bounds.lower && left.lower <= bounds.upper &&
                        left.lower >= bounds.lower - rounding &&
                        left.upper <= bounds.upper + rounding;
    if (!inside)
      FAIL("row " << row << ": " << left.lower << " beyond " << bounds.lower << ", "
                  << bounds.upper);
  }
}

Matrix beside(const Matrix& A, const Matrix& B, const Matrix& C) {
  Matrix all(A.rows(), A.cols() + B.cols() + C.cols());
  all << A, B, C;
  return all;
}

}  // namespace

TEST_CASE("two tanks: the Jacobian at the centre, and errors of a search") {
  const auto [system, states, inputs] = examples()[0];
  const Linearised made = linearise(model_of(system), states, inputs);
  const LinearModel& m = made.model.linear;
  CHECK(m.A(0, 0) == doctest::Approx(1 - 0.15 / 2));
  CHECK(m.A(0, 1) == 0);
  CHECK(m.A(1, 0) == doctest::Approx(0.15 / 2));
  CHECK(m.A(1, 1) == doctest::Approx(1 - 0.125 / std::sqrt(5)));
  CHECK(m.B(0, 0) == 0.5);
  CHECK(m.C == Matrix{{0, 1}});
  // The flow between the tanks stands in both rows: what the lower one loses, but for its own.
  CHECK(Matrix(m.Bw.leftCols(3)) == Matrix{{1, 0, 1}, {0, 1, m.Bw(1, 2)}});
  CHECK(m.Bw(1, 2) == doctest::Approx(-1).epsilon(0.05));
  CHECK(Matrix(m.Bw.col(3)) == Matrix{{0}, {1}});
  CHECK(made.in_W == std::vector<Index>{0, 1});
  CHECK(made.in_V.empty());
  CHECK_FALSE(made.model.region->nonlinear_outputs);
  // What a search over the region finds, to its digits: [-0.00538, 0.00312].
  const Interval error = made.f[1].remainder;
  CHECK(error.upper - error.lower == doctest::Approx(0.00850).epsilon(2e-3));
  const Box W = interval_hull(made.model.W);
  CHECK(W.upper[3] - W.lower[3] < 0.75 * (error.upper - error.lower));
  CHECK(W.upper[0] == doctest::Approx(0.01));
}

TEST_CASE("an exothermic reaction: errors of a search") {
  const auto [system, states, inputs] = examples()[1];
  const Linearised made = linearise(model_of(system), states, inputs);
  const Interval error = made.f[1].remainder;  // [-0.0122, 0.0965]
  CHECK(error.upper - error.lower == doctest::Approx(0.1087).epsilon(3e-3));
  CHECK(made.f[1].attained.upper - made.f[1].attained.lower > 0.99 * (error.upper - error.lower));
}

TEST_CASE("random points of the region keep to the linear model") {
  std::mt19937_64 random(7);
  const auto draw = [&](double low, double high) {
    switch (std::uniform_int_distribution<int>(0, 3)(random)) {
      case 0:
        return low;
      case 1:
        return high;
      default:
        return std::uniform_real_distribution<double>(low, high)(random);
    }
  };
  for (const auto& [system, states, inputs] : examples()) {
    const Model model = model_of(system);
    const Linearised made = linearise(model, states, inputs);
    const LinearModel& m = made.model.linear;
    const Index q = model.disturbances(), r = model.noises();
    const Matrix of_f = beside(m.A, m.Bw.leftCols(q), m.B),
                 of_g = beside(m.C, m.Dv.leftCols(r), m.D);
    formulas::Evaluator f(model.nonlinear->f, Rounding::outward),
        g(model.nonlinear->g, Rounding::outward);
    for (int i = 0; i < points(); ++i) {
      const auto drawn = [&](const LineForm& set) {
        Vector xi(set.generators());
        for (double& entry : xi) entry = draw(-1, 1);
        return Vector(set.c + set.G * xi);
      };
      const Vector w = drawn(model.W), v = drawn(model.V);
      std::vector<Interval> point;
      const auto add = [&](double value) { point.push_back({value, value}); };
      for (Index j = 0; j < states.dim(); ++j) add(draw(states.lower[j], states.upper[j]));
      std::vector<Interval> shown = point;
      for (const double entry : w) add(entry);
      for (const double entry : v) shown.push_back({entry, entry});
      for (Index j = 0; j < inputs.dim(); ++j) {
        add(draw(inputs.lower[j], inputs.upper[j]));
        shown.push_back(point.back());
      }
      add(0);
      shown.push_back({0, 0});
      check_rows(f, point, of_f, made.f);
      check_rows(g, shown, of_g, made.g);
    }
  }
}

TEST_CASE("outputs that are bent hold in the region alone") {
  const auto [system, states, inputs] = examples()[2];
  const Linearised made = linearise(model_of(system), states, inputs);
  CHECK(made.model.region->nonlinear_outputs);
  CHECK(made.in_V == std::vector<Index>{0, 1});
  CHECK(made.model.V.dim() == 3);
  CHECK(made.model.W.dim() == 4);
}

TEST_CASE("an output that is linear in the region alone is no linear one") {
  std::string kinked = tanks;
  kinked.replace(kinked.find("x2 + v\""), 7, "abs(x2) + v\"");
  const auto [system, states, inputs] = examples()[0];
  const Linearised made = linearise(model_of(kinked), states, inputs);
  CHECK(made.model.linear.C == Matrix{{0, 1}});
  CHECK(made.in_V.empty());
  CHECK(made.model.region->nonlinear_outputs);
}

TEST_CASE("what cannot be linearised is refused") {
  const auto [system, states, inputs] = examples()[0];
  const Model model = model_of(system);
  const auto code_of = [](const Model& of, const Box& x, const Box& u) {
    try {
      linearise(of, x, u);
    } catch (const Error& error) {
      return error.code();
    }
    return Errc::internal;
  };
  CHECK(code_of(model, {Vector{{-1, 4}}, Vector{{5, 6}}}, inputs) == Errc::not_enclosed);
  CHECK(code_of(model, {Vector{{3, 4}}, Vector{{infinity, 6}}}, inputs) == Errc::unsupported);
  CHECK(code_of(model, {Vector{{3}}, Vector{{5}}}, inputs) == Errc::dimension);
  CHECK(code_of(Model{}, states, inputs) == Errc::unsupported);
  std::string timed = tanks;
  timed.replace(timed.find("0.5*u1"), 6, "0.5*k ");
  CHECK(code_of(model_of(timed), states, inputs) == Errc::unsupported);
  Model open = model;
  open.W = make_space(2);
  CHECK(code_of(open, states, inputs) == Errc::unsupported);
}
