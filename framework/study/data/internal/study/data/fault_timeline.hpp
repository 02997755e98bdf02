// SPDX-License-Identifier: GPL-3.0-or-later
// Which fault acts when, and the effectiveness of actuators and sensors over time.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/study.hpp"
#include "study/data/disturbance.hpp"

namespace cordon::detail {

/// The faults of a simulation in the order of time.
class FaultTimeline {
 public:
  /// Throws InputError: a fault that ends before it begins, or begins before the one ahead of it
  /// has ended.
  FaultTimeline(const std::vector<FaultSpec>& faults, const std::string& file);

  /// Index of the fault at time k, or -1; k must not decrease from call to call. O(1).
  Index at(std::int64_t k);

 private:
  std::vector<std::pair<std::int64_t, std::int64_t>> times_;
  std::size_t next_ = 0;  ///< first fault that has not ended
};

/// "/data/simulate/faults/3".
std::string place_of_fault(std::size_t index);

/// Draws the effectiveness (f, g) of actuators and sensors from their ranges, anew at every step,
/// by the same kinds of noise as disturbances: `vertex` takes an end of each range, `zero` the
/// middle. Exact entries are exact.
class Effectiveness {
 public:
  /// Boxes of dimension 0 stand for 1.
  Effectiveness(const Box& actuator, const Box& sensor, Index inputs, Index outputs, Noise noise,
                RandomStream stream, Index first_prime, const std::string& file,
                const std::string& pointer);

  struct Value {
    Vector actuator, sensor;
  };
  /// As Disturbance::at.
  Value at(std::int64_t k);

 private:
  Box box_;  ///< of both
  Index inputs_;
  Disturbance draw_;
};

}  // namespace cordon::detail
