// SPDX-License-Identifier: GPL-3.0-or-later
#include <csignal>
#include <fcntl.h>
#include <iostream>
#include <memory>
#include <sstream>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "cordon/registry/build.hpp"

namespace cordon::apps {

#undef CORDON_COMMAND
#define CORDON_COMMAND(name) void add_##name(CLI::App& app, Program& program);
#include "generated/CORDON_COMMAND.inc"

}  // namespace cordon::apps

namespace {

using namespace cordon::apps;

/// `did you mean "list"?` for a word that is no command; "" if there is none.
std::string unknown_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (words.empty() || !app.get_subcommands().empty()) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return "no command \"" + words.front() + "\"; " + cordon::suggest(words.front(), names);
}

/// Options that are none, each with a suggestion; "" if there is none among what was left over.
std::string unknown_options(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  std::vector<std::string> known;
  for (const CLI::App* one = command; one; one = one->get_parent()) {
    for (const CLI::Option* option : one->get_options({})) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  }
  std::string text;
  for (const std::string& word : app.remaining(true)) {
    if (word.size() < 2 || word.front() != '-') continue;
    const std::string option = word.substr(0, word.find('='));
    text += (text.empty() ? "" : "\n") + command->get_display_name() + " has no option \"" +
            option + "\"; " + cordon::suggest(option, known);
  }
  return text;
}

/// Those that were closed stay unusable: no file that is opened later gets their numbers.
void keep_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    // the lowest number that is free: reads and writes fail as before
    [[maybe_unused]] const int placed =
        ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// The help of all, or of one command.
void add_help(CLI::App& app, Program& program) {
  CLI::App* const command = app.add_subcommand("help", "Show what a command does and takes");
  const auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("COMMAND", *words, "The command; all commands without one");
  command->callback([&app, &program, words] {
    const CLI::App* about = &app;
    std::string called = app.get_name();
    for (const std::string& word : *words) {
      std::vector<std::string> names;
      const CLI::App* found = nullptr;
      for (const CLI::App* one : about->get_subcommands({})) {
        names.push_back(one->get_name());
        if (one->get_name() == word) found = one;
      }
      if (!found) {
        complain("no command \"" + word + "\"; " + cordon::suggest(word, names));
        program.exit = Exit::invalid;
        return;
      }
      about = found;
      called += " " + word;
    }
    print(app.get_formatter()->make_help(about, called, CLI::AppFormatMode::Normal));
    program.exit = Exit::done;
  });
}

/// What CLI11 has to say (help, version, usage errors); its own code is replaced by ours.
Exit answer(const CLI::App& app, const CLI::ParseError& outcome) {
  std::ostringstream out, err;
  const bool failed = app.exit(outcome, out, err) != 0;
  print(out.str());
  if (!failed) return Exit::done;
  std::string unknown = unknown_command(app);
  if (unknown.empty()) unknown = unknown_options(app);
  if (unknown.empty() && app.get_subcommands().empty() && app.remaining().empty() &&
      outcome.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    unknown = "no command is given; \"cordon help\" lists them";
  complain(unknown.empty() ? err.str().substr(0, err.str().find_last_not_of('\n') + 1) : unknown);
  return Exit::invalid;
}

Exit run(int argc, char** argv) {
  Program program;
  CLI::App app(
      "Cordon: guaranteed set-based state estimation with interchangeable set representations",
      "cordon");
  app.footer(exit_codes_help);
  app.fallthrough();
  app.require_subcommand(1);
  app.set_version_flag("--version", "cordon " + cordon::build_info().version);
  app.add_option("--plugins", program.plugins,
                 "Directory with plugins, searched before all others (may be repeated)")
      ->check(CLI::ExistingDirectory)
      ->option_text("DIR")
      ->allow_extra_args(false);
  app.add_flag("--trust-plugins", program.trust_plugins,
               "Load plugins from the directories that a study names: programs, which can do all "
               "that you can");
#undef CORDON_COMMAND
#define CORDON_COMMAND(name) add_##name(app, program);
#include "generated/CORDON_COMMAND.inc"
  add_help(app, program);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& outcome) {
    return answer(app, outcome);
  }
  return program.exit;
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  std::signal(
      SIGPIPE,
      SIG_IGN);  // a reader that leaves is an error code of write, not the end of the process
  Exit exit = Exit::internal;
  try {
    exit = run(argc, argv);
  } catch (...) {
    exit = report_current_exception();
  }
  return static_cast<int>(exit);
}
