// SPDX-License-Identifier: GPL-3.0-or-later
// What the files hold of pipelines with an input designer.
#include "results_design.hpp"

#include "design_json.hpp"
#include "study/results/results.hpp"
#include "study/results/results_parts.hpp"
#include "study/text/numbers.hpp"

namespace cordon::detail {

namespace {

using Layout = JsonWriter::Layout;

void write_inputs(Sink& file, const std::string& pipeline, const Matrix& u) {
  for (Index k = 0; k < u.rows(); ++k) {
    std::vector<std::string> row{pipeline, std::to_string(k)};
    for (Index i = 0; i < u.cols(); ++i) row.push_back(to_text(u(k, i)));
    file.write(joined(row));
  }
}

std::vector<std::string> design_fields(const PipelineOutcome& outcome) {
  std::vector<std::string> fields{csv_field(outcome.designer), csv_field(outcome.diagnoser)};
  if (const auto& design = outcome.design) {
    const auto& best = design->best;
    fields.emplace_back(to_string(design->status));
    fields.push_back(std::to_string(design->horizon));
    fields.push_back(best ? csv_number(best->cost) : "");
    fields.push_back(csv_number(design->lower_bound));
    fields.push_back(outcome.exact ? std::string(to_string(outcome.exact->separates())) : "");
  }
  if (outcome.experiments.empty()) return fields;
  std::int64_t runs = 0, isolated = 0, wrong = 0;
  for (const ExperimentRow& row : outcome.experiments) {
    runs += row.runs;
    isolated += row.isolated;
    wrong += row.wrong;
  }
  for (const std::int64_t count : {runs, isolated, wrong}) fields.push_back(std::to_string(count));
  return fields;
}

}  // namespace

const std::vector<std::string>& design_summary_columns() {
  static const std::vector<std::string> names{"designer",
                                              "experiment_diagnoser",
                                              "design_status",
                                              "horizon",
                                              "cost",
                                              "lower_bound",
                                              "separates",
                                              "experiments",
                                              "experiments_isolated",
                                              "experiments_wrong"};
  return names;
}

void write_inputs_header(Sink& file, Index inputs) {
  std::vector<std::string> names{"pipeline", "k"};
  for (Index i = 1; i <= inputs; ++i) names.push_back("u_" + std::to_string(i));
  file.write(joined(names));
}

void Results::design(const PipelineSpec& spec, std::optional<Rounding> rounding,
                     const PipelineOutcome& outcome) {
  ModeNames modes;
  for (const Mode& mode : bank_of(study_).modes) modes.push_back(mode.name);
  const std::string name = csv_field(spec.name),
                    used = rounding ? std::string(to_string(*rounding)) : "";
  results_.begin_object(Layout::lines)
      .member("name", spec.name)
      .member("backend", spec.backend.type)
      .member("designer", spec.designer->type);
  results_.key("diagnoser");
  spec.diagnoser ? results_.value(spec.diagnoser->type) : results_.null();
  results_.key("rounding");
  rounding ? results_.value(used) : results_.null();
  results_.key("modes").begin_array();
  for (const std::string& mode : modes) results_.value(mode);
  results_.end_array().key("design");
  outcome.design ? write(results_, *outcome.design, modes) : void(results_.null());
  results_.key("exact");
  outcome.exact ? write(results_, *outcome.exact, modes) : void(results_.null());
  results_.key("experiments");
  write(results_, outcome.experiments, modes);
  results_.key("summary").begin_object(Layout::lines);
  write_assumptions(results_, outcome, modes);
  results_.key("refuted").begin_array(outcome.refuted.empty() ? Layout::line : Layout::lines);
  for (const std::string& claim : outcome.refuted) results_.value(claim);
  results_.end_array();
  write_time(results_, "violated_at", outcome.violated_at);
  results_.key("error");
  outcome.error.empty() ? results_.null() : results_.value(outcome.error);
  const std::vector<ResultNumber> numbers = numbers_of(outcome);
  results_.end_object();
  write_numbers(results_, numbers, false);
  results_.end_object();
  if (outcome.design && outcome.design->best)
    write_inputs(*inputs_file_, name, outcome.design->best->u);
  Summary row;
  row.fields.assign(15, "");
  row.fields[0] = name;
  row.fields[1] = csv_field(outcome.backend);
  row.fields[3] = used;
  row.fields[4] = std::to_string(outcome.steps);
  row.fields[9] = csv_time(outcome.assumptions_until);
  row.fields[11] = csv_time(outcome.violated_at);
  row.fields[14] = csv_field(outcome.error);
  row.design = design_fields(outcome);
  summaries_.push_back(std::move(row));
  run_.begin_object(Layout::lines).member("name", spec.name).key("steps").begin_array().end_array();
  run_.key("summary")
      .begin_object(Layout::lines)
      .member("median_step_us", outcome.median_step_us)
      .member("largest_step_us", outcome.largest_step_us);
  run_.member("wall_s", outcome.wall_s);
  write_numbers(run_, numbers, true);
  run_.end_object().end_object();
}

}  // namespace cordon::detail
