// SPDX-License-Identifier: GPL-3.0-or-later
// The trajectories of one mode that explain samples, in boxes and in linear rows.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "study/verification/mode_enclosure.hpp"
#include "study/verification/trajectory_program.hpp"

namespace cordon::verification {

/// x_s ∈ start, x_{j+1} by the mode's equations with w_j ∈ W, x_j ∈ X_A, outputs with v_j ∈ V, for
/// all samples from the first one taken. Boxes hold x_j by what came before; that nothing is left
/// is proven by them, or by linear rows over the last samples: one of them, two, four, … Where rows
/// of formulas prove nothing, they bound the last states, and are made anew over smaller boxes.
class ModeTrajectories {
 public:
  ModeTrajectories(const Model& model, LineForm start, std::optional<LineForm> admissible);

  /// Takes the sample of the next time.
  void step(const Sample& now);
  /// Of the last sample.
  const Box& hull() const { return stages_.back().x; }

  using Deadline = std::optional<std::chrono::steady_clock::time_point>;
  /// No trajectory explains all samples: proven, with every number taken as it is. False: not
  /// proven.
  bool proves_none(const Deadline& deadline = {});
  /// Is the last x_i of all of them at most, or with `sign` -1 at least, the bound?
  bool proves_bound(Index i, double sign, double bound, const Deadline& deadline = {});
  /// All that were taken; none where too many were.
  std::vector<Sample> samples() const;
  /// Is a linear model used where it is not shown to hold? "" if it is not.
  const std::string& left_region() const { return left_region_; }

 private:
  struct Stage {
    Sample sample;
    Box x;
    EnclosedRows outputs;
    std::optional<EnclosedRows> successors;  ///< to the next stage; none: it may be anywhere
  };

  using Clock = std::chrono::steady_clock;
  static double seconds_to(Clock::time_point limit);

  /// Of all stages from `first` on, with the columns of the last state and of all of them; nothing:
  /// it is too large.
  struct Window {
    TrajectoryProgram program;
    Index last;
    std::vector<Index> states;
  };
  std::optional<Window> window(std::size_t first) const;
  /// Asks windows of 1, 2, 4, … stages, until one proves it, and again over smaller boxes.
  bool proves(const std::function<bool(const Window&, double seconds)>& by,
              const Deadline& deadline);
  bool proves_by_windows(const std::function<bool(const Window&, double seconds)>& by,
                         Clock::time_point limit) const;
  /// Bounds the states of the last stages by their rows, and encloses formulas over these bounds;
  /// false: they have hardly become narrower, or nothing is left.
  bool narrow(Clock::time_point limit);
  void watch_region(const Box& x, const Sample& now);

  const Model& model_;
  LineForm start_;
  std::optional<LineForm> admissible_;
  Box space_, start_hull_, admissible_hull_;
  ModeEnclosure enclosure_;
  std::deque<Stage> stages_;  ///< the last ones
  bool is_whole_ = true;      ///< all of them
  bool none_left_ = false;    ///< which is proven
  std::string left_region_;
};

}  // namespace cordon::verification
