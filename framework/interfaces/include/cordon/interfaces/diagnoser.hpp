// SPDX-License-Identifier: GPL-3.0-or-later
// The diagnoser: which of the modes of a bank can the plant be in?
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/gain_designer.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon {

/// What a diagnoser makes of the data so far.
enum class Decision {
  monitoring,    ///< the plant is in `mode`: assumed at the start, or isolated since: the only mode
                 ///< that is not excluded
  isolating,     ///< that mode is excluded, several are possible
  ambiguous,     ///< several modes are still possible after the waiting time
  unknown_fault  ///< every mode of the bank is excluded
};
std::string_view to_string(Decision decision) noexcept;

/// What is known about one mode. An exclusion is a statement about the time from `Diagnosis::since`
/// to k: the plant has not been in this mode throughout. It is made on a proof only.
struct ModeEvidence {
  bool candidate = true;  ///< not excluded by now; after a reset every mode is a candidate again
  Answer consistent = Answer::unknown;  ///< by the samples from `since` to k: `no`: proven to
                                        ///< contradict the mode; `yes`: proven not to
  Certificate why;     ///< proof of `consistent`, of the kind that the diagnoser documents
  Box residual;        ///< hull of what has to contain 0 (dimension 0: not offered)
  Box reset_residual;  ///< the same of the copy that was made at the last reset, on which
                       ///< exclusions rest (dimension 0: none)
  /// Why no later sample excludes the mode until a reset, as that its equations could not be
  /// enclosed any more; "": it may.
  std::string left_open = {};
};

/// Bounds of one additive fault at one time, proven by the samples up to now.
struct FaultBound {
  Index fault = 0;  ///< column of F
  Index at = 0;  ///< the time of n(at), which lies behind that of the sample by the fault's delay
  double lower = 0, upper = 0;
  double estimate = 0;  ///< inside
};

struct Diagnosis {
  Index k = 0;
  Decision decision = Decision::monitoring;
  Index mode = -1;     ///< `monitoring`: the mode, else -1
  Index since = 0;     ///< the time from which on the evidence of this step speaks
  bool reset = false;  ///< every mode is excluded or given up at k: all are candidates again, later
                       ///< evidence speaks of k on
  Index suggested = -1;  ///< a mode that a heuristic points to, without proof; -1: none
  std::vector<ModeEvidence> modes;
  std::vector<FaultBound> faults;  ///< additive faults that can be bounded at k; one that excludes
                                   ///< 0 excludes every mode
  std::optional<Enclosure>
      estimate;  ///< `monitoring`: contains the state as long as the plant is in `mode`
  /// At a reset: the sets that modes begin anew from, by mode, where they are not those of
  /// `assumptions`. They hold the state in each mode if the mode has changed once since `since`.
  std::vector<LineForm> restarts = {};
};

/// A statement made in advance about the true mode i and the observer of mode j.
struct PairGuarantee {
  Index mode = 0, observer = 0;
  Box residual;  ///< hull of R̊_ij, which contains the residual sets of observer j in the steady
                 ///< state of mode i, but for what reductions and coarser representations add to
                 ///< them
  Answer holds = Answer::unknown;  ///< the FDI condition, 0 ∈ R̊_ii or 0 ∉ R̊_ij; `no`: it is proven
                                   ///< to fail; `unknown`: not guaranteed
  Box iterated = {};  ///< where a published iteration was asked for, what it came to: it need not
                      ///< hold the limit, `residual` does; else of dimension 0
};

/// The set X̃ that must hold the errors of the point observers, centres in place of sets, whatever
/// the modes have been, and how far it does.
struct ErrorSetCheck {
  LineForm set;           ///< X̃
  bool computed = false;  ///< made by the diagnoser: it contains the errors by construction
  double factor = 0;  ///< all errors lie in `factor` · X̃ about its centre; above 1: too small
  double steady_factor = 0;        ///< the same for the invariant sets S_ij alone
  Index mode = -1, observer = -1;  ///< where `steady_factor` is attained
};

/// A statement made in advance about the bounds of one additive fault.
struct FaultGuarantee {
  Index fault = 0;
  Index delay = 0;  ///< n(k - delay) is bounded at k
  double half_width =
      0;  ///< at all times of the steady state, whatever the data are; infinite: no bound is proven
};

struct Guarantees {
  std::string method;                ///< how the sets were computed, for people
  std::vector<PairGuarantee> pairs;  ///< all (i, j), by observer, then by mode
  Answer all = Answer::unknown;      ///< the weakest of `pairs`
  std::optional<ErrorSetCheck> error_set;
  std::vector<FaultGuarantee> faults = {};
};

/// What exclusions of one mode and estimates in it rest on, beside its model and the samples since.
struct ModeAssumptions {
  LineForm initial_set;                         ///< holds the state at the first sample
  std::optional<LineForm> restart_set = {};     ///< and at a reset; none: there is no reset
  std::optional<LineForm> admissible_set = {};  ///< and at all times
};

/// Of a diagnoser whose statements follow from the modes' equations, bounds and samples: a mode is
/// excluded where no state of these sets and no w ∈ W, v ∈ V make the samples since.
struct DiagnosisAssumptions {
  std::optional<Index> known_mode = {};  ///< the plant's at the start; none: any
  std::vector<ModeAssumptions> modes;    ///< of all modes of the bank
};

/// Decides, sample by sample, which modes of a bank are possible. The base class checks samples and
/// keeps the previous one.
class Diagnoser {
 public:
  virtual ~Diagnoser() = default;
  Diagnoser(const Diagnoser&) = delete;
  Diagnoser& operator=(const Diagnoser&) = delete;

  /// Begins anew, in the nominal mode.
  void start();
  /// Takes the sample of the next time; samples come in order. Sizes and finiteness are checked.
  /// Throws Errc::unsupported for missing outputs that the diagnoser does not take.
  Diagnosis step(const Sample& now);

  /// As Observer::serialize; the bank takes the place of the model.
  void serialize(Archive& archive);

  /// What can be said before any experiment; nothing if the method has no such statements.
  std::optional<Guarantees> guarantees() const { return do_guarantees(); }

  /// The gains of the observers that it is made of, with what is known about them; their names say
  /// of which mode.
  virtual std::vector<Gain> gains() const { return {}; }

  /// Does it take samples with missing outputs, and exclude only what the outputs that are there
  /// contradict? Otherwise `step` refuses such samples.
  bool takes_missing_outputs() const { return do_takes_missing_outputs(); }

  /// Nothing where statements rest on more, as on bounds of errors: they are not checked again.
  virtual std::optional<DiagnosisAssumptions> assumptions() const { return std::nullopt; }

  /// How many steps after `start` the last sample is that it makes use of; nothing: there is no
  /// last one.
  std::optional<Index> last_used_sample() const { return do_last_used_sample(); }

  const ModeBank& bank() const { return bank_; }
  /// Wall-clock time of the last step in microseconds.
  double step_us() const { return step_us_; }

 protected:
  Diagnoser(ModeBank bank, std::shared_ptr<const SetBackend> backend)
      : bank_(std::move(bank)), backend_(std::move(backend)) {}
  const SetBackend& backend() const { return *backend_; }
  const std::shared_ptr<const SetBackend>& shared_backend() const { return backend_; }

 private:
  virtual void do_start() = 0;
  /// `before` is null at the first sample.
  virtual Diagnosis do_step(const Sample* before, const Sample& now) = 0;
  virtual std::optional<Guarantees> do_guarantees() const { return std::nullopt; }
  virtual std::optional<Index> do_last_used_sample() const { return std::nullopt; }
  virtual bool do_takes_missing_outputs() const { return false; }
  /// The members that `do_start` and `do_step` change, once there has been a sample; `do_start` has
  /// been called before they are read. Default: Errc::unsupported.
  virtual void do_serialize(Archive& archive);

  ModeBank bank_;
  std::shared_ptr<const SetBackend> backend_;
  std::optional<Sample> before_;
  double step_us_ = 0;
  bool started_ = false;
};

}  // namespace cordon
