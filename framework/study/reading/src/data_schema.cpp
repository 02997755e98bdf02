// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON Schema of /data.
#include "schema_parts.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon::schema_parts {

namespace {

Json additive_faults() {
  const Json time = integer(0, static_cast<std::int64_t>(json::max_integer));
  Json properties;
  properties["fault"] =
      described(integer(1, json::max_dimension), "number of a column of F, from 1 on");
  properties["from"] = described(time, "the first k at which the fault acts");
  properties["from"]["default"] = 0;
  properties["to"] = described(time, "the last such k; the end by default");
  properties["signal"] =
      described(reference("signal"), "the value at k; entries of the same fault add up");
  return list_of(object(properties, {"fault", "signal"}));
}

/// The times and outputs of dropouts and outliers.
Json drawn_outputs(const char* spared) {
  const Json time = integer(0, static_cast<std::int64_t>(json::max_integer));
  Json properties;
  properties["outputs"] = described(
      Json{{"type", "array"}, {"items", integer(1, json::max_dimension)}, {"minItems", 1}},
      "numbers of rows of C, from 1 on; all by default");
  properties["from"] = described(time, "the first k that this is about");
  properties["from"]["default"] = 0;
  properties["to"] = described(time, "the last such k; the end by default");
  properties["probability"] =
      described(Json{{"type", "number"}, {"minimum", 0}, {"maximum", 1}, {"default", 1}},
                "of every output at every step, each by itself");
  properties["every"] = described(integer(1, static_cast<std::int64_t>(json::max_integer)), spared);
  return properties;
}

Json dropouts() {
  return list_of(
      object(drawn_outputs("the outputs are there at every so many steps from `from` on"), {}));
}

Json outliers() {
  Json properties = drawn_outputs("the outputs are right at every so many steps from `from` on");
  properties["shift"] =
      described(Json{{"type", "number"}}, "by how much the output is too large or too small");
  return list_of(object(properties, {"shift"}));
}

}  // namespace

Json data() {
  Json simulate;
  simulate["steps"] = described(integer(1, 1'000'000'000), "samples k = 0 ... steps");
  simulate["seed"] = integer(0, static_cast<std::int64_t>(json::max_integer));
  simulate["seed"]["default"] = 1;
  simulate["seeds"] =
      described(integer(1, 100'000), "diagnosers are tried on so many seeds, from seed on");
  simulate["seeds"]["default"] = 1;
  simulate["noise"] = one_of(json::noise_names());
  simulate["noise"]["default"] = "uniform";
  simulate["parameters"] = described(one_of(json::parameter_draw_names()),
                                     "whether uncertain matrices are drawn once or at every step");
  simulate["parameters"]["default"] = "constant";
  simulate["x0"] = described(
      Json{{"anyOf", {reference("vector"), reference("set")}}},
      "initial state, or a bounded set that it is drawn from; the centre of X0 by default");
  simulate["input"] = described(list_of(reference("signal")), "one signal per column of B");
  simulate["plant"] =
      described(Json{{"anyOf", {reference("plant"), reference("nonlinear_system")}}},
                "makes the data in place of the system: a plant, or a system by formulas");
  simulate["faults"] =
      described(list_of(reference("fault")), "in the order of time, without overlap");
  simulate["additive_faults"] =
      described(additive_faults(), "values of the faults in the directions of F; 0 otherwise");
  simulate["dropouts"] = described(dropouts(), "outputs that are missing in samples");
  simulate["outliers"] = described(outliers(), "outputs that are wrong in samples");
  const Json names{{"type", "array"}, {"items", text(4096)}, {"uniqueItems", true}};
  Json csv;
  csv["file"] = described(text(4096), "relative to the folder of the study");
  csv["inputs"] = described(names, "columns of u, one per column of B");
  csv["outputs"] = described(names, "columns of y, one per row of C");
  csv["truth"] = described(names, "columns of the true state, one per row of A");
  csv["mode"] =
      described(text(4096), "column with the name of the true mode, empty outside the bank");
  csv["missing"] = described(one_of(json::missing_value_names()),
                             "what outputs without a value, empty fields or NaN, are: an error, or "
                             "missing in the sample");
  csv["missing"]["default"] = "error";
  csv["time"] = described(text(4096),
                          "column of times in seconds, of steps of /system's "
                          "sampling_time");
  csv["irregular"] = described(one_of(json::irregular_rows_names()),
                               "rows that leave steps out: an error, or steps without outputs");
  csv["irregular"]["default"] = "error";
  return {{"oneOf",
           {object({{"simulate", object(simulate, {})}}, {"simulate"}),
            object({{"csv", object(csv, {"file", "outputs"})}}, {"csv"})}}};
}

}  // namespace cordon::schema_parts
