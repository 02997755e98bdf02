// SPDX-License-Identifier: GPL-3.0-or-later
#include "reported_sets.hpp"

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::verification {

void ReportedSets::refuse(std::int64_t line, const std::string& reason) const {
  throw InputError((run_.files.directory() / "sets.jsonl").string(),
                   {{"", reason, "the file is not as \"cordon run\" wrote it; run the study again",
                     static_cast<int>(line)}});
}

RecordedSet ReportedSets::of(const RecordedPipeline& pipeline, const RecordedStep& step) {
  std::optional<RecordedSet> row = sets_.next();
  if (!row) refuse(0, fmt::format("ends before pipeline \"{}\", k = {}", pipeline.name, step.k));
  if (row->pipeline != pipeline.name || row->k != step.k || row->set.dim() != run_.model.states()) {
    refuse(row->line,
           fmt::format("does not hold the set of pipeline \"{}\", k = {}", pipeline.name, step.k));
  }
  return std::move(*row);
}

void ReportedSets::expect_same_claims(const RecordedStep& step, const RecordedSet& row) const {
  if (row.tightness != step.tightness)
    refuse(row.line, fmt::format("says tightness \"{}\", results.json \"{}\"",
                                 to_string(row.tightness), to_string(step.tightness)));
  if (row.consistent != step.consistent)
    refuse(row.line, fmt::format("says consistent \"{}\", results.json \"{}\"",
                                 to_string(row.consistent), to_string(step.consistent)));
}

void ReportedSets::expect_end() {
  if (const auto extra = sets_.next())
    refuse(extra->line, "has more lines than results.json has steps");
}

}  // namespace cordon::verification
