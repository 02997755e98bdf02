// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact_trajectories.hpp"

#include "feasible_sequence.hpp"

namespace cordon::verification {

namespace {

constexpr double a_millionth = 1e-6;
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
      : model(scaled(whole, share)),
        assumed{.initial_set = scaled(start, share), .admissible_set = scaled(admissible, share)},
        sets(model, assumed) {}

  std::optional<Box> at(const std::vector<Sample>& samples, const Deadline& deadline) {
    const Clock::time_point limit = Clock::now() + most_time;
    while (taken < samples.size() && !is_empty) {
      if (Clock::now() > std::min(limit, deadline.value_or(limit))) return std::nullopt;
      const std::optional<Polytope> F = sets.at(taken, samples[taken]);
      if (!F) return std::nullopt;
      ++taken;
      is_empty = F->is_empty();
      hull = F->interval_hull();
    }
    return hull;
  }

  Model model;
  RecordedEstimation assumed;
  FeasibleSequence sets;
  std::size_t taken = 0;
  bool is_empty = false;
  std::optional<Box> hull;
};

ExactTrajectories::ExactTrajectories(const Model& model, const LineForm& start,
                                     const std::optional<LineForm>& admissible) {
  const LinearModel& m = model.linear;
  if (!model.is_linear() || m.is_uncertain() || m.has_ranges()) return;
  whole_ = std::make_unique<Sequence>(model, start, admissible, 1);
  smaller_ = std::make_unique<Sequence>(model, start, admissible, 1 - a_millionth);
}

ExactTrajectories::~ExactTrajectories() = default;
ExactTrajectories::ExactTrajectories(ExactTrajectories&&) noexcept = default;

std::optional<Box> ExactTrajectories::hull(Sequence* of, const std::vector<Sample>& samples,
                                           const Deadline& deadline) {
  return of && !samples.empty() ? of->at(samples, deadline) : std::nullopt;
}

}  // namespace cordon::verification
