// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/draws.hpp"

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace {

/// A plant is not disturbed by W.
LineForm drawn_W(const Model& model, const SimulateSpec& spec) {
  return spec.made_plant ? make_point(Vector(0)) : model.W;
}

/// A plant has no matrices that hold the exact part of the effectiveness.
const Box& actuator_of(const FaultSpec& fault, const SimulateSpec& spec) {
  return spec.made_plant ? fault.actuator : fault.model.linear.actuator;
}
const Box& sensor_of(const FaultSpec& fault, const SimulateSpec& spec) {
  return spec.made_plant ? fault.sensor : fault.model.linear.sensor;
}

void check_radius(const Matrix& A, const Matrix& radius, const std::string& pointer,
                  std::vector<Diagnostic>& problems) {
  if (radius.size() == 0) return;
  if (radius.rows() != A.rows() || radius.cols() != A.cols()) {
    problems.push_back({pointer, "has a radius of another size", ""});
  } else if (!radius.allFinite() || radius.minCoeff() < 0) {
    problems.push_back({pointer, "has a radius that is negative or not finite", ""});
  }
}

void check_additive_faults(const SimulateSpec& spec, Index faults,
                           std::vector<Diagnostic>& problems) {
  for (std::size_t i = 0; i < spec.additive_faults.size(); ++i) {
    const AdditiveFaultSpec& fault = spec.additive_faults[i];
    const std::string place = "/data/simulate/additive_faults/" + std::to_string(i);
    if (fault.fault < 0 || fault.fault >= faults)
      problems.push_back({place + "/fault", "is no column of /system/F", ""});
    if (fault.from < 0 || fault.to < fault.from)
      problems.push_back({place, "ends before it begins, or begins before k = 0", ""});
    for (Diagnostic& d : problems_of(fault.signal, place + "/signal"))
      problems.push_back(std::move(d));
  }
}

void check_dropouts(const SimulateSpec& spec, Index outputs, std::vector<Diagnostic>& problems) {
  for (std::size_t i = 0; i < spec.dropouts.size(); ++i) {
    const DropoutSpec& dropout = spec.dropouts[i];
    const std::string place = "/data/simulate/dropouts/" + std::to_string(i);
    for (const Index output : dropout.outputs) {
      if (output < 0 || output >= outputs)
        problems.push_back({place + "/outputs", "has a number that is no row of /system/C", ""});
    }
    if (dropout.from < 0 || dropout.to < dropout.from)
      problems.push_back({place, "ends before it begins, or begins before k = 0", ""});
    if (!(dropout.probability >= 0 && dropout.probability <= 1))
      problems.push_back({place + "/probability", "does not lie in [0, 1]", ""});
    if (dropout.every < 0) problems.push_back({place + "/every", "is negative", ""});
  }
}

}  // namespace

void check_simulation(const Model& model, const SimulateSpec& spec, const std::string& file) {
  std::vector<Diagnostic> problems;
  const auto require = [&](Index size, Index wanted, const std::string& pointer, const char* of) {
    if (size == wanted) return;
    problems.push_back(
        {pointer,
         "has size " + std::to_string(size) + ", must be " + std::to_string(wanted) + ", " + of,
         ""});
  };
  const LinearModel& linear = model.linear;
  require(static_cast<Index>(spec.input.size()), model.inputs(), "/data/simulate/input",
          "one signal per column of /system/B");
  require(model.W.dim(), model.disturbances(), "/system/W", "the columns of /system/Bw");
  require(model.V.dim(), model.noises(), "/system/V", "the columns of /system/Dv");
  if (spec.x0)
    require(spec.x0->size(), model.states(), "/data/simulate/x0", "the rows of /system/A");
  if (spec.x0 && !spec.x0->allFinite())
    problems.push_back({"/data/simulate/x0", "has a NaN or infinite number", ""});
  if (spec.x0_set)
    require(spec.x0_set->dim(), model.states(), "/data/simulate/x0", "the rows of /system/A");
  if (spec.x0 && spec.x0_set)
    problems.push_back(
        {"/data/simulate/x0", "is both a state and a set of states", "give one of them"});
  if (spec.steps < 0) problems.push_back({"/data/simulate/steps", "is negative", ""});
  for (std::size_t i = 0; i < spec.input.size(); ++i) {
    for (Diagnostic& d : problems_of(spec.input[i], "/data/simulate/input/" + std::to_string(i)))
      problems.push_back(std::move(d));
  }
  check_radius(linear.A, linear.A_radius, "/system/A", problems);
  check_radius(linear.B, linear.B_radius, "/system/B", problems);
  check_radius(linear.C, linear.C_radius, "/system/C", problems);
  if (linear.faults() > 0)
    require(linear.F.rows(), model.states(), "/system/F", "the rows of /system/A");
  check_additive_faults(spec, linear.faults(), problems);
  check_dropouts(spec, model.outputs(), problems);
  if (spec.made_plant && !spec.additive_faults.empty()) {
    problems.push_back({"/data/simulate/additive_faults",
                        "cannot be simulated with a plant: they are about the linear model", ""});
  }
  for (std::size_t i = 0; i < spec.faults.size(); ++i) {
    const Model& fault = spec.faults[i].model;
    require(fault.states(), model.states(), place_of_fault(i), "the states of /system");
    require(fault.inputs(), model.inputs(), place_of_fault(i), "the inputs of /system");
    require(fault.outputs(), model.outputs(), place_of_fault(i), "the outputs of /system");
    require(fault.W.dim(), fault.disturbances(), place_of_fault(i), "the columns of its Bw");
    require(fault.V.dim(), fault.noises(), place_of_fault(i), "the columns of its Dv");
    require(fault.linear.faults(), linear.faults(), place_of_fault(i), "the columns of /system/F");
    for (const auto& [A, radius] : {std::pair(&fault.linear.A, &fault.linear.A_radius),
                                    std::pair(&fault.linear.B, &fault.linear.B_radius),
                                    std::pair(&fault.linear.C, &fault.linear.C_radius)}) {
      check_radius(*A, *radius, place_of_fault(i), problems);
    }
  }
  if (!problems.empty()) throw InputError(file, std::move(problems));
}

Disturbance start_draws(const SimulateSpec& spec, const std::string& file) {
  return {*spec.x0_set, spec.noise,         RandomStream(spec.seed, Purpose::start), 0,
          file,         "/data/simulate/x0"};
}

InputSource::InputSource(const std::vector<Signal>& signals) {
  for (std::size_t i = 0; i < signals.size(); ++i) signals_.emplace_back(signals[i], i);
}

Vector InputSource::at(std::int64_t k) {
  Vector u(static_cast<Index>(signals_.size()));
  for (Index i = 0; i < u.size(); ++i) u[i] = signals_[static_cast<std::size_t>(i)].at(k);
  return u;
}

AdditiveFaultSource::AdditiveFaultSource(const std::vector<AdditiveFaultSpec>& specs, Index faults)
    : faults_(faults) {
  for (std::size_t i = 0; i < specs.size(); ++i)
    entries_.push_back({specs[i], SignalSource(specs[i].signal, i, Purpose::additive_fault)});
}

Vector AdditiveFaultSource::at(std::int64_t k) {
  Vector n = Vector::Zero(faults_);
  for (Entry& entry : entries_) {
    if (k >= entry.spec.from && k <= entry.spec.to) n[entry.spec.fault] += entry.signal.at(k);
  }
  return n;
}

ParameterSource::ParameterSource(const LinearModel& model, Noise noise, ParameterDraw draw,
                                 RandomStream stream)
    : A_(model.interval_A()),
      B_(model.interval_B()),
      C_(model.interval_C()),
      noise_(noise),
      pending_(model.is_uncertain() && (noise == Noise::uniform || noise == Noise::vertex)),
      again_(pending_ && draw == ParameterDraw::varying),
      stream_(stream) {}

/// Row by row; numbers are taken for entries with a radius only.
Matrix ParameterSource::drawn(const IntervalMatrix& A) {
  Matrix inside = A.center;
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) {
      if (A.radius(i, j) > 0)
        inside(i, j) +=
            A.radius(i, j) * (noise_ == Noise::vertex ? stream_.sign() : stream_.symmetric());
    }
  }
  return inside;
}

std::optional<DrawnMatrices> ParameterSource::next() {
  if (!pending_) return std::nullopt;
  pending_ = again_;
  DrawnMatrices matrices;
  matrices.A = drawn(A_);
  matrices.B = drawn(B_);
  matrices.C = drawn(C_);
  return matrices;
}

DrawSource::DrawSource(const Model& model, const SimulateSpec& spec, const std::string& file)
    : DrawSource(model, model.linear.actuator, model.linear.sensor, spec, 0, file,
                 {"/system/W", "/system/V", "/system"}) {}

DrawSource::DrawSource(const SimulateSpec& spec, std::size_t fault, const std::string& file)
    : DrawSource(spec.faults[fault].model, actuator_of(spec.faults[fault], spec),
                 sensor_of(spec.faults[fault], spec), spec,
                 static_cast<std::uint64_t>(spec.faults[fault].from) + 1, file,
                 {place_of_fault(fault), place_of_fault(fault), place_of_fault(fault)}) {}

DrawSource::DrawSource(const Model& model, const Box& actuator, const Box& sensor,
                       const SimulateSpec& spec, std::uint64_t stream, const std::string& file,
                       const Place& place)
    : disturbance_(drawn_W(model, spec), spec.noise,
                   RandomStream(spec.seed, Purpose::disturbance, stream), 0, file, place.W),
      noise_(model.V, spec.noise, RandomStream(spec.seed, Purpose::noise, stream),
             disturbance_.factors(), file, place.V),
      effectiveness_(actuator, sensor, model.linear.inputs(), model.linear.outputs(), spec.noise,
                     RandomStream(spec.seed, Purpose::effectiveness, stream),
                     disturbance_.factors() + noise_.factors(), file, place.effectiveness),
      parameters_(model.linear, spec.noise, spec.parameters,
                  RandomStream(spec.seed, Purpose::parameters, stream)) {}

Draw DrawSource::at(std::int64_t k) {
  Draw draw;
  draw.w = disturbance_.at(k);
  draw.v = noise_.at(k);
  draw.effectiveness = effectiveness_.at(k);
  draw.matrices = parameters_.next();
  return draw;
}

}  // namespace cordon::detail
