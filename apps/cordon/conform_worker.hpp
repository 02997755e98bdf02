// SPDX-License-Identifier: GPL-3.0-or-later
// Runs laws, in a child process unless it is told otherwise: a component may crash or hang.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "conform_discovery.hpp"
#include "cordon/conformance/conformance.hpp"
#include "cordon/registry/registry.hpp"

namespace cordon::apps {

/// What became of a law.
struct LawReport {
  enum class State { passed, failed, skipped, crashed, timed_out };
  State state = State::passed;
  conformance::Result result;
  double seconds = 0;
};
std::string_view to_string(LawReport::State state) noexcept;

struct ConformRequest {
  std::filesystem::path library;
  Candidate candidate;
  conformance::Options options;
  double timeout_s = 20;   ///< of one case
  std::string command;     ///< of the replay line
  SearchPath others = {};  ///< where what components work with is found
};
using LawProgress = std::function<void(std::size_t law, std::size_t laws)>;
/// Checks the laws one by one; after a crash or a hang the next law runs in a new process.
std::vector<LawReport> check_in_child(const ConformRequest& request, const LawProgress& progress);
/// The same in this process, for debuggers: a crash ends it, a hang hangs it.
std::vector<LawReport> check_in_process(const ConformRequest& request, const LawProgress& progress);

}  // namespace cordon::apps
