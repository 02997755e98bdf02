// SPDX-License-Identifier: GPL-3.0-or-later
// Systems by formulas.
#pragma once

#include <string>

#include "cordon/study/study.hpp"
#include "run/scratch.hpp"

namespace cordon {

/// The system of a study, of which the pipelines do not matter.
inline Model model_of(const std::string& system) {
  const Scratch scratch;
  const std::string study = R"({"cordon": 1, "system": )" + system +
                            R"(, "pipelines": [{"backend": "interval", "observer": "nonlinear"}]})";
  Registry registry;
  registry.load({{CORDON_BINARY_DIR "/lib/cordon/plugins-v1"}});
  return read_study(scratch.write("s.json", study), registry, {}, StudyPlugins::refuse,
                    StudyData::optional)
      .model;
}

inline const char* const tanks =
    R"json({"type": "nonlinear", "states": ["x1", "x2"], "inputs": ["u1"],
  "disturbances": ["w1", "w2"], "noises": ["v"],
  "f": ["x1 + 0.5*u1 - 0.3*sqrt(x1) + w1", "x2 + 0.3*sqrt(x1) - 0.25*sqrt(x2) + w2"],
  "g": ["x2 + v"], "X0": {"type": "box", "lower": [3, 4], "upper": [5, 6]},
  "W": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
  "V": {"type": "box", "lower": [-0.05], "upper": [0.05]}})json";
inline const char* const reaction =
    R"json({"type": "nonlinear", "states": ["C", "T"], "inputs": ["Tc"],
  "disturbances": ["w1", "w2"], "noises": ["v"],
  "f": ["C + 0.02*(1 - C - 7.2e10*exp(-8750/T)*C) + w1",
        "T + 0.02*(350 - T + 209.205*7.2e10*exp(-8750/T)*C + 2.09205*(Tc - T)) + w2"],
  "g": ["T + v"], "X0": {"type": "box", "lower": [0.45, 347], "upper": [0.55, 353]},
  "W": {"type": "box", "lower": [-0.0005, -0.05], "upper": [0.0005, 0.05]},
  "V": {"type": "box", "lower": [-0.5], "upper": [0.5]}})json";
/// Disturbances, noises and inputs that are multiplied, W no box, outputs that are bent.
inline const char* const bent =
    R"json({"type": "nonlinear", "states": ["x1", "x2"], "inputs": ["u1"],
  "disturbances": ["w1", "w2"], "noises": ["v"],
  "f": ["x1*(3 - x1/7 - 4*x2/(4 + x1))*(1 + w1) + 0.1*u1*x2", "abs(x2 - 1)*u1 + w2*x1 + 0.3"],
  "g": ["x1 - sin(x2/2)*(1 + v)", "(1 - x1)*x2 + v*u1"],
  "X0": {"type": "box", "lower": [4, 0], "upper": [6, 1]},
  "W": {"type": "zonotope", "center": [0.1, 0], "generators": [[0.1, 0.05], [0.02, -0.1]]},
  "V": {"type": "box", "lower": [-0.2], "upper": [0.1]}})json";

}  // namespace cordon
