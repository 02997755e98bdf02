// SPDX-License-Identifier: GPL-3.0-or-later
// Plants are functions.
#include <cmath>
#include <memory>
#include <thread>

#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/plant_formulas.hpp"
#include "making.hpp"

namespace cordon::conformance {

namespace {

/// Points are drawn by the law itself: the case does not know the plant's sizes.
TestCase plant_case(const Setting& s) {
  TestCase test;
  test.numbers.push_back({"k", s.random.between(0, 3), 0});
  return test;
}

struct PlantTrial {
  Params params;
  std::shared_ptr<Plant> plant;
  Index k = 0;
  Vector x, u, next, output;

  Verdict fails(const std::string& message) const {
    Verdict verdict = Verdict::fails(message);
    verdict.derived = {{"x", describe_vector(x)}, {"u", describe_vector(u)}};
    verdict.derived.emplace_back("params", describe(params));
    return verdict;
  }
  bool is_defined() const { return !next.array().isNaN().any() && !output.array().isNaN().any(); }
};

PlantTrial plant_trial(const Context& context, const TestCase& test) {
  PlantTrial trial;
  const Registry& registry = context.registry();
  const std::string& name = context.subject.component;
  ParameterDraw draw(context, test, registry.info("plant", name)->schema);
  trial.params = draw.find([&](const Params& params) {
    Params complete = params;
    return registry.info("plant", name)->schema.complete(complete);
  });
  trial.plant = registry.make<PlantEntry>(name, trial.params);
  trial.k = test.number(0);
  Random random(test.seed);
  const double size = std::exp2(random.between(-6, 2));
  const auto drawn = [&](Index n) {
    Vector x(n);
    for (double& value : x)
      value = size * (random.chance(0.5) ? random.unit() : 2 * random.unit() - 1);
    return x;
  };
  trial.x = drawn(trial.plant->states());
  trial.u = drawn(trial.plant->inputs());
  trial.next = trial.plant->next(trial.k, trial.x, trial.u);
  trial.output = trial.plant->output(trial.k, trial.x, trial.u);
  return trial;
}

bool same(const Vector& a, const Vector& b) {
  if (a.size() != b.size()) return false;
  for (Index i = 0; i < a.size(); ++i) {
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
  }
  return true;
}

Verdict check_function(const Context& context, const TestCase& test) {
  const PlantTrial trial = plant_trial(context, test);
  const auto other = context.registry().make<PlantEntry>(context.subject.component, trial.params);
  Vector next, output, again;
  std::thread([&] {
    next = other->next(trial.k, trial.x, trial.u);
    output = other->output(trial.k, trial.x, trial.u);
  }).join();
  again = trial.plant->next(trial.k, trial.x, trial.u);
  if (!same(again, trial.next))
    return trial.fails("next() gives " + describe_vector(trial.next) + ", then " +
                       describe_vector(again));
  if (!same(next, trial.next) || !same(output, trial.output))
    return trial.fails("another plant with the same parameters gives " + describe_vector(next) +
                       " and " + describe_vector(output) + " in place of " +
                       describe_vector(trial.next) + " and " + describe_vector(trial.output));
  return {};
}

Verdict check_plant_finite(const Context& context, const TestCase& test) {
  const PlantTrial trial = plant_trial(context, test);
  for (const Vector* result : {&trial.next, &trial.output}) {
    if (result->array().isInf().any())
      return trial.fails("a result is infinite: " + describe_vector(*result));
  }
  return trial.is_defined() ? Verdict::holds() : Verdict::inapplicable();
}

Verdict check_formulas(const Context& context, const TestCase& test) {
  const PlantTrial trial = plant_trial(context, test);
  const Index n = trial.plant->states(), m = trial.plant->inputs();
  std::vector<std::string> names;
  for (Index i = 0; i < n; ++i) names.push_back("x" + std::to_string(i));
  for (Index i = 0; i < m; ++i) names.push_back("u" + std::to_string(i));
  names.emplace_back("k");
  const auto graph = std::make_shared<formulas::Graph>(names);
  PlantVariables of{{}, {}, graph->variable(n + m)};
  for (Index i = 0; i < n; ++i) of.x.push_back(graph->variable(i));
  for (Index i = 0; i < m; ++i) of.u.push_back(graph->variable(n + i));
  const auto made = trial.plant->as_formulas(of);
  if (!made || !trial.is_defined()) return Verdict::inapplicable();
  std::vector<int> nodes;
  for (const auto* rows : {&made->next, &made->output}) {
    for (const formulas::Expression& row : *rows) nodes.push_back(row.node());
  }
  formulas::Evaluator evaluator(std::make_shared<formulas::Function>(graph, nodes, n, 0),
                                Rounding::outward);
  std::vector<Interval> point;
  for (const Vector* x : {&trial.x, &trial.u}) {
    for (const double value : *x) point.push_back({value, value});
  }
  point.push_back({static_cast<double>(trial.k), static_cast<double>(trial.k)});
  evaluator.evaluate(point);
  evaluator.bound_rounding();
  Vector numbers(n + trial.output.size());
  numbers << trial.next, trial.output;
  for (Index row = 0; row < numbers.size(); ++row) {
    if (!evaluator.is_enclosed(row)) continue;
    const Interval value = evaluator.value(row);
    const double size = std::max({std::abs(numbers[row]), value.magnitude(),
                                  trial.x.cwiseAbs().sum() + trial.u.cwiseAbs().sum()});
    const double room = 1e-9 * size + evaluator.rounding_error(row);
    if (numbers[row] >= value.lower - room && numbers[row] <= value.upper + room) continue;
    return trial.fails("entry " + std::to_string(row) + " is " + describe(numbers[row]) +
                       ", by its formula " + describe(value.lower) + " to " +
                       describe(value.upper));
  }
  return {};
}

}  // namespace

void add_plants(LawList& list) {
  const std::string kind = "plant";
  list.push_back(law_of(kind, "plant.function",
                        "the same state and input give the same bits, on any thread and of any "
                        "object",
                        plant_case, check_function, 0.3));
  list.push_back(law_of(kind, "plant.finite",
                        "results are numbers, or NaN where the plant is not defined", plant_case,
                        check_plant_finite, 0.3));
  list.push_back(law_of(kind, "plant.formulas", "formulas agree with numbers up to rounding",
                        plant_case, check_formulas, 0.2));
}

}  // namespace cordon::conformance
