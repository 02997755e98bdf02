// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/read_report.hpp"

#include "figures/figures.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t max_study = 1'000'000;  ///< bytes of the study's text in a report

/// Runs of the first versions of the format have none.
bool has_numbers(const RunFiles& files) {
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    if (!files.tree(p).find("numbers")) return false;
  }
  return !files.pipelines().empty();
}

void add_run(const RunFiles& files, Report& report) {
  const Curves curves = read_curves(files);
  add_failures(files, report);
  if (has_numbers(files)) add_comparisons(files, report);
  add_bounds(files, curves, report);
  if (const std::string kept = text_of(files.root(), "sets"); kept == "last") {
    report.notes.emplace_back("Only the last sets were kept (--sets last).");
  } else if (kept == "none") {
    report.notes.emplace_back("No sets were kept (--sets none).");
  }
  add_projections(files, curves, report);
  if (files.any(PipelineKind::diagnosis)) add_diagnosis(files, curves, report);
  if (files.any(PipelineKind::design)) add_designs(files, report);
  add_data(files, curves, report);
  add_metrics(files, curves, report);
  add_answers(files, curves, report);
}

}  // namespace

Report read_report(const std::filesystem::path& directory, Detail detail) {
  const RunFiles files(directory, detail);
  Report report;
  report.title = files.title();
  for (const PipelineHead& head : files.pipelines()) report.pipelines.push_back(head.name);
  report.versions = files.versions();
  if (files.study().size() <= max_study) {
    report.study = files.study();
  } else {
    report.notes.emplace_back("The study is too long to be repeated here; results.json holds it.");
  }
  if (files.is_sweep()) {
    add_comparisons(files, report);
  } else {
    add_run(files, report);
  }
  if (files.labels().sampling_time > 0) show_seconds(report, files.labels().sampling_time);
  files.check();
  return report;
}

}  // namespace cordon::report
