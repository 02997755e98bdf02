// SPDX-License-Identifier: GPL-3.0-or-later
// Values of metrics keep to the ranges of what they say they are.
#include <algorithm>
#include <cmath>

#include "making.hpp"

namespace cordon::conformance {

namespace {

/// Sets with one of their points, in a model of some kind.
TestCase metric_case(const Setting& s) {
  SystemShape shape;
  shape.samples = 4;
  TestCase test = system_case(s, shape);
  for (int k = 0; k < 3; ++k)
    test.sets.push_back(s.make().set("X" + std::to_string(k + 1), 'n', s.n, {false, 5, 1}));
  return test;
}

struct MetricTrial {
  Model model;
  Params params;
  std::string backend;
  std::shared_ptr<Metric> metric;
  std::vector<Estimate> estimates;
  std::vector<Box> hulls;
  std::vector<Vector> truths;

  Verdict fails(const std::string& message) const {
    Verdict verdict = Verdict::fails(message);
    verdict.derived.emplace_back("backend", backend);
    verdict.derived.emplace_back("params", describe(params));
    return verdict;
  }
  std::vector<MetricValue> step(Metric& of, std::size_t k) const {
    const PhaseTimes times{1, 2, 3, 4};
    return of.step({estimates[k], hulls[k], &truths[k], true, times});
  }
};

MetricTrial metric_trial(const Context& context, const TestCase& test) {
  MetricTrial trial{model_of(test), {}, {}, nullptr, {}, {}, {}};
  const DrawnBackend drawn = backend_for(context, test);
  trial.backend = drawn.text;
  for (std::size_t k = 3; k < test.sets.size(); ++k) {
    Estimate estimate{
        static_cast<Index>(k), drawn.backend->import(test.set(k).form), Answer::unknown, {}};
    estimate.consistent = negate(estimate.set->is_empty(&estimate.why));
    trial.hulls.push_back(estimate.set->interval_hull());
    trial.truths.push_back(test.set(k).point());
    trial.estimates.push_back(std::move(estimate));
  }
  const Registry& registry = context.registry();
  const std::string& name = context.subject.component;
  ParameterDraw draw(context, test, registry.info("metric", name)->schema);
  trial.params = draw.find([&](const Params& params) {
    return registry.check<MetricEntry>(name, MetricContext{trial.model}, params);
  });
  trial.metric = registry.make<MetricEntry>(name, trial.params);
  return trial;
}

std::string text_of(const MetricValue& value) {
  struct Text {
    std::string operator()(double x) const { return describe(x); }
    std::string operator()(Index x) const { return std::to_string(x); }
    std::string operator()(const std::string& x) const { return "\"" + x + "\""; }
  };
  return value.name + " = " + std::visit(Text{}, value.value);
}

/// "" or what is wrong with a value that is described.
std::string out_of_range(const MetricValue& value, const std::vector<Measure>& measures) {
  for (const Measure& measure : measures) {
    if (measure.name != value.name && measure.of != value.name) continue;
    const double* number = std::get_if<double>(&value.value);
    if (!number || std::isnan(*number)) continue;
    const bool is_size = measure.quantity != Measure::Quantity::number;
    if (is_size && *number < 0) return text_of(value) + " is a size below 0";
    if (measure.share && measure.name == value.name && (*number < 0 || *number > 1))
      return text_of(value) + " is a share that is not within 0 and 1";
  }
  return "";
}

Verdict check_ranges(const Context& context, const TestCase& test) {
  const MetricTrial trial = metric_trial(context, test);
  const std::vector<Measure> measures = trial.metric->measures();
  for (std::size_t k = 0; k < trial.estimates.size(); ++k) {
    for (const MetricValue& value : trial.step(*trial.metric, k)) {
      if (const std::string why = out_of_range(value, measures); !why.empty())
        return trial.fails(why);
      const double* number = std::get_if<double>(&value.value);
      if (number && std::isnan(*number))
        return trial.fails(text_of(value) + ", though the set is bounded and the state is known");
    }
  }
  for (const MetricValue& value : trial.metric->summary()) {
    if (const std::string why = out_of_range(value, measures); !why.empty())
      return trial.fails(why);
    const double* number = std::get_if<double>(&value.value);
    if (number && std::isnan(*number))
      return trial.fails(text_of(value) + " of bounded sets with known states");
  }
  return {};
}

std::string names_of(const std::vector<MetricValue>& values) {
  std::string names;
  for (const MetricValue& value : values) names += (names.empty() ? "" : ", ") + value.name;
  return names;
}

Verdict check_names(const Context& context, const TestCase& test) {
  const MetricTrial trial = metric_trial(context, test);
  const std::string summary = names_of(trial.metric->summary());
  std::string step;
  for (std::size_t k = 0; k < trial.estimates.size(); ++k) {
    const std::string names = names_of(trial.step(*trial.metric, k));
    if (k > 0 && names != step)
      return trial.fails("the values of a step were " + step + " and are " + names);
    step = names;
    if (const std::string now = names_of(trial.metric->summary()); now != summary)
      return trial.fails("the values of the summary were " + summary + " and are " + now);
  }
  const auto values = trial.metric->summary();
  for (const Measure& measure : trial.metric->measures()) {
    const bool there = std::any_of(values.begin(), values.end(), [&](const MetricValue& value) {
      return value.name == measure.name;
    });
    if (!there)
      return trial.fails("\"" + measure.name +
                         "\" is described, and no value of the summary: " + summary);
  }
  return {};
}

Verdict check_metric_repeats(const Context& context, const TestCase& test) {
  const MetricTrial trial = metric_trial(context, test);
  if (!trial.metric->reproducible()) return Verdict::inapplicable();
  const auto other = context.registry().make<MetricEntry>(context.subject.component, trial.params);
  const auto texts = [&](Metric& metric) {
    std::string text;
    for (std::size_t k = 0; k < trial.estimates.size(); ++k) {
      for (const MetricValue& value : trial.step(metric, k)) text += text_of(value) + "; ";
    }
    for (const MetricValue& value : metric.summary()) text += text_of(value) + "; ";
    return text;
  };
  const std::string first = texts(*trial.metric), then = texts(*other);
  if (first == then) return {};
  Verdict verdict = trial.fails("another metric gives other values for the same steps");
  verdict.derived.emplace_back("first", first);
  verdict.derived.emplace_back("then", then);
  return verdict;
}

}  // namespace

void add_metrics(LawList& list) {
  const std::string kind = "metric";
  list.push_back(law_of(kind, "metric.ranges",
                        "sizes are not below 0, shares within 0 and 1, and of bounded sets with "
                        "known states nothing is NaN",
                        metric_case, check_ranges, 0.3));
  list.push_back(law_of(kind, "metric.names",
                        "names of values never change, and what is described is there", metric_case,
                        check_names, 0.1));
  list.push_back(law_of(kind, "metric.repeats",
                        "if it is reproducible, the same steps give the same values", metric_case,
                        check_metric_repeats, 0.1));
}

}  // namespace cordon::conformance
