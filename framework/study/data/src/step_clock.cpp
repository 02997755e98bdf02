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

std::optional<std::int64_t> StepClock::on_grid(double t, double origin) const {
  const double steps = (t - origin) / sampling_time_, k = std::round(steps);
  if (!(std::abs(steps - k) <= tolerated) || !(std::abs(k) < most_steps)) return std::nullopt;
  return static_cast<std::int64_t>(k);
}

StepClock::Answer StepClock::refuse(std::string problem, std::string suggestion) const {
  return {next_, std::move(problem), std::move(suggestion)};
}

StepClock::Answer StepClock::refuse_second(double t) {
  is_silent_ = true;
  const std::string apart = fmt::format("{:.6g}", t - *first_);
  return refuse(fmt::format("is {}, {} after the first row's {}; the sampling time is {}", t, apart,
                            *first_, sampling_time_),
                fmt::format("if all rows lie that far apart, \"sampling_time\" is {} in the unit "
                            "of this column{}",
                            apart,
                            t - *first_ > sampling_time_ && !fills_
                                ? "; with \"irregular\": \"gaps\" rows may leave out steps"
                                : ""));
}

StepClock::Answer StepClock::step_at(double t) {
  if (is_silent_) return {next_++};
  if (!first_) first_ = t;
  if (before_ && !(t > *before_))
    return refuse(fmt::format("is {} after {} in the row before: times must grow", t, *before_),
                  "sort the rows by time, each time once");
  std::optional<std::int64_t> k = on_grid(t, *first_);
  if (!k && shifted_) k = on_grid(t, *shifted_);
  const std::int64_t left_out = k ? *k - next_ : 0;
  const bool is_expected =
      k && left_out >= 0 &&
      (fills_ ? static_cast<double>(left_out) <= most_left_out : left_out == 0);
  if (is_expected) {
    before_ = t;
    next_ = *k + 1;
    return {*k};
  }
  if (next_ == 1 && !(fills_ && left_out > 0)) return refuse_second(t);
  if (!k) {
    shifted_ = t - static_cast<double>(next_++) * sampling_time_;
    return refuse(fmt::format("is {}, which is no multiple of the sampling time {} after the first "
                              "row's {}: {:.6g} steps",
                              t, sampling_time_, *first_, (t - *first_) / sampling_time_),
                  "resample the data, or correct \"sampling_time\"");
  }
  before_ = t;
  if (left_out < 0)
    return refuse(fmt::format("is {}, of the same step as the row before", t),
                  "remove one of them");
  const double expected = *first_ + static_cast<double>(next_) * sampling_time_;
  next_ = *k + 1;
  return refuse(fmt::format("is {}, where {} was expected: {} step{} left out", t, expected,
                            left_out, left_out == 1 ? " is" : "s are"),
                fills_ ? "split the data there: so many steps without data say nothing"
                       : "with \"irregular\": \"gaps\" these are steps without outputs");
}

}  // namespace cordon::detail
