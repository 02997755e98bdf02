// SPDX-License-Identifier: GPL-3.0-or-later
// A session beside a plant: samples come as lines of text, and not always in order
// (docs/online.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/study/alarms.hpp"
#include "cordon/study/session.hpp"

namespace cordon {

/// A sample as it was sent.
struct GivenSample {
  std::optional<Index> k = {};  ///< nothing: the next one, or that of t
  Vector u, y;                  ///< an output that is NaN is missing
  /// Seconds on the plant's clock. Where k is not given they tell it, in systems with a sampling
  /// time: by how long after the last sample it was taken. Where both are, the clock is set.
  std::optional<double> t = {};
};

/// A step, the sample that it is of, and the alarms that it has changed.
struct TakenStep : SessionStep {
  Sample sample = {};
  std::optional<double> t = {};  ///< with which it was sent
  std::vector<AlarmChange> alarms = {};
};

/// What became of a sample that was sent.
struct Taken {
  enum class How {
    taken,      ///< it was the next one
    filled,     ///< the times before it had no samples: they were taken without outputs
    corrected,  ///< outputs of an earlier time: it was taken again, and all that followed
    late,       ///< outputs of an earlier time, which were left out
    repeated    ///< nothing that was not known
  };
  How how = How::taken;
  std::string said = {};  ///< the rule that was followed, for people; "" for the next one
  /// In the order of times: those that were filled or taken again first.
  std::vector<TakenStep> steps = {};
};
std::string_view to_string(Taken::How how) noexcept;

/// How many samples became what, beginnings anew included.
struct TakenCounts {
  std::int64_t taken = 0, filled = 0, corrected = 0, late = 0, repeated = 0;
  std::int64_t filled_steps = 0;  ///< times that were filled
};

/// A session that follows the study's rules ("online") for samples that do not come one after
/// another, with its alarms.
class OnlineSession {
 public:
  /// As Session; where late outputs correct the past, the components have to offer their states.
  OnlineSession(const Study& study, const Registry& registry, const std::string& pipeline = "");
  ~OnlineSession();
  OnlineSession(OnlineSession&&) noexcept;
  OnlineSession& operator=(OnlineSession&&) noexcept;

  const Session& session() const;
  /// As Session::prove_hulls.
  void prove_hulls(bool wanted);

  /// Throws Errc::dimension, Errc::not_finite or Errc::invalid for what is refused: nothing has
  /// happened then. Any other error, and each after which `has_ended`, ends the session until
  /// `start` or `restore`.
  Taken take(const GivenSample& sample);
  /// Has a step ended with an error, or could its alarms not be told?
  bool has_ended() const;
  const TakenCounts& counts() const;

  const std::vector<Alarm>& alarms() const;  ///< that stand
  std::vector<AlarmChange> acknowledge();    ///< all of them

  /// Begins anew. Alarms stay until they are acknowledged; their causes are gone.
  std::vector<AlarmChange> start();
  /// As Session::save and restore, with what late outputs can still correct, the alarms and the
  /// counts. Where a state does not fit, alarms stay.
  std::string save();
  void restore(const std::string& saved);

 private:
  class Intake;
  std::unique_ptr<Intake> intake_;
};

/// What somebody asks for between samples.
enum class Request {
  acknowledge,  ///< of all alarms that stand
  start         ///< to begin anew
};
/// One of the two.
struct GivenLine {
  std::optional<GivenSample> sample = {};
  std::optional<Request> request = {};
};

/// Reads lines: JSON objects {"k": 3, "u": [0.5], "y": [1.2, null]}, {"t": 15.0, …} and {"do":
/// "acknowledge"}, or rows of a CSV file with a header row. Members and columns: docs/online.md.
class SampleLines {
 public:
  explicit SampleLines(const Study& study);
  ~SampleLines();
  SampleLines(SampleLines&&) noexcept;
  SampleLines& operator=(SampleLines&&) noexcept;

  /// What the line holds, whose end may be part of it; neither of the two: the header, or an empty
  /// line. Throws InputError with all that is wrong with it.
  GivenLine read(std::string_view line);
  /// Columns of the header that tell nothing; none without one.
  std::vector<std::string> passed_over() const;
  /// Do rows say which times they are of, by k or by t? Without a header nothing is known: true.
  bool have_times() const;

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

/// A step as `steps` of results.json has it, without metrics, true values and events:
/// {"k": 3, "hull": …}.
std::string json_of(const SessionStep& step, const std::vector<std::string>& modes);
/// A list of events as results.json has them.
std::string events_json_of(const std::vector<DiagnosisEvent>& events,
                           const std::vector<std::string>& modes);
/// Its set as a line of sets.jsonl has it, without the end; of an estimate with `is_last`.
std::string set_json_of(const EstimateStep& step, const std::string& pipeline);

/// All of it as a line of `cordon stream`, without its end: {"k": 3, …, "events": …, "alarms": …}.
std::string line_json_of(const TakenStep& step, const Session& session, bool with_set = false);

}  // namespace cordon
