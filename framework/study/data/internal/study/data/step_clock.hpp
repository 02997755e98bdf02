// SPDX-License-Identifier: GPL-3.0-or-later
// Which step a row of recorded data is of, by its time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace cordon::detail {

/// Rows are of the steps k = 0, 1, … at the times t_0 + k T, t_0 that of the first row, up to a
/// hundredth of T. A row at another time is told once: those after it may keep to t_0, or to its
/// own time. If that is the second row already, T may be meant otherwise, and nothing more is told.
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
  /// The step nearest to t where step 0 is at `origin`; nothing: it is too far off.
  std::optional<std::int64_t> on_grid(double t, double origin) const;
  Answer refuse(std::string problem, std::string suggestion) const;
  /// Of a row at no expected time.
  Answer refuse_second(double t);

  double sampling_time_;
  bool fills_;
  std::optional<double> first_, before_;
  std::optional<double> shifted_;  ///< t_0 as the last row that was refused would have it
  std::int64_t next_ = 0;          ///< step
  bool is_silent_ = false;
};

}  // namespace cordon::detail
