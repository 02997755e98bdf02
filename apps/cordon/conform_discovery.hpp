// SPDX-License-Identifier: GPL-3.0-or-later
// What a plugin's file offers to be checked, found out in a child process.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cordon::apps {

/// A component of a plugin with its parameters, as JSON text ("{}" for the defaults).
struct Candidate {
  std::string kind, component, params = "{}";
};

/// Which components are meant: "" stands for all.
struct Wanted {
  std::string kind, component;
  std::string params = "{}";  ///< must fit each of them
};

/// What a plugin's file offers.
struct Discovery {
  std::string plugin, version;
  std::vector<Candidate>
      candidates;       ///< a backend that can round in several ways stands once for each
  std::string problem;  ///< refused, crashed or wrong parameters: why; then there are no candidates
  bool invalid = false;  ///< the problem is one of the command line
};
/// Loads the plugin in a child process.
Discovery discover(const std::filesystem::path& library, const Wanted& wanted);
/// Makes a backend in a child process: why no law can be checked on it; "" if nothing is wrong. Of
/// other kinds, which are made for a model, nothing is known in advance.
std::string problem_of_making(const std::filesystem::path& library, const Candidate& candidate);

}  // namespace cordon::apps
