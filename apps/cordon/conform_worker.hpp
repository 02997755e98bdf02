// SPDX-License-Identifier: GPL-3.0-or-later
// Runs laws, in a child process unless it is told otherwise: a backend may crash or hang.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cordon/conformance/conformance.hpp"

namespace cordon::apps {

/// A backend of a plugin with its parameters, as JSON text ("{}" for the defaults).
struct Candidate {
  std::string backend, params = "{}";
};

/// What a plugin's file offers.
struct Discovery {
  std::string plugin, version;
  std::vector<Candidate>
      candidates;       ///< a backend that can round in several ways stands once for each
  std::string problem;  ///< refused, crashed or wrong parameters: why; then there are no candidates
  bool invalid = false;  ///< the problem is one of the command line
};
/// Loads the plugin in a child process. `backend` "" stands for all; `params` must fit each of
/// them.
Discovery discover(const std::filesystem::path& library, const std::string& backend,
                   const std::string& params);
/// Makes the backend in a child process: why no law can be checked on it; "" if nothing is wrong.
std::string problem_of_making(const std::filesystem::path& library, const Candidate& candidate);

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
  double timeout_s = 20;  ///< of one case
  std::string command;    ///< of the replay line
};
using LawProgress = std::function<void(std::size_t law, std::size_t laws)>;
/// Checks the laws one by one; after a crash or a hang the next law runs in a new process.
std::vector<LawReport> check_in_child(const ConformRequest& request, const LawProgress& progress);
/// The same in this process, for debuggers: a crash ends it, a hang hangs it.
std::vector<LawReport> check_in_process(const ConformRequest& request, const LawProgress& progress);

}  // namespace cordon::apps
