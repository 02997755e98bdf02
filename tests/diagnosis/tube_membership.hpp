// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnosers `tube_membership`, their runs over samples, and samples of scalar models.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cordon/sets/sampling.hpp"
#include "published/study_models.hpp"

namespace diagnosis_test {

using namespace cordon;

inline const Plugins& plugins() {
  static const Plugins instance;
  return instance;
}

inline Params horizon(std::int64_t N) {
  Params params;
  params.set("horizon", N);
  return params;
}

inline std::shared_ptr<Diagnoser> make(const ModeBank& bank, const std::string& backend,
                                       Params params) {
  return plugins().registry.make<DiagnoserEntry>(
      "tube_membership", {bank, plugins().backend(backend)}, std::move(params));
}

/// Steps of one experiment; the first step at which one mode is left, or the number of samples.
struct Run {
  std::vector<Diagnosis> steps;
  Index decided = 0;
};
inline Run run(Diagnoser& diagnoser, const std::vector<Sample>& samples) {
  Run result;
  diagnoser.start();
  for (const Sample& now : samples) {
    result.steps.push_back(diagnoser.step(now));
    if (result.steps.back().decision == Decision::isolating) ++result.decided;
  }
  return result;
}

/// x⁺ = a x + u + w, y = x + v of the three scalar models, from an x_0 that nobody bounds.
inline std::vector<Sample> scalar_samples(const Model& model, double x,
                                          const std::vector<double>& inputs, std::uint64_t seed,
                                          bool vertex) {
  sets::Random random(seed);
  const auto noise = [&] {
    const double xi = random.cube(1)[0];
    return .1 * (vertex ? (xi < 0 ? -1.0 : 1.0) : xi);
  };
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    samples.push_back({static_cast<Index>(k), Vector{{inputs[k]}}, Vector{{x + noise()}}});
    x = model.linear.A(0, 0) * x + inputs[k] + noise();
  }
  return samples;
}

}  // namespace diagnosis_test
