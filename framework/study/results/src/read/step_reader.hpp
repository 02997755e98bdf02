// SPDX-License-Identifier: GPL-3.0-or-later
// steps[] of all pipelines of results.json.
#pragma once

#include <vector>

#include "read/recorded_parts.hpp"

namespace cordon::verification {

/// The steps of all pipelines, read one after another before it is known of which kind a pipeline
/// is: what is wrong with them matters where it has an observer, or a diagnoser.
class StepReader {
 public:
  void take(const json::Cursor& at, std::size_t pipeline);

  /// Those of one pipeline with an observer, whose hulls must be boxes of the state.
  std::vector<RecordedStep> of(const json::Cursor& pipeline, std::size_t index, Index n, Index p);
  /// Those of one with a diagnoser.
  std::vector<RecordedDiagnosis::Step> of_diagnosis(const json::Cursor& pipeline,
                                                    std::size_t index);

 private:
  struct Steps {
    std::vector<RecordedStep> read;
    std::vector<RecordedDiagnosis::Step> diagnosed;
    std::vector<Diagnostic> wrong;
  };
  std::vector<Steps> steps_;
};

}  // namespace cordon::verification
