// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_dropouts = 10'000;
constexpr const char* dropout_form = "{\"outputs\": [1], \"probability\": 0.3}";
constexpr const char* outlier_form = "{\"outputs\": [1], \"probability\": 0.02, \"shift\": 5}";

std::vector<Index> all_of(std::optional<Index> outputs) {
  std::vector<Index> all;
  for (Index i = 0; i < outputs.value_or(0); ++i) all.push_back(i);
  return all;
}

/// Rows of C, counted from 1.
std::vector<Index> read_outputs(const Cursor& at, std::optional<Index> outputs) {
  std::vector<Index> read;
  if (!at.expect(Kind::array, "a list of outputs, the numbers of rows of /system/C from 1 on"))
    return read;
  if (at.size() == 0) at.error("is an empty list", "leave it out for all outputs");
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    const auto number = read_integer(item, 1, max_dimension);
    if (!number) continue;
    const Index output = static_cast<Index>(*number) - 1;
    if (outputs && output >= *outputs) {
      item.error("there is no output " + std::to_string(*number) + ": /system/C has " +
                     counted(*outputs, "row"),
                 "outputs are counted from 1");
    } else if (std::find(read.begin(), read.end(), output) != read.end()) {
      item.error("names output " + std::to_string(*number) + " a second time");
    } else {
      read.push_back(output);
    }
  }
  return read;
}

/// The keys of a dropout are there and known.
DropoutSpec read_drawn(const Cursor& at, std::optional<Index> outputs, std::int64_t steps,
                       std::vector<std::string>& warnings) {
  DropoutSpec dropout;
  const auto list = at.find("outputs");
  dropout.outputs = list ? read_outputs(*list, outputs) : all_of(outputs);
  read_times(at, steps, dropout.from, dropout.to, warnings);
  if (const auto every = at.find("every"))
    dropout.every = read_integer(*every, 1, max_integer).value_or(0);
  if (const auto probability = at.find("probability")) {
    dropout.probability = read_number(*probability).value_or(1);
    if (!(dropout.probability >= 0 && dropout.probability <= 1))
      probability->error("is no probability", "give a number from 0 to 1");
  }
  return dropout;
}

/// A list of so many things at most.
bool expect_list(const Cursor& list, const std::string& noun, const char* form) {
  if (!list.expect(Kind::array, "a list of " + noun + ": [" + form + "]")) return false;
  if (list.size() <= max_dropouts) return true;
  list.error("holds more than " + std::to_string(max_dropouts) + " " + noun);
  return false;
}

}  // namespace

void read_outliers(const Cursor& list, std::optional<Index> outputs, SimulateSpec& spec,
                   std::vector<std::string>& warnings) {
  if (!expect_list(list, "outliers", outlier_form)) return;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Cursor at = list.item(i);
    if (!at.expect_keys({"outputs", "from", "to", "probability", "every", "shift"},
                        "key of outliers", outlier_form))
      continue;
    OutlierSpec& outlier =
        spec.outliers.emplace_back(OutlierSpec{read_drawn(at, outputs, spec.steps, warnings), 0});
    if (const auto shift = at.need("shift", "by how much the output is wrong, up or down"))
      outlier.shift = read_number(*shift).value_or(0);
  }
}

void read_dropouts(const Cursor& list, std::optional<Index> outputs, SimulateSpec& spec,
                   std::vector<std::string>& warnings) {
  if (!expect_list(list, "dropouts", dropout_form)) return;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Cursor at = list.item(i);
    if (at.expect_keys({"outputs", "from", "to", "probability", "every"}, "key of a dropout",
                       dropout_form))
      spec.dropouts.push_back(read_drawn(at, outputs, spec.steps, warnings));
  }
}

}  // namespace cordon::json
