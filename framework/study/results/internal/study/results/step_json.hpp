// SPDX-License-Identifier: GPL-3.0-or-later
// One step of an observer as JSON.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/interfaces/observer.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

/// The members k, hull, inner, left_out, consistent and tightness of a step in results.json, inside
/// an open object.
void write_members(JsonWriter& json, const Estimate& estimate, const Box& hull,
                   const std::optional<Box>& inner, const std::vector<Index>& left_out);

/// A line of sets.jsonl, without its end. `pipeline`: its name, as JSON.
std::string set_json(const Estimate& estimate, const Box& hull,
                     const std::vector<Certificate>& hull_proofs, std::string_view pipeline);

}  // namespace cordon::detail
