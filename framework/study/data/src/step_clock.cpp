// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/step_clock.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace cordon::detail {

namespace {

constexpr double tolerated = 0.01;     // of the sampling time
constexpr double most_steps = 1e9;     // of a study
constexpr double most_left_out = 1e6;  // in one place

}  // namespace

StepClock::Answer StepClock::step_at(double t) {
  if (!first_) first_ = t;
  const double steps = (t - *first_) / sampling_time_, k = std::round(steps);
  const auto expected = static_cast<double>(next_);
  const auto refuse = [&](std::string problem, std::string suggestion) {
    return Answer{next_, std::move(problem), std::move(suggestion)};
  };
  if (before_ && !(t > *before_))
    return refuse(fmt::format("is {} after {} in the row before: times must grow", t, *before_),
                  "sort the rows by time, each time once");
  before_ = t;
  if (!(std::abs(steps - k) <= tolerated) || !(k < most_steps)) {
    const double first = std::exchange(*first_, t - expected * sampling_time_);
    ++next_;  // those after it are told from it
    return refuse(fmt::format("is {}, which is no multiple of the sampling time {} after the first "
                              "row's {}: {:.6g} steps",
                              t, sampling_time_, first, steps),
                  "resample the data, or correct \"sampling_time\"");
  }
  if (k < expected)
    return refuse(fmt::format("is {}, of the same step as the row before", t),
                  "remove one of them");
  next_ = static_cast<std::int64_t>(k) + 1;
  if (k > expected && (!fills_ || k - expected > most_left_out)) {
    return refuse(fmt::format("is {}, where {} was expected: {} step{} left out", t,
                              *first_ + expected * sampling_time_, k - expected,
                              k - expected == 1 ? " is" : "s are"),
                  fills_ ? "split the data there: so many steps without data say nothing"
                         : "with \"irregular\": \"gaps\" these are steps without outputs");
  }
  return {static_cast<std::int64_t>(k)};
}

}  // namespace cordon::detail
