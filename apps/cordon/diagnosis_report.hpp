// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about pipelines with a diagnoser.
#pragma once

#include <string>

#include "common.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// [a, b], for several coordinates [a, b] × [c, d]; ∅ for an empty box. Numbers with 4 significant
/// digits, or, for tables, with 4 decimals if that shows them well.
enum class Digits { significant, decimals };
std::string box_text(const Box& box, Digits digits = Digits::significant);

/// The timeline of the first seed, then delays and counts over all seeds, of modes and of additive
/// faults.
std::string diagnosis_text(const Study& study, const PipelineOutcome& pipeline, const Paint& paint);

/// A line about the assumption that has failed first; "" if none has.
std::string assumption_text(const Study& study, const PipelineOutcome& pipeline,
                            const Paint& paint);

/// What to say of a pipeline that has excluded the true mode, or bounds without the true fault
/// (`violated_at`).
std::string diagnosis_violation(const Labels& labels, const PipelineOutcome& pipeline);

/// Statements made in advance: tables, one row per additive fault, and one per observer and true
/// mode.
std::string guarantees_text(const Guarantees& guarantees, const Labels& labels,
                            const std::vector<std::string>& modes, const Paint& paint);

}  // namespace cordon::apps
