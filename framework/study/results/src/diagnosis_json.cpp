// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/diagnosis_json.hpp"

#include <limits>

#include "study/results/results_parts.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace {

using Names = std::vector<std::string>;
using Layout = JsonWriter::Layout;

void write(JsonWriter& json, const JudgedBound& judged) {
  const FaultBound& bound = judged.bound;
  json.begin_object()
      .member("fault", bound.fault + 1)
      .member("at", bound.at)
      .member("lower", bound.lower);
  json.member("upper", bound.upper).member("estimate", bound.estimate);
  if (judged.truth) json.member("truth", *judged.truth);
  json.end_object();
}

void write(JsonWriter& json, const DiagnosisSegment& segment, const Names& modes) {
  json.begin_object();
  write_mode(json, "mode", modes, segment.mode);
  json.member("from", segment.from).member("to", segment.to).member("scored", segment.scored);
  write_time(json, "detected_at", segment.detected_at);
  write_time(json, "isolated_at", segment.isolated_at);
  write_time(json, "unknown_fault_at", segment.unknown_fault_at);
  write_time(json, "wrong_at", segment.wrong_at);
  json.member("missed", segment.missed()).member("last", to_string(segment.last)).end_object();
}

void write_rate(JsonWriter& json, std::string_view key, std::int64_t count, std::int64_t all) {
  json.key(key);
  all == 0 ? json.null() : json.value(static_cast<double>(count) / static_cast<double>(all));
}

void write(JsonWriter& json, const ModeStatistics& counts, const Names& modes) {
  json.begin_object();
  write_mode(json, "mode", modes, counts.mode);
  json.member("segments", counts.segments)
      .member("detected", counts.detected)
      .member("isolated", counts.isolated);
  json.member("missed", counts.missed)
      .member("wrong", counts.wrong)
      .member("unknown_fault", counts.unknown_fault);
  write_rate(json, "missed_rate", counts.missed, counts.segments);
  write_rate(json, "wrong_rate", counts.wrong, counts.segments);
  write_rate(json, "unknown_fault_rate", counts.unknown_fault, counts.segments);
  write_delays(json, "detection_delay", counts.detection);
  write_delays(json, "isolation_delay", counts.isolation);
  json.end_object();
}

template <class Items>
void write_list(JsonWriter& json, std::string_view key, const Items& items, const Names& modes) {
  json.key(key).begin_array(items.empty() ? Layout::line : Layout::lines);
  for (const auto& item : items) write(json, item, modes);
  json.end_array();
}

void write(JsonWriter& json, const FaultStatistics& counts) {
  json.begin_object().member("fault", counts.fault + 1);
  write_time(json, "delay", counts.delay);
  json.member("bounds", counts.bounds)
      .member("checked", counts.checked)
      .member("outside", counts.outside);
  json.member("excluded_0", counts.excluded_0);
  json.member("mean_half_width", counts.bounds > 0 ? counts.mean_half_width : not_available);
  json.member("last_half_width", counts.bounds > 0 ? counts.last_half_width : not_available);
  json.member("rms_error", counts.checked > 0 ? counts.rms_error : not_available);
  json.member("largest_share", counts.checked > 0 ? counts.largest_share : not_available)
      .end_object();
}

void write(JsonWriter& json, const FaultGuarantee& guarantee) {
  json.begin_object().member("fault", guarantee.fault + 1).member("delay", guarantee.delay);
  json.member("half_width", guarantee.half_width).end_object();
}

/// What can be said only where the data tell the true mode.
void write_scores(JsonWriter& json, const DiagnosisOutcome& outcome) {
  json.key("scores");
  if (!outcome.truth_known) {
    json.null();
    return;
  }
  json.begin_object(Layout::lines).member("false_alarms", outcome.false_alarms);
  json.member("runs_with_false_alarm", outcome.runs_with_false_alarm)
      .member("runs_with_wrong_mode", outcome.runs_with_wrong_mode);
  write_rate(json, "false_alarm_rate", outcome.runs_with_false_alarm, outcome.runs);
  write_rate(json, "wrong_mode_rate", outcome.runs_with_wrong_mode, outcome.runs);
  write_list(json, "modes", outcome.statistics, outcome.modes);
  json.key("true_mode_excluded");
  if (const auto& excluded = outcome.true_mode_excluded) {
    json.begin_object().member("k", excluded->k).member("since", excluded->since);
    write_mode(json, "mode", outcome.modes, excluded->mode);
    json.member("seed_offset", excluded->seed_offset).end_object();
  } else {
    json.null();
  }
  json.end_object();
}

}  // namespace

void write(JsonWriter& json, const DiagnosisEvent& event, const Names& modes) {
  using Kind = DiagnosisEvent::Kind;
  json.begin_object().member("k", event.k).member("what", to_string(event.what));
  write_mode(json, "mode", modes, event.mode);
  if (event.what == Kind::detected || event.what == Kind::excluded ||
      event.what == Kind::left_open) {
    json.key("evidence");
    write(json, event.evidence);
  }
  if (event.estimate.dim() > 0) write_box(json, "estimate", event.estimate);
  if (!event.faults.empty()) {
    json.key("faults").begin_array();
    for (const FaultBound& bound : event.faults) write(json, JudgedBound{bound, {}});
    json.end_array();
  }
  json.end_object();
}

void write_mode(JsonWriter& json, std::string_view key, const Names& modes, Index mode) {
  json.key(key);
  const auto at = static_cast<std::size_t>(mode);
  mode >= 0 && at < modes.size() ? json.value(std::string_view(modes[at])) : json.null();
}

void write_delays(JsonWriter& json, std::string_view key, const DelayStatistics& delays) {
  json.key(key);
  if (delays.count == 0) {
    json.null();
    return;
  }
  json.begin_object()
      .member("min", delays.min)
      .member("median", delays.median)
      .member("max", delays.max)
      .end_object();
}

void write(JsonWriter& json, const ModeEvidence& evidence) {
  json.begin_object()
      .member("candidate", evidence.candidate)
      .member("consistent", to_string(evidence.consistent));
  if (evidence.residual.dim() > 0) write_box(json, "residual", evidence.residual);
  if (evidence.reset_residual.dim() > 0) write_box(json, "reset_residual", evidence.reset_residual);
  if (!evidence.left_open.empty()) json.member("left_open", evidence.left_open);
  if (evidence.why.kind != Certificate::Kind::none) {
    json.key("proof");
    write(json, evidence.why);
  }
  json.end_object();
}

void write(JsonWriter& json, const Diagnosis& diagnosis, const std::optional<Index>& truth,
           const std::vector<JudgedBound>& faults, const Names& modes) {
  json.begin_object().member("k", diagnosis.k).member("decision", to_string(diagnosis.decision));
  write_mode(json, "mode", modes, diagnosis.mode);
  if (truth) write_mode(json, "true_mode", modes, *truth);
  json.member("since", diagnosis.since).member("reset", diagnosis.reset);
  write_mode(json, "suggested", modes, diagnosis.suggested);
  json.key("modes").begin_array();
  for (const ModeEvidence& evidence : diagnosis.modes) write(json, evidence);
  json.end_array();
  if (!diagnosis.restarts.empty()) {
    json.key("restarts").begin_array();
    for (const LineForm& set : diagnosis.restarts) write(json, set);
    json.end_array();
  }
  if (!faults.empty()) {
    json.key("faults").begin_array();
    for (const JudgedBound& judged : faults) write(json, judged);
    json.end_array();
  }
  json.end_object();
}

void write_members(JsonWriter& json, const DiagnosisOutcome& outcome) {
  json.member("runs", outcome.runs).member("steps_of_all_runs", outcome.steps);
  write_list(json, "events", outcome.events, outcome.modes);
  json.key("last_state");
  if (const auto& state = outcome.last_state) {
    json.begin_object().member("k", state->k);
    write_mode(json, "mode", outcome.modes, state->mode);
    json.member("since", state->since);
    write_box(json, "hull", state->hull);
    json.end_object();
  } else {
    json.null();
  }
  write_list(json, "segments", outcome.segments, outcome.modes);
  json.member("left_out", outcome.left_out);
  write_scores(json, outcome);
  json.key("faults").begin_array(outcome.faults.empty() ? Layout::line : Layout::lines);
  for (const FaultStatistics& counts : outcome.faults) write(json, counts);
  json.end_array().key("fault_outside");
  if (const auto& outside = outcome.fault_outside) {
    json.begin_object()
        .member("k", outside->k)
        .member("at", outside->at)
        .member("fault", outside->fault + 1);
    json.member("seed_offset", outside->seed_offset).end_object();
  } else {
    json.null();
  }
}

void write(JsonWriter& json, const Guarantees& guarantees, const Names& modes) {
  json.begin_object(Layout::lines)
      .member("method", guarantees.method)
      .member("all", to_string(guarantees.all));
  json.key("pairs").begin_array(guarantees.pairs.empty() ? Layout::line : Layout::lines);
  for (const PairGuarantee& pair : guarantees.pairs) {
    json.begin_object();
    write_mode(json, "observer", modes, pair.observer);
    write_mode(json, "true_mode", modes, pair.mode);
    write_box(json, "residual", pair.residual);
    if (pair.iterated.dim() > 0) write_box(json, "iterated", pair.iterated);
    json.member("holds", to_string(pair.holds)).end_object();
  }
  json.end_array().key("error_set");
  if (const auto& check = guarantees.error_set) {
    json.begin_object().member("computed", check->computed).member("factor", check->factor);
    json.member("steady_factor", check->steady_factor);
    write_mode(json, "true_mode", modes, check->mode);
    write_mode(json, "observer", modes, check->observer);
    json.key("set");
    write(json, check->set);
    json.end_object();
  } else {
    json.null();
  }
  json.key("faults").begin_array();
  for (const FaultGuarantee& guarantee : guarantees.faults) write(json, guarantee);
  json.end_array().end_object();
}

void write(JsonWriter& json, const DiagnosisAssumptions& assumed, const Names& modes) {
  json.begin_object(Layout::lines);
  write_mode(json, "known_mode", modes, assumed.known_mode.value_or(-1));
  json.key("modes").begin_array(Layout::lines);
  for (const ModeAssumptions& mode : assumed.modes) {
    json.begin_object().key("initial_set");
    write(json, mode.initial_set);
    for (const auto& [key, set] :
         {std::pair("restart_set", &mode.restart_set), {"admissible_set", &mode.admissible_set}}) {
      if (!*set) continue;
      json.key(key);
      write(json, **set);
    }
    json.end_object();
  }
  json.end_array().end_object();
}

}  // namespace cordon::detail

namespace cordon {

std::string_view to_string(DiagnosisEvent::Kind kind) noexcept {
  switch (kind) {
    case DiagnosisEvent::Kind::truth:
      return "truth";
    case DiagnosisEvent::Kind::starts:
      return "starts";
    case DiagnosisEvent::Kind::detected:
      return "detected";
    case DiagnosisEvent::Kind::excluded:
      return "excluded";
    case DiagnosisEvent::Kind::isolated:
      return "isolated";
    case DiagnosisEvent::Kind::resumed:
      return "resumed";
    case DiagnosisEvent::Kind::isolating:
      return "isolating";
    case DiagnosisEvent::Kind::ambiguous:
      return "ambiguous";
    case DiagnosisEvent::Kind::unknown_fault:
      return "unknown_fault";
    case DiagnosisEvent::Kind::left_open:
      return "left_open";
  }
  return "truth";
}

std::string json_of(const DiagnosisOutcome& outcome) {
  detail::StringSink sink;
  detail::JsonWriter json(sink);
  json.begin_object();
  detail::write_members(json, outcome);
  json.end_object();
  return sink.text;
}

std::string json_of(const Guarantees& guarantees, const std::vector<std::string>& modes) {
  detail::StringSink sink;
  detail::JsonWriter json(sink);
  detail::write(json, guarantees, modes);
  return sink.text;
}

}  // namespace cordon
