// SPDX-License-Identifier: GPL-3.0-or-later
// What a simulation draws and feeds at every step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cordon/study/study.hpp"
#include "study/data/disturbance.hpp"
#include "study/data/fault_timeline.hpp"
#include "study/data/signals.hpp"

namespace cordon::detail {

/// Throws InputError with all problems: sizes of sets, signals and x0 that do not fit the model,
/// numbers that are not finite.
void check_simulation(const Model& model, const SimulateSpec& spec, const std::string& file);

/// Draws of x_0 from the x0_set of `spec`, in a sequence of their own. Throws InputError if the set
/// is unbounded.
Disturbance start_draws(const SimulateSpec& spec, const std::string& file);

/// The inputs u_k.
class InputSource {
 public:
  explicit InputSource(const std::vector<Signal>& signals);
  /// k must not decrease from call to call.
  Vector at(std::int64_t k);

 private:
  std::vector<SignalSource> signals_;
};

/// The additive faults n_k: of each the sum of its entries that act at k.
class AdditiveFaultSource {
 public:
  AdditiveFaultSource(const std::vector<AdditiveFaultSpec>& specs, Index faults);
  /// k must not decrease from call to call.
  Vector at(std::int64_t k);

 private:
  struct Entry {
    AdditiveFaultSpec spec;
    SignalSource signal;
  };
  std::vector<Entry> entries_;
  Index faults_;
};

/// Matrices within the intervals of a model.
struct DrawnMatrices {
  Matrix A, B, C;
};

/// Draws the matrices of an uncertain model, entry by entry: uniform in their intervals, or at one
/// of their ends (`vertex`). For `zero` and `sine` they stay in the middle, as those of an exact
/// model do.
class ParameterSource {
 public:
  ParameterSource(const LinearModel& model, Noise noise, ParameterDraw draw, RandomStream stream);
  /// The matrices from this step on; nothing if they stay as they are. To be called once per step.
  std::optional<DrawnMatrices> next();

 private:
  Matrix drawn(const IntervalMatrix& A);

  IntervalMatrix A_, B_, C_;
  Noise noise_;
  bool pending_, again_;  ///< to be drawn at the next step; and at every later one
  RandomStream stream_;
};

/// w_k, v_k, the effectiveness of actuators and sensors at time k, and the matrices where they
/// change.
struct Draw {
  Vector w, v;
  Effectiveness::Value effectiveness;
  std::optional<DrawnMatrices> matrices = {};
};

/// Draws for one model: the nominal one, or that of a fault. Each has its own streams of random
/// numbers: what is drawn for one does not depend on the others. Those of a fault follow from the
/// time at which it begins.
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
  DrawSource(const Model& model, const Box& actuator, const Box& sensor, const SimulateSpec& spec,
             std::uint64_t stream, const std::string& file, const Place& place);

  Disturbance disturbance_, noise_;
  Effectiveness effectiveness_;
  ParameterSource parameters_;
};

}  // namespace cordon::detail
