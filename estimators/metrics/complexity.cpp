// SPDX-License-Identifier: GPL-3.0-or-later
// Generators, lines, constraints, and what else representations count.
#include <string>
#include <vector>

#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

constexpr const char* further_sizes = "sizes";

/// The names in a text, which commas and blanks separate.
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names(1);
  for (const char c : text) {
    if (c != ',' && c != ' ') {
      names.back() += c;
    } else if (!names.back().empty()) {
      names.emplace_back();
    }
  }
  if (names.back().empty()) names.pop_back();
  return names;
}

class Size final : public Metric {
 public:
  explicit Size(const Params& params) {
    if (!params.has(further_sizes)) return;
    for (std::string& name : names_in(params.text(further_sizes)))
      further_.push_back({std::move(name), 0});
  }

 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    const Complexity c = view.estimate.set->complexity();
    largest_.generators = std::max(largest_.generators, c.generators);
    largest_.lines = std::max(largest_.lines, c.lines);
    largest_.constraints = std::max(largest_.constraints, c.constraints);
    std::vector<MetricValue> values{
        {"generators", c.generators}, {"lines", c.lines}, {"constraints", c.constraints}};
    for (Complexity::Named& size : further_) {
      const Index count = c.count(size.name);
      size.count = std::max(size.count, count);
      values.push_back({size.name, count});
    }
    return values;
  }
  std::vector<MetricValue> do_summary() const override {
    std::vector<MetricValue> values{{"generators_max", largest_.generators},
                                    {"lines_max", largest_.lines},
                                    {"constraints_max", largest_.constraints}};
    for (const Complexity::Named& size : further_)
      values.push_back({size.name + "_max", size.count});
    return values;
  }
  std::vector<Measure> do_measures() const override {
    std::vector<Measure> measures{
        {.name = "generators_max", .title = "used generators", .short_title = "gen"},
        {.name = "lines_max",
         .title = "used lines",
         .short_title = "lines",
         .in_comparison = Shown::never},
        {.name = "constraints_max", .title = "used constraints", .short_title = "constr"}};
    for (const Complexity::Named& size : further_) {
      measures.push_back(
          {.name = size.name + "_max", .title = "used " + size.name, .short_title = size.name});
    }
    return measures;
  }

  Complexity largest_;
  std::vector<Complexity::Named> further_;
};

/// Names are columns of tables, and stand beside the three that are always there.
std::vector<Diagnostic> check_sizes(const MetricContext&, const Params& params) {
  std::vector<Diagnostic> found;
  if (!params.has(further_sizes)) return found;
  std::vector<std::string> seen{"generators", "lines", "constraints"};
  for (const std::string& name : names_in(params.text(further_sizes))) {
    const bool is_word = std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
    if (!is_word) {
      found.push_back({"/sizes", "has \"" + name + "\", which is no name in snake_case",
                       "write names with commas between them: \"facets, vertices\""});
    } else if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
      found.push_back(
          {"/sizes", "has \"" + name + "\" twice, or it is always counted", "leave it out"});
    }
    seen.push_back(name);
  }
  return found;
}

}  // namespace

CORDON_COMPONENT(metric, complexity) {
  ParamSchema schema;
  schema.text(further_sizes,
              "further sizes that a representation may have, by name with commas between them "
              "(\"facets, vertices\"); 0 where it has none");
  registrar.add(MetricEntry{
      {"complexity", "generators, lines and constraints of the estimate", "", std::move(schema)},
      [](const Params& params) -> std::unique_ptr<Metric> {
        return std::make_unique<Size>(params);
      },
      check_sizes});
}

}  // namespace cordon::estimators
