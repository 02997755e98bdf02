// SPDX-License-Identifier: GPL-3.0-or-later
// Samples in, estimates or diagnoses out, one line each (docs/online.md).
#include <memory>
#include <string>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "cordon/experiments/report.hpp"
#include "cordon/study/run.hpp"
#include "interrupt.hpp"
#include "run_failures.hpp"
#include "stream_loop.hpp"

namespace cordon::apps {

namespace {

/// The results of a run over what was recorded, beside it.
Exit run_recorded(const std::filesystem::path& file, const Program& program, bool quiet) {
  Registry registry;
  registry.load({program.plugins});
  const Study study = read_study(file, registry, default_search_path(), program.study_plugins());
  RunOptions options;
  options.out = file.parent_path();
  options.report = cordon::add_report;
  const RunOutcome outcome = run_study(study, registry, options);
  if (!quiet) note("Results are in " + options.out.string());
  for (const std::string& complaint : complaints(study, outcome)) complain(complaint);
  if (!outcome.report_error.empty()) warn(no_report + outcome.report_error);
  return exit_of(outcome);
}

Exit run_stream(const Program& program, const StreamArguments& arguments) {
  const std::atomic<bool>* const stop = stop_on_signals();
  std::atomic<bool>* const acknowledge = acknowledge_on_signal();
  Registry registry;
  registry.load({program.plugins});
  const Study study = read_study(arguments.study, registry, default_search_path(),
                                 program.study_plugins(), StudyData::optional, arguments.settings);
  if (!arguments.quiet) {
    for (const std::string& warning : study.warnings) warn(warning);
  }
  StreamLoop loop(study, registry, arguments, stop, acknowledge);
  loop.run();
  if (!arguments.quiet) note(loop.summary());
  for (const std::string& complaint : loop.complaints()) complain(complaint);
  if (!loop.recorded().empty()) {
    const Exit exit = run_recorded(loop.recorded(), program, arguments.quiet);
    if (exit != Exit::done) return exit;
  }
  if (loop.differs()) return Exit::violated;
  return loop.complaints().empty() ? Exit::done : Exit::invalid;
}

/// Microseconds of "5ms", "200us" or "0.01s"; nothing: it is none.
std::optional<double> microseconds_of(const std::string& text) {
  std::size_t end = 0;
  double number = 0;
  try {
    number = std::stod(text, &end);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  const std::string unit = text.substr(end);
  const double scale = unit == "us" ? 1 : unit == "ms" ? 1e3 : unit == "s" ? 1e6 : 0;
  const double time = number * scale;
  return time > 0 && time <= 1e9 ? std::optional(time) : std::nullopt;
}

std::string deadline_problem(const std::string& text) {
  return microseconds_of(text) ? "" : "a time with its unit: 5ms, 200us or 0.01s";
}

std::string every_problem(const std::string& text) {
  const bool is_number = !text.empty() && text.size() < 10 &&
                         text.find_first_not_of("0123456789") == std::string::npos;
  return is_number && std::stol(text) > 0 ? "" : "a number of samples, 1 or more";
}

}  // namespace

CORDON_COMMAND(stream) {
  CLI::App* command = app.add_subcommand(
      "stream", "Take samples from standard input, one line each, and answer each with a line");
  command->footer(
      "SIGINT and SIGTERM end the stream after the sample at hand, as the end of its input does, "
      "with exit code 0. SIGUSR1 acknowledges all alarms.");
  const auto arguments = std::make_shared<StreamArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON); it needs no data")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--pipeline", arguments->pipeline,
                   "The pipeline that takes the samples [the only one]")
      ->option_text("NAME");
  command
      ->add_option("--set", arguments->settings,
                   "Put a value into the study, may be repeated: --set /online/jumps=fill")
      ->option_text("/PATH=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--sets", arguments->sets, "Answer with the sets and their proofs, too");
  command
      ->add_option("--checkpoint", arguments->checkpoint,
                   "Keep the state in this file, and go on from it if it is there")
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text("FILE");
  command->add_option("--every", arguments->every, "Lines with samples between checkpoints [100]")
      ->check(CLI::Validator(every_problem, "", ""))
      ->option_text("N")
      ->needs("--checkpoint");
  command
      ->add_option_function<std::string>(
          "--deadline",
          [arguments](const std::string& text) { arguments->deadline_us = *microseconds_of(text); },
          "What solvers have not decided so long after the sample has come stays open")
      ->check(CLI::Validator(deadline_problem, "", ""))
      ->option_text("TIME");
  command
      ->add_option("--log", arguments->log,
                   "Keep samples, requests and alarms in this file, for --replay")
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text("FILE");
  command
      ->add_option("--replay", arguments->replay,
                   "Take the samples from a log, and compare the alarms with those in it")
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text("LOG")
      ->excludes("--log")
      ->excludes("--checkpoint");
  command
      ->add_option("--record", arguments->record,
                   "Keep the samples in this directory, and at the end the results of a run over "
                   "them; not with --checkpoint")
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text("DIR")
      ->excludes("--checkpoint");
  command
      ->add_flag("--watch", arguments->watch,
                 "In place of the answers draw bounds, modes and alarms on the terminal, or write "
                 "lines for people")
      ->excludes("--sets");
  command->add_flag("--quiet", arguments->quiet, "Print no summary at the end");
  command->callback([&program, arguments] { program.exit = run_stream(program, *arguments); });
}

}  // namespace cordon::apps
