// SPDX-License-Identifier: GPL-3.0-or-later
// Small studies for sessions.
#pragma once

#include <string>

#include "cordon/study/online.hpp"

namespace online_test {

using namespace cordon;

/// x⁺ = A x + u + w, y = x + v in two states with two outputs, and a mode with a leak. Pipelines:
/// "zonotope", "constrained", "interval", "bank".
inline std::string study_text(const std::string& online = "") {
  return R"({"cordon": 1,
    "system": {"type": "lti", "A": [[0.8, 0.1], [0, 0.7]], "B": [[1], [0.5]], "Bw": [[1, 0], [0, 1]],
      "C": [[1, 0], [0, 1]], "Dv": [[1, 0], [0, 1]],
      "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "V": {"type": "box", "lower": [-0.2, -0.2], "upper": [0.2, 0.2]},
      "modes": [{"name": "leak", "system": {"type": "lti", "A": [[0.4, 0.1], [0, 0.7]], "B": [[1], [0.5]],
        "Bw": [[1, 0], [0, 1]], "C": [[1, 0], [0, 1]], "Dv": [[1, 0], [0, 1]],
        "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
        "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
        "V": {"type": "box", "lower": [-0.2, -0.2], "upper": [0.2, 0.2]}}}]},
    "pipelines": [
      {"name": "zonotope", "backend": {"type": "zonotope"},
       "observer": {"type": "prediction_correction", "max_generators": 10}},
      {"name": "constrained", "backend": {"type": "constrained_zonotope"},
       "observer": {"type": "prediction_correction", "max_generators": 10, "max_constraints": 4}},
      {"name": "interval", "backend": {"type": "interval"},
       "observer": {"type": "luenberger"}},
      {"name": "bank", "backend": {"type": "constrained_zonotope"},
       "diagnoser": {"type": "consistency_bank", "start": "any",
         "observer": {"type": "prediction_correction", "max_generators": 10, "max_constraints": 4}}}])" +
         (online.empty() ? "" : ", \"online\": " + online) + "}";
}

/// The same, with a sampling time of half a second.
inline std::string study_with_clock(const std::string& online = "") {
  std::string text = study_text(online);
  return text.insert(text.find("\"A\""), "\"sampling_time\": 0.5, ");
}

/// Registry and study, with the plugins of this build.
struct Loaded {
  explicit Loaded(const std::string& online = "") : Loaded(study_text(online), whole) {}
  enum Whole { whole };
  Loaded(const std::string& text, Whole)
      : study(read_study_text(text, "study.json", registry, default_search_path(),
                              StudyPlugins::refuse, StudyData::optional)) {}
  Registry registry;
  Study study;
};

/// The plant with leak or without, from x₀ = 0, without noise but what the sine makes.
struct LeakyPlant {
  Vector x = Vector::Zero(2);
  Index k = 0;

  GivenSample next(bool leaks = false) {
    const Vector u = Vector::Constant(1, std::sin(0.3 * static_cast<double>(k)));
    const Vector noise{{0.15 * std::sin(1.7 * static_cast<double>(k)),
                        0.15 * std::cos(2.3 * static_cast<double>(k))}};
    GivenSample sample{k, u, x + noise};
    const Matrix A{{leaks ? 0.4 : 0.8, 0.1}, {0, 0.7}};
    x = A * x + Vector{{u[0], 0.5 * u[0]}} + 0.5 * noise;
    ++k;
    return sample;
  }
};

}  // namespace online_test
