// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of sets.jsonl beside the steps of results.json, one after another.
#pragma once

#include "study/results/recorded_run.hpp"

namespace cordon::verification {

/// Throws InputError where the two files do not tell the same.
class ReportedSets {
 public:
  explicit ReportedSets(const RecordedRun& run) : run_(run), sets_(run.files) {}

  /// The next line, of this step.
  RecordedSet of(const RecordedPipeline& pipeline, const RecordedStep& step);
  /// Both files tell what is claimed of the set. What results.json says is checked.
  void expect_same_claims(const RecordedStep& step, const RecordedSet& row) const;
  void expect_end();

  [[noreturn]] void refuse(std::int64_t line, const std::string& reason) const;

 private:
  const RecordedRun& run_;
  SetReader sets_;
};

}  // namespace cordon::verification
