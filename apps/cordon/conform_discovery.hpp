// SPDX-License-Identifier: GPL-3.0-or-later
// What a plugin's file offers to be checked, found out in a child process.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace cordon::apps
