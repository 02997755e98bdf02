// SPDX-License-Identifier: GPL-3.0-or-later
// Which step a row of recorded data is of, by its time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace cordon::detail {

/// Rows are of the steps k = 0, 1, … at the times t_0 + k T, t_0 that of the first row, up to a
/// hundredth of T.
class StepClock {
 public:
  struct Answer {
    std::int64_t k = 0;
    std::string problem = {}, suggestion = {};  ///< not empty: the row is of no step
  };

  /// T > 0. `fills`: rows may leave out steps, otherwise that is a problem.
  StepClock(double sampling_time, bool fills) : sampling_time_(sampling_time), fills_(fills) {}

  /// Of the row after those before, at time t.
  Answer step_at(double t);

 private:
  double sampling_time_;
  bool fills_;
  std::optional<double> first_, before_;
  std::int64_t next_ = 0;  ///< step
};

}  // namespace cordon::detail
