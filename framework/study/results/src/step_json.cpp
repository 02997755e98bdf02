// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/step_json.hpp"

#include "outcome_json.hpp"
#include "study/results/recorded_view.hpp"
#include "study/results/results_parts.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

void write_members(JsonWriter& json, const Estimate& estimate, const Box& hull,
                   const std::optional<Box>& inner, const std::vector<Index>& left_out) {
  json.member("k", estimate.k);
  write_box(json, "hull", hull);
  if (inner) write_box(json, "inner", *inner);
  if (!left_out.empty()) write_outputs(json, "left_out", left_out);
  json.member("consistent", to_string(estimate.consistent))
      .member("tightness", to_string(estimate.set.tightness));
}

std::string set_json(const Estimate& estimate, const Box& hull,
                     const std::vector<Certificate>& hull_proofs, std::string_view pipeline) {
  const View X = recorded_view(*estimate.set, hull);
  StringSink line;
  JsonWriter json(line);
  json.begin_object().key("pipeline").raw(pipeline).member("k", estimate.k);
  json.member("tightness", to_string(estimate.set.tightness));
  json.member("exchange", to_string(X.claim));
  write_blocks(json, X.form);
  if (X.rows.rows() > 0) json.key("H").matrix(X.rows.H).member("h", X.rows.h);
  json.member("consistent", to_string(estimate.consistent));
  json.key("proof");
  write(json, estimate.why);
  if (estimate.consistent != Answer::no) {
    json.key("hull_proofs").begin_array();
    for (const Certificate& proof : hull_proofs) write(json, proof);
    json.end_array();
  }
  json.end_object();
  return std::move(line.text);
}

}  // namespace cordon::detail
