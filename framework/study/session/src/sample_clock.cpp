// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_clock.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::detail {

Index SampleClock::number_of(double t, std::optional<Index> k, Index next) const {
  if (!std::isfinite(t)) throw Error(Errc::not_finite, "the time \"t\" must be finite");
  if (!(sampling_time_ > 0)) {
    throw Error(Errc::invalid,
                "the time \"t\" says nothing, as the system has no \"sampling_time\": give it one, "
                "or send \"k\"");
  }
  if (!last_) return k.value_or(next);
  const double steps = (t - last_->t) / sampling_time_, whole = std::round(steps);
  const auto text_of_last = [&] { return fmt::format("t = {} of k = {}", last_->t, last_->k); };
  if (!(std::abs(steps - whole) <= tolerance_)) {
    throw Error(Errc::invalid,
                fmt::format("t = {} lies {:.6g} sampling times of {} s after {}: it is refused, as "
                            "a time may miss a whole number of them by \"clock_tolerance\": {}; "
                            "where a clock was set begin anew, or send \"k\" without \"t\"",
                            t, steps, sampling_time_, text_of_last(), tolerance_));
  }
  constexpr double most = 9e15;
  if (!(std::abs(whole) < most) || whole + static_cast<double>(last_->k) < 0) {
    throw Error(Errc::invalid, fmt::format("t = {} lies before k = 0 or beyond all times: {:.6g} "
                                           "sampling times after {}",
                                           t, whole, text_of_last()));
  }
  const Index found = last_->k + static_cast<Index>(whole);
  if (k && *k != found) {
    throw Error(Errc::invalid,
                fmt::format("k = {} and t = {} are not of the same time: t is that of k = {}, as "
                            "it lies {} sampling times of {} s after {}; it is refused",
                            *k, t, found, whole, sampling_time_, text_of_last()));
  }
  return found;
}

void SampleClock::serialize(Archive& archive) {
  archive(last_);
  if (last_ && (!std::isfinite(last_->t) || last_->k < 0)) archive.refuse("no time");
}

}  // namespace cordon::detail
