// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_clock.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace {

constexpr double least_share = 1e-3;  // of a sampling time, that times have to tell
constexpr const char* what_to_do =
    "; a sample with both \"k\" and \"t\" sets the clock, as after it was changed";

/// From t to the next double.
double spacing_at(double t) { return std::nextafter(std::abs(t), HUGE_VAL) - std::abs(t); }

[[noreturn]] void refuse(const std::string& why) { throw Error(Errc::invalid, why + what_to_do); }

}  // namespace

Index SampleClock::number_of(std::optional<double> t, std::optional<Index> k, Index next,
                             bool is_first) const {
  if (t && !std::isfinite(*t)) throw Error(Errc::not_finite, "the time \"t\" must be finite");
  if (k) return *k;
  if (!t) return next;
  if (!(sampling_time_ > 0)) {
    throw Error(Errc::invalid,
                "the time \"t\" says nothing, as the system has no \"sampling_time\": give it one, "
                "or send \"k\"");
  }
  expect_digits(*t);
  if (last_) return by_time(*t);
  if (!is_first) refuse(fmt::format("t = {} is the first time that is told, and tells no k", *t));
  return next;
}

void SampleClock::expect_digits(double t) const {
  const double spacing = spacing_at(t);
  if (spacing <= std::max(errors_.tolerance, least_share) * sampling_time_) return;
  throw Error(Errc::invalid,
              fmt::format("t = {} is known to {:.2g} s only, and the sampling time is {} s: send "
                          "times from a beginning that is near",
                          t, spacing, sampling_time_));
}

double SampleClock::steps_from(const Known& known, double t) const {
  return (t - known.t) / sampling_time_;
}

Index SampleClock::by_time(double t) const {
  const double rounded = 4 * std::max(spacing_at(t), spacing_at(last_->t)) / sampling_time_;
  const auto allowed = [&](double count) {
    return errors_.tolerance + rounded + errors_.drift * std::abs(count);
  };
  const double steps = steps_from(*last_, t), whole = std::round(steps);
  const auto refuse_as = [&](const std::string& why) {
    refuse(
        fmt::format("t = {} lies {} sampling times of {} s after t = {} of k = {}: it is refused, "
                    "as {}",
                    t, steps, sampling_time_, last_->t, last_->k, why));
  };
  if (!(allowed(whole) < 0.5)) {
    refuse_as(
        fmt::format("over so many times a clock that may be wrong by \"clock_drift\": {} "
                    "tells no number",
                    errors_.drift));
  }
  if (!(std::abs(steps - whole) <= allowed(whole))) {
    refuse_as(
        fmt::format("it may miss a whole number of them by \"clock_tolerance\": {} and "
                    "\"clock_drift\": {} of their number",
                    errors_.tolerance, errors_.drift));
  }
  const Index k = last_->k + static_cast<Index>(whole);
  if (k < 0) refuse_as("this is before k = 0");
  const double since = static_cast<double>(k - set_->k);
  if (!(std::abs(steps_from(*set_, t) - since) <= allowed(since))) {
    refuse_as(
        fmt::format("the clock has gone wrong by {:.3g} sampling times since k = {}, more "
                    "than \"clock_tolerance\": {} and \"clock_drift\": {} of their number",
                    steps_from(*set_, t) - since, set_->k, errors_.tolerance, errors_.drift));
  }
  return k;
}

void SampleClock::took(double t, Index k, bool sets) {
  last_ = Known{t, k};
  if (sets || !set_) set_ = last_;
}

void SampleClock::forget() {
  set_.reset();
  last_.reset();
}

void SampleClock::serialize(Archive& archive) {
  archive(set_, last_);
  for (const std::optional<Known>& known : {set_, last_})
    if (known && (!std::isfinite(known->t) || known->k < 0)) archive.refuse("no time");
  if (set_.has_value() != last_.has_value()) archive.refuse("a clock that is half set");
}

}  // namespace cordon::detail
