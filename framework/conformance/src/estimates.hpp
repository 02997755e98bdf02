// SPDX-License-Identifier: GPL-3.0-or-later
// Observers over data, and estimates beside the true states.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "making.hpp"

namespace cordon::conformance {

/// An observer of the subject for the system of a case, with the data that it is given.
struct ObserverTrial {
  Model model;  ///< linear; without its square terms
  Trajectory data;
  DrawnBackend backend;
  Params params;
  std::shared_ptr<Observer> observer;
  Model given;  ///< what the observer is made for: the model, or the same by formulas

  /// What a witness shows beside the case.
  Verdict fails(const std::string& message) const;
};
/// Nothing: the case has no data that bear on a law.
std::optional<ObserverTrial> observer_trial(const Context& context, const TestCase& test,
                                            bool gaps = false);
/// Another observer of the same kind.
std::shared_ptr<Observer> another(const Context& context, const ObserverTrial& trial);
std::vector<Estimate> estimates_of(Observer& observer, const std::vector<Sample>& samples);

TestCase observer_case(const Setting& s);        ///< all kinds of systems
TestCase plain_observer_case(const Setting& s);  ///< at most two states, without E and intervals

/// What nominal operations, and observers from data, may have rounded: a part of the largest
/// numbers that the states have been made of.
class RoundingRoom {
 public:
  RoundingRoom(const Model& model, Rounding rounding);
  /// Takes in a step; the bound for its estimate, coordinate by coordinate.
  Vector next(const Estimate& estimate, const Vector& state, const Sample& sample);

 private:
  void take_output(Index i, double terms);

  const LinearModel& model_;
  double share_;
  Vector largest_;
};

/// Why the set does not hold the point, which is proven, by more than `tolerance` in some
/// coordinates; "": it may hold it.
std::string why_not_in(const Set& X, const Vector& point, const Vector& tolerance);

/// "" or why the estimates do not hold the true states. `from`: of this estimate on; states are
/// those of the model in these units.
std::string misses(const ObserverTrial& trial, const std::vector<Estimate>& estimates,
                   std::size_t from = 0);

}  // namespace cordon::conformance
