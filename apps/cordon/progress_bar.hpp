// SPDX-License-Identifier: GPL-3.0-or-later
// One line on the terminal that tells how far a run is.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "cordon/experiments/sweep.hpp"

namespace cordon::apps {

/// Appears on stderr after one second, with the remaining time; nothing at all where stderr is no
/// terminal.
class ProgressBar {
 public:
  ProgressBar(std::vector<std::string> pipelines, bool visible);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `total` 0: not known.
  void show(std::size_t pipeline, std::int64_t done, std::int64_t total);
  /// A line of the caller's, where there is no total.
  void show(const std::string& line);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due();
  void draw(const std::string& line);

  std::vector<std::string> pipelines_;
  bool visible_, drawn_ = false;
  Clock::time_point begin_, drawn_at_;
};

/// "[#####     ]  50 %  name  10/20  3 s left"; without a total "name  10". Names are cut to 20
/// characters.
std::string progress_line(const std::string& name, double fraction, std::int64_t done,
                          std::int64_t total, double elapsed_s);

/// "[#####     ]  50 %  10/20 points  1 failed  3 s left", the time by the rate of this process.
std::string progress_line(const SweepProgress& progress);

}  // namespace cordon::apps
