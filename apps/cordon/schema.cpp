// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "cordon/study/study.hpp"

namespace cordon::apps {

namespace {

Exit schema(const Program& program) {
  Registry registry;
  load_plugins(registry, program.plugins);
  warn_refused(registry);
  print(study_json_schema(registry));
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(schema) {
  CLI::App* command = app.add_subcommand(
      "schema", "Print the JSON Schema of study files, with the components found, for editors");
  command->callback([&program] { program.exit = schema(program); });
}

}  // namespace cordon::apps
