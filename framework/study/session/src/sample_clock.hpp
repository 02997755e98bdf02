// SPDX-License-Identifier: GPL-3.0-or-later
// The number of a sample by the seconds on its plant's clock.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"
#include "cordon/interfaces/archive.hpp"

namespace cordon::detail {

/// t lies k - k₀ sampling times after t₀, the time of the last sample in order, k₀: a clock may run
/// a little faster or slower than the plant's, and jitter by `tolerance` of a sampling time.
class SampleClock {
 public:
  /// `sampling_time` 0: it is not known, and times tell nothing.
  SampleClock(double sampling_time, double tolerance)
      : sampling_time_(sampling_time), tolerance_(tolerance) {}

  /// What a sample is that was sent with these: k, else what its time tells, else `next`. Throws
  /// Errc::invalid or Errc::not_finite for a time that fits no number.
  Index number_of(std::optional<double> t, std::optional<Index> k, Index next) const;

  /// A sample of time t was that of k.
  void took(double t, Index k) { last_ = Last{t, k}; }
  void forget() { last_.reset(); }
  void serialize(Archive& archive);

 private:
  struct Last {
    double t = 0;
    Index k = 0;
    void serialize(Archive& archive) { archive(t, k); }
  };
  double sampling_time_, tolerance_;
  std::optional<Last> last_;
};

}  // namespace cordon::detail
