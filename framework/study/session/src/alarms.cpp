// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/alarms.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/interfaces/archive.hpp"
#include "study/session/diagnosis_timeline.hpp"
#include "study/text/numbers.hpp"

namespace cordon {

namespace {

constexpr int causes = 3;
constexpr Index nominal = 0;  // of the modes of a study

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace

std::string_view to_string(AlarmCause cause) noexcept {
  if (cause == AlarmCause::contradiction) return "contradiction";
  return cause == AlarmCause::outlier ? "outlier" : "fault";
}

std::string_view to_string(AlarmChange::What what) noexcept {
  switch (what) {
    case AlarmChange::What::raised:
      return "raised";
    case AlarmChange::What::again:
      return "again";
    case AlarmChange::What::specified:
      return "specified";
    case AlarmChange::What::passed:
      return "passed";
    case AlarmChange::What::acknowledged:
      return "acknowledged";
    case AlarmChange::What::gone:
      return "gone";
  }
  return "raised";
}

/// What a step says of one cause.
struct Alarms::Finding {
  enum class What { comes, says_more, goes } what = What::comes;
  AlarmCause cause = AlarmCause::fault;
  Index since = 0;
  std::string text = {};
  Certificate proof = {};
};

Alarms::Alarms(const Study& study, const Session& session)
    : labels_(study.labels), modes_(session.modes()) {}

std::string Alarms::mode(Index j) const {
  const auto at = static_cast<std::size_t>(j);
  return j >= 0 && at < modes_.size() ? "\"" + modes_[at] + "\"" : "none of the modes";
}

std::vector<Alarms::Finding> Alarms::findings(const SessionStep& step) const {
  using What = Finding::What;
  std::vector<Finding> found;
  if (step.estimate) {
    const EstimateStep& done = *step.estimate;
    const auto output = [&](Index i) { return "\"" + label_of(labels_.outputs, "y", i) + "\""; };
    if (!done.left_out.empty()) {
      std::vector<std::string> names;
      for (const Index i : done.left_out) names.push_back(output(i));
      found.push_back({What::comes,
                       AlarmCause::outlier,
                       step.k,
                       "at " + time(step.k) + " " + list_of(names) +
                           (names.size() == 1 ? " misses its prediction" : " miss the prediction"),
                       {}});
    } else {
      found.push_back({What::goes, AlarmCause::outlier});
    }
    if (done.estimate.consistent == Answer::no) {
      std::string text = "no state explains the samples up to " + time(step.k);
      if (done.contradiction && done.contradiction->output >= 0) {
        text += ": " + output(done.contradiction->output) + " misses its prediction";
        if (done.contradiction->distance > 0)
          text += " by " + detail::to_text(done.contradiction->distance);
      }
      found.push_back({What::comes, AlarmCause::contradiction, step.k, text, done.estimate.why});
    } else {
      found.push_back({What::goes, AlarmCause::contradiction});
    }
    return found;
  }
  const Diagnosis& diagnosis = step.diagnosis->diagnosis;
  for (const DiagnosisEvent& event : step.diagnosis->events) {
    using Kind = DiagnosisEvent::Kind;
    const bool is_excluded = event.what == Kind::detected || event.what == Kind::excluded;
    if (is_excluded && event.mode == nominal) {
      Index since = diagnosis.since;
      for (const FaultBound& bound : event.faults) since = std::min(since, bound.at);
      std::string text =
          "the samples from " + time(since) + " to " + time(step.k) + " exclude " + mode(nominal);
      for (const FaultBound& bound : event.faults) {
        text += "; " + label_of(labels_.faults, "n", bound.fault) + " at " + time(bound.at) +
                " is within [" + detail::to_text(bound.lower) + ", " +
                detail::to_text(bound.upper) + "]";
      }
      found.push_back({What::comes, AlarmCause::fault, since, text, event.evidence.why});
    } else if (event.what == Kind::isolated || event.what == Kind::resumed) {
      const bool is_nominal = event.mode == nominal;
      found.push_back({is_nominal ? What::goes : What::says_more,
                       AlarmCause::fault,
                       0,
                       "at " + time(step.k) + " " + mode(event.mode) + " is the only mode left",
                       {}});
    } else if (event.what == Kind::unknown_fault) {
      found.push_back({What::says_more,
                       AlarmCause::fault,
                       0,
                       "at " + time(step.k) + " every mode of the bank is excluded",
                       {}});
    }
  }
  return found;
}

void Alarms::raise(const Finding& finding, Index k, std::vector<AlarmChange>& changes) {
  const auto at = std::ranges::find(standing_, finding.cause, &Alarm::cause);
  if (at == standing_.end()) {
    standing_.push_back(
        {finding.cause, k, finding.since, 1, true, false, finding.text, finding.proof});
    changes.push_back({AlarmChange::What::raised, k, standing_.back()});
    return;
  }
  if (at->is_active) {  // more is known of what lasts: after a reset, or with outputs that came
                        // late
    if (at->cause != AlarmCause::fault || at->text.starts_with(finding.text)) return;
    at->text = finding.text;
    at->proof = finding.proof;
    changes.push_back({AlarmChange::What::specified, k, *at});
    return;
  }
  at->is_active = true;
  ++at->times;
  at->acknowledged = false;
  at->text = finding.text;
  at->proof = finding.proof;
  changes.push_back({AlarmChange::What::again, k, *at});
}

void Alarms::pass(AlarmCause cause, Index k, std::vector<AlarmChange>& changes) {
  const auto at = std::ranges::find(standing_, cause, &Alarm::cause);
  if (at == standing_.end() || !at->is_active) return;
  at->is_active = false;
  changes.push_back(
      {at->acknowledged ? AlarmChange::What::gone : AlarmChange::What::passed, k, *at});
  if (at->acknowledged) standing_.erase(at);
}

std::vector<AlarmChange> Alarms::step(const SessionStep& step) {
  std::vector<AlarmChange> changes;
  for (const Finding& finding : findings(step)) {
    if (finding.what == Finding::What::comes) {
      raise(finding, step.k, changes);
    } else if (finding.what == Finding::What::goes) {
      pass(finding.cause, step.k, changes);
    } else if (const auto at = std::ranges::find(standing_, finding.cause, &Alarm::cause);
               at != standing_.end()) {
      if (at->text.find(finding.text) != std::string::npos) continue;
      at->text += "; " + finding.text;
      changes.push_back({AlarmChange::What::specified, step.k, *at});
    }
  }
  last_ = std::max(last_, step.k);
  return changes;
}

std::vector<AlarmChange> Alarms::acknowledge() {
  std::vector<AlarmChange> changes;
  for (Alarm& alarm : standing_) {
    if (alarm.acknowledged) continue;
    alarm.acknowledged = true;
    changes.push_back({alarm.is_active ? AlarmChange::What::acknowledged : AlarmChange::What::gone,
                       last_, alarm});
  }
  std::erase_if(standing_, [](const Alarm& alarm) { return !alarm.is_active; });
  return changes;
}

void Alarms::serialize(Archive& archive) {
  archive.section("alarms");
  std::size_t count = standing_.size();
  archive(last_, count);
  if (count > causes) archive.refuse("more alarms than causes");
  standing_.resize(count);
  for (Alarm& alarm : standing_) {
    archive.choice(alarm.cause, causes);
    archive(alarm.raised_at, alarm.since, alarm.times, alarm.is_active, alarm.acknowledged,
            alarm.text, alarm.proof);
  }
}

}  // namespace cordon
