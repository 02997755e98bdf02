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
  for (const DiagnosisEvent& event : step.diagnosis->events) {
    using Kind = DiagnosisEvent::Kind;
    const bool is_excluded = event.what == Kind::detected || event.what == Kind::excluded;
    if (!is_excluded || event.mode != nominal) continue;
    Index since = diagnosis.since;
    for (const FaultBound& bound : event.faults) since = std::min(since, bound.at);
    std::string text =
        "the samples from " + time(since) + " to " + time(step.k) + " exclude " + mode(nominal);
    for (const FaultBound& bound : event.faults) {
      text += "; " + label_of(labels_.faults, "n", bound.fault) + " at " + time(bound.at) +
              " is within [" + detail::to_text(bound.lower) + ", " + detail::to_text(bound.upper) +
              "]";
    }
    found.push_back({What::comes, AlarmCause::fault, since, text, event.evidence.why});
  }
  const auto says_more = [&](Index left, const std::string& text) {
    found.push_back({What::says_more, AlarmCause::fault, 0, text, {}, left});
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
  const auto cause = static_cast<std::size_t>(finding.cause);
  std::vector<Index>& told = told_[cause];
  if (const auto place = std::ranges::lower_bound(told, k); place == told.end() || *place != k) {
    told.insert(place, k);
    news_[cause] = true;
  }
  const auto at = std::ranges::find(standing_, finding.cause, &Alarm::cause);
  if (at != standing_.end() && at->is_active) return;  // the evidence that has raised it stays
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
    if (rests_on_it && finding.what == Finding::What::comes)
      finding.text +=
          " (if the plant held its input where times were filled, last at " + time(*held) + ")";
    if (finding.what == Finding::What::comes) raise(finding, step.k, changes);
    if (finding.what == Finding::What::says_more) specify(finding, step.k, changes);
    if (finding.what == Finding::What::goes) pass(finding.cause, step.k, changes);
  }
  last_ = step.k;
  for (std::vector<Index>& told : told_)
    std::erase_if(told, [&](Index k) { return k < last_ - window_; });
  return changes;
}

void Alarms::settle(const Alarm& before, std::vector<AlarmChange>& changes) {
  const auto at = std::ranges::find(standing_, before.cause, &Alarm::cause);
  const bool lasts = at != standing_.end() && at->is_active;
  const auto is_of_it = [&](const AlarmChange& change) {
    return change.alarm.cause == before.cause;
  };
  if (before.is_active && lasts) {  // as before, but for what its evidence and what is left are now
    const Alarm now = std::exchange(*at, before);
    const bool says_more = now.left != before.left && now.left != Alarm::not_known;
    const std::string left =
        (says_more ? now : before).text.substr((says_more ? now : before).reason.size());
    std::erase_if(changes, is_of_it);
    if (!says_more && now.reason == before.reason) return;
    at->since = now.since;
    at->reason = now.reason;
    at->proof = now.proof;
    if (says_more) at->left = now.left;
    at->text = at->reason + left;
    changes.push_back({AlarmChange::What::specified, last_, *at});
  } else if (before.is_active) {  // the last change says that it is gone
    const auto gone = std::find_if(changes.rbegin(), changes.rend(), is_of_it);
    if (gone == changes.rend()) return;
    const AlarmChange kept = *gone;
    std::erase_if(changes, is_of_it);
    changes.push_back(kept);
  } else if (at != standing_.end() && !lasts && !news_[static_cast<std::size_t>(before.cause)]) {
    *at = before;
    std::erase_if(changes, is_of_it);
  }
}

std::vector<AlarmChange> Alarms::retake(const std::vector<const SessionStep*>& steps,
                                        std::optional<Index> held) {
  const std::vector<Alarm> before = standing_;
  news_.fill(false);
  std::vector<AlarmChange> changes;
  for (const SessionStep* one : steps) {
    for (AlarmChange& change : step(*one, held)) changes.push_back(std::move(change));
  }
  for (const Alarm& alarm : before) settle(alarm, changes);
  // What was told of these samples already, and was acknowledged and gone, is no news.
  std::erase_if(standing_, [&](const Alarm& alarm) {
    const bool stood = std::ranges::find(before, alarm.cause, &Alarm::cause) != before.end();
    const bool is_known =
        !stood && !alarm.is_active && !news_[static_cast<std::size_t>(alarm.cause)];
    if (is_known)
      std::erase_if(changes, [&](const AlarmChange& c) { return c.alarm.cause == alarm.cause; });
    return is_known;
  });
  for (AlarmChange& change : changes) change.k = last_;
  return changes;
}

void Alarms::begin_anew() {
  for (std::vector<Index>& told : told_) told.clear();
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

void Alarms::serialize(Archive& archive) {
  archive.section("alarms");
  std::size_t count = standing_.size();
  archive(last_, told_, count);
  if (count > causes) archive.refuse("more alarms than causes");
  standing_.resize(count);
  for (Alarm& alarm : standing_) {
    archive.choice(alarm.cause, static_cast<int>(causes));
    archive(alarm.raised_at, alarm.since, alarm.times, alarm.is_active, alarm.acknowledged,
            alarm.reason, alarm.left, alarm.text, alarm.proof);
  }
}

}  // namespace cordon
