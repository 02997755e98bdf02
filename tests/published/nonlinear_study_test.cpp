// SPDX-License-Identifier: GPL-3.0-or-later
// The comparison of methods for formulas: widths at k = 10 of the predator-prey system, computed
// apart from this project without any reduction; those of zonotopes, which cut in another way, are
// bounds.
#include <algorithm>
#include <map>

#include <doctest/doctest.h>

#include "cordon/study/run.hpp"

using namespace cordon;

namespace {

RunOutcome outcome_of(const std::string& name) {
  Registry registry;
  const Study study =
      read_study(std::string(CORDON_SOURCE_DIR "/examples/studies/") + name, registry,
                 {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  return run_study(study, registry, {});
}

}  // namespace

TEST_CASE("methods for formulas: widths of the predator-prey system after ten steps") {
  const std::map<std::string, Vector> known{
      {"constrained, mean value", Vector{{.474852, .164973}}},
      {"constrained, first order", Vector{{.362462, .086019}}},
      {"constrained, first order + HC4", Vector{{.206863, .035546}}}};
  const std::map<std::string, Vector> most{
      {"interval", Vector{{.2375, .0372}}},
      {"zonotope, mean value", Vector{{.724, .224}}},
      {"zonotope, first order", Vector{{.704, .208}}},
      {"zonotope, first order + box", Vector{{.2375, .0372}}},
      {"strips, F-radius", Vector{{.68, .14}}},
      {"strips, F-radius, one gain", Vector{{.51, .12}}},
      {"strips, volume", Vector{{.47, .11}}},
      {"strips, volume by columns", Vector{{.47, .11}}},
      {"constrained, relaxation", Vector{{.338, .058}}},
      {"constrained, dc + HC4", Vector{{.2075, .0357}}},
      {"constrained, relaxation + HC4", Vector{{.207, .0355}}}};
  const Vector attained{{.180, .0327}};  // by trajectories
  const RunOutcome outcome = outcome_of("nonlinear_methods.json");
  REQUIRE(outcome.pipelines.size() == known.size() + most.size());
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    CAPTURE(pipeline.name);
    CHECK(pipeline.error.empty());
    CHECK(pipeline.violated_at == -1);
    REQUIRE(pipeline.estimation());
    CHECK(pipeline.estimation()->outside_from == -1);
    const Vector widths = 2 * pipeline.estimation()->last_hull.radius();
    CAPTURE(widths.transpose());
    CHECK((widths.array() >= attained.array()).all());
    if (known.contains(pipeline.name)) {
      CHECK((widths - known.at(pipeline.name)).cwiseAbs().maxCoeff() <= 1e-6);
    } else {
      CHECK((widths.array() <= most.at(pipeline.name).array()).all());
    }
  }
}
