// SPDX-License-Identifier: GPL-3.0-or-later
// Designs the inputs of a study, and proves over the rationals what was designed.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/study.hpp"

namespace cordon {

/// A pair of modes, judged in rational arithmetic on the equations of the study as they stand in
/// the file.
struct ExactPair {
  Index i = 0, j = 0;
  Answer disjoint =
      Answer::unknown;  ///< `unknown` beyond the size limits of the exact programs only
  double kappa_lower =
      0;  ///< proven: κ is at least this (rounded down); meaningful if `disjoint` is yes
  std::string reason = {};  ///< if unknown
  /// Of a pair that meets: does it meet for a κ that is smaller than the `kappa_lower` of the
  /// designer, by more than `tolerances::reported` (1e-9)? Asked on demand.
  std::optional<Answer> within = {};
};

/// What is proven of an input sequence without any rounding.
struct ExactSeparation {
  std::vector<ExactPair> pairs;  ///< all i < j
  std::vector<Answer> empty;     ///< per mode: is its tube empty?
  double wall_s = 0;
  /// As `InputDesign::separates`, but `yes` needs tubes that are proven not to be empty.
  Answer separates() const;
};

/// Is the input of this outcome separating the modes of the bank? Doubles are taken as the numbers
/// they are, no line is eliminated in floating point, and the designer is not asked.
/// Errc::dimension if the outcome has no input or does not fit. `stop` (may be null) ends it early:
/// what is open then is `unknown`. With `bounds` `within` is answered too.
ExactSeparation verify_design(const ModeBank& bank, const DesignOutcome& outcome,
                              const std::atomic<bool>* stop = nullptr, bool bounds = false);

/// What of a designer's answer is proven false: by the exact separation of its input, and by what
/// the study asks for in the parameters of these names, where the designer has them: `horizon`,
/// `horizon_at_most`, `max_horizon`, `input`, `input_set` (absent: U of the nominal mode),
/// `first_input`, `epsilon`, `outputs`, `admissible_set`. An input is outside the set, or another
/// than the one that was asked for, if it is so by more than `tolerances::reported` (1e-9) of its
/// size. One sentence each; none: nothing is contradicted.
std::vector<std::string> refuted_claims(const ModeBank& bank, const ComponentSpec& designer,
                                        const DesignOutcome& outcome, const ExactSeparation* exact);

struct DesignOptions {
  std::string pipeline;                     ///< this one only; empty: all that have a designer
  const std::atomic<bool>* stop = nullptr;  ///< set from a signal handler: searches end, and say so
  /// Called now and then: pipeline index, horizon, cheapest input so far (+inf: none), lower bound.
  std::function<void(std::size_t, Index, double, double)> progress;
};

struct PipelineDesign {
  std::size_t index = 0;  ///< in the study
  std::string name, backend, designer;
  std::optional<DesignOutcome> outcome;
  std::optional<ExactSeparation> exact;   ///< what is proven of the input, if there is one
  std::vector<std::string> refuted = {};  ///< of the designer's answer
  double design_s = 0;                    ///< wall-clock time of the design
  std::string error = {};                 ///< the designer ended with this error
  std::optional<Errc> error_code = {};
};

/// Designs the inputs of all pipelines with a designer, one after another, and checks every answer.
/// Throws InputError if `pipeline` is unknown or has no designer. An exception of a component ends
/// its pipeline only.
std::vector<PipelineDesign> design_study(const Study& study, const Registry& registry,
                                         const DesignOptions& options);

/// The same as JSON objects (docs/results_format.md). What is exact has no time in it, so that it
/// repeats.
std::string json_of(const DesignOutcome& outcome, const std::vector<std::string>& modes);
std::string json_of(const ExactSeparation& exact, const std::vector<std::string>& modes);

}  // namespace cordon
