// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon compare` prints.
#pragma once

#include <string>

#include "cordon/experiments/compare.hpp"

namespace cordon::apps {

/// What a row of a comparison says in words: "equal", "different at 3 of 50 points", "12 % faster,
/// p = 0.001", "not significant".
std::string verdict_of(const ResultColumn& column, const ComparedNumber& first,
                       const ComparedNumber& other);

/// The runs, a table per number that differs and is shown in comparison tables, the others by name,
/// and warnings.
std::string compare_text(const Comparison& comparison);
std::string compare_markdown(const Comparison& comparison);
/// Every number, one row per run.
std::string compare_csv(const Comparison& comparison);
std::string compare_json(const Comparison& comparison);

}  // namespace cordon::apps
