// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon run` with a study that has a sweep.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common.hpp"
#include "cordon/experiments/sweep.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// What the options of `cordon run` say about sweeps, and about everything.
struct RunArguments {
  std::filesystem::path study, out;
  bool json = false, quiet = false, no_report = false;
  std::optional<int> jobs;
  bool resume = false, restart = false;
  std::optional<double> point_limit_s;
  std::string shard;
  std::optional<std::int64_t> point;
  std::string sets;  ///< "all", "last" or "none"; empty: not said
  std::vector<std::string> settings;
};

/// "I/N". Throws Errc::invalid.
Shard shard_of(const std::string& text);

/// Throws Errc::invalid for options that say nothing about this study.
void check_options(const RunArguments& arguments, const Study& study);

/// Runs all points and tells what came out.
Exit run_all_points(const Study& study, const Registry& registry, const RunArguments& arguments,
                    const std::filesystem::path& out, const std::atomic<bool>* stop);

/// After a sweep or a merger: a violated guarantee, or the first error if every point failed.
Exit exit_of(const SweepOutcome& outcome);

}  // namespace cordon::apps
