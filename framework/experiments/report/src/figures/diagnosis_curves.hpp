// SPDX-License-Identifier: GPL-3.0-or-later
// The curves of diagnosis.csv.
#pragma once

#include <string>
#include <vector>

#include "experiments/report/thinning.hpp"
#include "figures/run_files.hpp"

namespace cordon::report {

/// One pipeline with a diagnoser.
struct DiagnosisCurves {
  bool any = false;                             ///< the table has rows of it
  std::vector<std::vector<Thinner>> residuals;  ///< by mode, by output
  std::vector<Thinner> faults,
      fault_estimates;                ///< by column of F, over the time that is spoken of
  std::vector<Timeline::Span> spans;  ///< what became of the modes; row: the mode
  std::vector<Timeline::Span> truth;  ///< row: the true mode; of `outside`: the number of modes
  bool spans_left_out = false;
};

struct DiagnosisTable {
  std::size_t modes = 0, outputs = 0, faults = 0;
  std::vector<DiagnosisCurves> pipelines;
  std::vector<Thinner> fault_truth;  ///< by column of F
  bool thinned = false;
};

DiagnosisTable read_diagnoses(const RunFiles& files);

}  // namespace cordon::report
