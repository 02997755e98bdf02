// SPDX-License-Identifier: GPL-3.0-or-later
// The operations of a step of the main study on values of `sets`, without abstract sets, plugins
// and observers; `interface` is what these add to it, as a share. Both are measured in turns, so
// that other load on the machine falls on both.
#include <algorithm>
#include <chrono>
#include <vector>

#include <benchmark/benchmark.h>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/line_zonotope.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"

namespace {

using namespace cordon;

/// The descriptor observer where E = diag(1, 1, 0): z = x, the third row is static.
class DirectObserver {
 public:
  DirectObserver(const Model& model, LineForm start, LineForm free)
      : m_(model), X_(std::move(start)), free_(std::move(free)) {
    dynamic_A_.topRows(2) = m_.linear.A.topRows(2);
    dynamic_Bw_.topRows(2) = m_.linear.Bw.topRows(2);
    static_A_ = m_.linear.A.bottomRows(1);
    static_Bw_ = m_.linear.Bw.bottomRows(1);
  }

  void start(const Sample& first) { X_ = sets::reduce(measured(X_, first), 30, 5).set; }

  void step(const Sample& before, const Sample& now) {
    const sets::Summand summands[] = {{dynamic_Bw_, m_.W}, {free_part_, free_}};
    Vector f = linalg::product(m_.linear.B, before.u);
    f[2] = 0;
    const LineForm open = sets::affine_sum(X_, dynamic_A_, f, summands).set;
    const Vector right = -linalg::product(m_.linear.B.bottomRows(1), now.u);
    const LineForm predicted =
        sets::strip_intersection(open, static_A_, right, static_Bw_, m_.W).set;
    X_ = sets::reduce(measured(predicted, now), 30, 5).set;
  }

  const LineForm& set() const { return X_; }

 private:
  LineForm measured(const LineForm& X, const Sample& now) const {
    return sets::strip_intersection(X, m_.linear.C, now.y, m_.linear.Dv, m_.V).set;
  }

  const Model& m_;
  LineForm X_, free_;
  Matrix dynamic_A_ = Matrix::Zero(3, 3), dynamic_Bw_ = Matrix::Zero(3, 3), static_A_, static_Bw_;
  Matrix free_part_ = Matrix::Identity(3, 3).rightCols(1);
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

double microseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
      .count();
}

bool are_same(const LineForm& X, const LineForm& Y) {
  return X.G == Y.G && X.c == Y.c && X.A == Y.A && X.b == Y.b;
}

/// Steps k = 2 … 20 of the pipeline by an observer, and the same directly.
void direct_steps(benchmark::State& state, const char* name, const LineForm& start,
                  const LineForm& free) {
  Registry registry;
  registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const Study study = read_study(
      CORDON_SOURCE_DIR "/examples/studies/descriptor_four_representations.json", registry);
  const auto pipeline = std::find_if(study.pipelines.begin(), study.pipelines.end(),
                                     [&](const auto& p) { return p.name == name; });
  const auto backend =
      registry.make<BackendEntry>(pipeline->backend.type, pipeline->backend.params);
  const auto observer =
      registry.make<ObserverEntry>(pipeline->estimation()->observer.type, {study.model, backend},
                                   pipeline->estimation()->observer.params);
  std::vector<Sample> samples;
  for (const auto source = open_data(study); samples.size() <= 20;)
    samples.push_back(source->next()->sample);

  std::vector<double> by_observer, directly;
  for (auto _ : state) {
    observer->start();
    Estimate estimate = observer->step(samples[0]);
    DirectObserver direct(study.model, start, free);
    direct.start(samples[0]);
    double observer_time = 0, direct_time = 0;
    for (std::size_t k = 1; k < samples.size(); ++k) {
      estimate = observer->step(samples[k]);
      const auto begin = std::chrono::steady_clock::now();
      direct.step(samples[k - 1], samples[k]);
      if (k == 1) continue;  // not yet of full size
      direct_time += microseconds_since(begin);
      observer_time += observer->times().step();
    }
    if (!are_same(direct.set(), estimate.set->line_form()))
      state.SkipWithError("the sets differ from those of the observer");
    const double steps = static_cast<double>(samples.size() - 2);
    by_observer.push_back(observer_time / steps);
    directly.push_back(direct_time / steps);
    state.SetIterationTime(direct_time / steps * 1e-6);
  }
  state.counters["interface"] = median(by_observer) / median(directly) - 1;
}

const LineForm bounded = make_box({Vector::Constant(1, -50), Vector::Constant(1, 50)});

BENCHMARK_CAPTURE(direct_steps, LZ, "LZ", make_space(3), make_space(1))
    ->UseManualTime()
    ->Repetitions(7)
    ->Unit(benchmark::kMicrosecond)
    ->MinTime(.01);
BENCHMARK_CAPTURE(direct_steps, CZ, "CZ",
                  make_zonotope(Vector{{.5, .5, .25}}, Matrix(Vector{{.1, 1.5, .6}}.asDiagonal())),
                  bounded)
    ->UseManualTime()
    ->Repetitions(7)
    ->Unit(benchmark::kMicrosecond)
    ->MinTime(.01);

}  // namespace
