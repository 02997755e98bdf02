// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about designed inputs.
#pragma once

#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/design.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// One paragraph per design: outcome, inputs, pairs with what is proven of them and what is claimed
/// only, search.
std::string designs_text(const Study& study, const std::vector<PipelineDesign>& designs,
                         const Paint& paint);
std::string designs_json(const Study& study, const std::vector<PipelineDesign>& designs);

/// What went wrong, a sentence each: errors, tubes that are empty, claims that are refuted; if all
/// is to be proven, what stayed open.
std::vector<std::string> complaints(const Study& study, const std::vector<PipelineDesign>& designs,
                                    bool all_proven);
/// The code of the worst outcome: a refuted claim, an error or an empty tube, no answer.
Exit exit_of(const std::vector<PipelineDesign>& designs, bool all_proven);
/// The same of refuted claims alone.
std::vector<std::string> refutations(const std::string& pipeline,
                                     const std::vector<std::string>& refuted);

/// A design in a run, in short, and what became of the experiments with it.
std::string design_text(const Study& study, const PipelineOutcome& pipeline, const Paint& paint);
/// Names of modes whose tube is empty under the design: the model contradicts itself.
std::vector<std::string> empty_tubes(const Study& study, const PipelineOutcome& pipeline);

/// "name  N = 3  best 9.2, at least 8.7 (5.4 %)".
std::string design_progress(const std::string& name, Index horizon, double best, double bound);

}  // namespace cordon::apps
