// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/draws.hpp"

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace {

/// A plant is not disturbed by W.
LineForm drawn_W(const Model& model, const SimulateSpec& spec) { return spec.made_plant ? make_point(Vector(0)) : model.W; }

/// A plant has no matrices that hold the exact part of the effectiveness.
const Box& actuator_of(const FaultSpec& fault, const SimulateSpec& spec) {
  return spec.made_plant ? fault.actuator : fault.model.linear.actuator;
}
const Box& sensor_of(const FaultSpec& fault, const SimulateSpec& spec) {
  return spec.made_plant ? fault.sensor : fault.model.linear.sensor;
}

}  // namespace

void check_simulation(const Model& model, const SimulateSpec& spec, const std::string& file) {
  std::vector<Diagnostic> problems;
  const auto require = [&](Index size, Index wanted, const std::string& pointer, const char* of) {
    if (size == wanted) return;
    problems.push_back({pointer, "has size " + std::to_string(size) + ", must be " + std::to_string(wanted) + ", " + of, ""});
  };
  const LinearModel& linear = model.linear;
  require(static_cast<Index>(spec.input.size()), linear.inputs(), "/data/simulate/input", "one signal per column of /system/B");
  require(model.W.dim(), linear.disturbances(), "/system/W", "the columns of /system/Bw");
  require(model.V.dim(), linear.noises(), "/system/V", "the columns of /system/Dv");
  if (spec.x0) require(spec.x0->size(), linear.states(), "/data/simulate/x0", "the rows of /system/A");
  if (spec.x0 && !spec.x0->allFinite()) problems.push_back({"/data/simulate/x0", "has a NaN or infinite number", ""});
  if (spec.steps < 0) problems.push_back({"/data/simulate/steps", "is negative", ""});
  for (std::size_t i = 0; i < spec.input.size(); ++i) {
    for (Diagnostic& d : problems_of(spec.input[i], "/data/simulate/input/" + std::to_string(i)))
      problems.push_back(std::move(d));
  }
  for (std::size_t i = 0; i < spec.faults.size(); ++i) {
    const Model& fault = spec.faults[i].model;
    require(fault.linear.states(), linear.states(), place_of_fault(i), "the states of /system");
    require(fault.linear.inputs(), linear.inputs(), place_of_fault(i), "the inputs of /system");
    require(fault.linear.outputs(), linear.outputs(), place_of_fault(i), "the outputs of /system");
    require(fault.W.dim(), fault.linear.disturbances(), place_of_fault(i), "the columns of its Bw");
    require(fault.V.dim(), fault.linear.noises(), place_of_fault(i), "the columns of its Dv");
  }
  if (!problems.empty()) throw InputError(file, std::move(problems));
}

InputSource::InputSource(const std::vector<Signal>& signals) {
  for (std::size_t i = 0; i < signals.size(); ++i) signals_.emplace_back(signals[i], i);
}

Vector InputSource::at(std::int64_t k) {
  Vector u(static_cast<Index>(signals_.size()));
  for (Index i = 0; i < u.size(); ++i) u[i] = signals_[static_cast<std::size_t>(i)].at(k);
  return u;
}

DrawSource::DrawSource(const Model& model, const SimulateSpec& spec, const std::string& file)
    : DrawSource(model, model.linear.actuator, model.linear.sensor, spec, 0, file, {"/system/W", "/system/V", "/system"}) {}

DrawSource::DrawSource(const SimulateSpec& spec, std::size_t fault, const std::string& file)
    : DrawSource(spec.faults[fault].model, actuator_of(spec.faults[fault], spec), sensor_of(spec.faults[fault], spec), spec,
                 static_cast<std::uint64_t>(spec.faults[fault].from) + 1, file,
                 {place_of_fault(fault), place_of_fault(fault), place_of_fault(fault)}) {}

DrawSource::DrawSource(const Model& model, const Box& actuator, const Box& sensor, const SimulateSpec& spec, std::uint64_t stream,
                       const std::string& file, const Place& place)
    : disturbance_(drawn_W(model, spec), spec.noise, RandomStream(spec.seed, Purpose::disturbance, stream), 0, file, place.W),
      noise_(model.V, spec.noise, RandomStream(spec.seed, Purpose::noise, stream), disturbance_.factors(), file, place.V),
      effectiveness_(actuator, sensor, model.linear.inputs(), model.linear.outputs(), spec.noise,
                     RandomStream(spec.seed, Purpose::effectiveness, stream), disturbance_.factors() + noise_.factors(), file,
                     place.effectiveness) {}

Draw DrawSource::at(std::int64_t k) {
  Draw draw;
  draw.w = disturbance_.at(k);
  draw.v = noise_.at(k);
  draw.effectiveness = effectiveness_.at(k);
  return draw;
}

}  // namespace cordon::detail
