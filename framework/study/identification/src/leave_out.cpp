// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>

#include "cordon/study/identify.hpp"
#include "study/identification/fewest_left_out.hpp"

namespace cordon {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_candidates = 16;  ///< of the samples that require a factor
constexpr Index most_programs = 200;         ///< for the proof that no fewer samples do

class Leaver {
 public:
  Leaver(const Model& model, std::span<const Sample> samples, const IdentifyOptions& options,
         const std::function<bool()>& stop)
      : model_(model), samples_(samples.begin(), samples.end()), options_(options), stop_(stop) {}

  BoundFactors factors() const { return identify_bounds(model_, samples_, options_); }
  bool is_stopped() const { return stop_ && stop_(); }
  Sample without_outputs(Index k) {
    Sample& sample = samples_[as_size(k - samples_.front().k)];
    Sample before = sample;
    sample = missing_outputs(sample, present_outputs(sample));
    return before;
  }
  void put_back(Sample sample) {
    const Index place = sample.k - samples_.front().k;
    samples_[as_size(place)] = std::move(sample);
  }

 private:
  const Model& model_;
  std::vector<Sample> samples_;
  IdentifyOptions options_;
  const std::function<bool()>& stop_;
};

/// Those with the largest multipliers.
std::vector<Index> candidates_of(const BoundFactors& factors) {
  std::vector<std::size_t> order(factors.required_by.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return factors.weights[a] > factors.weights[b]; });
  order.resize(std::min(order.size(), most_candidates));
  std::vector<Index> some;
  for (const std::size_t place : order) some.push_back(factors.required_by[place]);
  return some;
}

/// The sample without which the factor is smallest, and the factors then.
std::optional<LeftOutSamples::Step> best_of(Leaver& leaver, const std::vector<Index>& candidates) {
  std::optional<LeftOutSamples::Step> best;
  for (const Index k : candidates) {
    if (leaver.is_stopped()) return std::nullopt;
    Sample kept = leaver.without_outputs(k);
    BoundFactors factors = leaver.factors();
    leaver.put_back(std::move(kept));
    if (factors.status != BoundFactors::Status::found) continue;
    if (!best || factors.cost < best->factors.cost) best = {k, std::move(factors)};
  }
  return best;
}

/// Fewer samples than those of the result, or the proof that there are none.
void make_fewest(LeftOutSamples& result, const Model& model, std::span<const Sample> samples,
                 double wanted, const IdentifyOptions& options, const std::function<bool()>& stop) {
  const auto factors = [&](const std::set<Index>& left_out) {
    Leaver leaver(model, samples, options, stop);
    for (const Index k : left_out) leaver.without_outputs(k);
    return leaver.factors();
  };
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  const auto is_over = [&] { return (stop && stop()) || Clock::now() >= end; };
  const identification::FewestLeftOut fewest = identification::fewest_left_out(
      factors, wanted, std::ssize(result.steps), result.at_least, most_programs, is_over);
  result.at_least = fewest.at_least;
  if (!fewest.samples) return;
  result.steps.clear();
  std::set<Index> left_out;
  for (const Index k : *fewest.samples) {
    left_out.insert(k);
    result.steps.push_back({k, factors(left_out)});
  }
}

}  // namespace

LeftOutSamples leave_out(const Model& model, std::span<const Sample> samples, double wanted,
                         Index most, const IdentifyOptions& options,
                         const std::function<bool()>& stop) {
  LeftOutSamples result;
  if (samples.empty()) return result;
  Leaver leaver(model, samples, options, stop);
  BoundFactors factors = leaver.factors();
  while (factors.cost > wanted && std::ssize(result.steps) < most) {
    const auto best = best_of(leaver, candidates_of(factors));
    if (!best) return result;
    leaver.without_outputs(best->k);
    factors = best->factors;
    result.steps.push_back(*best);
  }
  result.is_enough = factors.status == BoundFactors::Status::found && factors.cost <= wanted;
  // Of each sample with all that are not left out: what they require without it is less than
  // wanted.
  Leaver others(model, samples, options, stop);
  for (const auto& [k, unused] : result.steps) others.without_outputs(k);
  for (const auto& [k, unused] : result.steps) {
    if (stop && stop()) break;
    others.put_back(samples[as_size(k - samples.front().k)]);
    const BoundFactors more = others.factors();
    const bool is_proven = more.proven > wanted;
    result.at_least += is_proven ? 1 : 0;
    for (const Index used : is_proven ? more.required_by : std::vector<Index>{k})
      others.without_outputs(used);
  }
  if (result.is_enough && result.at_least < std::ssize(result.steps))
    make_fewest(result, model, samples, wanted, options, stop);
  return result;
}

}  // namespace cordon
