// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of standard input, or of a log, through a session.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/alarms.hpp"
#include "cordon/study/online.hpp"
#include "line_pipe.hpp"
#include "stream_checkpoint.hpp"
#include "stream_log.hpp"
#include "stream_record.hpp"
#include "stream_view.hpp"
#include "study/results/quantiles.hpp"

namespace cordon::apps {

struct StreamArguments {
  std::filesystem::path study;
  std::string pipeline;
  std::vector<std::string> settings;
  std::filesystem::path checkpoint, log, replay, record;  ///< empty: none
  std::int64_t every = 100;
  double deadline_us = 0;  ///< of a step; 0: none
  bool sets = false, watch = false, quiet = false;
};

class StreamLoop {
 public:
  /// What the arguments name lives longer.
  StreamLoop(const Study& study, const Registry& registry, const StreamArguments& arguments,
             const std::atomic<bool>* stop, std::atomic<bool>* acknowledge);

  /// Until the lines end, nobody reads on, or a signal comes. Throws the errors of components.
  void run();
  /// Counts and times, for people.
  std::string summary() const;
  /// The study that was recorded; empty: none, or not all of it.
  const std::filesystem::path& recorded() const { return recorded_; }
  /// What was asked for and is not there, as the record of some samples.
  const std::vector<std::string>& complaints() const { return complaints_; }
  /// Has a log other alarms?
  bool differs() const { return differs_; }

 private:
  using Clock = std::chrono::steady_clock;

  bool restore();
  void answer_all();
  /// What is said of it in the end.
  void judge_replay();
  /// False: nobody reads on, or a signal came.
  bool answer(const std::string& line);
  void tell_of_header() const;
  /// Between lines: what signals ask for.
  void look_up();
  std::string answer_to(const GivenLine& given);
  /// Within the deadline, if there is one.
  Taken take(const GivenSample& sample);
  std::string answer_to(const Taken& taken);
  void keep(const std::vector<AlarmChange>& changes);
  /// What could not be written is said, and the stream goes on.
  template <class Work>
  void written(const char* what, Work&& work);
  void save();
  /// What ends the record does not end the stream.
  template <class Work>
  void keep_record(Work&& work);
  /// Samples that follow are not in it.
  void finish_record();

  const StreamArguments& arguments_;
  OnlineSession session_;
  SampleLines lines_;
  LineInput input_;
  LineOutput output_;
  std::optional<StreamLog> log_;
  std::optional<ReplayedLog> replayed_;
  std::optional<StreamRecord> record_;
  std::optional<StreamView> view_;  ///< in place of lines for programs
  Checkpoint checkpoint_;
  const std::atomic<bool>* stop_;
  std::atomic<bool>* acknowledge_;
  detail::Quantiles latency_us_;
  std::int64_t line_ = 0, refused_ = 0, since_checkpoint_ = 0, unwritten_ = 0, left_open_ = 0;
  std::filesystem::path recorded_;
  bool differs_ = false;
  std::vector<std::string> complaints_;
  bool restored_ = false;  ///< and no line has come since
  double wall_s_ = 0;
};

}  // namespace cordon::apps
