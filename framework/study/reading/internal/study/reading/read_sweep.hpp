// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep of a study file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/reading/sweep_path.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// An axis of a sweep as it is written.
struct WrittenAxis {
  std::string name;
  std::vector<SweepPath> paths;          ///< at least one; none meets another one
  bool together = false;                 ///< a list of paths: each value is a list, one per path
  std::vector<Value> values;             ///< at least one
  std::vector<std::string> labels = {};  ///< one per value, or none
  bool repeat = false;
  bool range = false;   ///< written as a range
  std::string pointer;  ///< of the axis
  int path_line = 0;

  /// What the i-th value puts at the j-th path.
  const Value& value(std::size_t i, std::size_t j) const;
  bool leads_to(std::string_view place) const;
  bool ends_at(std::string_view place) const;
  bool meets(const WrittenAxis& other) const;
  /// The path, or the list of them as JSON.
  std::string path_text() const;
};

/// The same of a resolved study, whose "path" stands at `at`.
std::string resolved_path_text(const Cursor& at);

/// Why no axis may write there; empty: it may.
std::string why_not_varied(const std::vector<PathStep>& steps);

/// Reads /sweep: none if there is no such key, or if anything is wrong with it. Two axes do not
/// meet, no value comes twice, and there are at most 10 million points.
std::vector<WrittenAxis> read_sweep(const Cursor& root);

/// `tree` with the value of each axis in its places, the types of components first: `at` are
/// indices of values. What cannot be put where it belongs is reported at the path of its axis.
Value substituted(const Value& tree, const std::vector<WrittenAxis>& axes,
                  const std::vector<std::size_t>& at, const Registry& registry, Problems& problems);

/// A value as JSON on one line, with numbers in their shortest form and without comments.
std::string canonical_text(const Value& value);
/// The same for values that are equal, whatever the order of their keys.
std::string text_to_compare(const Value& value);

}  // namespace cordon::json
