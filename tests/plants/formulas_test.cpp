// SPDX-License-Identifier: GPL-3.0-or-later
// Plants as formulas: the same steps as their numbers, parts that are shared, and where they are
// not defined.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/plant_formulas.hpp"
#include "plants/plants.hpp"

using namespace cordon;
using test::Plugins;

namespace {

/// x⁺ and y of a plant with two states, one input and one output, over (x1, x2, u, k).
class Formulas {
 public:
  explicit Formulas(const Plant& plant)
      : graph_(std::make_shared<formulas::Graph>(std::vector<std::string>{"x1", "x2", "u", "k"})) {
    const auto made = plant.as_formulas(
        {{graph_->variable(0), graph_->variable(1)}, {graph_->variable(2)}, graph_->variable(3)});
    REQUIRE(made);
    const std::vector<int> rows{made->next[0].node(), made->next[1].node(), made->output[0].node()};
    evaluator_ = std::make_unique<formulas::Evaluator>(
        std::make_shared<const formulas::Function>(graph_, rows, 2, 1), Rounding::outward);
  }

  /// Over the box, with u known.
  std::vector<Interval> over(const Vector& lower, const Vector& upper, double u) {
    const std::vector<Interval> box{{lower[0], upper[0]}, {lower[1], upper[1]}, {u, u}, {0, 0}};
    evaluator_->evaluate(box);
    return {evaluator_->value(0), evaluator_->value(1), evaluator_->value(2)};
  }
  std::vector<Interval> at(const Vector& x, double u) { return over(x, x, u); }
  bool is_defined(const Vector& x, double u) {
    at(x, u);
    return evaluator_->is_enclosed(0) && evaluator_->is_enclosed(1);
  }
  const formulas::Graph& graph() const { return *graph_; }
  Index count(formulas::Operation operation) const {
    return std::ranges::count_if(
        graph_->nodes(), [&](const formulas::Node& node) { return node.operation == operation; });
  }

 private:
  std::shared_ptr<formulas::Graph> graph_;
  std::unique_ptr<formulas::Evaluator> evaluator_;
};

double middle(Interval x) { return 0.5 * x.lower + 0.5 * x.upper; }

/// The numbers of the plant are the formulas' within `room`, at points of the box x ± radius.
void expect_same(const Plant& plant, const Vector& radius, double lowest, double highest,
                 double room) {
  Formulas formulas(plant);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(-1, 1), input(lowest, highest);
  for (int i = 0; i < 100; ++i) {
    const Vector x{{share(random) * radius[0], share(random) * radius[1]}};
    const double u = input(random);
    const Vector next = plant.next(0, x, Vector{{u}}), y = plant.output(0, x, Vector{{u}});
    const std::vector<Interval> values = formulas.at(x, u);
    CAPTURE(x);
    CAPTURE(u);
    for (std::size_t row = 0; row < 2; ++row) {
      const double number = next[static_cast<Index>(row)];
      CHECK(std::abs(middle(values[row]) - number) <= room * (1 + std::abs(number)));
      CHECK(values[row].upper - values[row].lower <= 1e-8 * (1 + std::abs(number)));
    }
    CHECK(values[2] == Interval{y[0], y[0]});
  }
}

TEST_CASE("formulas are the steps that are simulated") {
  const Plugins plugins;
  for (const std::int64_t substeps : {1, 2, 20}) {
    const Params of = Params().set("substeps", substeps);
    // Levels reach beyond empty and full tanks.
    expect_same(*plugins.coupled_tanks(of), Vector{{25, 25}}, -1.5, 3.5, 1e-12);
  }
  for (const std::int64_t substeps : {10, 250}) {
    const Params of = Params().set("substeps", substeps);
    expect_same(*plugins.stirred_tank(of), Vector{{.05, 12}}, -99, 60, 1e-10);
  }
}

TEST_CASE("formulas of the stirred tank match the solution of the balances") {
  // Of an extrapolated midpoint rule in arithmetic of 40 digits.
  const Plugins plugins;
  Formulas formulas(*plugins.stirred_tank());
  const double steps[][5] = {{0, 0, -1, -0.00018162673791667457, 0.11780093869558818},
                             {0, 0, 20, 0.0035211871932527669, -2.3034320713100827},
                             {0.01, -3, -20, 0.007813104838355938, -0.58305633111473809},
                             {-0.02, 6, 5, -0.017961315239377031, 4.4447582741461158},
                             {0.05, -12, -99.5, 0.035361157427543956, -0.19371920142885238}};
  for (const auto& [c, t, u, c_after, t_after] : steps) {
    const std::vector<Interval> values = formulas.at(Vector{{c, t}}, u);
    CHECK(std::abs(middle(values[0]) - c_after) < 1e-11);
    CHECK(std::abs(middle(values[1]) - t_after) < 1e-8);
  }
}

TEST_CASE("formulas of the tanks are Euler's step with Torricelli's law") {
  const Plugins plugins;
  Formulas formulas(*plugins.coupled_tanks());
  const double upper = .2261 * 1.5 / .0114 / 2, lower = .2261 * 1.5 / .0097 / 2;
  const std::vector<Interval> values = formulas.at(Vector{{4, -2}}, .7);
  const double drained = 2 * .0114 * std::sqrt(upper) * std::sqrt(upper + 4),
               left = 2 * .0097 * std::sqrt(lower) * std::sqrt(lower - 2);
  CHECK(middle(values[0]) == doctest::Approx(4 + .2261 * 2.2 - drained).epsilon(1e-12));
  CHECK(middle(values[1]) == doctest::Approx(-2 + drained - left).epsilon(1e-12));
}

TEST_CASE("ranges hold what is simulated within the box") {
  const Plugins plugins;
  const auto tanks = plugins.coupled_tanks(Params().set("substeps", std::int64_t{5}));
  Formulas formulas(*tanks);
  const Vector lower{{-16, -3}}, upper{{-13, 9}};  // the upper tank may be empty
  const std::vector<Interval> values = formulas.over(lower, upper, .5);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vector x{{lower[0] + share(random) * (upper[0] - lower[0]),
                    lower[1] + share(random) * (upper[1] - lower[1])}};
    const Vector next = tanks->next(0, x, Vector{{.5}});
    CHECK(values[0].contains(next[0]));
    CHECK(values[1].contains(next[1]));
  }
}

TEST_CASE("parts that both states need are shared") {
  const Plugins plugins;
  const Formulas tank(*plugins.stirred_tank());
  CHECK(tank.count(formulas::Operation::exponential) == 4 * 250 + 1);  // and one of the coolant
  CHECK(tank.graph().nodes().size() < 100 * 250);
  const Formulas tanks(*plugins.coupled_tanks(Params().set("substeps", std::int64_t{10})));
  CHECK(tanks.count(formulas::Operation::square_root) == 2 * 10 + 2);  // and two of the voltage
}

TEST_CASE("inputs outside their range have no value") {
  const Plugins plugins;
  const Vector rest{{0, 0}};
  Formulas tanks(*plugins.coupled_tanks()), tank(*plugins.stirred_tank());
  CHECK(tanks.is_defined(rest, -1.5));
  CHECK(tanks.is_defined(rest, 3.5));
  CHECK_FALSE(tanks.is_defined(rest, -1.6));
  CHECK_FALSE(tanks.is_defined(rest, 3.6));
  CHECK(tank.is_defined(rest, -99.9));
  CHECK_FALSE(tank.is_defined(rest, -100));
  CHECK_FALSE(tank.is_defined(rest, -101));
}

TEST_CASE("more substeps than a graph should hold are refused, and simulated all the same") {
  const Plugins plugins;
  for (const bool stirred : {true, false}) {
    const auto make = [&](std::int64_t substeps) {
      const Params of = Params().set("substeps", substeps);
      return stirred ? plugins.stirred_tank(of) : plugins.coupled_tanks(of);
    };
    CHECK(Formulas(*make(500)).graph().nodes().size() < formulas::Graph::most_nodes);
    const auto finer = make(501);
    CHECK(finer->next(0, Vector{{0, 0}}, Vector{{0}}).allFinite());
    formulas::Graph graph({"x1", "x2", "u", "k"});
    try {
      finer->as_formulas(
          {{graph.variable(0), graph.variable(1)}, {graph.variable(2)}, graph.variable(3)});
      FAIL("formulas of 501 substeps");
    } catch (const Error& error) {
      CHECK(error.code() == Errc::invalid);
      CHECK(std::string(error.what()) ==
            "as formulas a plant has at most 500 substeps, and this "
            "one 501: give fewer \"substeps\"");
    }
  }
}

}  // namespace
