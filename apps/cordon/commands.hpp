// SPDX-License-Identifier: GPL-3.0-or-later
// What the commands share. A command is a function in the file of its name,
//   CORDON_COMMAND(run) {
// in namespace cordon::apps, that adds its subcommand to `app`; the subcommand's callback leaves
// its exit code in `program.exit`. The build finds these lines (cmake/Collect.cmake), and main
// calls the functions.
#pragma once

#include <filesystem>
#include <vector>

#include "common.hpp"
#include "cordon/study/study.hpp"

#define CORDON_COMMAND(name) void add_##name(CLI::App& app, [[maybe_unused]] Program& program)

namespace CLI {
class App;
}

namespace cordon::apps {

/// What the commands share with main.
struct Program {
  std::vector<std::filesystem::path> plugins;  ///< --plugins, searched first
  bool trust_plugins = false;  ///< --trust-plugins: of directories that studies name
  /// For commands that need the whole study.
  StudyPlugins study_plugins() const {
    return trust_plugins ? StudyPlugins::load : StudyPlugins::refuse;
  }
  Exit exit = Exit::done;
};

/// The pipelines of this name, or all if it is empty. Throws InputError if there is none.
std::vector<const PipelineSpec*> pipelines_called(const Study& study, const std::string& name);

/// `cordon list`.
Exit list_components(const Program& program, bool json);

}  // namespace cordon::apps
