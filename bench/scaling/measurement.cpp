// SPDX-License-Identifier: GPL-3.0-or-later
#include "measurement.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include "live_heap.hpp"
#include "random_system.hpp"

namespace cordon::bench {

namespace {

constexpr std::uint64_t system_seed = 1, data_seed = 2;
constexpr double seconds_per_case = .15;
constexpr std::size_t fewest_steps = 5, most_steps = 400, counted_steps = 3;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Repeats `work` until the time of a case is over.
template <class Work>
void repeat(std::size_t fewest, std::size_t most, Work work) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < most && (i < fewest || seconds_since(begin) < seconds_per_case); ++i)
    work();
}

class Pipeline {
 public:
  Pipeline(const Registry& registry, const std::string& backend, Size budget)
      : model_(random_system(budget.n, system_seed)),
        simulation_(model_.linear, data_seed),
        backend_(registry.make<BackendEntry>(backend, {})),
        observer_(registry.make<ObserverEntry>("prediction_correction", {model_, backend_},
                                               params(budget))) {
    observer_->start();
  }

  const Set& set() const { return *estimate_.set; }
  const PhaseTimes& times() const { return observer_->times(); }

  void step() {
    take(simulation_.next());
    check();
  }

  /// A step whose memory is counted: its peak.
  long counted_step() {
    const Sample sample = simulation_.next();
    long peak = 0;
    {
      const LiveHeap heap;
      take(sample);
      peak = heap.peak();
    }
    check();
    return peak;
  }

  /// Steps until neither generators nor constraints grow any more.
  void settle() {
    constexpr int still = 3;
    Complexity most;
    for (int unchanged = 0; unchanged < still; ++unchanged) {
      step();
      const Complexity now = set().complexity();
      if (now.generators > most.generators || now.constraints > most.constraints) unchanged = -1;
      most = {std::max(most.generators, now.generators), now.lines,
              std::max(most.constraints, now.constraints)};
    }
  }

  void check_truth() const {
    if (set().contains(simulation_.state()) == Answer::no)
      throw Error(Errc::internal, "the true state is proven outside");
  }

  /// Ends the observer: the bytes it gives back.
  long end() {
    estimate_ = {};
    const LiveHeap heap;
    observer_.reset();
    return -heap.growth();
  }

 private:
  static Params params(Size budget) {
    Params params;
    return params.set("max_generators", std::int64_t{budget.g})
        .set("max_constraints", std::int64_t{budget.m});
  }

  void take(const Sample& sample) { estimate_ = observer_->step(sample); }
  void check() const {
    if (estimate_.consistent == Answer::no)
      throw Error(Errc::internal, "the estimate is proven empty");
  }

  Model model_;
  Simulation simulation_;
  std::shared_ptr<const SetBackend> backend_;
  std::shared_ptr<Observer> observer_;
  Estimate estimate_;
};

double hull_time(Pipeline& pipeline) {
  std::vector<double> times;
  repeat(1, fewest_steps, [&] {
    pipeline.step();
    const auto begin = std::chrono::steady_clock::now();
    const bool is_empty = pipeline.set().interval_hull().is_empty();
    times.push_back(1e6 * seconds_since(begin));
    if (is_empty) throw Error(Errc::internal, "the hull of an estimate is empty");
  });
  return median(times);
}

}  // namespace

Measurement measure(const Registry& registry, const std::string& backend, Size budget,
                    bool with_hull) {
  Pipeline pipeline(registry, backend, budget);
  pipeline.settle();
  std::vector<long> peaks;  // of the same steps in each run
  while (peaks.size() < counted_steps) peaks.push_back(pipeline.counted_step());
  std::vector<double> steps, questions;
  repeat(fewest_steps, most_steps, [&] {
    pipeline.step();
    steps.push_back(pipeline.times().step());
    questions.push_back(pipeline.times().question);
  });
  Measurement result{
      backend, budget,        {}, static_cast<long>(steps.size()), median(steps), median(questions),
      {},      median(peaks), 0};
  result.used = pipeline.set().complexity();
  pipeline.check_truth();
  if (with_hull) result.hull = hull_time(pipeline);
  result.kept_bytes = pipeline.end();
  return result;
}

}  // namespace cordon::bench
