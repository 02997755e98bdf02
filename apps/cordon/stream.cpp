// SPDX-License-Identifier: GPL-3.0-or-later
// Samples in, estimates or diagnoses out, one line each (docs/online.md).
#include <chrono>
#include <memory>
#include <string>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "cordon/study/online.hpp"
#include "interrupt.hpp"
#include "line_pipe.hpp"
#include "study/results/quantiles.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::apps {

namespace {

struct StreamArguments {
  std::filesystem::path study;
  std::string pipeline;
  std::vector<std::string> settings;
  bool sets = false, quiet = false;
};

using Clock = std::chrono::steady_clock;

/// An open object that ends with its line.
class Line {
 public:
  Line() { json_.begin_object(); }
  detail::JsonWriter& json() { return json_; }
  std::string text() {
    json_.end_object();
    return std::move(sink_.text) + "\n";
  }

 private:
  detail::StringSink sink_;
  detail::JsonWriter json_{sink_};
};

/// The line of a step: the step itself, and what else there is to say of it.
std::string line_of(const SessionStep& step, const Session& session, bool with_set) {
  if (step.estimate && !step.estimate->is_last) {
    Line line;
    line.json().key("k").null().member("sample", step.k);
    return line.text();
  }
  std::string text = json_of(step, session.modes());
  text.pop_back();
  if (step.estimate && step.estimate->estimate.k != step.k)
    text += fmt::format(", \"sample\": {}", step.k);
  if (step.diagnosis && !step.diagnosis->events.empty())
    text += ", \"events\": " + events_json_of(step.diagnosis->events, session.modes());
  if (step.estimate && step.estimate->restarted) text += ", \"restarted\": true";
  if (step.estimate && !step.estimate->not_enclosed.empty())
    text += ", \"not_enclosed\": " + detail::json_string(step.estimate->not_enclosed);
  if (with_set && step.estimate)
    text += ", \"set\": " + set_json_of(*step.estimate, session.name());
  return text + "}\n";
}

/// Lines of standard input through a session, until they end.
class Stream {
 public:
  Stream(const Study& study, const Registry& registry, const StreamArguments& arguments,
         const std::atomic<bool>* stop)
      : arguments_(arguments),
        session_(study, registry, arguments.pipeline),
        lines_(study),
        input_(STDIN_FILENO, stop),
        output_(STDOUT_FILENO, stop) {
    session_.session().prove_hulls(arguments.sets);
  }

  void run() {
    const Clock::time_point begin = Clock::now();
    std::string line;
    while (input_.next(line)) {
      ++line_;
      if (!answer(line)) break;
    }
    wall_s_ = std::chrono::duration<double>(Clock::now() - begin).count();
  }

  std::string summary() const {
    const TakenCounts& counts = session_.counts();
    const std::int64_t samples = counts.taken + counts.filled;
    std::string text = count(samples, "sample") + fmt::format(" in {:.1f} s", wall_s_);
    const auto add = [&](std::int64_t number, const char* what) {
      if (number > 0) text += fmt::format(", {} {}", number, what);
    };
    add(refused_, "refused");
    add(counts.filled_steps, "times filled");
    add(counts.corrected, "corrected");
    add(counts.late, "late");
    add(counts.repeated, "repeated");
    if (samples == 0) return text;
    return text + fmt::format("\nline to line: median {:.1f} µs, 99 % {:.1f} µs, largest {:.1f} µs",
                              latency_us_.median(), latency_us_.quantile(0.99),
                              latency_us_.largest());
  }

 private:
  /// False: nobody reads on, or a signal came.
  bool answer(const std::string& line) {
    const Clock::time_point begin = Clock::now();
    std::string text;
    try {
      const std::optional<GivenSample> sample = lines_.read(line);
      if (!sample) return true;
      text = answer_to(session_.take(*sample));
    } catch (const Error& error) {
      if (session_.session().has_ended() || !is_of_the_line(error)) throw;
      ++refused_;
      text = refusal(error);
    }
    if (!output_.write(text)) return false;
    latency_us_.add(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    return true;
  }

  static bool is_of_the_line(const Error& error) {
    return error.code() == Errc::invalid || error.code() == Errc::dimension ||
           error.code() == Errc::not_finite;
  }

  std::string answer_to(const Taken& taken) {
    std::string text;
    if (taken.how != Taken::How::taken) {
      Line line;
      line.json().member("how", to_string(taken.how)).member("said", taken.said);
      line.json().member("line", line_);
      text = line.text();
    }
    for (const SessionStep& step : taken.steps)
      text += line_of(step, session_.session(), arguments_.sets);
    return text;
  }

  std::string refusal(const Error& error) const {
    Line line;
    std::string what = error.what();
    if (const auto* input = dynamic_cast<const InputError*>(&error)) {
      what.clear();
      for (const Diagnostic& problem : input->diagnostics()) {
        if (!what.empty()) what += "; ";
        what += (problem.pointer.empty() ? "" : problem.pointer + ": ") + problem.message;
        if (!problem.suggestion.empty()) what += " (" + problem.suggestion + ")";
      }
    }
    line.json().member("error", what).member("line", line_);
    return line.text();
  }

  const StreamArguments& arguments_;
  OnlineSession session_;
  SampleLines lines_;
  LineInput input_;
  LineOutput output_;
  detail::Quantiles latency_us_;
  std::int64_t line_ = 0, refused_ = 0;
  double wall_s_ = 0;
};

void run_stream(const Program& program, const StreamArguments& arguments) {
  const std::atomic<bool>* const stop = stop_on_signals();
  Registry registry;
  registry.load({program.plugins});
  const Study study = read_study(arguments.study, registry, default_search_path(),
                                 program.study_plugins(), StudyData::optional, arguments.settings);
  if (!arguments.quiet) {
    for (const std::string& warning : study.warnings) warn(warning);
  }
  Stream stream(study, registry, arguments, stop);
  stream.run();
  if (!arguments.quiet) note(stream.summary());
}

}  // namespace

CORDON_COMMAND(stream) {
  CLI::App* command = app.add_subcommand(
      "stream", "Take samples from standard input, one line each, and answer each with a line");
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
  command->add_flag("--quiet", arguments->quiet, "Print no summary at the end");
  command->callback([&program, arguments] {
    run_stream(program, *arguments);
    program.exit = Exit::done;
  });
}

}  // namespace cordon::apps
