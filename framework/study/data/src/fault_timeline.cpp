// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/fault_timeline.hpp"

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace {

Box both(const Box& actuator, const Box& sensor, Index inputs, Index outputs) {
  Box box{Vector::Ones(inputs + outputs), Vector::Ones(inputs + outputs)};
  if (actuator.dim() != 0)
    box.lower.head(inputs) = actuator.lower, box.upper.head(inputs) = actuator.upper;
  if (sensor.dim() != 0)
    box.lower.tail(outputs) = sensor.lower, box.upper.tail(outputs) = sensor.upper;
  return box;
}

}  // namespace

std::string place_of_fault(std::size_t index) {
  return "/data/simulate/faults/" + std::to_string(index);
}

FaultTimeline::FaultTimeline(const std::vector<FaultSpec>& faults, const std::string& file) {
  std::vector<Diagnostic> problems;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (faults[i].from < 0 || faults[i].to < faults[i].from)
      problems.push_back({place_of_fault(i), "ends before it begins, or begins before k = 0", ""});
    if (i > 0 && faults[i].from <= faults[i - 1].to)
      problems.push_back({place_of_fault(i), "begins before the fault ahead of it has ended",
                          "one fault at a time, in order"});
    times_.emplace_back(faults[i].from, faults[i].to);
  }
  if (!problems.empty()) throw InputError(file, std::move(problems));
}

Index FaultTimeline::at(std::int64_t k) {
  while (next_ < times_.size() && times_[next_].second < k) ++next_;
  return next_ < times_.size() && times_[next_].first <= k ? static_cast<Index>(next_) : -1;
}

Effectiveness::Effectiveness(const Box& actuator, const Box& sensor, Index inputs, Index outputs,
                             Noise noise, RandomStream stream, Index first_prime,
                             const std::string& file, const std::string& pointer)
    : box_(both(actuator, sensor, inputs, outputs)),
      inputs_(inputs),
      draw_(make_box(box_), noise, stream, first_prime, file, pointer) {}

Effectiveness::Value Effectiveness::at(std::int64_t k) {
  const Vector x = draw_.at(k)
                       .cwiseMax(box_.lower)
                       .cwiseMin(box_.upper);  // centre ± radius may be rounded outside
  return {x.head(inputs_), x.tail(x.size() - inputs_)};
}

}  // namespace cordon::detail
