// SPDX-License-Identifier: GPL-3.0-or-later
// The main study over a hundred seeds: the truth stays inside every estimate, and the mean radii
// are the published ones [Rego2025, fig. 5].
#include <map>

#include <doctest/doctest.h>

#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"
#include "study_models.hpp"

using namespace cordon;

namespace {

struct Figures {
  double radius_sum = 0;
  Index radius_count = 0, empty_before_exit = 0;
};

/// Runs one pipeline over one seed; containment is asserted while the truth keeps to the pipeline's
/// admissible set.
void run(const Study& study, const PipelineSpec& pipeline, const Registry& registry,
         Figures& figures) {
  const auto backend = registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
  const auto observer =
      registry.make<ObserverEntry>(pipeline.estimation()->observer.type, {study.model, backend},
                                   pipeline.estimation()->observer.params);
  observer->start();
  const auto source = open_data(study);
  bool admissible = true;
  while (const auto record = source->next()) {
    const Estimate estimate = observer->step(record->sample);
    const Index k = record->sample.k;
    if (const auto set = observer->admissible_set())
      admissible = admissible && contains(*set, *record->truth) != Answer::no;
    if (!admissible) return;
    INFO(pipeline.name << ", k = " << k);
    REQUIRE(estimate.consistent != Answer::no);  // never empty before the truth leaves
    const Answer inside = estimate.set->contains(*record->truth);
    REQUIRE(inside != Answer::no);
    // noise at a vertex may put the truth on the boundary, where nothing is proven
    if (std::get<SimulateSpec>(study.data).noise == Noise::uniform) REQUIRE(inside == Answer::yes);
    // a bound of every estimate: the measurement y₂ = x₁ - x₂ + 1.5 v₂ and x₁ = ± 0.35 of the exact
    // sets
    if (pipeline.backend.type == "line_zonotope" && k >= 1)
      REQUIRE(estimate.set->interval_hull().longest_half_edge() <= 1.85 * (1 + 1e-6));
    if (k >= 2 && k <= 20) {
      figures.radius_sum += estimate.set->interval_hull().longest_half_edge();
      ++figures.radius_count;
    }
  }
}

}  // namespace

TEST_CASE("a hundred seeds of the main study") {
  const Plugins plugins;
  Registry registry;
  registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  Study study = read_study(
      CORDON_SOURCE_DIR "/examples/studies/descriptor_four_representations.json", registry);
  std::map<std::string, Figures> figures;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    std::get<SimulateSpec>(study.data).seed = seed;
    std::get<SimulateSpec>(study.data).noise = seed % 10 == 0 ? Noise::vertex : Noise::uniform;
    for (const PipelineSpec& pipeline : study.pipelines)
      run(study, pipeline, registry,
          figures[pipeline.backend.type + (seed % 10 == 0 ? "_vertex" : "")]);
  }
  const auto mean = [&](const std::string& backend) {
    return figures.at(backend).radius_sum / static_cast<double>(figures.at(backend).radius_count);
  };
  MESSAGE("mean radii k = 2..20: line " << mean("line_zonotope") << ", constrained "
                                        << mean("constrained_zonotope") << ", zonotope "
                                        << mean("zonotope") << ", interval " << mean("interval"));
  CHECK(mean("line_zonotope") == doctest::Approx(1.6469).epsilon(.03));
  CHECK(mean("constrained_zonotope") == doctest::Approx(1.6466).epsilon(.03));
  CHECK(mean("zonotope") == doctest::Approx(6.66).epsilon(.03));
}
