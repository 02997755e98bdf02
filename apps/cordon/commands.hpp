// SPDX-License-Identifier: GPL-3.0-or-later
// The commands: each adds its subcommand, whose callback leaves its exit code in `program.exit`.
#pragma once

#include <filesystem>
#include <vector>

#include "common.hpp"
#include "cordon/study/study.hpp"

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

void add_run(CLI::App& app, Program& program);
void add_merge(CLI::App& app, Program& program);
void add_report(CLI::App& app, Program& program);
void add_validate(CLI::App& app, Program& program);
void add_verify(CLI::App& app, Program& program);
void add_compare(CLI::App& app, Program& program);
void add_gain(CLI::App& app, Program& program);
void add_guarantees(CLI::App& app, Program& program);
void add_design(CLI::App& app, Program& program);
void add_list(CLI::App& app, Program& program);
void add_info(CLI::App& app, Program& program);
void add_schema(CLI::App& app, Program& program);
void add_new(CLI::App& app, Program& program);
void add_doctor(CLI::App& app, Program& program);
void add_conform(CLI::App& app, Program& program);
void add_convert(CLI::App& app, Program& program);

}  // namespace cordon::apps
