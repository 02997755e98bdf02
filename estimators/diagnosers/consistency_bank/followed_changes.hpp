// SPDX-License-Identifier: GPL-3.0-or-later
// Where the plant may be if its mode has changed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/observer.hpp"
#include "diagnosers/mode_workers.hpp"

namespace cordon::estimators {

/// For each mode j of a bank a set that holds the state of time k if the plant has been in some
/// other mode i throughout from the beginning to τ - 1 and in j from τ to k, 0 < τ ≤ k counted from
/// the beginning, y_τ being the first output of j:
///   Z^j_k = u_j(f_j(Z^j_{k-1}) ∪ ⋃ f_i(X^i_{k-1}), y_k),   Z^j = ∅ at the beginning,
/// with X^i the states of mode i throughout, f_i(X) what follows them in mode i and u_j what is
/// left of it by the sample [Rego2025, "any number of switches"]. Unions are enclosed by convex
/// hulls. One change at most is followed.
class FollowedChanges {
 public:
  using MakeObserver = std::function<std::shared_ptr<Observer>(const Model&)>;
  /// Three observers of every mode; all take samples without outputs.
  FollowedChanges(const ModeBank& bank, std::shared_ptr<const SetBackend> backend,
                  const MakeObserver& make);

  /// Begins anew: nothing has changed. `now`: the first sample; `throughout`: X^i with it, by mode;
  /// none: excluded.
  void begin(const Sample& now, const std::vector<std::optional<Enclosure>>& throughout);
  /// Takes the sample of the next time. `throughout`: X^i with it; a mode that was given none
  /// before stays so. `unknown`: modes i that are possible, and of which X^i is not known any more.
  void step(const Sample& now, const std::vector<std::optional<Enclosure>>& throughout,
            const std::vector<bool>& unknown, ModeWorkers& workers);

  void serialize(Archive& archive);

  /// Z^j; none: ∅.
  const std::optional<Enclosure>& since_change(std::size_t j) const { return changed_[j].states; }
  /// Why Z^j is not known any more; "": it is.
  const std::string& lost(std::size_t j) const { return changed_[j].lost; }

 private:
  /// A mode i that has lasted: what follows it.
  struct Lasting {
    std::shared_ptr<Observer> observer;  ///< of samples without outputs
    std::optional<Enclosure> states;     ///< X^i of the last sample; none: excluded
  };
  /// A mode j that has begun.
  struct Changed {
    std::shared_ptr<Observer> going_on, beginning;
    std::optional<Enclosure> states;
    bool runs = false;  ///< `going_on` has begun
    std::string lost;
  };
  using Sets = std::vector<std::optional<Enclosure>>;

  std::optional<Enclosure> joined(const std::optional<Enclosure>& X,
                                  const std::optional<Enclosure>& Y) const;
  Sets followers(const Sample& now, ModeWorkers& workers, std::vector<std::string>& open);
  void take(std::size_t j, const Sample& now, const Sets& followers);

  const ModeBank& bank_;
  std::shared_ptr<const SetBackend> backend_;
  std::vector<Lasting> lasting_;
  std::vector<Changed> changed_;
};

/// The set with the mode's bounds of parameters that are states.
LineForm within_parameters(const LineForm& set, const Model& model);

}  // namespace cordon::estimators
