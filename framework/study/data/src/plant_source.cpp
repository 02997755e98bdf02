// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/plant_source.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"

namespace cordon::detail {

PlantSource::PlantSource(const Model& model, const SimulateSpec& spec, std::string file, bool modes)
    : spec_(spec),
      file_(std::move(file)),
      modes_(modes),
      Dv_((check_simulation(model, spec, file_), model.linear.Dv)),
      timeline_(spec_.faults, file_),
      nominal_(model, spec_, file_),
      inputs_(spec_.input) {
  const Plant& plant = *spec_.made_plant;
  const LinearModel& linear = model.linear;
  if (plant.states() != linear.states() || plant.inputs() != linear.inputs() ||
      plant.outputs() != linear.outputs())
    fail("/data/simulate/plant", "has other numbers of states, inputs or outputs than /system", "");
  for (std::size_t i = 0; i < spec_.faults.size(); ++i) DrawSource(spec_, i, file_);
  std::optional<Vector> start = spec_.x0;
  if (!start) start = spec_.x0_set ? start_draws(spec_, file_).at(0) : central_point(model.X0);
  if (!start)
    fail("/system/X0", "no point of the set was found to start from",
         "check its constraints, or give /data/simulate/x0");
  x_ = *start;
}

void PlantSource::fail(const std::string& pointer, const std::string& message,
                       const std::string& suggestion) const {
  throw InputError(file_, {{pointer, message, suggestion}});
}

/// What the plant answers, checked.
Vector PlantSource::ask(const char* what,
                        Vector (Plant::*function)(Index, VectorIn, VectorIn) const, std::int64_t k,
                        const Vector& u) const {
  Vector answer;
  const auto broken = [&](const std::string& how) {
    const std::string name = spec_.plant ? "plant \"" + spec_.plant->type + "\"" : "the plant";
    return Error(Errc::plugin, name + ": " + what + " at k = " + std::to_string(k) + " " + how);
  };
  try {
    answer = (spec_.made_plant.get()->*function)(static_cast<Index>(k), x_, u);
  } catch (const Error& error) {
    if (error.code() == Errc::violated) throw broken(std::string("is wrong: ") + error.what());
    throw;
  } catch (const std::exception& error) {
    throw broken(std::string("threw ") + error.what());
  }
  if (!answer.allFinite()) {
    fail("/data/simulate/plant",
         std::string("its ") + what + " is not finite at k = " + std::to_string(k),
         "simulate fewer steps, or with other inputs");
  }
  return answer;
}

std::optional<Record> PlantSource::next() {
  if (k_ > spec_.steps) return std::nullopt;
  const std::int64_t k = k_++;
  if (const Index acting = timeline_.at(k); acting != acting_) {
    fault_.reset();
    if (acting >= 0) fault_.emplace(spec_, static_cast<std::size_t>(acting), file_);
    acting_ = acting;
  }
  const FaultSpec* fault = acting_ < 0 ? nullptr : &spec_.faults[static_cast<std::size_t>(acting_)];
  Draw draw = nominal_.at(k);  // also while a fault acts: what comes after it does not depend on it
  if (fault_) draw = fault_->at(k);
  Record record;
  record.sample.k = static_cast<Index>(k);
  record.sample.u = inputs_.at(k);
  record.truth = x_;
  if (modes_) record.mode = fault ? fault->mode : 0;
  const Vector u = draw.effectiveness.actuator.cwiseProduct(record.sample.u);
  const Vector y = ask("output", &Plant::output, k, u);
  record.sample.y = y.cwiseProduct(draw.effectiveness.sensor) +
                    linalg::product(fault ? fault->model.linear.Dv : Dv_, draw.v);
  if (k < spec_.steps) x_ = ask("next state", &Plant::next, k, u);
  return record;
}

}  // namespace cordon::detail
