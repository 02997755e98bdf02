// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_clock.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace {

constexpr double most_steps = 9e15;  // from a time to another

}  // namespace

Index SampleClock::number_of(std::optional<double> time, std::optional<Index> k, Index next) const {
  if (time && !std::isfinite(*time)) throw Error(Errc::not_finite, "the time \"t\" must be finite");
  if (k) return *k;
  if (time && !(sampling_time_ > 0)) {
    throw Error(Errc::invalid,
                "the time \"t\" says nothing, as the system has no \"sampling_time\": give it one, "
                "or send \"k\"");
  }
  if (!time || !last_) return next;
  const double t = *time;
  const double steps = (t - last_->t) / sampling_time_, whole = std::round(steps);
  const std::string apart = fmt::format(
      "t = {} lies {:.6g} sampling times of {} s after t = {} of "
      "k = {}: it is refused, as ",
      t, steps, sampling_time_, last_->t, last_->k);
  const char* const what_to_do = "; if the clock was set, tell both \"k\" and \"t\" of a sample";
  if (!(std::abs(steps - whole) <= tolerance_)) {
    throw Error(Errc::invalid,
                fmt::format("{}it may miss a whole number of them by \"clock_tolerance\": {}{}",
                            apart, tolerance_, what_to_do));
  }
  if (whole + static_cast<double>(last_->k) < 0)
    throw Error(Errc::invalid, apart + "this is before k = 0" + what_to_do);
  if (!(whole < most_steps)) throw Error(Errc::invalid, apart + "this is too long" + what_to_do);
  return last_->k + static_cast<Index>(whole);
}

void SampleClock::serialize(Archive& archive) {
  archive(last_);
  if (last_ && (!std::isfinite(last_->t) || last_->k < 0)) archive.refuse("no time");
}

}  // namespace cordon::detail
