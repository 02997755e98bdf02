// SPDX-License-Identifier: GPL-3.0-or-later
// The number of a sample by the seconds on its plant's clock.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"
#include "cordon/interfaces/archive.hpp"

namespace cordon::detail {

/// What clocks may be off by, in sampling times: |(t - t') / h - (k - k')| ≤ tolerance + drift
/// |k - k'| for any two samples since the clock was set.
struct ClockErrors {
  double tolerance = 0, drift = 0;
};

/// A time is measured from that of the last sample in order, which leaves one number only as long
/// as the errors stay below a half, and compared with the one that has set the clock.
class SampleClock {
 public:
  /// `sampling_time` 0: it is not known, and times tell nothing.
  SampleClock(double sampling_time, ClockErrors errors)
      : sampling_time_(sampling_time), errors_(errors) {}

  /// What a sample is that was sent with these: k, else what its time tells, else `next`. The first
  /// sample of all sets the clock by its time alone. Throws Errc::invalid or Errc::not_finite for a
  /// time that fits no number.
  Index number_of(std::optional<double> t, std::optional<Index> k, Index next, bool is_first) const;

  /// A sample of time t in order is that of k; `sets`: by its own number, which sets the clock.
  void took(double t, Index k, bool sets);
  void forget();
  void serialize(Archive& archive);

 private:
  struct Known {
    double t = 0;
    Index k = 0;
    void serialize(Archive& archive) { archive(t, k); }
  };
  Index by_time(double t) const;
  /// (t - known.t) / h
  double steps_from(const Known& known, double t) const;
  /// That t tells such differences.
  void expect_digits(double t) const;

  double sampling_time_;
  ClockErrors errors_;
  std::optional<Known> set_, last_;
};

}  // namespace cordon::detail
