// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "study/reading/sweep_path.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/json_text.hpp"

namespace cordon::json {

/// What stands at the path of `at`, which leads to one place; null: nothing does, and it is
/// reported there.
const Value* value_at(const Value& tree, const SweepPath& path, const Cursor& at);

/// How many values it is made of, itself included.
std::size_t count_of(const Value& value);

/// A value times a factor: a number, every number of lists (a matrix), or a set about its centre,
/// of type box, zonotope, constrained_zonotope or line_zonotope. Nothing for others; `problem` says
/// why.
std::optional<Value> scaled(const Value& value, double factor, std::string& problem);

}  // namespace cordon::json
