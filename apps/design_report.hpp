// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about designed inputs.
#pragma once

#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/design.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// One paragraph per design: outcome, inputs, pairs, search; with the exact proof, if there is one.
std::string designs_text(const Study& study, const std::vector<PipelineDesign>& designs, const Paint& paint);
std::string designs_json(const Study& study, const std::vector<PipelineDesign>& designs);

/// What went wrong, a sentence each: errors, tubes that are empty, claims that the exact proof refutes, what stayed open.
std::vector<std::string> complaints(const Study& study, const std::vector<PipelineDesign>& designs);
/// The code of the worst outcome: a refuted claim, an error or an empty tube, no answer.
Exit exit_of(const std::vector<PipelineDesign>& designs);

/// A design in a run, in short, and what became of the experiments with it.
std::string design_text(const Study& study, const PipelineOutcome& pipeline, const Paint& paint);
/// Names of modes whose tube is proven empty under the design: the model contradicts itself.
std::vector<std::string> empty_tubes(const Study& study, const DesignOutcome& outcome);

/// "name  N = 3  best 9.2, at least 8.7 (5.4 %)".
std::string design_progress(const std::string& name, Index horizon, double best, double bound);

}  // namespace cordon::apps
