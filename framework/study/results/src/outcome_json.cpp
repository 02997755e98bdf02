// SPDX-License-Identifier: GPL-3.0-or-later
#include "outcome_json.hpp"

#include <cmath>

#include "study/results/results_parts.hpp"

namespace cordon::detail {

using Layout = JsonWriter::Layout;

void write(JsonWriter& json, const std::vector<Gain>& gains) {
  json.key("gains").begin_array(gains.empty() ? Layout::line : Layout::lines);
  for (const Gain& gain : gains) {
    const GainCertificate& known = gain.certificate;
    json.begin_object()
        .member("name", gain.name)
        .member("type", gain.type)
        .key("matrix")
        .matrix(gain.L);
    json.member("spectral_radius", known.spectral_radius).key("monotone");
    known.monotone == Answer::unknown ? json.null() : json.value(known.monotone == Answer::yes);
    json.key("norm");
    if (std::isnan(known.norm_lower) && std::isnan(known.norm_upper)) {
      json.null();
    } else {
      json.begin_object()
          .member("lower", known.norm_lower)
          .member("upper", known.norm_upper)
          .end_object();
    }
    if (!known.objective.empty()) {
      json.member("objective", known.objective).member("optimum", known.optimum);
      json.member("optimum_bound", known.optimum_bound).member("margin", known.margin);
    }
    json.end_object();
  }
  json.end_array();
}

void write_last(JsonWriter& json, Index k, const Box& hull) {
  json.key("last");
  if (hull.dim() == 0) {
    json.null();
    return;
  }
  json.begin_object().member("k", k);
  write_box(json, "hull", hull);
  json.key("width");
  hull.is_empty() ? json.null() : json.value(Vector(hull.upper - hull.lower));
  json.end_object();
}

void write_inner(JsonWriter& json, const EstimationOutcome& outcome) {
  json.member("inner_steps", outcome.inner_steps);
  json.member("inner_share", outcome.inner_steps > 0 ? outcome.inner_share : std::nan(""));
  write_time(json, "inner_outside", outcome.inner_outside);
}

void write_growth(JsonWriter& json, const EstimationOutcome& outcome) {
  json.key("growth");
  if (!outcome.growth) {
    json.null();
    return;
  }
  const WidthGrowth& growth = *outcome.growth;
  json.begin_object().member("state", growth.state + 1).member("smallest", growth.smallest);
  json.member("smallest_at", growth.smallest_at)
      .member("last", growth.last)
      .member("factor", growth.factor);
  json.member("advice", advice_on(growth)).end_object();
}

void write_outputs(JsonWriter& json, const char* name, const std::vector<Index>& outputs) {
  json.key(name).begin_array();
  for (const Index output : outputs) json.value(output + 1);
  json.end_array();
}

namespace {

/// The members output and distance, null where no output contradicts by itself.
void write_worst(JsonWriter& json, const Contradiction& found) {
  const bool any = found.output >= 0;
  json.key("output");
  any ? json.value(found.output + 1) : json.null();
  json.key("distance");
  any ? json.value(found.distance) : json.null();
}

}  // namespace

void write_contradictions(JsonWriter& json, const EstimationOutcome& outcome) {
  if (outcome.contradiction) {
    json.key("contradiction").begin_object().member("k", outcome.contradiction->k);
    write_worst(json, *outcome.contradiction);
    if (outcome.contradiction->before) json.member("before", true);
    json.end_object();
  }
  if (outcome.restarts > 0) json.member("restarts", outcome.restarts);
  if (outcome.not_enclosed > 0) {
    json.key("not_enclosed").begin_object().member("times", outcome.not_enclosed);
    json.member("from", outcome.not_enclosed_from).member("reason", outcome.why_not_enclosed);
    json.end_object();
  }
  if (outcome.outliers == 0) return;
  json.key("outliers").begin_object().member("samples", outcome.outliers);
  json.key("left_out").begin_array(JsonWriter::Layout::lines);
  for (const LeftOut& one : outcome.left_out) {
    json.begin_object().member("k", one.worst.k);
    write_outputs(json, "outputs", one.outputs);
    write_worst(json, one.worst);
    json.end_object();
  }
  json.end_array().end_object();
}

}  // namespace cordon::detail
