// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a finished run again, in rational arithmetic and without any plugin: only the files that
// the run left are read.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/study/pipeline_task.hpp"

namespace cordon {

struct VerifyOptions {
  std::int64_t every =
      1;  ///< check k = first, first + every, …; proofs and bounds of those steps only
  std::int64_t directions =
      32;  ///< random directions per step where polytopes are too large, beside the coordinates
  std::uint64_t seed = 1;       ///< of these directions
  bool second_opinion = false;  ///< repeat conversions and exact programs by another engine
  std::vector<std::string> pipelines = {};  ///< check these only; empty: all
  /// When to end: steps that are not checked by then count as undecided.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  const std::atomic<bool>* stop = nullptr;  ///< set from a signal handler: the check ends early
  /// Called now and then: names of the pipelines, index of the one at work, steps done, steps in
  /// all.
  std::function<void(const std::vector<std::string>&, std::size_t, std::int64_t, std::int64_t)>
      progress;
};

/// A statement of the results that is proven false.
struct Violation {
  std::string pipeline;
  std::int64_t k = 0;
  std::string what;     ///< one sentence with the numbers
  std::string pointer;  ///< JSON pointer into results.json, or "sets.jsonl:LINE"
};

struct VerifiedPipeline {
  std::string name, backend;
  Rounding rounding = Rounding::nominal;
  PipelineKind kind = PipelineKind::estimation;
  /// A diagnosis whose exclusions rest on more than equations, bounds and samples: none of them is
  /// checked.
  bool rests_on_more = false;
  bool asked_for = true;          ///< else nothing of it is checked
  std::int64_t steps = 0;         ///< checked
  std::int64_t by_polytopes = 0;  ///< of them against the exact feasible set
  std::int64_t by_supports =
      0;  ///< of them against the successors of the set before, in directions
  /// Of them, estimates that lag behind their samples and of which the proofs alone are checked;
  /// neither that they hold every state nor that they are exact.
  std::int64_t not_compared = 0;
  std::int64_t proofs = 0;        ///< proofs of (non-)emptiness and of bounds that hold
  std::int64_t exclusions = 0;    ///< of modes, proven again
  std::int64_t states = 0;        ///< boxes that a diagnosis tells of the state, proven again
  std::int64_t exact_claims = 0;  ///< claims of `exact` that are true
  /// Those that directions do not refute, or that there is nothing to compare with: no state is
  /// consistent with model and data, perhaps since data are rounded.
  std::int64_t exact_claims_unproven = 0;
  std::int64_t undecided = 0;   ///< single checks that neither succeeded nor failed
  std::string first_undecided;  ///< the first of them
  /// An assumption that the simulated truth does not keep, as the run has told it: nothing is
  /// promised from `assumptions_until` on.
  std::string failed_assumption = {};
  std::int64_t assumptions_until = -1;
  Answer fails_again = Answer::unknown;  ///< is that proven again from data.csv?
  /// Exclusions and states after a reset rest on sets that the run has told, for a mode that has
  /// changed once: that these hold the state is not checked.
  bool from_told_sets = false;
};

/// What cddlib says of the conversions of polyhedra and of the exact linear programs that the
/// checks rest on. Answers are compared as rational numbers.
struct SecondOpinionFindings {
  struct Count {
    std::int64_t agree = 0, disagree = 0;
    std::int64_t too_large = 0;   ///< left out: cddlib might take more than about 5 s
    std::int64_t unanswered = 0;  ///< cddlib has failed
  };
  std::string engine;  ///< with its version
  Count conversions, programs;
  std::string first_disagreement, first_unanswered;  ///< one sentence with the question, or ""
};

/// Of the engine that gives second opinions: "0.94m".
std::string cddlib_version();

struct VerifyOutcome {
  bool interrupted = false;
  bool by_samples =
      false;  ///< matrices are known by intervals only: checked for some of them, not for all
  bool of_formulas = false;  ///< the model is one of formulas: some of its successors, not all
  std::vector<VerifiedPipeline> pipelines;
  std::optional<Violation> violation;                   ///< the first; the check ends there
  std::optional<SecondOpinionFindings> second_opinion;  ///< if it was asked for
};

/// Re-checks the run in `directory` (results.json, sets.jsonl, data.csv). For every step, with F_k
/// the set of all states that are consistent with the model, the data up to k and the pipeline's
/// own assumptions (initial set, admissible set):
///   1. F_k ⊆ X_k, the reported set, and F_k ⊆ the reported hull. By the vertices of F_k, exact
///   rational polytopes, up to n = 4;
///      beyond, or where polytopes grow too large, by support functions of the successors of
///      X_{k-1} that are consistent with the samples k-1 and k, in the coordinates' and in seeded
///      random directions, with rationally checked bounds.
///   2. Every proof that is stored with the step holds in rational arithmetic: emptiness or
///   non-emptiness, and the hull's bounds.
///   3. Where the step claims `exact`: X_k ⊆ F_k (in directions: X_k ⊆ those successors, which
///   contain F_k).
/// Of a model with interval matrices, F_k is computed for matrices drawn from them, anew at every
/// step: a subset of the states that are consistent, so that whatever lies outside is a violation,
/// but an estimate that holds F_k may still miss others. Claims of `exact` stay undecided there.
/// Of a model by formulas, drawn successors of X_{k-1} that are proven consistent with y_k have to
/// lie in X_k and its hull, in rational arithmetic; where none is found the step is undecided.
/// Of a diagnosis by sets (`consistency_bank`): its decisions follow from its exclusions, and these
/// and the state that it tells from the mode's equations, bounds and samples alone. Linear rows
/// that all trajectories of the mode keep to have no solution, by multipliers checked in rational
/// arithmetic; formulas are enclosed over boxes for that. Where that fails for a linear mode of up
/// to 4 states, exact polytopes decide, and refute.
/// With `second_opinion`, every conversion of a polyhedron and every exact linear program is
/// answered by cddlib once more, up to a size; the checks go on with the project's own answers.
/// That takes a lock in this process, and up to about 5 s during which `stop` is not looked at.
/// Margins for rounding errors: docs/results_format.md; none for claims of `exact` with outward
/// rounding. Throws InputError for files that are missing or wrong, with place and reason.
VerifyOutcome verify_run(const std::filesystem::path& directory, const VerifyOptions& options = {});

}  // namespace cordon
