// SPDX-License-Identifier: GPL-3.0-or-later
// Alarms: what a session has proven to be wrong, kept until somebody has taken note of it
// (docs/online.md).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/session.hpp"

namespace cordon {

/// What is proven to be wrong.
enum class AlarmCause {
  contradiction,  ///< no state explains the samples: the estimate is proven empty
  outlier,        ///< outputs missed the prediction, and were left out
  fault           ///< the nominal mode is excluded
};
std::string_view to_string(AlarmCause cause) noexcept;

/// An alarm stands from the sample that has raised it until it is acknowledged and its cause is
/// gone, whichever comes last.
struct Alarm {
  /// What is left of the modes, where it is not the index of the only one.
  static constexpr Index not_known = -2, none_left = -1;

  AlarmCause cause = AlarmCause::fault;
  Index raised_at = 0;     ///< k of the sample
  Index since = 0;         ///< first time that the evidence speaks of
  std::int64_t times = 1;  ///< that the cause has come while the alarm stood
  bool is_active = true;   ///< does the cause last?
  bool acknowledged = false;
  std::string reason;      ///< in words: what is proven, since when, and by what evidence
  Index left = not_known;  ///< of a fault: the only mode left, or `none_left`
  std::string text;        ///< `reason`, and what is left
  Certificate proof = {};  ///< of the sample that has raised it, as its decision has it

  void serialize(Archive& archive);
};

/// What has become of an alarm.
struct AlarmChange {
  enum class What {
    raised,        ///< it stands from now on
    again,         ///< its cause has come again
    specified,     ///< more is known of it: `text` is another
    passed,        ///< its cause is gone; it stands until it is acknowledged
    acknowledged,  ///< somebody has taken note; it stands while its cause lasts
    gone           ///< it stands no longer
  };
  What what = What::raised;
  Index k = 0;  ///< of the sample, or of the one before
  Alarm alarm;  ///< as it is now
};
std::string_view to_string(AlarmChange::What what) noexcept;

/// The alarms of one pipeline; of each cause one stands at most.
class Alarms {
 public:
  Alarms(const Study& study, const Session& session);
  Alarms(const Alarms&) = default;
  Alarms& operator=(const Alarms&) = default;

  /// Steps come in order. `held`: the last time, up to that of the step, whose input was not sent,
  /// and is taken for that of the time before; evidence that speaks of it says so.
  std::vector<AlarmChange> step(const SessionStep& step, std::optional<Index> held = {});
  /// A step that is taken again, with what stood before it in case that it was not the first time.
  struct Again {
    const SessionStep* step = nullptr;
    std::optional<Index> held = {};
    std::vector<Alarm>* before = nullptr;
  };
  /// Steps that are taken again after late outputs, from where alarms stood before the first one,
  /// and all that follow: what they change on the whole, told of the last one. What would have
  /// stood before the others replaces what did.
  std::vector<AlarmChange> retake(const std::vector<Again>& steps);
  /// The pipeline begins anew: causes are gone.
  std::vector<AlarmChange> begin_anew();
  /// Of all that stand.
  std::vector<AlarmChange> acknowledge();
  const std::vector<Alarm>& standing() const { return standing_; }

  void serialize(Archive& archive);

 private:
  struct Finding;
  std::vector<Finding> findings(const SessionStep& step) const;
  std::vector<Finding> fault_findings(const SessionStep& step) const;
  void raise(const Finding& finding, Index k, std::vector<AlarmChange>& changes);
  void specify(const Finding& finding, Index k, std::vector<AlarmChange>& changes);
  void pass(AlarmCause cause, Index k, std::vector<AlarmChange>& changes);
  /// From what was told of a cause to what `now` is: the change, if there is one.
  void settle(AlarmCause cause, const std::optional<Alarm>& now, Index onsets,
              std::vector<AlarmChange>& changes);
  std::string time(Index k) const { return time_text(labels_, k); }
  std::string mode(Index j) const;

  Labels labels_;
  std::vector<std::string> modes_;
  std::vector<Alarm> standing_;
  Index last_ = -1;   ///< k of the last step
  Index window_ = 0;  ///< samples that late outputs may lie behind the last one
  std::array<std::vector<Index>, 3> onsets_;  ///< by cause, the times within the window it came at
};

/// {"what", "k", "cause", "raised_at", "since", "times", "active", "acknowledged", "text",
/// "proof"}.
std::string json_of(const AlarmChange& change);
/// A list of these.
std::string json_of(const std::vector<AlarmChange>& changes);

}  // namespace cordon
