// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "cordon/experiments/report.hpp"
#include "cordon/registry/build.hpp"
#include "experiments/sweep/journal.hpp"
#include "experiments/sweep/sweep_files.hpp"
#include "experiments/sweep/sweep_run.hpp"
#include "study/reading/point_study.hpp"
#include "study/text/fingerprint.hpp"
#include "study/text/host.hpp"

namespace cordon::detail {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double longest_limit_s = 1e9;  // beyond that the clock would overflow, and nobody waits

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void check(const SweepOptions& options) {
  if (options.out.empty()) throw Error(Errc::invalid, "a sweep needs a directory for its results");
  if (options.jobs < 1) throw Error(Errc::invalid, "a sweep needs one job at least");
  if (options.resume && options.restart)
    throw Error(Errc::invalid, "resume and restart exclude each other");
  if (!(options.point_limit_s > 0))
    throw Error(Errc::invalid, "the time limit of a point must be above 0");
  if (options.shard.of < 1 || options.shard.part < 1 || options.shard.part > options.shard.of ||
      options.shard.of > most_parts)
    throw Error(Errc::invalid, "a shard is a part between 1 and the number of parts, which is " +
                                   std::to_string(most_parts) + " at most");
}

JournalHead head_of(const Study& study, const Registry& registry, const SweepOptions& options) {
  const BuildInfo build = build_info();
  JournalHead head{fingerprint(study.resolved), build.version, build.abi_tag, {}, options.shard,
                   options.point_limit_s,       utc_now()};
  for (const PluginReport& report : registry.reports()) {
    if (report.state == PluginReport::State::loaded)
      head.plugins.push_back(report.name + ' ' + report.version);
  }
  return head;
}

/// One line for the problems of an input, without the name of the study's file, which is not part
/// of the results.
std::string text_of(const InputError& error, const Study& study) {
  std::string text = error.file() == study.file.string() ? "" : error.file() + ": ";
  bool first = true;
  for (const Diagnostic& one : error.diagnostics()) {
    text += first ? "" : "; ";
    first = false;
    if (!one.pointer.empty()) text += one.pointer + " ";
    text += one.message;
    if (!one.suggestion.empty()) text += "; " + one.suggestion;
  }
  return text;
}

/// Paths as the study writes them: without its folder, which is another one elsewhere.
std::string without_folder(std::string text, const Study& study) {
  std::error_code failure;
  const std::string folder =
      (std::filesystem::absolute(study.file, failure).parent_path() / "").string();
  if (failure || folder.size() < 2) return text;
  for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos;) {
    if (at == 0 || std::string_view(" \"'(\n").find(text[at - 1]) != std::string_view::npos) {
      text.erase(at, folder.size());
    } else {
      ++at;
    }
  }
  return text;
}

/// Runs points, one after another: what one thread of a sweep does.
class PointRunner {
 public:
  PointRunner(const StudyOf& of, const Study& study, const Registry& registry, double limit_s,
              const std::atomic<bool>& stop)
      : of_(of), study_(study), registry_(registry), limit_s_(limit_s), stop_(stop) {}

  /// Nothing: stopped.
  std::optional<PointResult> run(const SweepPoint& point) {
    PointResult result;
    result.index = point.index;
    try {
      if (!run(point, result)) return std::nullopt;
    } catch (const InputError& error) {
      fail(result, error.code(), text_of(error, study_));
    } catch (const Error& error) {
      fail(result, error.code(), error.what());
    } catch (const std::bad_alloc&) {
      throw;  // no fault of this point: the sweep ends, and can go on where there is more
    } catch (const std::system_error& error) {
      if (error.code() == std::errc::resource_unavailable_try_again) throw;
      fail(result, Errc::internal, error.what());
    } catch (const std::exception& error) {
      fail(result, Errc::internal, error.what());
    } catch (...) {
      fail(result, Errc::internal, "an exception of unknown type");
    }
    return result;
  }

 private:
  bool run(const SweepPoint& point, PointResult& result) {
    const Study now = of_(point);
    RunOptions options;
    options.pipeline = now.pipelines.at(point.pipeline).name;
    options.stop = &stop_;
    if (limit_s_ < longest_limit_s)
      options.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                            std::chrono::duration<double>(limit_s_));
    const RunOutcome outcome = run_study(now, registry_, options);
    if (outcome.interrupted) return false;
    const PipelineOutcome& pipeline = outcome.pipelines.front();
    result.numbers = numbers_of(pipeline);
    result.error = without_folder(pipeline.error, study_);
    result.code = pipeline.error_code;
    return true;
  }

  void fail(PointResult& result, Errc code, const std::string& message) const {
    result.code = code;
    result.error = message.empty() ? std::string(to_string(code)) : without_folder(message, study_);
  }

  const StudyOf& of_;
  const Study& study_;
  const Registry& registry_;
  double limit_s_;
  const std::atomic<bool>& stop_;
};

class SweepRun {
 public:
  SweepRun(const StudyOf& of, const Study& study, const Registry& registry,
           const SweepOptions& options)
      : of_(of), study_(study), registry_(registry), options_(options), grid_(study) {
    for (std::int64_t i = 0; i < grid_.size(); ++i) total_ += is_mine(i);
  }

  SweepOutcome run() {
    JournalHead head = head_of(study_, registry_, options_);
    if (options_.resume && !Journal::is_in(options_.out)) {
      if (auto finished = finished_before(head)) return std::move(*finished);
    }
    const Journal::Start start = options_.resume    ? Journal::Start::resume
                                 : options_.restart ? Journal::Start::restart
                                                    : Journal::Start::fresh;
    journal_.emplace(options_.out, head, start, [&](const PointResult& point) {
      if (point.index < grid_.size() && is_mine(point.index)) rows_.add(point);
    });
    resumed_ = rows_.size();
    work();
    SweepOutcome outcome;
    outcome.progress = progress();
    outcome.interrupted = rows_.size() < total_;
    if (outcome.interrupted) {
      journal_->sync();
      return outcome;
    }
    SweepFiles files = described(journal_->head().started);
    files.rows = std::move(rows_);
    files.wall_s = seconds_since(begin_);
    outcome.table = table_of(files);
    outcome.files = write_sweep(journal_->lock(), files, outcome.table);
    if (options_.report)
      outcome.report_error = add_report(journal_->lock().directory(), outcome.files);
    journal_->remove();
    outcome.violated = violations(outcome.table);
    outcome.first_error = files.rows.first_error();
    return outcome;
  }

 private:
  bool stopped_from_outside() const { return options_.stop && options_.stop->load(); }
  bool is_mine(std::int64_t index) const {
    return options_.shard.has(grid_[index], study_.pipelines.size());
  }

  SweepFiles described(const std::string& started) const {
    SweepFiles files;
    files.heads = heads_of(study_, registry_, started, options_.point_limit_s);
    read_head(files, study_.file);
    if (options_.shard.of > 1) files.shard = options_.shard;
    return files;
  }

  void check_same_work(const SweepFiles& finished) const {
    const auto refuse = [&](const std::string& reason, const std::string& suggestion) {
      throw InputError(options_.out.string(), {{"", reason, suggestion}});
    };
    const Shard shard = finished.shard.value_or(Shard{});
    if (shard.part != options_.shard.part || shard.of != options_.shard.of)
      refuse("holds the results of " + name_of(shard) + ", and " + name_of(options_.shard) +
                 " was asked for",
             "every part needs an \"--out\" of its own; without \"--resume\" the results there are "
             "replaced");
    if (finished.limit_s != options_.point_limit_s)
      refuse("holds results with " + name_of_limit(finished.limit_s) + " per point, now there is " +
                 name_of_limit(options_.point_limit_s),
             "give the same limit; without \"--resume\" all points are run again");
  }

  /// Results of this sweep that are there already. Throws InputError if they are of another part or
  /// limit.
  std::optional<SweepOutcome> finished_before(const JournalHead& head) const {
    std::optional<SweepFiles> files;
    try {
      files = read_sweep(options_.out);
    } catch (const InputError&) {
      return std::nullopt;  // nothing that was finished
    }
    if (files->study_hash == head.study_hash) check_same_work(*files);
    if (files->heads.results != described(head.started).heads.results) return std::nullopt;
    SweepOutcome outcome;
    outcome.progress = {total_, total_, files->rows.failed(), total_, 0};
    outcome.table = table_of(*files);
    outcome.violated = violations(outcome.table);
    outcome.first_error = files->rows.first_error();
    complete(outcome);
    return outcome;
  }

  /// What a process left undone that died when its results were in place: the report, and its lock
  /// and empty folder, which go. In a directory that another process holds, or nobody may write
  /// into, things stay as they are.
  void complete(SweepOutcome& outcome) const {
    std::error_code ignored;
    const bool report =
        options_.report && !std::filesystem::exists(options_.out / "report.html", ignored);
    try {
      const DirectoryLock lock(options_.out);
      Journal::remove_empty_folder(lock);
      std::vector<std::filesystem::path> added;
      if (report) outcome.report_error = add_report(lock.directory(), added);
    } catch (const Error& error) {
      if (report) outcome.report_error = error.what();
    }
  }

  SweepProgress progress() {
    const std::lock_guard guard(sharing_);
    return {rows_.size(), total_, rows_.failed(), resumed_, seconds_since(begin_)};
  }

  /// Runs what is left. Returns when all is done, or when it was stopped; throws what a thread
  /// could not deal with.
  void work() {
    const std::int64_t left = total_ - rows_.size();
    const std::int64_t jobs = std::min<std::int64_t>(options_.jobs, left);
    {
      std::vector<std::jthread> threads;
      const struct StopAtEnd {
        std::atomic<bool>& stop;
        ~StopAtEnd() { stop = true; }
      } stop_at_end{stop_};  // before the threads are joined, also if one of them cannot be made
      start(threads, jobs);
      watch();
    }
    if (failure_) std::rethrow_exception(failure_);
  }

  /// None of them takes a point before all have started: if they cannot, nothing is left behind
  /// that did not finish.
  void start(std::vector<std::jthread>& threads, std::int64_t jobs) {
    const std::lock_guard guard(sharing_);
    try {
      for (; working_ < jobs; ++working_) threads.emplace_back([this] { work_on_points(); });
    } catch (const std::system_error& error) {
      stop_ = true;
      if (rows_.size() == 0) journal_->remove();
      throw std::system_error(error.code(),
                              fmt::format("cannot start {} threads, give fewer with --jobs", jobs));
    }
  }

  void watch() {
    Clock::time_point synced = Clock::now();
    for (;;) {
      {
        std::unique_lock guard(sharing_);
        if (ended_.wait_for(guard, std::chrono::milliseconds(50),
                            [this] { return finished_ == working_; }))
          break;
      }
      if (stopped_from_outside()) stop_ = true;
      if (options_.progress) options_.progress(progress());
      if (seconds_since(synced) > 5) {
        journal_->sync();
        synced = Clock::now();
      }
    }
    if (options_.progress) options_.progress(progress());
  }

  void work_on_points() {
    try {
      PointRunner runner(of_, study_, registry_, options_.point_limit_s, stop_);
      while (!stop_ && !stopped_from_outside()) {
        const std::optional<SweepPoint> point = next();
        if (!point) break;
        const std::optional<PointResult> result = runner.run(*point);
        if (result) keep(*result);
      }
    } catch (...) {
      const std::lock_guard guard(sharing_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
    const std::lock_guard guard(sharing_);
    ++finished_;
    ended_.notify_all();
  }

  std::optional<SweepPoint> next() {
    const std::lock_guard guard(sharing_);
    if (stop_) return std::nullopt;
    while (next_ < grid_.size() && (!is_mine(next_) || rows_.has(next_))) ++next_;
    if (next_ == grid_.size()) return std::nullopt;
    return grid_[next_++];
  }

  /// Rows are made from the journal's line, so that they do not depend on whether it was read back.
  void keep(const PointResult& result) {
    const std::string line = line_of(result);
    const std::optional<PointResult> read = point_of(line);
    if (!read) throw Error(Errc::internal, "a point was written that cannot be read: " + line);
    journal_->add(line);
    const std::lock_guard guard(sharing_);
    rows_.add(*read);
  }

  const StudyOf& of_;
  const Study& study_;
  const Registry& registry_;
  const SweepOptions& options_;
  SweepGrid grid_;
  std::int64_t total_ = 0, resumed_ = 0;
  Clock::time_point begin_ = Clock::now();
  std::optional<Journal> journal_;
  std::atomic<bool> stop_ = false;
  std::mutex sharing_;  ///< of all that follows
  std::condition_variable ended_;
  SweepRows rows_;
  std::int64_t next_ = 0, working_ = 0, finished_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

SweepOutcome run_sweep_on(const StudyOf& of, const Study& study, const Registry& registry,
                          const SweepOptions& options) {
  check(options);
  return SweepRun(of, study, registry, options).run();
}

}  // namespace cordon::detail

namespace cordon {

SweepOutcome run_sweep(const Study& study, const Registry& registry, const SweepOptions& options) {
  return detail::run_sweep_on(
      [&](const SweepPoint& point) { return study_of_point(study, point, registry); }, study,
      registry, options);
}

}  // namespace cordon
