// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/alarms.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "cordon/interfaces/archive.hpp"
#include "study/session/diagnosis_timeline.hpp"
#include "study/text/numbers.hpp"

namespace cordon {

namespace {

constexpr std::size_t causes = 3;
constexpr Index nominal = 0;  // of the modes of a study

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string short_text(double value) {
  std::ostringstream text;
  text << std::setprecision(3) << value;
  return std::move(text).str();
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
  Index left = Alarm::not_known;
};

Alarms::Alarms(const Study& study, const Session& session)
    : labels_(study.labels),
      modes_(session.modes()),
      window_(study.online.late == LateRule::correct ? study.online.lag : 0) {}

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
          text += " by about " + short_text(done.contradiction->distance);
      }
      found.push_back({What::comes, AlarmCause::contradiction, step.k, text, done.estimate.why});
    } else {
      found.push_back({What::goes, AlarmCause::contradiction});
    }
    return found;
  }
  return fault_findings(step);
}

std::vector<Alarms::Finding> Alarms::fault_findings(const SessionStep& step) const {
  using What = Finding::What;
  std::vector<Finding> found;
  const Diagnosis& diagnosis = step.diagnosis->diagnosis;
  const auto excluded = [&](Index since, const std::vector<FaultBound>& faults,
                            const Certificate& why) {
    for (const FaultBound& bound : faults) since = std::min(since, bound.at);
    std::string text =
        "the samples from " + time(since) + " to " + time(step.k) + " exclude " + mode(nominal);
    for (const FaultBound& bound : faults) {
      text += "; " + label_of(labels_.faults, "n", bound.fault) + " at " + time(bound.at) +
              " is within [" + detail::to_text(bound.lower) + ", " + detail::to_text(bound.upper) +
              "]";
    }
    found.push_back({What::comes, AlarmCause::fault, since, text, why});
  };
  for (const DiagnosisEvent& event : step.diagnosis->events) {
    using Kind = DiagnosisEvent::Kind;
    const bool is_excluded = event.what == Kind::detected || event.what == Kind::excluded;
    if (is_excluded && event.mode == nominal)
      excluded(diagnosis.since, event.faults, event.evidence.why);
  }
  // The first sample has no event of what it excludes.
  const bool is_proven =
      !diagnosis.modes.empty() && diagnosis.modes.front().consistent == Answer::no;
  if (found.empty() && is_proven) excluded(diagnosis.since, {}, diagnosis.modes.front().why);
  const auto says_more = [&](Index left, const std::string& text) {
    found.push_back({What::says_more, AlarmCause::fault, diagnosis.since, text, {}, left});
  };
  if (diagnosis.decision == Decision::unknown_fault) {
    says_more(Alarm::none_left, "at " + time(step.k) + " every mode of the bank is excluded");
  } else if (diagnosis.decision == Decision::monitoring && diagnosis.mode == nominal) {
    found.push_back({What::goes, AlarmCause::fault});
  } else if (diagnosis.decision == Decision::monitoring) {
    says_more(diagnosis.mode,
              "at " + time(step.k) + " " + mode(diagnosis.mode) + " is the only mode left");
  }
  return found;
}

void Alarms::raise(const Finding& finding, Index k, std::vector<AlarmChange>& changes) {
  const auto at = std::ranges::find(standing_, finding.cause, &Alarm::cause);
  if (at != standing_.end() && at->is_active) return;  // the evidence that has raised it stays
  onsets_[static_cast<std::size_t>(finding.cause)].push_back(k);
  const bool is_new = at == standing_.end();
  Alarm& alarm = is_new ? standing_.emplace_back() : *at;
  if (is_new) {
    alarm.cause = finding.cause;
    alarm.raised_at = k;
  } else {
    ++alarm.times;
  }
  alarm.is_active = true;
  alarm.acknowledged = false;
  alarm.since = finding.since;
  alarm.reason = alarm.text = finding.text;
  alarm.left = Alarm::not_known;
  alarm.proof = finding.proof;
  changes.push_back({is_new ? AlarmChange::What::raised : AlarmChange::What::again, k, alarm});
}

void Alarms::specify(const Finding& finding, Index k, std::vector<AlarmChange>& changes) {
  const auto at = std::ranges::find(standing_, finding.cause, &Alarm::cause);
  if (at == standing_.end() || !at->is_active) return;
  if (at->left == finding.left) return;
  at->left = finding.left;
  at->text = at->reason + "; " + finding.text;
  changes.push_back({AlarmChange::What::specified, k, *at});
}

void Alarms::pass(AlarmCause cause, Index k, std::vector<AlarmChange>& changes) {
  const auto at = std::ranges::find(standing_, cause, &Alarm::cause);
  if (at == standing_.end() || !at->is_active) return;
  at->is_active = false;
  changes.push_back(
      {at->acknowledged ? AlarmChange::What::gone : AlarmChange::What::passed, k, *at});
  if (at->acknowledged) standing_.erase(at);
}

std::vector<AlarmChange> Alarms::step(const SessionStep& step, std::optional<Index> held) {
  std::vector<AlarmChange> changes;
  for (Finding& finding : findings(step)) {
    // An estimate rests on all times before, the exclusion of a mode on those that it names.
    const bool rests_on_it = held && (finding.cause != AlarmCause::fault || *held >= finding.since);
    if (rests_on_it && !finding.text.empty())
      finding.text +=
          " (if the plant held its input where times were filled, last at " + time(*held) + ")";
    if (finding.what == Finding::What::comes) raise(finding, step.k, changes);
    if (finding.what == Finding::What::says_more) specify(finding, step.k, changes);
    if (finding.what == Finding::What::goes) pass(finding.cause, step.k, changes);
  }
  last_ = step.k;
  for (std::vector<Index>& onsets : onsets_)
    std::erase_if(onsets, [&](Index k) { return k < last_ - window_; });
  return changes;
}

void Alarms::settle(AlarmCause cause, const std::optional<Alarm>& now, Index onsets,
                    std::vector<AlarmChange>& changes) {
  const bool lasts = now && now->is_active;
  const auto at = std::ranges::find(standing_, cause, &Alarm::cause);
  const auto take = [&](Alarm& told) {  // what is known now
    told.since = now->since;
    told.reason = now->reason;
    told.left = now->left;
    told.text = now->text;
    told.proof = now->proof;
    told.is_active = now->is_active;
  };
  if (at == standing_.end()) {
    const bool was_told = onsets == 0;  // what was told and has left was acknowledged
    if (!now || (was_told && !lasts)) return;
    Alarm& alarm = standing_.emplace_back(*now);
    alarm.acknowledged = was_told;
    alarm.times = std::max<Index>(onsets, 1);
    alarm.is_active = true;
    changes.push_back(
        {was_told ? AlarmChange::What::again : AlarmChange::What::raised, last_, alarm});
    if (!lasts) pass(cause, last_, changes);
    return;
  }
  if (now && (onsets > 0 || (lasts && !at->is_active))) {
    take(*at);
    at->times += std::max<Index>(onsets, 1);
    at->acknowledged = false;
    at->is_active = true;
    changes.push_back({AlarmChange::What::again, last_, *at});
    if (!lasts) pass(cause, last_, changes);
    return;
  }
  if (at->is_active && !lasts) {
    if (now) take(*at);
    at->is_active = true;
    return pass(cause, last_, changes);
  }
  if (!now) return;
  const bool says_more = lasts && at->text != now->text;
  take(*at);
  if (says_more) changes.push_back({AlarmChange::What::specified, last_, *at});
}

std::vector<AlarmChange> Alarms::retake(const std::vector<Again>& steps) {
  Alarms again = *this;
  again.standing_ = *steps.front().before;
  for (std::vector<Index>& onsets : again.onsets_)
    std::erase_if(onsets, [&](Index k) { return k >= steps.front().step->k; });
  for (const Again& one : steps) {
    *one.before = again.standing_;
    again.step(*one.step, one.held);
  }
  std::vector<AlarmChange> changes;
  last_ = again.last_;
  for (std::size_t i = 0; i < causes; ++i) {
    const auto cause = static_cast<AlarmCause>(i);
    const auto at = std::ranges::find(again.standing_, cause, &Alarm::cause);
    const auto now = at == again.standing_.end() ? std::optional<Alarm>() : *at;
    const auto news = std::ranges::count_if(
        again.onsets_[i], [&](Index k) { return !std::ranges::binary_search(onsets_[i], k); });
    settle(cause, now, news, changes);
    onsets_[i] = again.onsets_[i];
  }
  return changes;
}

std::vector<AlarmChange> Alarms::begin_anew() {
  std::vector<AlarmChange> changes;
  for (std::size_t i = 0; i < causes; ++i) pass(static_cast<AlarmCause>(i), last_, changes);
  for (std::vector<Index>& onsets : onsets_) onsets.clear();
  return changes;
}

std::vector<AlarmChange> Alarms::acknowledge() {
  std::vector<AlarmChange> changes;
  for (Alarm alarm : standing_) {
    if (alarm.acknowledged) continue;
    alarm.acknowledged = true;
    const auto what = alarm.is_active ? AlarmChange::What::acknowledged : AlarmChange::What::gone;
    changes.push_back({what, last_, std::move(alarm)});
  }
  for (Alarm& alarm : standing_) alarm.acknowledged = true;  // nothing fails from here on
  std::erase_if(standing_, [](const Alarm& alarm) { return !alarm.is_active; });
  return changes;
}

void Alarm::serialize(Archive& archive) {
  archive.choice(cause, static_cast<int>(causes));
  archive(raised_at, since, times, is_active, acknowledged, reason, left, text, proof);
}

void Alarms::serialize(Archive& archive) {
  archive.section("alarms");
  archive(last_, onsets_, standing_);
  if (standing_.size() > causes) archive.refuse("more alarms than causes");
}

}  // namespace cordon
