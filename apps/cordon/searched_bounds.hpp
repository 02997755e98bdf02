// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds that explain data, sought with the estimates of a pipeline: for systems of which no linear
// program finds them.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "common.hpp"
#include "cordon/study/identify.hpp"
#include "cordon/study/study.hpp"

namespace cordon::apps {

struct SearchedBounds {
  double refuted = 0;      ///< with this factor an estimate is proven empty, as the pipeline rounds
  Index empty_at = -1;     ///< k of that estimate
  double kept = infinity;  ///< with this one none is; ∞: none was found up to 1000
  Index fails_at = -1;     ///< with `kept`: k from which the rest of the samples contradicts it
  Index wider_fails_at = -1;  ///< the same with the margin added
};

struct BoundSearch {
  const Study& study;
  const PipelineSpec& pipeline;  ///< with an observer
  const Registry& registry;
  std::span<const Sample> samples, all;  ///< from which the factor comes; on which it is tried
  Scaled scaled;                         ///< not `each`
  double margin = 0;                     ///< a share of the factor, tried where it fails
};

/// W(s) = c + s G [-1,1]^g, rows of constraints as they are; V likewise. Factors are doubled or
/// halved until one is refuted and one is not, and then halved between them down to a hundredth.
/// Estimates that cannot be enclosed refute nothing. `stop` is asked between runs.
SearchedBounds search_bounds(const BoundSearch& search, const std::function<bool()>& stop);

/// `kept` for what was scaled, if there is one.
BoundFactors factors_of(const SearchedBounds& found, const BoundSearch& search);

std::string text_of(const SearchedBounds& found, const BoundSearch& search);
std::string json_of(const SearchedBounds& found, const BoundSearch& search);

}  // namespace cordon::apps
