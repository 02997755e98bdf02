// SPDX-License-Identifier: GPL-3.0-or-later
// A bank of Luenberger observers on sets, one per mode. [Xu2014, Xu2013]
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cordon/interfaces/diagnoser.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "diagnosers/mode_elimination.hpp"
#include "diagnosers/mode_workers.hpp"
#include "diagnosers/observer_bank/fdi_conditions.hpp"
#include "diagnosers/observer_bank/point_drift.hpp"
#include "observers/error_memory.hpp"
#include "observers/luenberger_recursion.hpp"
#include "observers/present_outputs.hpp"
#include "observers/widening_limit.hpp"

namespace cordon::estimators {

struct ObserverBankOptions {
  std::vector<Matrix> gains;    ///< one per mode
  std::vector<Gain> described;  ///< the same with their origin; those that are given, uncertified
  Budget budget;
  std::vector<LineForm> initial_sets;  ///< one per mode
  double widening_limit = 0;
  Index waiting_time = 0;
  std::optional<Matrix> strip_gain;
  OfflineOptions offline;
  Index threads = 1;
};

/// Every observer j runs from the start, from the initial set of mode j; its residual set R_j
/// contains 0 as long as the plant is in mode j and always was. What is excluded is excluded by
/// resets alone:
///   reset at k   X̂'_j := {x̂_j} ⊕ {e ∈ X̃ : y_k - C_j (x̂_j + e) is explained by the noise}   for
///   every mode j, afterwards   the same recursion; 0 ∉ R'_j proves that the plant has not been in
///   mode j throughout from k on.
/// `ModeEvidence::why` is a direction that separates 0 from the residual set, or the proof that the
/// copy is empty: no error in X̃ explains the sample of the reset. It rests on x - x̂_j ∈ X̃ (the
/// point observers' errors, whatever the modes have been), which is checked in advance. Before the
/// first reset R_j of the nominal mode takes that place. `ModeElimination` turns exclusions into
/// decisions. `suggested` follows the published algorithm: at the reset Ř_j := C X̌_j ⊕ V ⊕ (-V)
/// starts from X̌_j, the part of X̃ in the strips of R_j; a mode goes when R_j ⊄ Ř_j is certified,
/// and after the waiting time when 0 ∉ R_j. It names the one that is left. Not a proof: R_j carries
/// errors of the earlier mode, and loses containment by its reductions.
///
/// Samples may lack outputs: recursions and residuals take those that are there, and x - x̂_j ∈ X̃
/// ⊕ (-Δ_j) with the drift Δ_j of the point observer. What is promised in advance is about complete
/// samples.
class ObserverBank final : public Diagnoser {
 public:
  ObserverBank(ModeBank bank, std::shared_ptr<const SetBackend> backend,
               ObserverBankOptions options);

  std::vector<Gain> gains() const override;

 private:
  /// The observer of one mode.
  struct Member {
    Member(const Model& model, const Matrix& L, const std::shared_ptr<const SetBackend>& backend,
           Budget budget, double widening)
        : recursion(model, L, backend, budget),
          X_limit(widening),
          copy_limit(widening),
          rounding(recursion.error_map()) {}
    LuenbergerRecursion recursion;  ///< for all outputs
    PerOutputs<LuenbergerRecursion> others;
    WideningLimit X_limit, copy_limit;
    PointDrift drift;               ///< Δ
    ErrorMemory rounding;           ///< the same by rounding alone, in units of its share of terms
    Enclosure X, residual;          ///< X̂, R; of the outputs that are there
    Box X_hull, copy_hull;          ///< of X̂ and X̂'; of dimension 0: not known
    Box hull;                       ///< of R
    Vector center;                  ///< x̂
    Vector size, residual_size;     ///< of the numbers that x̂ and its residual are made of
    std::optional<Enclosure> copy;  ///< X̂', while the mode is a candidate
    std::optional<Enclosure>
        bound;  ///< X̌, while the mode is among those that the published algorithm keeps
    bool bound_violated = false;  ///< R ⊄ Ř
    ModeEvidence evidence;
  };

  bool do_takes_missing_outputs() const override { return true; }
  void do_start() override;
  Diagnosis do_step(const Sample* before, const Sample& now) override;
  std::optional<Guarantees> do_guarantees() const override;
  void do_serialize(Archive& archive) override;

  void serialize_member(Member& member, Archive& archive);
  void expect_input(const Sample& now) const;
  /// Makes `residuals_` where this step takes them.
  void expect_residuals(const Sample* before, const Sample& now);
  /// A sample's outputs, and the recursion of one mode for them.
  struct Seen {
    std::shared_ptr<const LuenbergerRecursion> others;
    Sample without;  ///< the missing outputs
    const LuenbergerRecursion* recursion;
    const Sample* sample;
  };
  void see(Index j, const Sample& sample, Seen& seen);
  void advance(Index j, const Sample& before);
  void judge(Index j, const Sample& now);
  void reset(Index j, const Sample& now);
  void suggest(const Sample& now);
  void begin_suggestion(Index from);
  Diagnosis report(const Sample& now) const;
  Member& member(Index j) { return members_[static_cast<std::size_t>(j)]; }
  const Member& member(Index j) const { return members_[static_cast<std::size_t>(j)]; }

  ObserverBankOptions options_;
  Box inputs_;
  std::vector<Member> members_;
  Enclosure error_set_;
  std::vector<Box> residuals_;  ///< of the point observers at all times; made at the first gap
  ModeElimination elimination_;
  ModeWorkers workers_;
  bool was_reset_ = false;
  bool unfinished_ = false;  ///< a step ended with an error half way
  Index suggested_ = -1, suggesting_since_ = -1;
};

}  // namespace cordon::estimators
