// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact_trajectories.hpp"

#include "cordon/core/error.hpp"
#include "study/verification/feasible_set.hpp"

namespace cordon::verification {

namespace {

constexpr Index most_states = 4;
constexpr double a_millionth = 1e-6;
constexpr std::size_t most_bits_of_all = std::size_t{1} << 25;
constexpr std::chrono::seconds most_time(10);  ///< for one answer

using Clock = std::chrono::steady_clock;

LineForm scaled(LineForm set, double share) {
  set.G *= share;
  set.A *= share;
  return set;
}

Model scaled(Model model, double share) {
  model.W = scaled(model.W, share);
  model.V = scaled(model.V, share);
  return model;
}

std::optional<LineForm> scaled(const std::optional<LineForm>& set, double share) {
  return set ? std::optional(scaled(*set, share)) : std::nullopt;
}

}  // namespace

/// F_k for all sets scaled by a share.
struct ExactTrajectories::Sequence {
  Sequence(const Model& whole, const LineForm& start, const std::optional<LineForm>& admissible,
           double share)
      : model(scaled(whole, share)), sets(model, scaled(start, share), scaled(admissible, share)) {}

  std::optional<Box> at(const std::vector<Sample>& samples, const Deadline& deadline) {
    const Clock::time_point limit = Clock::now() + most_time;
    while (taken < samples.size() && !is_empty) {
      if (Clock::now() > std::min(limit, deadline.value_or(limit)) || bits > most_bits_of_all)
        return std::nullopt;
      const Polytope F = sets.step(samples[taken++]);
      bits += F.bits();
      is_empty = F.is_empty();
      hull = F.interval_hull();
    }
    return hull;
  }

  Model model;
  FeasibleSets sets;
  std::size_t taken = 0, bits = 0;
  bool is_empty = false;
  std::optional<Box> hull;
};

ExactTrajectories::ExactTrajectories(const Model& model, const LineForm& start,
                                     const std::optional<LineForm>& admissible) {
  const LinearModel& m = model.linear;
  if (!model.is_linear() || m.is_uncertain() || m.has_ranges() || m.states() > most_states) return;
  try {
    whole_ = std::make_unique<Sequence>(model, start, admissible, 1);
    smaller_ = std::make_unique<Sequence>(model, start, admissible, 1 - a_millionth);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    whole_.reset();
  }
}

ExactTrajectories::~ExactTrajectories() = default;
ExactTrajectories::ExactTrajectories(ExactTrajectories&&) noexcept = default;

std::optional<Box> ExactTrajectories::hull(std::unique_ptr<Sequence>& of,
                                           const std::vector<Sample>& samples,
                                           const Deadline& deadline) {
  if (!of || samples.empty()) return std::nullopt;
  try {
    return of->at(samples, deadline);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    of.reset();
    return std::nullopt;
  }
}

}  // namespace cordon::verification
