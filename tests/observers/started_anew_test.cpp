// SPDX-License-Identifier: GPL-3.0-or-later
// Observers keep memory, and one of them its gain, from step to step: nothing of it may show after
// a new start, and the gain is kept only while it is as good as a new one.
#include <doctest/doctest.h>

#include "cordon/registry/registry.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"

using namespace cordon;

namespace {

std::vector<Matrix> run(Observer& observer, const std::vector<Sample>& samples) {
  std::vector<Matrix> sets;
  observer.start();
  for (const Sample& sample : samples) {
    const LineForm X = observer.step(sample).set->line_form();
    sets.insert(sets.end(), {X.M, X.G, X.c, X.S, X.A, X.b});
  }
  return sets;
}

bool same(const std::vector<Matrix>& left, const std::vector<Matrix>& right) {
  return std::equal(
      left.begin(), left.end(), right.begin(), right.end(), [](const Matrix& A, const Matrix& B) {
        return A.rows() == B.rows() && A.cols() == B.cols() && (A.array() == B.array()).all();
      });
}

}  // namespace

TEST_CASE("an observer that is started anew, after other data too, gives the sets of a new one") {
  Registry registry;
  registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const Study study = read_study(
      CORDON_SOURCE_DIR "/examples/studies/descriptor_four_representations.json", registry);
  std::vector<Sample> samples;
  for (const auto source = open_data(study); samples.size() < 100;)
    samples.push_back(source->next()->sample);
  std::vector<Sample> other(samples.begin(), samples.begin() + 90);
  for (Sample& sample : other) sample.y *= 1.001;
  for (const PipelineSpec& pipeline : study.pipelines) {
    CAPTURE(pipeline.name);
    const auto make = [&] {
      return registry.make<ObserverEntry>(
          pipeline.estimation()->observer.type,
          {study.model,
           registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params)},
          pipeline.estimation()->observer.params);
    };
    const auto observer = make(), fresh = make();
    run(*observer, other);
    CHECK(same(run(*observer, samples), run(*fresh, samples)));
  }
}

TEST_CASE("a gain is not kept while the smallest state still changes, whatever the units") {
  Model model;
  LinearModel& m = model.linear;
  m.E = m.C = m.Bw = m.Dv = Matrix::Identity(2, 2);
  m.A = Vector{{0, 3}}.asDiagonal();
  m.B = m.D = Matrix::Zero(2, 1);
  const auto box = [](double first, double second) {
    const Vector upper{{first, second}};
    return make_box({-upper, upper});
  };
  model.X0 = box(1e7, 1e-6);
  model.W = box(1e7, 1e-4);
  model.V = box(1e6, 1e-3);
  model.U = make_space(1);
  Registry registry;
  registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  for (const char* backend : {"interval", "zonotope"}) {
    CAPTURE(backend);
    const auto observer = registry.make<ObserverEntry>(
        "descriptor", {model, registry.make<BackendEntry>(backend, {})},
        Params().set("max_generators", Index{20}));
    observer->start();
    double widest = 0;
    for (Index k = 0; k < 200; ++k) {
      const Box hull = observer->step({k, Vector::Zero(1), Vector::Zero(2)}).set->interval_hull();
      widest = std::max(widest, hull.upper[1]);
    }
    CHECK(widest < .02);
  }
}
