// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about pipelines with an observer beside their comparison: gains, widths at the
// end, inner estimates.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "common.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

// Tables with a title and an empty line behind; "" where no pipeline has anything to tell. All
// pipelines of the outcome estimate.

/// Which metrics compare states of different units as they are.
std::string units_text(const RunOutcome& outcome, const Labels& labels);
/// Samples that contradict the model: why the first estimate is empty, what was left out, and how
/// often an observer has begun anew.
std::string contradictions_text(const Study& study, const RunOutcome& outcome, const Paint& paint);
/// Gains with the names of their pipelines.
using NamedGains = std::vector<std::pair<std::string, std::vector<Gain>>>;
NamedGains gains_of(const RunOutcome& outcome);
/// One row per gain.
std::string gains_text(const NamedGains& all, const Paint& paint);
/// One row per pipeline, one column per state, up to eight states.
std::string widths_text(const RunOutcome& outcome, const Labels& labels, const Paint& paint);
/// One row per pipeline that offers an inner estimate.
std::string inner_text(const RunOutcome& outcome, const Labels& labels, const Paint& paint);
/// One row per pipeline whose bounds grow, and what to do about it.
std::string growth_text(const RunOutcome& outcome, const Labels& labels, const Paint& paint);

/// The number, null for NaN, "inf" and "-inf".
nlohmann::ordered_json json_number(double value);
/// The same as in results.json.
nlohmann::ordered_json gains_json(const std::vector<Gain>& gains);
/// The matrix as a list of rows, with all its digits.
nlohmann::ordered_json matrix_json(const Matrix& matrix);
/// The same as in results.json; null if nothing grows.
nlohmann::ordered_json growth_json(const EstimationOutcome& found);
/// {hull, width}; null if there was no step.
nlohmann::ordered_json last_json(const EstimationOutcome& found);

}  // namespace cordon::apps
