// SPDX-License-Identifier: GPL-3.0-or-later
// Components with the names and parameters of the shipped plugins that do nothing: reading a study
// needs no algorithm. And helpers to read studies from texts.
#pragma once

#include <filesystem>
#include <string>

#include "cordon/registry/registry.hpp"
#include "cordon/study/study.hpp"
#include "study/study_texts.hpp"

namespace study_test {

/// Backends interval, zonotope, constrained_zonotope, line_zonotope; observers
/// prediction_correction, descriptor and `all_kinds` (one parameter of every kind); the metrics of
/// the shipped plugin and `quantile` with a required parameter; the diagnosers `observer_bank`
/// (with an observer inside), `committee` (with a diagnoser inside) and `fault_filter` (for
/// additive faults); the observer `luenberger` with a gain that may be written as a matrix, the
/// gains `given` and `optimal`; the plant `reactor` with two states, two inputs and one output; the
/// designers `search` and `given`. All observers but `descriptor`, and `fault_filter`, take
/// uncertain models.
void register_fakes(cordon::Registrar& registrar);

/// `text` with its only occurrence of `from` exchanged. Throws std::logic_error if there is none or
/// more than one.
std::string exchanged(std::string text, const std::string& from, const std::string& to);

/// Reads a text as a study with the fake components.
cordon::Study read_text(const std::string& text);
/// The problems of a text; none if it is valid.
std::vector<cordon::Diagnostic> problems_of(const std::string& text);

}  // namespace study_test
