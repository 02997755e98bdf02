// SPDX-License-Identifier: GPL-3.0-or-later
// Random banks of formulas: what is called separated is separated in experiments.
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "cordon/study/run.hpp"
#include "run/scratch.hpp"

using namespace cordon;

namespace {

class RandomFormulas {
 public:
  explicit RandomFormulas(unsigned seed) : random_(seed) {}

  /// A study whose modes differ in parameters, in units over six decades.
  std::string study() {
    const double scale = std::pow(10, between(-3, 3));
    const int states = 1 + below(4), inputs = 1 + below(2), outputs = below(2) ? states : 1;
    std::string f, g, x, w, v, u, parameters;
    for (int i = 0; i < states; ++i) {
      x += fmt::format("{}\"x{}\"", i ? ", " : "", i);
      w += fmt::format("{}\"w{}\"", i ? ", " : "", i);
      parameters += fmt::format("{}\"p{}\": {:.3f}", i ? ", " : "", i, between(0.3, 1));
      f +=
          fmt::format("{}\"{:.3f}*x{} + {:.3f}*x{} + {} + w{}\"", i ? ", " : "", between(-0.5, 0.8),
                      i, between(-0.3, 0.3), below(states), driven(i, below(inputs), scale), i);
    }
    for (int i = 0; i < inputs; ++i) u += fmt::format("{}\"u{}\"", i ? ", " : "", i);
    for (int i = 0; i < outputs; ++i) {
      v += fmt::format("{}\"v{}\"", i ? ", " : "", i);
      g += fmt::format("{0}\"x{1} + v{1}\"", i ? ", " : "", i);
    }
    const std::string modes = fmt::format(R"({{"name": "fault", "parameters": {{"p{}": {:.3f}}}}})",
                                          below(states), between(0, 0.3) + (below(2) ? 1.2 : 0));
    return fmt::format(
        R"({{"cordon": 1, "system": {{"type": "nonlinear", "states": [{}], "inputs": [{}],
        "disturbances": [{}], "noises": [{}], "parameters": {{{}}}, "f": [{}], "g": [{}],
        "X0": {}, "W": {}, "V": {}, "U": {}, "modes": [{}]}},
        "data": {{"simulate": {{"seed": {}, "seeds": 15, "noise": "{}"}}}},
        "pipelines": [{{"backend": "{}", "designer": {{"type": "{}", "horizon": {},
        "time_limit": 2}}, "diagnoser": {{"type": "tube_membership", "horizon": 3}}}}]}})",
        x, u, w, v, parameters, f, g, box(states, between(0.05, 0.3) * scale),
        box(states, below(3) * 0.01 * scale), box(outputs, between(0.005, 0.1) * scale),
        box(inputs, 2 * scale), modes, 1 + below(1000), below(2) ? "vertex" : "uniform",
        below(2) ? "zonotope" : "constrained_zonotope", below(3) ? "facets" : "milp", 1 + below(3));
  }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  double between(double a, double b) {
    return a + (b - a) * static_cast<double>(random_() >> 1) / 0x1p31;
  }
  static std::string box(int size, double reach) {
    std::string lower, upper;
    for (int i = 0; i < size; ++i) {
      lower += fmt::format("{}{:.6g}", i ? ", " : "", -reach);
      upper += fmt::format("{}{:.6g}", i ? ", " : "", reach);
    }
    return fmt::format(R"({{"type": "box", "lower": [{}], "upper": [{}]}})", lower, upper);
  }
  std::string driven(int i, int j, double scale) {
    switch (below(5)) {
      case 0:
        return fmt::format("p{}*sin(u{}/{})*{}", i, j, scale, scale);
      case 1:
        return fmt::format("p{}*u{}*(1 + 0.2*x{}/{})", i, j, i, scale);
      case 2:
        return fmt::format("p{}*u{}*u{}/{}", i, j, j, scale);
      case 3:
        return fmt::format("p{}*u{} + 0.3*{}*sqrt(4 + x{}/{})", i, j, scale, i, scale);
      default:
        return fmt::format("p{}*u{} - 0.1*x{}*abs(x{})/{}", i, j, i, i, scale);
    }
  }

  std::mt19937 random_;
};

}  // namespace

TEST_CASE("random formulas that are called separated are so in every experiment") {
  const char* wanted = std::getenv("CORDON_FORMULA_BANKS");
  const unsigned count = wanted ? static_cast<unsigned>(std::stoul(wanted)) : 40;
  Registry registry;
  registry.load({{CORDON_BINARY_DIR "/lib/cordon/plugins-v1"}});
  unsigned separated = 0;
  for (unsigned seed = 1; seed <= count; ++seed) {
    CAPTURE(seed);
    const Scratch scratch;
    const std::string text = RandomFormulas(seed).study();
    CAPTURE(text);
    const Study study =
        read_study(scratch.write("s.json", text), registry, {}, StudyPlugins::refuse);
    const PipelineOutcome pipeline = run_study(study, registry, {}).pipelines.at(0);
    CHECK(pipeline.error == "");
    CHECK(pipeline.violated_at == -1);
    const DesignedOutcome& found = *pipeline.design();
    CHECK(found.refuted.empty());
    if (!found.exact) continue;
    CHECK(found.exact->separates() == Answer::yes);
    ++separated;
    for (const ExperimentRow& row : found.experiments) {
      CHECK(row.runs == 15);
      CHECK(row.isolated == row.runs);
    }
  }
  CHECK(2 * separated >= count);
}
