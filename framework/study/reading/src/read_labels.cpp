// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>

#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_label = 60;  // bytes
constexpr const char* names_form =
    "{\"states\": [\"level [m]\"], \"inputs\": [\"inflow [L/s]\"], \"outputs\": [\"gauge [m]\"]}";

/// A list of names, one per coordinate.
Labels::Names read_label_list(const Cursor& at, const std::string& noun, std::optional<Index> size,
                              const std::string& of) {
  Labels::Names names;
  if (!at.expect(Kind::array, "write a list of texts, one per " + noun)) return names;
  if (size && static_cast<Index>(at.size()) != *size) {
    at.error("has " + counted(static_cast<Index>(at.size()), "name") + ", must have " +
                 std::to_string(*size) + ", one per " + noun + " (" + of + ")",
             "name each of them, or leave the list out");
    return names;
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    const auto name = read_line(item, max_label);
    if (!name) continue;
    if (name->empty() || name->front() == ' ' || name->back() == ' ') {
      item.error(name->empty() ? "is empty" : "begins or ends with a space",
                 "write a name and perhaps a unit in brackets, \"level [m]\"");
    } else if (!seen.insert(*name).second) {
      item.error("repeats the name " + in_quotes(*name), "call every " + noun + " otherwise");
    }
    names.push_back(*name);
  }
  return names;
}

}  // namespace

Labels read_labels(const Cursor& system, const LabelSizes& sizes) {
  Labels labels;
  if (const auto at = system.find("sampling_time")) {
    const auto time = read_number(*at);
    if (time && !(*time > 0))
      at->error("must be larger than 0", "give the seconds from k to k + 1");
    if (time && *time > 0) labels.sampling_time = *time;
  }
  const auto names = system.find("names");
  if (!names ||
      !names->expect_keys({"states", "inputs", "outputs", "disturbances", "noises", "faults"},
                          "kind of names", names_form))
    return labels;
  const auto read = [&](const char* key, const char* noun, std::optional<Index> size,
                        const char* of) {
    const auto at = names->find(key);
    return at ? read_label_list(*at, noun, size, of) : Labels::Names{};
  };
  labels.states = read("states", "state", sizes.states, "row of A");
  labels.inputs = read("inputs", "input", sizes.inputs, "column of B");
  labels.outputs = read("outputs", "output", sizes.outputs, "row of C");
  labels.disturbances =
      read("disturbances", "disturbance", sizes.disturbances, "column of Bw, n without Bw");
  labels.noises = read("noises", "noise", sizes.noises, "column of Dv, one per output without Dv");
  labels.faults = read("faults", "additive fault", sizes.faults, "column of F");
  return labels;
}

}  // namespace cordon::json
