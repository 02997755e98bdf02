// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with interval matrices and with additive faults.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>

#include "cordon/study/data.hpp"
#include "data/published.hpp"

namespace data_test {

using namespace cordon;

inline constexpr std::int64_t end = std::numeric_limits<std::int64_t>::max();

inline LineForm box(double radius, Index n) {
  return make_box({Vector::Constant(n, -radius), Vector::Constant(n, radius)});
}

/// Without disturbances and noise, so that the data show the matrices.
inline Model uncertain() {
  Model model;
  LinearModel& linear = model.linear;
  linear.A = Matrix{{.9, .1}, {0., .8}};
  linear.A_radius = Matrix{{.05, 0.}, {.02, .1}};
  linear.B = Matrix{{1.}, {2.}};
  linear.B_radius = Matrix{{0.}, {.5}};
  linear.Bw = Matrix::Identity(2, 2);
  linear.C = Matrix::Identity(2, 2);
  linear.C_radius = Matrix{{.1, 0.}, {0., 0.}};
  linear.D = Matrix{{0.}, {.5}};
  linear.Dv = Matrix::Identity(2, 2);
  model.X0 = make_point(Vector{{1., 2.}});
  model.W = make_point(Vector::Zero(2));
  model.V = make_point(Vector::Zero(2));
  return model;
}

inline Study study_of(Model model, Noise noise = Noise::uniform,
                      ParameterDraw parameters = ParameterDraw::constant) {
  SimulateSpec spec;
  spec.steps = 60;
  spec.noise = noise;
  spec.parameters = parameters;
  for (Index i = 0; i < model.linear.inputs(); ++i) {
    Signal signal;
    signal.type = Signal::Type::sine;
    signal.offset = 1;
    signal.amplitude = 1;
    signal.omega = .7 + static_cast<double>(i);
    spec.input.push_back(signal);
  }
  Study study;
  study.file = "study.json";
  study.model = std::move(model);
  study.data = std::move(spec);
  return study;
}

inline SimulateSpec& spec_of(Study& study) { return std::get<SimulateSpec>(study.data); }

inline AdditiveFaultSpec additive(Index fault, std::int64_t from, std::int64_t to, double offset,
                                  double amplitude = 0) {
  AdditiveFaultSpec spec;
  spec.fault = fault;
  spec.from = from;
  spec.to = to;
  spec.signal.type = Signal::Type::sine;
  spec.signal.offset = offset;
  spec.signal.amplitude = amplitude;
  spec.signal.omega = .3;
  return spec;
}

inline FaultSpec fault(std::int64_t from, std::int64_t to, Index mode, Model model) {
  FaultSpec spec;
  spec.from = from;
  spec.to = to;
  spec.mode = mode;
  spec.model = std::move(model);
  return spec;
}

/// The published descriptor system with two directions of faults; the second one acts on the static
/// row.
inline Study faulty_descriptor() {
  Model model = published::descriptor_model();
  model.linear.F = Matrix{{1., 0.}, {0., .5}, {.25, 1.}};
  Study study = study_of(std::move(model));
  spec_of(study).x0 = Vector{{.5, .5, .25}};
  spec_of(study).input = published::descriptor_input();
  spec_of(study).additive_faults = {additive(0, 10, 30, .5, 1), additive(1, 5, end, 0, .3),
                                    additive(1, 20, 25, .1)};
  return study;
}

}  // namespace data_test
