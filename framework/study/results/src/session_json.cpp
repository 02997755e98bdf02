// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a session as the files of a run have them.
#include "cordon/study/alarms.hpp"
#include "cordon/study/online.hpp"
#include "study/results/diagnosis_json.hpp"
#include "study/results/results_parts.hpp"
#include "study/results/step_json.hpp"
#include "study/text/numbers.hpp"
#include "study/text/string_sink.hpp"

namespace cordon {

std::string json_of(const SessionStep& step, const std::vector<std::string>& modes) {
  detail::StringSink text;
  detail::JsonWriter json(text);
  if (step.diagnosis) {
    std::vector<detail::JudgedBound> faults;
    for (const FaultBound& bound : step.diagnosis->diagnosis.faults) faults.push_back({bound, {}});
    detail::write(json, step.diagnosis->diagnosis, std::nullopt, faults, modes);
  } else {
    const EstimateStep& done = step.estimate.value();
    // Of observers that lag, what is left out of a sample is not that of the estimate's time.
    const std::vector<Index> none;
    const bool is_of_its_time = step.k == done.estimate.k;
    json.begin_object();
    detail::write_members(json, done.estimate, done.hull, done.inner,
                          is_of_its_time ? done.left_out : none);
    json.end_object();
  }
  return std::move(text.text);
}

std::string events_json_of(const std::vector<DiagnosisEvent>& events,
                           const std::vector<std::string>& modes) {
  detail::StringSink text;
  detail::JsonWriter json(text);
  json.begin_array();
  for (const DiagnosisEvent& event : events) detail::write(json, event, modes);
  json.end_array();
  return std::move(text.text);
}

std::string json_of(const AlarmChange& change) {
  detail::StringSink text;
  detail::JsonWriter json(text);
  const Alarm& alarm = change.alarm;
  json.begin_object().member("what", to_string(change.what)).member("k", change.k);
  json.member("cause", to_string(alarm.cause)).member("raised_at", alarm.raised_at);
  json.member("since", alarm.since).member("times", alarm.times);
  json.member("active", alarm.is_active).member("acknowledged", alarm.acknowledged);
  json.member("text", alarm.text);
  if (alarm.proof.kind != Certificate::Kind::none) {
    json.key("proof");
    detail::write(json, alarm.proof);
  }
  json.end_object();
  return std::move(text.text);
}

std::string line_json_of(const TakenStep& step, const Session& session, bool with_set) {
  const EstimateStep* const estimate = step.estimate ? &*step.estimate : nullptr;
  const bool waits = estimate && !estimate->is_last;
  std::string text = waits ? "{\"k\": null" : json_of(step, session.modes());
  if (!waits) text.pop_back();
  const auto add = [&](const char* name, const std::string& content) {
    text += std::string(", \"") + name + "\": " + content;
  };
  if (estimate && (waits || estimate->estimate.k != step.k)) add("sample", std::to_string(step.k));
  if (step.t) add("t", detail::to_text(*step.t));
  if (with_set && estimate && !waits) add("set", set_json_of(*estimate, session.name()));
  if (step.diagnosis && !step.diagnosis->events.empty())
    add("events", events_json_of(step.diagnosis->events, session.modes()));
  if (estimate && estimate->restarted) add("restarted", "true");
  if (estimate && !estimate->not_enclosed.empty())
    add("not_enclosed", detail::json_string(estimate->not_enclosed));
  if (step.left_open) add("left_open", "true");
  if (!step.alarms.empty()) add("alarms", json_of(step.alarms));
  return text + "}";
}

std::string json_of(const std::vector<AlarmChange>& changes) {
  std::string text = "[";
  for (const AlarmChange& change : changes) text += (text.size() > 1 ? ", " : "") + json_of(change);
  return text + "]";
}

std::string set_json_of(const EstimateStep& step, const std::string& pipeline) {
  return detail::set_json(step.estimate, step.hull, step.hull_proofs,
                          detail::json_string(pipeline));
}

}  // namespace cordon
