// SPDX-License-Identifier: GPL-3.0-or-later
// What the files hold of pipelines with a diagnoser.
#include "results_diagnosis.hpp"

#include <fmt/format.h>

#include "study/results/diagnosis_json.hpp"
#include "study/results/results.hpp"
#include "study/results/results_parts.hpp"

namespace cordon::detail {

namespace {

using Layout = JsonWriter::Layout;

/// A mode's index as a field; empty for -1.
std::string mode_field(Index mode) { return csv_time(mode); }

/// Sums over all true modes, in the order of the columns.
std::vector<std::string> diagnosis_fields(const PipelineOutcome& outcome) {
  const DiagnosisOutcome& found = *outcome.diagnosis();
  std::vector<std::string> fields{csv_field(found.diagnoser), std::to_string(found.runs)};
  if (!found.truth_known) return fields;
  std::int64_t segments = 0, isolated = 0, missed = 0, outside = 0, unknown = 0;
  for (const ModeStatistics& counts : found.statistics) {
    segments += counts.segments;
    isolated += counts.isolated;
    missed += counts.missed;
    outside += counts.mode < 0 ? counts.segments : 0;
    unknown += counts.mode < 0 ? counts.unknown_fault : 0;
  }
  for (const std::int64_t count : {segments, isolated, missed, outside, unknown, found.false_alarms,
                                   found.runs_with_false_alarm, found.runs_with_wrong_mode}) {
    fields.push_back(std::to_string(count));
  }
  return fields;
}

/// Five fields per additive fault, empty where there is no bound.
std::vector<std::string> fault_fields(const std::vector<JudgedBound>& faults, Index count) {
  std::vector<std::string> fields(static_cast<std::size_t>(5 * count));
  for (const auto& [bound, truth] : faults) {
    std::string* field = &fields[static_cast<std::size_t>(5 * bound.fault)];
    *field++ = std::to_string(bound.at);
    *field++ = csv_number(bound.lower);
    *field++ = csv_number(bound.estimate);
    *field++ = csv_number(bound.upper);
    *field++ = truth ? csv_number(*truth) : "";
  }
  return fields;
}

}  // namespace

const std::vector<std::string>& diagnosis_summary_columns() {
  static const std::vector<std::string> names{"diagnoser",
                                              "runs",
                                              "segments",
                                              "isolated",
                                              "missed",
                                              "outside_the_bank",
                                              "unknown_fault",
                                              "false_alarms",
                                              "runs_with_false_alarm",
                                              "runs_with_wrong_mode"};
  return names;
}

void Results::begin_diagnosis(const PipelineSpec& spec, std::optional<Rounding> rounding,
                              const DiagnosisOutcome& outcome) {
  begin_pipeline(spec, rounding);
  modes_ = outcome.modes;
  results_.key("modes").begin_array();
  for (const std::string& name : outcome.modes) results_.value(name);
  results_.end_array().key("guarantees");
  if (outcome.guarantees) {
    write(results_, *outcome.guarantees, outcome.modes);
  } else {
    results_.null();
  }
  results_.key("assumptions");
  if (outcome.assumptions) {
    write(results_, *outcome.assumptions, outcome.modes);
  } else {
    results_.null();
  }
  results_.key("steps").begin_array(Layout::lines);
}

void Results::write_diagnosis_header(std::size_t modes) {
  std::vector<std::string> names{"pipeline", "k",     "decision", "mode",
                                 "truth",    "since", "suggested"};
  for (std::size_t j = 0; j < modes; ++j) {
    const std::string of_mode = fmt::format("_{}", j);
    names.push_back("candidate" + of_mode);
    names.push_back("consistent" + of_mode);
    for (const char* bound : {"lower", "upper"}) {
      for (Index i = 0; i < study_.model.outputs(); ++i)
        names.push_back(csv_field(heading_of(study_.labels.outputs, bound + of_mode, i)));
    }
  }
  for (Index i = 0; i < study_.model.linear.faults(); ++i) {
    for (const char* name :
         {"fault_at", "fault_lower", "fault_estimate", "fault_upper", "fault_truth"})
      names.push_back(csv_field(heading_of(study_.labels.faults, name, i)));
  }
  diagnosis_file_->write(joined(names));
  diagnosis_header_written_ = true;
}

void Results::diagnosis(const DiagnosisResult& result) {
  const Diagnosis& diagnosis = result.diagnosis;
  write(results_, diagnosis, result.truth, result.faults, modes_);
  run_.begin_object().member("k", diagnosis.k).member("step_us", result.step_us).end_object();
  if (!diagnosis_header_written_) write_diagnosis_header(modes_.size());
  std::vector<std::string> row{pipeline_,
                               std::to_string(diagnosis.k),
                               std::string(to_string(diagnosis.decision)),
                               mode_field(diagnosis.mode),
                               result.truth ? std::to_string(*result.truth) : "",
                               std::to_string(diagnosis.since),
                               mode_field(diagnosis.suggested)};
  const auto outputs = static_cast<std::size_t>(study_.model.outputs());
  for (const ModeEvidence& evidence : diagnosis.modes) {
    row.emplace_back(evidence.candidate ? "1" : "0");
    row.emplace_back(to_string(evidence.consistent));
    for (const Vector* bound : {&evidence.residual.lower, &evidence.residual.upper}) {
      std::vector<std::string> fields(
          outputs);  // empty where the diagnoser offers no residual of this size
      for (std::size_t i = 0; i < outputs && static_cast<Index>(outputs) == bound->size(); ++i) {
        fields[i] = csv_number((*bound)[static_cast<Index>(i)]);
      }
      row.insert(row.end(), fields.begin(), fields.end());
    }
  }
  const std::vector<std::string> faults = fault_fields(result.faults, study_.model.linear.faults());
  row.insert(row.end(), faults.begin(), faults.end());
  diagnosis_file_->write(joined(row));
}

void Results::end_diagnosis(const PipelineOutcome& outcome) {
  results_.end_array().key("summary").begin_object(Layout::lines).member("steps", outcome.steps);
  write_members(results_, *outcome.diagnosis());
  write_assumptions(results_, outcome, modes_);
  write_time(results_, "violated_at", outcome.violated_at);
  if (outcome.left_open > 0) results_.member("left_open", outcome.left_open);
  write_error(results_, outcome);
  end_pipeline(outcome, {.diagnosis = diagnosis_fields(outcome)});
}

}  // namespace cordon::detail
