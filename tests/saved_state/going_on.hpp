// SPDX-License-Identifier: GPL-3.0-or-later
// A component that goes on from what another one has written, beside that one.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"
#include "saved_state/damage.hpp"

namespace saved_state {

using namespace cordon;

constexpr const char* refused_step = "refused: ";

inline void write_set(Archive& bits, const Enclosure& set) {
  LineForm form = set->line_form();
  Box hull = set->interval_hull();
  Tightness tightness = set.tightness;
  bits(form, hull, tightness);
}

/// All that a step tells, with every bit; or how it was refused.
inline std::string bits_of(Observer& observer, const Sample& sample) {
  Archive bits(nullptr);
  try {
    Estimate told = observer.step(sample);
    std::vector<Index> left_out = observer.left_out();
    std::optional<Contradiction> contradiction = observer.contradiction();
    std::optional<Box> inner = observer.inner_estimate();
    bits(told.k, told.consistent, told.why, left_out, contradiction, inner);
    write_set(bits, told.set);
  } catch (const Error& error) {
    return refused_step + std::string(error.what());
  }
  return bits.bytes();
}

inline std::string bits_of(Diagnoser& diagnoser, const Sample& sample) {
  Archive bits(nullptr);
  try {
    Diagnosis told = diagnoser.step(sample);
    bits(told.k, told.decision, told.mode, told.since, told.reset, told.suggested, told.restarts);
    for (ModeEvidence& mode : told.modes)
      bits(mode.candidate, mode.consistent, mode.why, mode.residual, mode.reset_residual,
           mode.left_open);
    for (FaultBound& fault : told.faults)
      bits(fault.fault, fault.at, fault.lower, fault.upper, fault.estimate);
    if (told.estimate) write_set(bits, *told.estimate);
  } catch (const Error& error) {
    return refused_step + std::string(error.what());
  }
  return bits.bytes();
}

template <class Component>
struct Trial {
  std::shared_ptr<const SetBackend> backend;
  std::function<std::shared_ptr<Component>()> make;
  std::vector<Sample> samples;
  std::map<Index, std::function<void(Component&)>> after = {};  ///< what is done after a sample

  std::string step(Component& component, std::size_t at) const {
    std::string told = bits_of(component, samples[at]);
    const auto found = after.find(static_cast<Index>(at));
    if (found != after.end()) found->second(component);
    return told;
  }
  std::string saved(Component& component) const {
    Archive archive(backend);
    archive(component);
    return archive.bytes();
  }
  void restore(Component& component, const std::string& bytes) const {
    Archive archive(backend, bytes);
    archive(component);
    archive.expect_end();
  }
};

template <class Component>
struct Told {
  std::vector<std::string> steps;
  std::map<std::size_t, std::string> saved;  ///< after so many samples
};

/// Steps through all samples; saves after each of these numbers of samples.
template <class Component>
Told<Component> run(const Trial<Component>& trial, Component& component,
                    const std::vector<std::size_t>& times) {
  Told<Component> told;
  for (std::size_t at = 0; at <= trial.samples.size(); ++at) {
    if (std::find(times.begin(), times.end(), at) != times.end())
      told.saved[at] = trial.saved(component);
    if (at < trial.samples.size()) told.steps.push_back(trial.step(component, at));
  }
  return told;
}

/// From each of the saved states a new component, and one that has been somewhere else, go on with
/// the same bits; saving changes nothing.
template <class Component>
Told<Component> check_going_on(const Trial<Component>& trial,
                               const std::vector<std::size_t>& times) {
  const auto undisturbed = trial.make(), saving = trial.make(), used = trial.make();
  const auto reference = run(trial, *undisturbed, {}).steps;
  Told<Component> told = run(trial, *saving, times);
  CHECK(told.steps == reference);
  CHECK(std::ranges::count_if(reference, [](const std::string& step) {
          return step.starts_with(refused_step);
        }) <= static_cast<std::ptrdiff_t>(reference.size()) / 10);
  run(trial, *used, {});
  for (const auto& [time, bytes] : told.saved) {
    CAPTURE(time);
    for (const auto& component : {trial.make(), used}) {
      trial.restore(*component, bytes);
      CHECK(trial.saved(*component) == bytes);
      std::size_t same = 0;
      for (std::size_t at = time; at < trial.samples.size(); ++at)
        same += trial.step(*component, at) == reference[at] ? 1 : 0;
      CHECK(same == trial.samples.size() - time);
    }
  }
  return told;
}

/// Damaged states are refused as what they are, or taken, and steps from them end somehow.
template <class Component>
int check_damage(const Trial<Component>& trial, const std::string& bytes, std::size_t time,
                 int trials, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  int refused = 0;
  const auto component = trial.make();
  for (int i = 0; i < trials; ++i) {
    const std::string damaged = damage(bytes, random);
    try {
      trial.restore(*component, damaged);
    } catch (const Error& error) {
      CAPTURE(error.what());
      CHECK(error.code() == Errc::invalid);
      ++refused;
      continue;
    }
    for (std::size_t at = time; at < std::min(time + 3, trial.samples.size()); ++at)
      bits_of(*component, trial.samples[at]);
  }
  return refused;
}

}  // namespace saved_state
