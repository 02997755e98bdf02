// SPDX-License-Identifier: GPL-3.0-or-later
// Systems in continuous time, which are sampled when a study is read.
#pragma once

#include "study/reading/read_parts.hpp"
#include "study/sampling/sampled_model.hpp"

namespace cordon::json {

/// What a system in continuous time was before it was sampled.
struct ContinuousPart {
  double time = 0;  ///< from sample to sample
  sampling::DisturbanceSignal disturbance = sampling::DisturbanceSignal::any;
  Matrix Bw;                                           ///< of ẋ = A x + B u + Bw w
  std::shared_ptr<const sampling::Sampling> sampling;  ///< of the nominal mode
};
/// The keys "continuous" and "disturbance" of a system, and whether it has a "sampling_time";
/// nothing where it is in discrete time, or where anything is wrong with them.
std::shared_ptr<const ContinuousPart> read_continuous(const Cursor& system);
/// Samples the model, which is written at `system`, and tells what it was; nothing: reported.
std::shared_ptr<const ContinuousPart> sample(const Cursor& system, const ContinuousPart& part,
                                             sampling::Matrices matrices, Model& model,
                                             std::vector<std::string>& warnings);
/// Samples an additive fault of a mode.
bool sample(const Cursor& additive, const ContinuousPart& part, Additive& fault);
/// What B w adds to the state from sample to sample, w ∈ W, where matrices are not kept.
std::optional<LineForm> sample(const Cursor& at, const ContinuousPart& part, const Matrix& B,
                               const LineForm& W);

}  // namespace cordon::json
