// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_sweep.hpp"

#include <charconv>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>

#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "sweep_report.hpp"

namespace cordon::apps {

namespace {

/// The command that goes on with a sweep, as a shell takes it.
std::string command_to_go_on(const RunArguments& arguments, const std::filesystem::path& out) {
  std::string command = "cordon run " + quoted(arguments.study.string()) + " --out " +
                        quoted(out.string()) + " --resume";
  for (const std::string& setting : arguments.settings) command += " --set " + quoted(setting);
  if (arguments.jobs) command += fmt::format(" --jobs {}", *arguments.jobs);
  if (arguments.point_limit_s)
    command += fmt::format(" --point-limit {}", *arguments.point_limit_s);
  if (!arguments.shard.empty()) command += " --shard " + arguments.shard;
  return command;
}

}  // namespace

Shard shard_of(const std::string& text) {
  Shard shard;
  const char *begin = text.data(), *end = begin + text.size();
  const auto first = std::from_chars(begin, end, shard.part);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, shard.of) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || shard.part < 1 ||
      shard.of < shard.part) {
    throw Error(Errc::invalid,
                fmt::format("--shard {}: write I/N with 1 ≤ I ≤ N, for example --shard 2/4", text));
  }
  return shard;
}

void check_options(const RunArguments& arguments, const Study& study) {
  std::string given;
  const auto add = [&](bool is_given, const char* name) {
    if (is_given) given += (given.empty() ? "" : ", ") + std::string(name);
  };
  add(arguments.jobs.has_value(), "--jobs");
  add(arguments.resume, "--resume");
  add(arguments.restart, "--restart");
  add(!arguments.shard.empty(), "--shard");
  if (!study.sweep.empty() && !arguments.point && !arguments.sets.empty())
    throw Error(Errc::invalid, "--sets: a sweep keeps no sets; --point runs one point with them");
  if (study.sweep.empty()) {
    add(arguments.point_limit_s.has_value(), "--point-limit");
    add(arguments.point.has_value(), "--point");
    if (!given.empty())
      throw Error(Errc::invalid, given + ": this study has no \"sweep\"; run it without");
  } else if (arguments.point && !given.empty()) {
    throw Error(
        Errc::invalid,
        given + ": --point runs one point as an ordinary run; leave out the one or the other");
  }
}

Exit exit_of(const SweepOutcome& outcome) {
  if (outcome.violated > 0) return Exit::violated;
  const bool all_failed =
      outcome.progress.total > 0 && outcome.progress.failed == outcome.progress.total;
  return all_failed && outcome.first_error ? exit_for(*outcome.first_error) : Exit::done;
}

Exit run_all_points(const Study& study, const Registry& registry, const RunArguments& arguments,
                    const std::filesystem::path& out, const std::atomic<bool>* stop) {
  ProgressBar bar({}, !arguments.quiet && isatty(STDERR_FILENO) == 1);
  SweepOptions options;
  options.out = out;
  options.jobs =
      arguments.jobs.value_or(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  options.resume = arguments.resume;
  options.restart = arguments.restart;
  if (arguments.point_limit_s) options.point_limit_s = *arguments.point_limit_s;
  if (!arguments.shard.empty()) options.shard = shard_of(arguments.shard);
  options.stop = stop;
  options.report = !arguments.no_report;
  options.progress = [&](const SweepProgress& progress) { bar.show(progress_line(progress)); };
  const SweepOutcome outcome = run_sweep(study, registry, options);
  bar.clear();
  if (outcome.interrupted) {
    complain(fmt::format("interrupted: {} of {} points are finished and kept; go on with\n  {}",
                         outcome.progress.done, outcome.progress.total,
                         command_to_go_on(arguments, out)));
    return interrupted;
  }
  if (!arguments.quiet) {
    if (outcome.files.empty())
      note(fmt::format("finished before: {} holds this sweep, nothing was run", out.string()));
    print(arguments.json
              ? sweep_report_json(outcome)
              : sweep_report_text(outcome, out, options.report && outcome.report_error.empty()));
  }
  if (!outcome.report_error.empty()) warn(no_report + outcome.report_error);
  if (outcome.violated > 0)
    complain(fmt::format("a guarantee was violated at {} of {} points", outcome.violated,
                         outcome.progress.total));
  if (outcome.progress.failed > 0 && outcome.progress.failed == outcome.progress.total)
    complain("every point failed");
  return exit_of(outcome);
}

}  // namespace cordon::apps
