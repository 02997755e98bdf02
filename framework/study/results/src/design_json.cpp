// SPDX-License-Identifier: GPL-3.0-or-later
#include "design_json.hpp"

#include <cmath>

#include "study/results/diagnosis_json.hpp"
#include "study/results/results_parts.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace {

using Layout = JsonWriter::Layout;

void text_or_null(JsonWriter& json, std::string_view key, const std::string& text) {
  json.key(key);
  text.empty() ? json.null() : json.value(text);
}

void write_pair(JsonWriter& json, const ModeNames& modes, Index i, Index j) {
  json.key("modes").begin_array();
  for (const Index mode : {i, j})
    json.value(std::string_view(modes.at(static_cast<std::size_t>(mode))));
  json.end_array();
}

void write_tubes(JsonWriter& json, const InputDesign& design, const ModeNames& modes) {
  json.key("tubes").begin_array(Layout::lines);
  for (std::size_t i = 0; i < design.empty.size(); ++i) {
    json.begin_object();
    write_mode(json, "mode", modes, static_cast<Index>(i));
    json.member("empty", to_string(design.empty[i]));
    write_box(json, "outputs", design.outputs[i]);
    json.end_object();
  }
  json.end_array();
}

/// What is known of the input; null without one.
void write_best(JsonWriter& json, const DesignOutcome& outcome, const ModeNames& modes) {
  if (!outcome.best) {
    for (const char* key : {"cost", "u", "separates", "pairs", "tubes"}) json.key(key).null();
    return;
  }
  const InputDesign& design = *outcome.best;
  json.member("cost", design.cost)
      .key("u")
      .matrix(design.u)
      .member("separates", to_string(design.separates()));
  json.key("pairs").begin_array(Layout::lines);
  for (const PairSeparation& pair : design.pairs) {
    json.begin_object();
    write_pair(json, modes, pair.i, pair.j);
    json.member("kappa", pair.kappa)
        .member("kappa_lower", pair.kappa_lower)
        .member("disjoint", to_string(pair.disjoint));
    json.key("proof");
    write(json, pair.why);
    json.end_object();
  }
  json.end_array();
  write_tubes(json, design, modes);
}

}  // namespace

void write(JsonWriter& json, const DesignOutcome& outcome, const ModeNames& modes) {
  json.begin_object(Layout::lines)
      .member("status", to_string(outcome.status))
      .member("horizon", outcome.horizon);
  json.member("epsilon", outcome.epsilon)
      .member("outputs", outcome.last_output_only ? "last" : "all")
      .key("admissible_set");
  outcome.admissible_set ? write(json, *outcome.admissible_set) : void(json.null());
  write_best(json, outcome, modes);
  json.member("lower_bound", outcome.lower_bound).key("restriction");
  if (const auto& restriction = outcome.restriction) {
    json.begin_object()
        .member("problem", restriction->name)
        .member("lower_bound", restriction->lower_bound)
        .end_object();
  } else {
    json.null();
  }
  json.member("gap", std::isfinite(outcome.gap()) ? outcome.gap() : not_available)
      .member("stopped", outcome.stopped);
  text_or_null(json, "reason", outcome.reason);
  text_or_null(json, "suggestion", outcome.suggestion);
  json.key("tried").begin_array(outcome.tried.empty() ? Layout::line : Layout::lines);
  for (const HorizonTrial& trial : outcome.tried) {
    json.begin_object().member("horizon", trial.horizon).member("status", to_string(trial.status));
    text_or_null(json, "reason", trial.reason);
    json.end_object();
  }
  json.end_array()
      .key("search")
      .begin_object()
      .member("nodes", outcome.nodes)
      .member("programs", outcome.programs);
  json.member("facets", outcome.facets).end_object().end_object();
}

void write(JsonWriter& json, const ExactSeparation& exact, const ModeNames& modes) {
  json.begin_object(Layout::lines)
      .member("separates", to_string(exact.separates()))
      .key("pairs")
      .begin_array(Layout::lines);
  for (const ExactPair& pair : exact.pairs) {
    json.begin_object();
    write_pair(json, modes, pair.i, pair.j);
    json.member("disjoint", to_string(pair.disjoint));
    json.member("kappa_lower", pair.disjoint == Answer::yes ? pair.kappa_lower : not_available);
    text_or_null(json, "reason", pair.reason);
    json.end_object();
  }
  json.end_array().key("tubes").begin_array(Layout::lines);
  for (std::size_t i = 0; i < exact.empty.size(); ++i) {
    json.begin_object();
    write_mode(json, "mode", modes, static_cast<Index>(i));
    json.member("empty", to_string(exact.empty[i])).end_object();
  }
  json.end_array().end_object();
}

void write(JsonWriter& json, const std::vector<ExperimentRow>& experiments,
           const ModeNames& modes) {
  json.begin_array(experiments.empty() ? Layout::line : Layout::lines);
  for (const ExperimentRow& row : experiments) {
    json.begin_object();
    write_mode(json, "mode", modes, row.mode);
    json.member("runs", row.runs).key("possible").begin_array();
    for (const std::int64_t count : row.possible) json.value(count);
    json.end_array().member("isolated", row.isolated).member("wrong", row.wrong);
    json.member("unknown_fault", row.unknown_fault).member("undecided", row.undecided);
    write_delays(json, "isolation", row.isolation);
    json.end_object();
  }
  json.end_array();
}

}  // namespace cordon::detail

namespace cordon {

namespace {

template <class Item>
std::string text_of(const Item& item, const std::vector<std::string>& modes) {
  detail::StringSink sink;
  detail::JsonWriter json(sink);
  detail::write(json, item, modes);
  return sink.text;
}

}  // namespace

std::string json_of(const DesignOutcome& outcome, const std::vector<std::string>& modes) {
  return text_of(outcome, modes);
}

std::string json_of(const ExactSeparation& exact, const std::vector<std::string>& modes) {
  return text_of(exact, modes);
}

}  // namespace cordon
