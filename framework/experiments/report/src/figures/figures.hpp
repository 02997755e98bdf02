// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of a report, one function per subject. Each appends what its subject has.
#pragma once

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
/// Bounds of every state over time.
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
/// What was proven, assumed and promised.
void add_answers(const RunFiles& files, const Curves& curves, Report& report);
/// Every metric that is a number, and the time of a step.
void add_metrics(const RunFiles& files, const Curves& curves, Report& report);

/// Times of plots and timelines in seconds in place of steps.
void show_seconds(Report& report, double sampling_time);

}  // namespace cordon::report
