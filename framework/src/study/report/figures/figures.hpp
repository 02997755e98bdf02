// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of a report, one function per subject. Each appends what its subject has.
#pragma once

#include "study/report/figure.hpp"
#include "study/report/figures/curves.hpp"
#include "study/report/figures/run_files.hpp"

namespace cordon::report {

/// Where a figure stands: the headings of a page.
namespace section {
inline const std::string bounds = "Bounds", sets = "Sets", metrics = "Metrics";
}

/// Bounds of every state over time.
void add_bounds(const RunFiles& files, const Curves& curves, Report& report);
/// Pairs of coordinates of the sets at chosen times.
void add_projections(const RunFiles& files, const Curves& curves, Report& report);
/// Every metric that is a number, and the time of a step.
void add_metrics(const RunFiles& files, const Curves& curves, Report& report);

}  // namespace cordon::report
