// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_loop.hpp"

#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common.hpp"
#include "cordon/solvers/limits.hpp"
#include "stream_lines.hpp"

namespace cordon::apps {

namespace {

/// Not an error of a component, after which there is no state to go on from.
bool is_of_the_line(const Error& error) {
  return error.code() == Errc::invalid || error.code() == Errc::dimension ||
         error.code() == Errc::not_finite;
}

}  // namespace

StreamLoop::StreamLoop(const Study& study, const Registry& registry,
                       const StreamArguments& arguments, const std::atomic<bool>* stop,
                       std::atomic<bool>* acknowledge)
    : arguments_(arguments),
      session_(study, registry, arguments.pipeline),
      lines_(study),
      input_(STDIN_FILENO, stop,
             [this] {
               look_up();
               if (view_) output_.write(view_->idle());
             }),
      output_(STDOUT_FILENO, stop),
      checkpoint_(arguments.checkpoint),
      stop_(stop),
      acknowledge_(acknowledge) {
  session_.prove_hulls(arguments.sets);
  if (arguments.watch) view_.emplace(study, session_, terminal_size());
  if (!arguments.record.empty() && !arguments.log.empty() &&
      std::filesystem::weakly_canonical(arguments.log).parent_path() ==
          std::filesystem::weakly_canonical(arguments.record)) {
    throw InputError(arguments.log.string(),
                     {{"", "is in the directory of the record", "name a file elsewhere"}});
  }
  if (!arguments.record.empty())
    record_.emplace(arguments.record, study, session_.session().name());
  if (!arguments.replay.empty()) replayed_.emplace(arguments.replay, session_.session().name());
}

bool StreamLoop::restore() {
  if (arguments_.checkpoint.empty()) return true;
  if (!arguments_.log.empty() && checkpoint_.uses(arguments_.log))
    throw InputError(arguments_.log.string(),
                     {{"", "is a file of the checkpoint", "give the log a name of its own"}});
  const std::optional<CheckpointState> state = checkpoint_.read();
  if (state && (state->log_bytes > 0) != !arguments_.log.empty()) {
    throw InputError(arguments_.checkpoint.string(),
                     {{"",
                       state->log_bytes > 0 ? "belongs to a log, and none is named"
                                            : "was written without a log",
                       state->log_bytes > 0 ? "name its log by \"--log\""
                                            : "leave \"--log\" out, or begin anew"}});
  }
  if (state) {
    try {
      session_.restore(state->session);
    } catch (const Error& error) {
      throw InputError(arguments_.checkpoint.string(),
                       {{"",
                         std::string("is of another pipeline, study, \"online\" section or version "
                                     "of Cordon: ") +
                             error.what(),
                         "name another file, or move this one and its log away to begin anew"}});
    }
    line_ = state->lines;
    restored_ = true;
  }
  if (!arguments_.log.empty())
    log_.emplace(arguments_.log, session_.session().name(), state ? state->log_bytes : 0,
                 state ? state->log_lost : 0);
  if (log_ && log_->cut() > 0 && !arguments_.quiet)
    warn(fmt::format("{} bytes that {} has beyond the checkpoint are in {}.cut now", log_->cut(),
                     arguments_.log.string(), arguments_.log.string()));
  if (!state) {  // a log and its checkpoint are there together; whoever cannot be saved is told so
    save();
    return true;
  }
  const Index next = session_.session().last().value_or(-1) + 1;
  if (view_)
    return output_.write(fmt::format("goes on from k = {}, after {} lines\n", next, line_));
  return output_.write(
      fmt::format("{{\"restored\": true, \"next\": {}, \"lines\": {}}}\n", next, line_));
}

void StreamLoop::run() {
  if (!restore()) return;
  if (!arguments_.log.empty() && !log_)
    log_.emplace(arguments_.log, session_.session().name(), 0, 0);
  const Clock::time_point begin = Clock::now();
  try {
    answer_all();
  } catch (...) {
    finish_record();
    throw;
  }
  if (view_) output_.write(view_->last());
  wall_s_ = std::chrono::duration<double>(Clock::now() - begin).count();
  if (replayed_) judge_replay();
  finish_record();
}

void StreamLoop::judge_replay() {
  std::vector<std::string> differences = replayed_->differences();
  if (refused_ > 0)
    differences.push_back(count(refused_, "line") +
                          (refused_ == 1 ? " of the log is" : " of the log are") +
                          " refused, which no line that was taken is");
  differs_ = !differences.empty();
  complaints_.insert(complaints_.end(), differences.begin(), differences.end());
  if (replayed_->lacks_lines())
    complaints_.push_back(
        "the log lacks lines, which could not be written then: it is replayed up to there");
  if (*stop_) complaints_.push_back("the replay was interrupted");
  if (const std::int64_t alarms = replayed_->cut_off(); alarms > 0) {
    warn(fmt::format("the log ends within its last sample: {} of it {} not in it",
                     count(alarms, "alarm change"), alarms == 1 ? "is" : "are"));
  } else if (replayed_->is_torn()) {
    warn("the log's last line is cut off: it is left out");
  }
}

void StreamLoop::answer_all() {
  const bool keeps = !arguments_.checkpoint.empty();
  std::string line;
  while (replayed_ ? !*stop_ && replayed_->next(line) : input_.next(line)) {
    look_up();
    ++line_;
    if (!answer(line)) return;  // nobody has read it: who goes on answers this line again
    if (keeps && since_checkpoint_ >= arguments_.every) save();
  }
  if (keeps) save();
}

void StreamLoop::look_up() {
  if (replayed_ || !acknowledge_->exchange(false)) return;
  output_.write(answer_to({std::nullopt, Request::acknowledge}));
  if (!arguments_.checkpoint.empty()) save();
}

template <class Work>
void StreamLoop::keep_record(Work&& work) {
  if (!record_) return;
  try {
    work();
  } catch (const Error& error) {
    complaints_.push_back(std::string("the record ends: ") + error.what());
    record_.reset();
  }
}

void StreamLoop::finish_record() {
  keep_record([&] {
    record_->finish();
    if (record_->has_samples()) recorded_ = record_->study();
  });
  record_.reset();
}

template <class Work>
void StreamLoop::written(const char* what, Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.code() != Errc::io) throw;
    if (unwritten_++ == 0) warn(fmt::format("{}: {}; the stream goes on", what, error.what()));
  }
}

void StreamLoop::save() {
  since_checkpoint_ = 0;
  written("the checkpoint was not written", [&] {
    if (log_) log_->flush();
    checkpoint_.write({session_.save(), line_, log_ ? log_->bytes() : 0, log_ ? log_->lost() : 0});
  });
}

bool StreamLoop::answer(const std::string& line) {
  const Clock::time_point begin = Clock::now();
  std::string text;
  try {
    if (!replayed_ && !input_.was_whole() && !line.starts_with('{'))
      throw Error(Errc::invalid, "the last line has no end: it may be cut off");
    const GivenLine given = lines_.read(line);
    if (!given.sample && !given.request) {
      const bool is_header = line.find_first_not_of(" \t\r") != std::string::npos;
      if (is_header) tell_of_header();
      if (restored_ && is_header) --line_;  // it came again, and was counted before
      restored_ = restored_ && !is_header;
      return true;
    }
    restored_ = false;
    text = answer_to(given);
    if (given.sample) ++since_checkpoint_;
  } catch (const Error& error) {
    if (session_.has_ended() || !is_of_the_line(error)) throw;
    ++refused_;
    text = view_ ? view_->show(error, line_) : error_line(error, line_);
  }
  if (!text.empty() && !output_.write(text)) return false;
  latency_us_.add(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
  return true;
}

void StreamLoop::tell_of_header() const {
  const std::vector<std::string> names = lines_.passed_over();
  if (lines_.have_times() || names.empty() || arguments_.quiet) return;
  warn(fmt::format("no column \"k\" or \"t\": each row is taken for the next time; passed over: {}",
                   fmt::join(names, ", ")));
}

std::string StreamLoop::answer_to(const GivenLine& given) {
  std::string text;
  std::vector<AlarmChange> changes;
  if (given.request == Request::acknowledge) {
    changes = session_.acknowledge();
    text = view_ ? view_->show(changes) : line_of(*given.request, changes);
  } else if (given.request) {
    if (record_ && record_->has_samples()) {
      finish_record();
      complaints_.push_back(
          "the record ends where the stream begins anew; later samples are not in it");
    }
    changes = session_.start();
    text = view_ ? view_->begin_anew() + view_->show(changes) : line_of(*given.request, changes);
  }
  std::optional<Taken> taken;
  if (given.sample) taken = take(*given.sample);
  if (log_) written("the log was not written", [&] { log_->write(log_line(given)); });
  keep(changes);
  return taken ? answer_to(*taken) : text;
}

Taken StreamLoop::take(const GivenSample& sample) {
  if (!(arguments_.deadline_us > 0)) return session_.take(sample);
  const std::chrono::duration<double, std::micro> limit(arguments_.deadline_us);
  const LimitedSolvers limits(
      {Clock::now() + std::chrono::duration_cast<Clock::duration>(limit), {}});
  return session_.take(sample);
}

std::string StreamLoop::answer_to(const Taken& taken) {
  std::string text;
  if (taken.how != Taken::How::taken && !view_) text = line_of(taken, line_);
  keep_record([&] {
    for (const TakenStep& step : taken.steps) record_->take(step.sample);
  });
  for (const TakenStep& step : taken.steps) {
    keep(step.alarms);
    left_open_ += step.left_open;
    if (!view_) text += line_json_of(step, session_.session(), arguments_.sets) + "\n";
  }
  return view_ ? view_->show(taken) : text;
}

void StreamLoop::keep(const std::vector<AlarmChange>& changes) {
  for (const AlarmChange& change : changes) {
    if (replayed_) replayed_->compare(json_of(change));
    if (log_) written("the log was not written", [&] { log_->write(log_line(change)); });
  }
}

std::string StreamLoop::summary() const {
  const TakenCounts& counts = session_.counts();
  const std::int64_t samples = counts.taken + counts.filled;
  std::string text = count(samples, "sample") + fmt::format(" in {:.1f} s", wall_s_);
  const auto add = [&](std::int64_t number, const char* what) {
    if (number > 0) text += fmt::format(", {} {}", number, what);
  };
  text += counts_text(counts, refused_);
  add(left_open_, left_open_ == 1 ? "step in which limits of work have left questions open"
                                  : "steps in which limits of work have left questions open");
  add(unwritten_, "not written");
  const std::size_t alarms = session_.alarms().size();
  if (alarms > 0) text += fmt::format(", {} alarm{}", alarms, alarms == 1 ? " stands" : "s stand");
  if (replayed_) text += ", " + count(replayed_->agreed(), "alarm change") + " as in the log";
  if (samples == 0 || !(latency_us_.largest() > 0)) return text;
  return text + fmt::format(
                    "\nline to line: median {:.1f} µs, 99 % {:.1f} µs, 99.9 % {:.1f} µs, largest "
                    "{:.1f} µs",
                    latency_us_.median(), latency_us_.quantile(0.99), latency_us_.quantile(0.999),
                    latency_us_.largest());
}

}  // namespace cordon::apps
