// SPDX-License-Identifier: GPL-3.0-or-later
// What a simulation draws and feeds at every step.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/study.hpp"
#include "study/data/disturbance.hpp"
#include "study/data/fault_timeline.hpp"
#include "study/data/signals.hpp"

namespace cordon::detail {

/// Throws InputError with all problems: sizes of sets, signals and x0 that do not fit the model, numbers that are not finite.
void check_simulation(const Model& model, const SimulateSpec& spec, const std::string& file);

/// The inputs u_k.
class InputSource {
 public:
  explicit InputSource(const std::vector<Signal>& signals);
  /// k must not decrease from call to call.
  Vector at(std::int64_t k);

 private:
  std::vector<SignalSource> signals_;
};

/// w_k, v_k and the effectiveness of actuators and sensors at time k.
struct Draw {
  Vector w, v;
  Effectiveness::Value effectiveness;
};

/// Draws for one model: the nominal one, or that of a fault. Each has its own streams of random numbers: what is drawn for one
/// does not depend on the others. Those of a fault follow from the time at which it begins.
class DrawSource {
 public:
  /// Of the nominal model.
  DrawSource(const Model& model, const SimulateSpec& spec, const std::string& file);
  /// Of a fault of `spec`.
  DrawSource(const SimulateSpec& spec, std::size_t fault, const std::string& file);

  Draw at(std::int64_t k);

 private:
  /// Where the sets of a model stand in the study.
  struct Place {
    std::string W, V, effectiveness;
  };
  DrawSource(const Model& model, const Box& actuator, const Box& sensor, const SimulateSpec& spec, std::uint64_t stream,
             const std::string& file, const Place& place);

  Disturbance disturbance_, noise_;
  Effectiveness effectiveness_;
};

}  // namespace cordon::detail
