// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/mode_trajectories.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/interval.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "study/verification/trajectory_program.hpp"

namespace cordon::verification {

namespace {

constexpr std::size_t most_entries = 300'000;  ///< of a program
constexpr double most_seconds = 10;            ///< for all windows of a question
constexpr std::size_t most_stages = 2000;      ///< that are kept
constexpr std::size_t most_narrowed = 32;      ///< of them at once
constexpr int most_narrowings = 8;             ///< for a question
constexpr double worth_narrowing = 0.999;      ///< a width that it is worth to go on for

Box common_part(const Box& a, const Box& b) {
  return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)};
}

bool has_points(const Box& box) { return (box.lower.array() <= box.upper.array()).all(); }

bool holds(const Box& outer, const Box& inner) {
  return (inner.lower.array() >= outer.lower.array()).all() &&
         (inner.upper.array() <= outer.upper.array()).all();
}

/// Of boxes their own sides: of what ends at 0, a root is defined up to there.
Box hull_of(const LineForm& set) {
  Box hull = outward::interval_hull(set);
  if (set.lines() > 0 || set.constraints() > 0 || !has_points(hull)) return hull;
  for (Index i = 0; i < set.dim(); ++i) {
    double radius = 0;
    for (Index j = 0; j < set.generators(); ++j)
      radius = directed::plus(radius, std::abs(set.G(i, j))).upper;
    hull.lower[i] = std::max(hull.lower[i], directed::plus(set.c[i], -radius).lower);
    hull.upper[i] = std::min(hull.upper[i], directed::plus(set.c[i], radius).upper);
  }
  return hull;
}

std::vector<Interval> opposite(const std::vector<Interval>& values) {
  std::vector<Interval> all;
  for (const Interval value : values) all.push_back(-value);
  return all;
}

}  // namespace

ModeTrajectories::ModeTrajectories(const Model& model, LineForm start,
                                   std::optional<LineForm> admissible)
    : model_(model),
      start_(std::move(start)),
      admissible_(std::move(admissible)),
      space_(Box::space(start_.dim())),
      start_hull_(hull_of(start_)),
      admissible_hull_(admissible_ ? hull_of(*admissible_) : space_),
      enclosure_(model) {}

/// The linear model is one of the formulas only as long as the state keeps to its region.
void ModeTrajectories::watch_region(const Box& x, const Sample& now) {
  if (!model_.region || !left_region_.empty()) return;
  const bool inside =
      holds(model_.region->states, x) && holds(model_.region->inputs, Box{now.u, now.u});
  if (!inside)
    left_region_ = fmt::format("that the linear model holds is not shown again at k = {}", now.k);
}

void ModeTrajectories::step(const Sample& now) {
  if (none_left_) return;
  Box x = start_hull_;
  if (!stages_.empty()) {
    Stage& before = stages_.back();
    watch_region(before.x, before.sample);
    before.successors = enclosure_.successors(before.x, before.sample);
    x = before.successors ? enclosure_.reached(*before.successors, before.x) : space_;
  }
  x = common_part(x, admissible_hull_);
  if (model_.region && model_.region->nonlinear_outputs) watch_region(x, now);
  none_left_ = !has_points(x) || !enclosure_.contract(x, now);
  if (none_left_) return;
  EnclosedRows outputs = enclosure_.outputs(x, now);
  stages_.push_back({now, std::move(x), std::move(outputs), {}});
  if (stages_.size() <= most_stages) return;
  stages_.pop_front();
  is_whole_ = false;
}

std::vector<Sample> ModeTrajectories::samples() const {
  std::vector<Sample> all;
  for (const Stage& stage : stages_) all.push_back(stage.sample);
  return is_whole_ && !none_left_ ? all : std::vector<Sample>{};
}

std::optional<ModeTrajectories::Window> ModeTrajectories::window(std::size_t first) const {
  Window made{{}, 0, {}};
  TrajectoryProgram& program = made.program;
  const Index n = start_.dim();
  for (std::size_t j = first; j < stages_.size(); ++j) {
    const Stage& stage = stages_[j];
    // exact rows say what bounds behind the first ones do, and proofs leave free states out
    const bool by_rows = j > first && model_.is_linear() && !model_.linear.is_descriptor();
    const Index before = made.last, x = made.last = program.columns(by_rows ? space_ : stage.x);
    made.states.push_back(x);
    TrajectoryProgram::States states{x, -1, Matrix(), -1, stage.outputs.slopes.leftCols(n)};
    if (j > first && stages_[j - 1].successors) {
      const EnclosedRows& rows = *stages_[j - 1].successors;
      const Index w = program.columns(enclosure_.disturbances());
      program.element(model_.W, w);
      states.slopes = rows.slopes.leftCols(n);
      const Index at = program.rows(
          {{x, rows.left}, {before, -states.slopes}, {w, -rows.slopes.rightCols(rows.noises())}},
          rows.rest);
      if (rows.left.isIdentity(0)) states.row = at;
    }
    if (j == 0 && is_whole_) program.element(start_, x);
    if (admissible_) program.element(*admissible_, x);
    if (stage.outputs.slopes.rows() > 0) {
      const Index v = program.columns(enclosure_.noises());
      program.element(model_.V, v);
      states.outputs = program.rows(
          {{x, states.seen}, {v, stage.outputs.slopes.rightCols(stage.outputs.noises())}},
          opposite(stage.outputs.rest));
    }
    program.add(std::move(states));
    if (program.entries() > most_entries) return std::nullopt;
  }
  return made;
}

double ModeTrajectories::seconds_to(Clock::time_point limit) {
  return std::chrono::duration<double>(limit - Clock::now()).count();
}

bool ModeTrajectories::proves(const std::function<bool(const Window&, double)>& by,
                              const Deadline& deadline) {
  const Clock::time_point own = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(most_seconds)),
                          limit = std::min(own, deadline.value_or(own));
  for (int round = 0; !none_left_; ++round) {
    if (proves_by_windows(by, limit)) return true;
    if (round == most_narrowings || !narrow(limit)) return none_left_;
  }
  return true;
}

bool ModeTrajectories::proves_by_windows(const std::function<bool(const Window&, double)>& by,
                                         Clock::time_point limit) const {
  for (std::size_t taken = 1;; taken *= 2) {
    const std::size_t first = taken < stages_.size() ? stages_.size() - taken : 0;
    const double left = seconds_to(limit);
    if (left <= 0) return false;
    const auto rows = window(first);
    if (!rows) return false;
    if (by(*rows, left)) return true;
    if (first == 0) return false;
  }
}

/// What formulas leave out of their rows is less over smaller boxes.
bool ModeTrajectories::narrow(Clock::time_point limit) {
  if (model_.is_linear()) return false;
  const std::size_t first = stages_.size() - std::min(stages_.size(), most_narrowed);
  const auto rows = window(first);
  if (!rows) return false;
  bool is_worth_it = false;
  for (std::size_t j = first; j < stages_.size(); ++j) {
    Box& x = stages_[j].x;
    for (Index i = 0; i < x.dim(); ++i) {
      const double width = x.upper[i] - x.lower[i];
      if (width == 0) continue;
      if (seconds_to(limit) <= 0) return false;
      const Index column = rows->states[j - first] + i;
      const TrajectoryProgram& program = rows->program;
      x.upper[i] = std::min(x.upper[i], program.proven_bound(column, 1, seconds_to(limit)));
      x.lower[i] = std::max(x.lower[i], -program.proven_bound(column, -1, seconds_to(limit)));
      none_left_ = none_left_ || x.lower[i] > x.upper[i];
      if (none_left_) return false;
      is_worth_it = is_worth_it || x.upper[i] - x.lower[i] < worth_narrowing * width;
    }
  }
  for (std::size_t j = first; j < stages_.size(); ++j) {
    Stage& stage = stages_[j];
    stage.outputs = enclosure_.outputs(stage.x, stage.sample);
    if (j + 1 < stages_.size()) stage.successors = enclosure_.successors(stage.x, stage.sample);
  }
  return is_worth_it;
}

bool ModeTrajectories::proves_none(const Deadline& deadline) {
  const auto by = [](const Window& window, double seconds) {
    return window.program.proves_none(seconds);
  };
  none_left_ = none_left_ || (!stages_.empty() && proves(by, deadline));
  return none_left_;
}

bool ModeTrajectories::proves_bound(Index i, double sign, double bound, const Deadline& deadline) {
  if (none_left_) return true;
  if (stages_.empty()) return false;
  if ((sign > 0 ? hull().upper[i] : -hull().lower[i]) <= sign * bound) return true;
  const auto by = [&](const Window& window, double seconds) {
    return window.program.proven_bound(window.last + i, sign, seconds) <= sign * bound;
  };
  return proves(by, deadline);
}

}  // namespace cordon::verification
