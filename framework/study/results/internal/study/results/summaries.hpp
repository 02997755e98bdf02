// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of a run or a sweep as files.
#pragma once

#include "cordon/study/statistics.hpp"
#include "study/text/atomic_directory.hpp"

namespace cordon::detail {

/// summary.tex, summary.md, benchmarks.csv: created first, so that they have their place in the
/// order of files.
class TableFiles {
 public:
  explicit TableFiles(AtomicDirectory& directory);
  void write(const ResultTable& table, const Summary& summary) const;

 private:
  Sink &tex_, &markdown_, &benchmarks_;
};

/// Those of a sweep: these three, summary.csv, and times.csv with the statistics of measured
/// numbers.
void write_summaries(AtomicDirectory& directory, const ResultTable& table, const Summary& summary);

}  // namespace cordon::detail
