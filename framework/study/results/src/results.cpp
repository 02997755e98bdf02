// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/results.hpp"

#include <algorithm>
#include <cmath>

#include "outcome_json.hpp"
#include "results_design.hpp"
#include "results_diagnosis.hpp"
#include "study/results/file_heads.hpp"
#include "study/results/results_parts.hpp"
#include "study/results/sets_file.hpp"
#include "study/results/step_json.hpp"
#include "study/results/table_builder.hpp"
#include "study/text/host.hpp"
#include "study/text/numbers.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace {

using Layout = JsonWriter::Layout;

void write(JsonWriter& json, const MetricValue& metric) {
  json.key(metric.name);
  std::visit([&](const auto& value) { json.value(value); }, metric.value);
}

std::string csv_value(const MetricValue& metric) {
  if (const auto* number = std::get_if<double>(&metric.value)) return csv_number(*number);
  if (const auto* integer = std::get_if<Index>(&metric.value)) return std::to_string(*integer);
  return csv_field(std::get<std::string>(metric.value));
}

void write(JsonWriter& json, std::string_view name, const AnswerCount& count) {
  json.key(name)
      .begin_object()
      .member("decided", count.decided)
      .member("unknown", count.unknown)
      .end_object();
}

void write_times(JsonWriter& json, const PhaseTimes& times, double hull_us) {
  json.begin_object();
  json.member("predict", times.predict)
      .member("correct", times.correct)
      .member("reduce", times.reduce);
  json.member("question", times.question).member("hull", hull_us).end_object();
}

std::size_t observers_of(const Study& study) {
  return static_cast<std::size_t>(
      std::count_if(study.pipelines.begin(), study.pipelines.end(),
                    [](const PipelineSpec& spec) { return spec.estimation() != nullptr; }));
}

bool has_diagnosers(const Study& study) {
  return std::any_of(study.pipelines.begin(), study.pipelines.end(),
                     [](const PipelineSpec& spec) { return spec.diagnosis() != nullptr; });
}

bool has_designers(const Study& study) {
  return std::any_of(study.pipelines.begin(), study.pipelines.end(),
                     [](const PipelineSpec& spec) { return spec.design() != nullptr; });
}

/// What every pipeline has in summary.csv; what only observers tell is empty in others.
std::vector<std::string> summary_fields(const PipelineOutcome& outcome, const std::string& pipeline,
                                        const std::optional<Rounding>& rounding) {
  const EstimationOutcome* const found = outcome.estimation();
  const auto count = [&](std::int64_t EstimationOutcome::*member) {
    return found ? std::to_string(found->*member) : "";
  };
  const auto time = [&](std::int64_t EstimationOutcome::*member) {
    return found ? csv_time(found->*member) : "";
  };
  const auto answers = [&](std::int64_t AnswerCount::*kind) {
    return found ? std::to_string(found->emptiness.*kind + found->containment.*kind +
                                  found->bounds.*kind)
                 : "";
  };
  return {pipeline,
          csv_field(outcome.backend),
          found ? csv_field(found->observer) : "",
          rounding ? std::string(to_string(*rounding)) : "",
          std::to_string(outcome.steps),
          count(&EstimationOutcome::consistent),
          count(&EstimationOutcome::inconsistent),
          count(&EstimationOutcome::undecided),
          time(&EstimationOutcome::inconsistent_from),
          csv_time(outcome.assumptions_until),
          time(&EstimationOutcome::outside_from),
          csv_time(outcome.violated_at),
          answers(&AnswerCount::decided),
          answers(&AnswerCount::unknown),
          csv_field(outcome.error)};
}

void write_algorithms(JsonWriter& json, const PipelineSpec& spec) {
  for (const auto& [kind, component] : algorithms_of(spec)) json.member(kind, component->type);
  if (spec.design() && !spec.design()->diagnoser) json.key("diagnoser").null();
}

}  // namespace

Results::Results(const Study& study, const Registry& registry, const DirectoryLock& out,
                 const RunOptions& options)
    : study_(study),
      directory_(out),
      data_file_(directory_.create("data.csv")),
      sets_(std::make_unique<SetsFile>(directory_.create("sets.jsonl"), observers_of(study),
                                       options.sets, options.many_sets)),
      steps_file_(directory_.create("steps.csv")),
      summary_file_(directory_.create("summary.csv")),
      diagnosis_file_(has_diagnosers(study) ? &directory_.create("diagnosis.csv") : nullptr),
      inputs_file_(has_designers(study) ? &directory_.create("inputs.csv") : nullptr),
      tables_(directory_),
      run_file_(directory_.create("run.json")),
      results_file_(directory_.create("results.json")),
      results_(results_file_),
      run_(run_file_) {
  begin_results(registry);
  begin_run(registry);
  if (inputs_file_) write_inputs_header(*inputs_file_, study.model.inputs(), study.labels);
}

Results::~Results() = default;

void Results::begin_results(const Registry& registry) {
  begin_results_file(results_, study_, registry, measures_of(study_.metrics, registry));
  if (sets_->kept() != KeptSets::all) results_.member("sets", to_string(sets_->kept()));
  results_.key("pipelines").begin_array(Layout::lines);
}

void Results::begin_run(const Registry& registry) {
  begin_run_file(run_, study_, registry, utc_now());
  run_.key("pipelines").begin_array(Layout::lines);
}

void Results::begin_pipeline(const PipelineSpec& spec, std::optional<Rounding> rounding) {
  pipeline_ = csv_field(spec.name);
  pipeline_json_ = json_string(spec.name);
  rounding_ = rounding;
  results_.begin_object(Layout::lines)
      .member("name", spec.name)
      .member("backend", spec.backend.type);
  write_algorithms(results_, spec);
  results_.key("rounding");
  rounding ? results_.value(to_string(*rounding)) : results_.null();
  run_.begin_object(Layout::lines)
      .member("name", spec.name)
      .key("steps")
      .begin_array(Layout::lines);
}

void Results::end_pipeline(const PipelineOutcome& outcome, Summary row,
                           const std::vector<MetricValue>& measured) {
  const std::vector<ResultNumber> numbers = numbers_of(outcome);
  results_.end_object();
  write_numbers(results_, numbers, false);
  results_.end_object();
  row.fields = summary_fields(outcome, pipeline_, rounding_);
  summaries_.push_back(std::move(row));
  run_.end_array().key("summary").begin_object(Layout::lines);
  if (const EstimationOutcome* const found = outcome.estimation()) {
    run_.key("median_time_us");
    write_times(run_, found->median_us, found->median_hull_us);
  }
  run_.member("median_step_us", outcome.step_us.median)
      .member("percentile_99_step_us", outcome.step_us.percentile_99)
      .member("largest_step_us", outcome.step_us.largest)
      .member("wall_s", outcome.wall_s);
  for (const MetricValue& metric : measured) write(run_, metric);
  write_numbers(run_, numbers, true);
  run_.end_object().end_object();
}

void Results::begin_estimation(const PipelineSpec& spec, std::optional<Rounding> rounding,
                               const std::optional<Assumptions>& assumptions,
                               const std::vector<Gain>& gains, std::int64_t samples) {
  begin_pipeline(spec, rounding);
  sets_->begin_pipeline(samples);
  results_.key("assumptions");
  if (assumptions) {
    results_.begin_object(Layout::lines).key("initial_set");
    write(results_, assumptions->initial_set);
    results_.key("admissible_set");
    assumptions->admissible_set ? write(results_, *assumptions->admissible_set)
                                : void(results_.null());
    if (assumptions->restart_set) {
      results_.key("restart_set");
      write(results_, *assumptions->restart_set);
    }
    results_.member("follows_its_sets", assumptions->follows_its_sets);
    if (assumptions->lag > 0) results_.member("lag", assumptions->lag);
    results_.end_object();
  } else {
    results_.null();
  }
  write(results_, gains);
  results_.key("steps").begin_array(Layout::lines);
}

void Results::data(const Record& record) {
  if (last_sample_ && record.sample.k <= *last_sample_) return;
  const Labels& labels = study_.labels;
  const std::tuple<const char*, const Vector*, const Labels::Names&> parts[]{
      {"u", &record.sample.u, labels.inputs},
      {"y", &record.sample.y, labels.outputs},
      {"x", record.truth ? &*record.truth : nullptr, labels.states},
      {"n", record.fault ? &*record.fault : nullptr, labels.faults}};
  if (!last_sample_) {
    std::vector<std::string> names{"k"};
    for (const auto& [symbol, part, called] : parts) {
      for (Index i = 0; part && i < part->size(); ++i)
        names.push_back(csv_field(heading_of(called, symbol, i)));
    }
    with_mode_ = record.mode.has_value();
    if (with_mode_) names.push_back("mode");
    data_file_.write(joined(names));
  }
  std::vector<std::string> row{std::to_string(record.sample.k)};
  for (const auto& [symbol, part, called] : parts) {
    for (Index i = 0; part && i < part->size(); ++i)
      row.push_back(std::isnan((*part)[i]) ? "" : to_text((*part)[i]));
  }
  if (with_mode_) row.push_back(record.mode ? std::to_string(*record.mode) : "");
  data_file_.write(joined(row));
  last_sample_ = record.sample.k;
}

void Results::check_columns(const MetricValues& metrics) {
  if (!columns_) {
    columns_.emplace();
    for (const MetricValue& metric : metrics.reproducible) columns_->push_back(metric.name);
    return;
  }
  bool same = columns_->size() == metrics.reproducible.size();
  for (std::size_t i = 0; same && i < columns_->size(); ++i)
    same = (*columns_)[i] == metrics.reproducible[i].name;
  if (!same)
    throw Error(Errc::plugin,
                "the metrics name their values otherwise than in an earlier pipeline");
}

void Results::estimate(const StepResult& result) {
  const Estimate& estimate = result.estimate;
  results_.begin_object();
  write_members(results_, estimate, result.hull, result.inner, result.left_out);
  for (const MetricValue& metric : result.metrics.reproducible) write(results_, metric);
  results_.end_object();
  run_.begin_object().member("k", estimate.k).key("time_us");
  write_times(run_, result.times, result.hull_us);
  for (const MetricValue& metric : result.metrics.measured) write(run_, metric);
  run_.end_object();
  write_row(result);
  write_set(result);
  last_estimate_ = estimate.k;
}

void Results::write_header(Index states) {
  std::vector<std::string> names{"pipeline", "k", "consistent", "tightness"};
  const auto add_bounds = [&](std::initializer_list<const char*> bounds) {
    for (const char* bound : bounds) {
      for (Index i = 0; i < states; ++i)
        names.push_back(csv_field(heading_of(study_.labels.states, bound, i)));
    }
  };
  add_bounds({"lower", "upper"});
  if (columns_) {
    for (const std::string& name : *columns_) names.push_back(csv_field(name));
  }
  add_bounds({"inner_lower", "inner_upper"});
  steps_file_.write(joined(names));
  header_written_ = true;
}

void Results::write_row(const StepResult& result) {
  if (!header_written_) write_header(result.hull.dim());
  std::vector<std::string> row{pipeline_, std::to_string(result.estimate.k),
                               std::string(to_string(result.estimate.consistent)),
                               std::string(to_string(result.estimate.set.tightness))};
  for (const Vector* bound : {&result.hull.lower, &result.hull.upper}) {
    for (const double x : *bound) row.push_back(csv_number(x));
  }
  for (const MetricValue& metric : result.metrics.reproducible) row.push_back(csv_value(metric));
  if (result.inner) {
    for (const Vector* bound : {&result.inner->lower, &result.inner->upper}) {
      for (const double x : *bound) row.push_back(csv_number(x));
    }
  } else {
    row.resize(row.size() + static_cast<std::size_t>(2 * result.hull.dim()));
  }
  steps_file_.write(joined(row));
}

void Results::write_set(const StepResult& result) {
  if (sets_->kept() == KeptSets::none) return;
  sets_->write(set_json(result.estimate, result.hull, result.hull_proofs, pipeline_json_) + "\n");
}

void Results::end_estimation(const PipelineOutcome& outcome, const MetricValues& summary) {
  const EstimationOutcome& found = *outcome.estimation();
  sets_->end_pipeline();
  results_.end_array();
  write_last(results_, last_estimate_, found.last_hull);
  results_.key("summary").begin_object(Layout::lines);
  results_.member("steps", outcome.steps)
      .member("consistent", found.consistent)
      .member("inconsistent", found.inconsistent);
  results_.member("undecided", found.undecided);
  write_claim(results_, "inconsistent", found.inconsistent_from, found.inconsistent_proven);
  write_contradictions(results_, found);
  write_assumptions(results_, outcome, mode_names(study_));
  write_claim(results_, "outside", found.outside_from, found.outside_proven);
  write_time(results_, "violated_at", outcome.violated_at);
  if (outcome.left_open > 0) results_.member("left_open", outcome.left_open);
  write_inner(results_, found);
  write_growth(results_, found);
  results_.key("answers").begin_object();
  write(results_, "emptiness", found.emptiness);
  write(results_, "containment", found.containment);
  write(results_, "bounds", found.bounds);
  results_.end_object();
  write_error(results_, outcome);
  Summary row;
  for (const MetricValue& metric : summary.reproducible) {
    write(results_, metric);
    row.metrics[metric.name] = csv_value(metric);
    const bool known = std::find(summary_columns_.begin(), summary_columns_.end(), metric.name) !=
                       summary_columns_.end();
    if (!known) summary_columns_.push_back(metric.name);
  }
  end_pipeline(outcome, std::move(row), summary.measured);
}

void Results::write_summaries() {
  std::vector<std::string> names{
      "pipeline",     "backend",      "observer",        "rounding",          "steps",
      "consistent",   "inconsistent", "undecided",       "inconsistent_from", "assumptions_until",
      "outside_from", "violated_at",  "answers_decided", "answers_unknown",   "error"};
  const std::vector<std::string> none,
      &diagnosis = diagnosis_file_ ? diagnosis_summary_columns() : none,
      &design = inputs_file_ ? design_summary_columns() : none;
  names.insert(names.end(), diagnosis.begin(), diagnosis.end());
  names.insert(names.end(), design.begin(), design.end());
  for (const std::string& name : summary_columns_) names.push_back(csv_field(name));
  summary_file_.write(joined(names));
  for (Summary& summary : summaries_) {
    summary.diagnosis.resize(diagnosis.size());
    summary.fields.insert(summary.fields.end(), summary.diagnosis.begin(), summary.diagnosis.end());
    summary.design.resize(design.size());
    summary.fields.insert(summary.fields.end(), summary.design.begin(), summary.design.end());
    for (const std::string& name : summary_columns_)
      summary.fields.push_back(summary.metrics[name]);
    summary_file_.write(joined(summary.fields));
  }
}

std::vector<std::filesystem::path> Results::commit(const RunOutcome& outcome) {
  if (!header_written_) write_header(study_.model.states());
  if (diagnosis_file_ && !diagnosis_header_written_)
    write_diagnosis_header(study_.modes.size() + 1);
  write_summaries();
  const ResultTable table = table_of(study_, outcome);
  tables_.write(table, summarise(table));
  results_.end_array().end_object();
  results_file_.write("\n");
  double wall = 0;
  for (const PipelineOutcome& pipeline : outcome.pipelines) wall += pipeline.wall_s;
  run_.end_array().member("wall_s", wall).member("finished", utc_now()).end_object();
  run_file_.write("\n");
  return directory_.commit();
}

}  // namespace cordon::detail
