// SPDX-License-Identifier: GPL-3.0-or-later
// Where the values of an axis of a sweep go, and how they get there.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/registry/registry.hpp"
#include "study/text/json_text.hpp"

namespace cordon::json {

/// A key of an object, an index into an array, or every element of an array ("*").
struct PathStep {
  std::string key;
  bool every = false;
};

/// A JSON pointer into a study with "*" for every element of an array.
struct SweepPath {
  std::string text;
  std::vector<PathStep> steps;
  /// Does a value there change what stands at `pointer`, or below it?
  bool leads_to(std::string_view pointer) const;
  /// Is `pointer` itself one of the places?
  bool ends_at(std::string_view pointer) const;
  /// Can the two write the same place, or one inside the other?
  bool meets(const SweepPath& other) const;
  bool is_type() const { return steps.back().key == "type"; }
};

/// The steps of a JSON pointer; none if the text is not one.
std::optional<std::vector<PathStep>> path_steps(std::string_view text);
/// The index that a step stands for, if it is one.
std::optional<std::size_t> step_index(const std::string& key);

/// A tree with a value in every place that a path matches.
struct Placement {
  Value tree;
  bool reported =
      false;  ///< nothing is matched, but a broken value or an unknown component may be the reason
  std::size_t places = 0;           ///< that were written
  std::string problem, suggestion;  ///< why it could not be put there
};

/// Puts `value` into every place of `tree` that `path` matches. A parameter that is absent is
/// added; components that "*" matches and that do not have the parameter are left as they are. The
/// name of a component becomes an object where parameters are added. Only what is on the way is
/// copied.
Placement place(const Value& tree, const SweepPath& path, const Value& value,
                const Registry& registry);

}  // namespace cordon::json
