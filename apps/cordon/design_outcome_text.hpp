// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of what is printed about one design: its outcome, the horizon, the input with its pairs
// of modes, the search.
#pragma once

#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/design.hpp"

namespace cordon::apps {

using Names = std::vector<std::string>;

Names mode_names(const Study& study);

/// What the designer claims of its search.
std::string status_text(const DesignOutcome& outcome, const std::string& designer,
                        const ExactSeparation* exact, const Paint& paint);
/// What was searched in place of the problem.
std::string restriction_text(const DesignOutcome& outcome);
std::string horizon_text(const DesignOutcome& outcome);
std::string reason_text(const DesignOutcome& outcome, const ExactSeparation* exact);
std::string search_text(const DesignOutcome& outcome, double design_s);
std::string refuted_text(const Names& refuted, const Paint& paint);

/// What there is to say of an input: the sequence, the pairs of modes, and what is proven of them.
std::string input_text(const Labels& labels, const Names& modes, const InputDesign& best,
                       const ExactSeparation* exact, const Paint& paint);

/// Modes whose tube is empty, as the designer says or by the exact proof.
Names empty_modes(const Names& modes, const std::vector<Answer>& empty,
                  const ExactSeparation* exact);
std::string empty_text(const Names& empty);

}  // namespace cordon::apps
