// SPDX-License-Identifier: GPL-3.0-or-later
// How the parts of a recorded run are read.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "study/reading/read_parts.hpp"
#include "study/results/recorded_run.hpp"
#include "study/text/input_file.hpp"

namespace cordon::verification {

template <class Enum>
std::optional<Enum> read_word(const json::Cursor& object, const char* key,
                              std::initializer_list<Enum> all) {
  const auto at = object.need(key, not_as_written);
  if (!at) return std::nullopt;
  std::vector<std::string> words;
  for (const Enum one : all) words.emplace_back(to_string(one));
  const auto word = json::read_choice(*at, words);
  if (!word) return std::nullopt;
  return *(all.begin() + (std::find(words.begin(), words.end(), *word) - words.begin()));
}

/// "design" and "exact" of a pipeline with a designer. Pairs and tubes have the names of their
/// modes, in the order of the bank; what is said of an input that is not there is refused.
RecordedDesign read_designed(const json::Cursor& pipeline, const json::SystemPart& system);

/// A step of a diagnosis; its mode is a name still.
std::optional<RecordedDiagnosis::Step> read_diagnosed_step(const json::Cursor& at);

/// "modes", "assumptions", and where the summary tells the state. Steps are checked against the
/// modes.
RecordedDiagnosis read_diagnosed(const json::Cursor& pipeline, const json::SystemPart& system,
                                 std::vector<RecordedDiagnosis::Step> steps);

/// Where "last", "summary" and "numbers" say what the steps do not.
std::vector<Diagnostic> contradictions_of(const json::Cursor& pipeline,
                                          const std::vector<RecordedStep>& steps);

}  // namespace cordon::verification
