// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of a study file: JSON to exchange form.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cordon/core/line_form.hpp"
#include "cordon/interfaces/model.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// The names a set may have as its "type".
const std::vector<std::string>& set_types();

/// The set at this place. Reports anything wrong; a set that is proven empty is an error. If
/// emptiness cannot be decided, the set is returned and `warnings` tells.
std::optional<LineForm> read_set(const Cursor& at, std::vector<std::string>& warnings);

/// {"lower": [...], "upper": [...]}: the bounds as they are written, "inf" and "-inf" among them.
/// `dim`: like what is named, if it is known.
std::optional<Box> read_plain_box(const Cursor& at, std::optional<Index> dim,
                                  const std::string& like);

/// {"states": box, "inputs": box, "nonlinear_outputs": true}, inputs where there are some.
std::optional<ValidRegion> read_region(const Cursor& at, std::optional<Index> states,
                                       std::optional<Index> inputs);

/// {x : lower ≤ x ≤ upper, H x ≤ h} with finite bounds, as a constrained zonotope: the box's
/// generators and one more generator and constraint per row, H_i (c + G ξ) + s_i = h_i with the
/// slack s_i ∈ [0, h_i - min H_i x]. The slack's interval is widened by the rounding errors of its
/// row, so that the set is enclosed. ∅ if a half-space is proven to miss the box. [Scott2016, Thm
/// 1]
LineForm make_polytope(const Box& box, MatrixIn H, VectorIn h);

}  // namespace cordon::json
