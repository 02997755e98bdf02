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

std::vector<std::string> design_fields(const DesignedOutcome& found) {
  std::vector<std::string> fields{csv_field(found.designer), csv_field(found.diagnoser)};
  if (const auto& design = found.design) {
    const auto& best = design->best;
    fields.emplace_back(to_string(design->status));
    fields.push_back(std::to_string(design->horizon));
    fields.push_back(best ? csv_number(best->cost) : "");
    fields.push_back(csv_number(design->lower_bound));
    fields.push_back(found.exact ? std::string(to_string(found.exact->separates())) : "");
  }
  if (found.experiments.empty()) return fields;
  std::int64_t runs = 0, isolated = 0, wrong = 0;
  for (const ExperimentRow& row : found.experiments) {
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

void write_inputs_header(Sink& file, Index inputs, const Labels& labels) {
  std::vector<std::string> names{"pipeline", "k"};
  for (Index i = 0; i < inputs; ++i) names.push_back(csv_field(heading_of(labels.inputs, "u", i)));
  file.write(joined(names));
}

void Results::design(const PipelineSpec& spec, std::optional<Rounding> rounding,
                     const PipelineOutcome& outcome) {
  const DesignedOutcome& found = *outcome.design();
  const ModeNames modes = mode_names(study_);
  begin_pipeline(spec, rounding);
  results_.key("modes").begin_array();
  for (const std::string& mode : modes) results_.value(mode);
  results_.end_array().key("design");
  found.design ? write(results_, *found.design, modes) : void(results_.null());
  results_.key("exact");
  found.exact ? write(results_, *found.exact, modes) : void(results_.null());
  results_.key("experiments");
  write(results_, found.experiments, modes);
  results_.key("summary").begin_object(Layout::lines);
  write_assumptions(results_, outcome, modes);
  results_.key("refuted").begin_array(found.refuted.empty() ? Layout::line : Layout::lines);
  for (const std::string& claim : found.refuted) results_.value(claim);
  results_.end_array();
  write_time(results_, "violated_at", outcome.violated_at);
  write_error(results_, outcome);
  if (found.design && found.design->best)
    write_inputs(*inputs_file_, pipeline_, found.design->best->u);
  end_pipeline(outcome, {.design = design_fields(found)});
}

}  // namespace cordon::detail
