// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "cordon/study/statistics.hpp"
#include "design_report.hpp"
#include "diagnosis_report.hpp"
#include "json_text.hpp"
#include "observer_report.hpp"

namespace cordon::apps {

namespace {

using nlohmann::ordered_json;

const MetricValue* find(const PipelineOutcome& pipeline, std::string_view name) {
  const std::vector<MetricValue>& summary = pipeline.estimation()->summary;
  const auto found = std::find_if(summary.begin(), summary.end(),
                                  [&](const MetricValue& m) { return m.name == name; });
  return found == summary.end() ? nullptr : &*found;
}

std::string text(const MetricValue* metric) {
  if (!metric) return "-";
  if (const auto* integer = std::get_if<Index>(&metric->value)) return fmt::format("{}", *integer);
  if (const auto* word = std::get_if<std::string>(&metric->value)) return *word;
  const double number = std::get<double>(metric->value);
  return std::isnan(number) ? "-" : fmt::format("{:.4g}", number);
}

double number_of(const MetricValue* metric) {
  if (!metric) return not_available;
  if (const auto* count = std::get_if<Index>(&metric->value)) return static_cast<double>(*count);
  const auto* number = std::get_if<double>(&metric->value);
  return number ? *number : not_available;
}

/// "71/101": a count of the whole that its rest makes it.
std::string part_text(const PipelineOutcome& pipeline, const Measure& measure) {
  const double part = number_of(find(pipeline, measure.name));
  double whole = part;
  for (const std::string& name : measure.rest) whole += number_of(find(pipeline, name));
  return whole > 0 ? fmt::format("{}/{}", part, whole) : "-";
}

std::string value_text(const PipelineOutcome& pipeline, const Measure& measure) {
  if (!measure.rest.empty()) return part_text(pipeline, measure);
  const MetricValue* metric = find(pipeline, measure.name);
  const double number = number_of(metric);
  return measure.share && !std::isnan(number) ? fmt::format("{:.4g} %", 100 * number)
                                              : text(metric);
}

std::string consistency(const Labels& labels, const PipelineOutcome& pipeline) {
  if (!pipeline.error.empty()) return fmt::format("error after {} steps", pipeline.steps);
  if (pipeline.violated_at >= 0) return "VIOLATED at " + time_text(labels, pipeline.violated_at);
  const EstimationOutcome& found = *pipeline.estimation();
  if (found.inner_outside >= 0) return "VIOLATED at " + time_text(labels, found.inner_outside);
  if (found.restarts > 0)
    return fmt::format("{}, begun anew", count(found.inconsistent, "empty set"));
  if (found.inconsistent_from >= 0)
    return "empty from " + time_text(labels, found.inconsistent_from);
  if (found.undecided > 0) return fmt::format("undecided at {} steps", found.undecided);
  if (pipeline.steps == 0)
    return found.lag > 0 ? "no step: no more samples than it lags by" : "no step";
  return found.not_enclosed > 0 ? "begun anew" : "consistent";
}

struct Column {
  std::string header;
  std::function<std::string(const PipelineOutcome&)> cell;
};

/// What is told of a value of this name; its name alone if nothing is.
Measure described(const RunOutcome& outcome, const std::string& name) {
  const auto told = std::find_if(outcome.measures.begin(), outcome.measures.end(),
                                 [&](const Measure& m) { return m.name == name; });
  return told == outcome.measures.end() ? Measure{.name = name} : *told;
}

bool is_shown(const RunOutcome& outcome, const Measure& measure) {
  if (measure.in_run == Measure::Shown::never) return false;
  return std::any_of(
      outcome.pipelines.begin(), outcome.pipelines.end(), [&](const PipelineOutcome& p) {
        const MetricValue* metric = find(p, measure.name);
        const double number = number_of(metric);
        return metric &&
               (measure.in_run == Measure::Shown::always || (number != 0 && number == number));
      });
}

/// One for every value of the metrics, in their order.
std::vector<Column> metric_columns(const RunOutcome& outcome) {
  std::vector<Column> found;
  std::vector<std::string> known;
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    for (const MetricValue& metric : pipeline.estimation()->summary) {
      if (std::find(known.begin(), known.end(), metric.name) != known.end()) continue;
      known.push_back(metric.name);
      const Measure measure = described(outcome, metric.name);
      if (!is_shown(outcome, measure)) continue;
      found.push_back({heading(short_title_of(measure)),
                       [measure](const PipelineOutcome& p) { return value_text(p, measure); }});
    }
  }
  return found;
}

std::vector<Column> columns(const RunOutcome& outcome, const Labels& labels) {
  std::vector<Column> found{
      {"PIPELINE", [](const PipelineOutcome& p) { return p.name; }},
      {"BACKEND", [](const PipelineOutcome& p) { return p.backend; }},
      {"CONSISTENCY", [&labels](const PipelineOutcome& p) { return consistency(labels, p); }}};
  for (Column& column : metric_columns(outcome)) found.push_back(std::move(column));
  const auto add_time = [&](const char* title, double StepTimes::*time) {
    found.push_back({title, [time](const PipelineOutcome& p) {
                       return p.steps ? fmt::format("{:.1f}", p.step_us.*time) : "-";
                     }});
  };
  add_time("µs/STEP", &StepTimes::median);
  add_time("99 % µs", &StepTimes::percentile_99);
  add_time("LARGEST", &StepTimes::largest);
  return found;
}

std::string observer_table(const RunOutcome& outcome, const Labels& labels, const Paint& paint) {
  const std::vector<Column> shown = columns(outcome, labels);
  std::vector<std::vector<std::string>> rows(1);
  for (const Column& column : shown) rows[0].push_back(column.header);
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    rows.emplace_back();
    for (const Column& column : shown) rows.back().push_back(column.cell(pipeline));
  }
  return table(rows, paint);
}

ordered_json time_or_null(std::int64_t k) {
  return k < 0 ? ordered_json(nullptr) : ordered_json(k);
}

ordered_json error_of(const PipelineOutcome& p) {
  return p.error.empty() ? ordered_json(nullptr) : ordered_json(p.error);
}

ordered_json assumption_json(const PipelineOutcome& p, const std::vector<std::string>& modes) {
  if (!p.failed_assumption) return nullptr;
  const FailedAssumption& failed = *p.failed_assumption;
  const bool named = failed.mode >= 0 && static_cast<std::size_t>(failed.mode) < modes.size();
  return {{"what", to_string(failed.what)},
          {"k", failed.k},
          {"mode", named ? ordered_json(modes[static_cast<std::size_t>(failed.mode)])
                         : ordered_json(nullptr)},
          {"seed_offset", failed.seed_offset},
          {"text", text_of(failed, modes)}};
}

ordered_json json_of(const PipelineOutcome& p, const DiagnosisOutcome& found) {
  const auto& guarantees = found.guarantees;
  return {{"name", p.name},
          {"backend", p.backend},
          {"diagnoser", found.diagnoser},
          {"modes", found.modes},
          {"steps", p.steps},
          {"assumptions_until", time_or_null(p.assumptions_until)},
          {"failed_assumption", assumption_json(p, found.modes)},
          {"violated_at", time_or_null(p.violated_at)},
          {"error", error_of(p)},
          {"guarantees", guarantees ? ordered_json::parse(cordon::json_of(*guarantees, found.modes))
                                    : ordered_json(nullptr)},
          {"diagnosis", ordered_json::parse(cordon::json_of(found))}};
}

ordered_json json_of(const PipelineOutcome& p, const DesignedOutcome& found,
                     const std::vector<std::string>& modes) {
  ordered_json experiments = ordered_json::array();
  for (const ExperimentRow& row : found.experiments) {
    const DelayStatistics& k = row.isolation;
    experiments.push_back(
        {{"mode", modes[static_cast<std::size_t>(row.mode)]},
         {"runs", row.runs},
         {"possible", row.possible},
         {"isolated", row.isolated},
         {"wrong", row.wrong},
         {"unknown_fault", row.unknown_fault},
         {"undecided", row.undecided},
         {"isolation", k.count == 0
                           ? ordered_json(nullptr)
                           : ordered_json{{"min", k.min}, {"median", k.median}, {"max", k.max}}}});
  }
  return {{"name", p.name},
          {"backend", p.backend},
          {"designer", found.designer},
          {"diagnoser",
           found.diagnoser.empty() ? ordered_json(nullptr) : ordered_json(found.diagnoser)},
          {"modes", modes},
          {"assumptions_until", time_or_null(p.assumptions_until)},
          {"failed_assumption", assumption_json(p, modes)},
          {"violated_at", time_or_null(p.violated_at)},
          {"refuted", found.refuted},
          {"error", error_of(p)},
          {"design", found.design ? ordered_json::parse(cordon::json_of(*found.design, modes))
                                  : ordered_json(nullptr)},
          {"exact", found.exact ? ordered_json::parse(cordon::json_of(*found.exact, modes))
                                : ordered_json(nullptr)},
          {"experiments", std::move(experiments)}};
}

ordered_json json_of(const PipelineOutcome& p, const EstimationOutcome& found,
                     const std::vector<std::string>& modes) {
  ordered_json metrics = ordered_json::object();
  for (const MetricValue& metric : found.summary) {
    if (const auto* value = std::get_if<double>(&metric.value)) {
      metrics[metric.name] = json_number(*value);
    } else {
      std::visit([&](const auto& other) { metrics[metric.name] = other; }, metric.value);
    }
  }
  return {{"name", p.name},
          {"backend", p.backend},
          {"observer", found.observer},
          {"lag", found.lag},
          {"steps", p.steps},
          {"consistent", found.consistent},
          {"inconsistent", found.inconsistent},
          {"undecided", found.undecided},
          {"inconsistent_from", time_or_null(found.inconsistent_from)},
          {"assumptions_until", time_or_null(p.assumptions_until)},
          {"failed_assumption", assumption_json(p, modes)},
          {"outside_from", time_or_null(found.outside_from)},
          {"violated_at", time_or_null(p.violated_at)},
          {"inner_steps", found.inner_steps},
          {"inner_share",
           found.inner_steps > 0 ? json_number(found.inner_share) : ordered_json(nullptr)},
          {"inner_outside", time_or_null(found.inner_outside)},
          {"growth", growth_json(found)},
          {"gains", gains_json(found.gains)},
          {"last", last_json(found)},
          {"error", error_of(p)},
          {"metrics", std::move(metrics)},
          {"median_hull_us", found.median_hull_us}};
}

ordered_json json_of(const PipelineOutcome& p, const std::vector<std::string>& modes) {
  ordered_json json = p.design()      ? json_of(p, *p.design(), modes)
                      : p.diagnosis() ? json_of(p, *p.diagnosis())
                                      : json_of(p, *p.estimation(), modes);
  json["median_step_us"] = p.step_us.median;
  json["percentile_99_step_us"] = p.step_us.percentile_99;
  json["largest_step_us"] = p.step_us.largest;
  return json;
}

}  // namespace

std::string report_text(const Study& study, const RunOutcome& outcome,
                        const std::filesystem::path& out) {
  RunOutcome observed;
  observed.measures = outcome.measures;
  // pipelines with a diagnoser or a designer have nothing to tell in the columns of this table
  std::string diagnoses, limits;
  const Paint paint(stdout);
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    if (pipeline.left_open > 0)
      limits += fmt::format("{}: \"max_programs\" has left questions open in {}\n", pipeline.name,
                            count(pipeline.left_open, "step"));
    if (pipeline.design()) {
      diagnoses += design_text(study, pipeline, paint) + "\n";
    } else if (pipeline.diagnosis()) {
      diagnoses += diagnosis_text(study, pipeline, paint) + "\n";
    } else {
      observed.pipelines.push_back(pipeline);
    }
  }
  const std::string title = study.title.empty() ? "" : paint.bold(study.title) + "\n\n",
                    comparison = observed.pipelines.empty() && !diagnoses.empty()
                                     ? ""
                                     : observer_table(observed, study.labels, paint) +
                                           units_text(observed, study.labels) + "\n";
  std::string details;
  for (const PipelineOutcome& pipeline : observed.pipelines) {
    const std::string failed = assumption_text(study, pipeline, paint);
    details += failed.empty() ? "" : pipeline.name + ": " + failed;
  }
  details += contradictions_text(study, observed, paint);
  if (!details.empty()) details += "\n";
  details += gains_text(gains_of(observed), paint) + widths_text(observed, study.labels, paint) +
             inner_text(observed, study.labels, paint) + growth_text(observed, study.labels, paint);
  const std::string sampled =
      study.continuous
          ? fmt::format("Sampled every {:.6g} s: what is said is said of the sampled model\n",
                        study.labels.sampling_time)
          : "";
  return title + comparison + details + diagnoses + limits + sampled + "Results are in " +
         out.string() + "\n";
}

std::string report_json(const Study& study, const RunOutcome& outcome) {
  std::vector<std::string> modes;
  for (const Mode& mode : bank_of(study).modes) modes.push_back(mode.name);
  ordered_json pipelines = ordered_json::array(), files = ordered_json::array();
  for (const PipelineOutcome& pipeline : outcome.pipelines)
    pipelines.push_back(json_of(pipeline, modes));
  for (const std::filesystem::path& file : outcome.files) files.push_back(file.string());
  const ordered_json report{{"pipelines", std::move(pipelines)}, {"files", std::move(files)}};
  return json_text(report);
}

}  // namespace cordon::apps
