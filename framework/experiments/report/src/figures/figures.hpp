// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of a report, one function per subject. Each appends what its subject has.
#pragma once

#include <optional>
#include <vector>

#include "experiments/report/figure.hpp"
#include "figures/curves.hpp"
#include "figures/run_files.hpp"

namespace cordon::report {

/// Where a figure stands: the headings of a page.
namespace section {
inline const std::string bounds = "Bounds", sets = "Sets", data = "Data", metrics = "Metrics",
                         diagnosis = "Diagnosis", designs = "Designed inputs",
                         answers = "Answers and proofs", comparison = "Comparison", sweep = "Sweep";
}

/// Pipelines side by side: who is best where, means and deviations, and measures over the values of
/// a sweep.
void add_comparisons(const RunFiles& files, Report& report);
/// Bounds of every state over time, their widths, and what of them a long transient hides.
void add_bounds(const RunFiles& files, const Curves& curves, Report& report);
/// Pairs of coordinates of the sets at chosen times.
void add_projections(const RunFiles& files, const Curves& curves, Report& report);
/// Modes over time, scores, bounds of faults, residuals.
void add_diagnosis(const RunFiles& files, const Curves& curves, Report& report);
/// Designed inputs, tubes of outputs, what keeps pairs of modes apart, experiments.
void add_designs(const RunFiles& files, Report& report);
/// Outputs and inputs over time.
void add_data(const RunFiles& files, const Curves& curves, Report& report);
/// Errors and violations, as notes.
void add_failures(const RunFiles& files, Report& report);
/// What diagnosers promise before any experiment.
void add_guarantees(const RunFiles& files, Report& report);
/// What was proven, assumed and promised.
void add_answers(const RunFiles& files, const Curves& curves, Report& report);
/// Every metric that is a number, and the time of a step.
void add_metrics(const RunFiles& files, const Curves& curves, Report& report);

/// Where the transient of a run ends: the first k from which on no curve exceeds twice the largest
/// value that it has in the second half of its time. Nothing: it has none, or the curves are short.
std::optional<double> end_of_transient(const std::vector<const Series*>& widths);
/// The plot from k on, if its values there take less than a quarter of the height of the whole, so
/// that they can hardly be read in it; else nothing.
std::optional<Plot> hidden_after(const Plot& plot, double k);
/// Is a logarithmic axis better? Values over more than a power of ten, all of them positive.
bool is_logarithmic(double smallest, double largest);

/// Times of plots and timelines in seconds in place of steps.
void show_seconds(Report& report, double sampling_time);

}  // namespace cordon::report
