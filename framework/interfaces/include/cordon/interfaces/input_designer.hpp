// SPDX-License-Identifier: GPL-3.0-or-later
// The input designer: which inputs make the outputs of all modes of a bank differ, whatever the
// disturbances are?
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon {

/// How far the output tubes Y_i(u) and Y_j(u) of two modes are apart under one input sequence u.
/// κ = min{κ : the tubes meet with ‖ξ‖∞ ≤ 1 + κ in place of ‖ξ‖∞ ≤ 1}: they are disjoint if and
/// only if κ > 0 [Rego2025, (28)].
struct PairSeparation {
  Index i = 0, j = 0;  ///< i < j, indices in the bank
  double kappa = 0;    ///< as computed; +inf: the tubes do not meet however far the box is widened
  double kappa_lower = -1;            ///< κ is at least this, by `why`; -1 of any pair
  Answer disjoint = Answer::unknown;  ///< `yes`: by a Farkas vector; `no`: they meet. A claim until
                                      ///< the host has proven it
  Certificate why = {};  ///< about rows of the designer's own making: the host rests nothing on it
};

/// An input sequence and what it does to the modes.
struct InputDesign {
  Matrix u;                           ///< (N+1)×n_u, row k is u_k
  double cost = 0;                    ///< of the study's cost, evaluated at u
  std::vector<PairSeparation> pairs;  ///< all i < j, by i, then by j
  std::vector<Answer> empty;  ///< per mode: is its tube empty under u? `yes`: the model contradicts
                              ///< itself, a modelling error
  std::vector<Box> outputs;   ///< per mode: hull of its output tube, (N+1)·n_y by time; n_y where
                              ///< only the last output counts

  /// What the designer claims of them. `yes`: every pair is disjoint and no tube is empty; `no`: a
  /// pair meets.
  Answer separates() const;
};

/// What became of a search at one horizon, as the designer says. That `best` keeps to the input set
/// and to a first input, and that it separates the modes, the host checks; that nothing is cheaper,
/// or that there is no such input, it does not. What is searched for separates with κ ≥ ε: one with
/// less may be cheaper, or there where nothing is.
enum class DesignStatus {
  optimal,   ///< `best` costs at most the designer's gap more than its lower bound
  feasible,  ///< an input was found; how much cheaper another one may be is told by the lower bound
  infeasible,  ///< no input of the input set separates the modes with κ ≥ ε
  unknown,     ///< nothing was found in the limit, and nothing is proven
  given        ///< the input was given, nothing was searched for
};
std::string_view to_string(DesignStatus status) noexcept;

/// A horizon that was tried beside the one that is reported.
struct HorizonTrial {
  Index horizon = 0;
  DesignStatus status = DesignStatus::unknown;
  std::string reason;  ///< for people; empty where there is none
};

/// A narrower problem that was searched in place of the problem itself, and what is known of it.
/// Its solutions are solutions of the problem, so that its bound does not bound the problem: other
/// inputs may cost less.
struct RestrictedProblem {
  std::string name;                ///< for people
  double lower_bound = -infinity;  ///< of the cost of its own solutions
};

struct DesignOutcome {
  DesignStatus status = DesignStatus::unknown;
  Index horizon = 0;                ///< N: inputs u_0 … u_N, outputs y_0 … y_N
  std::optional<InputDesign> best;  ///< `optimal`, `feasible`, `given`
  double lower_bound = -infinity;  ///< of the cost of every input with κ ≥ ε; +inf if infeasible
  std::optional<RestrictedProblem> restriction = {};  ///< the search looked at this one only
  bool stopped = false;     ///< the search ended early: time limit, or from outside
  std::string reason = {};  ///< why there is no better answer, for people; empty if `optimal`
  std::string suggestion = {};
  std::int64_t
      nodes = 0,
      programs = 0,
      facets = 0;  ///< size of the search: nodes, linear programs solved, facets of forbidden sets
  std::vector<HorizonTrial> tried = {};  ///< other horizons, in order
  double epsilon = 0;                    ///< κ ≥ ε was asked for
  // What was compared, for whoever proves it again:
  bool last_output_only = false;  ///< the outputs y_N, not those of all times
  std::optional<LineForm> admissible_set =
      {};  ///< holds x_k for k ≥ 1 as far as E does not determine it; nothing: not assumed

  /// (cost - lower bound) / cost, of the problem itself; infinite without both.
  double gap() const;
};

/// How a design is watched and ended. Called from the thread that designs.
class DesignControl {
 public:
  virtual ~DesignControl() = default;
  virtual bool stop() const noexcept { return false; }
  /// Cheapest input so far (+inf: none) and lower bound, now and then.
  virtual void progress(Index /*horizon*/, double /*best*/, double /*bound*/) {}
};

/// Designs an input sequence for the modes of a bank. Immutable.
class InputDesigner {
 public:
  virtual ~InputDesigner() = default;
  InputDesigner(const InputDesigner&) = delete;
  InputDesigner& operator=(const InputDesigner&) = delete;

  /// The outcome fits the bank: Errc::violated for a designer that gives an input, pairs or tubes
  /// of other sizes, pairs in another order, or numbers that are none.
  DesignOutcome design(DesignControl& control) const;

  const ModeBank& bank() const { return bank_; }

 protected:
  InputDesigner(ModeBank bank, std::shared_ptr<const SetBackend> backend)
      : bank_(std::move(bank)), backend_(std::move(backend)) {}
  const SetBackend& backend() const { return *backend_; }

 private:
  virtual DesignOutcome do_design(DesignControl& control) const = 0;

  ModeBank bank_;
  std::shared_ptr<const SetBackend> backend_;
};

}  // namespace cordon
