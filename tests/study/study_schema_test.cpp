// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON Schema of studies knows what a study may hold.
#include <algorithm>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/registry/registry.hpp"
#include "cordon/study/study.hpp"
#include "study/fakes.hpp"

using namespace cordon;
using namespace study_test;

TEST_CASE("the JSON Schema knows sections, components and limits") {
  Registry registry;
  registry.add(register_fakes);
  const auto schema = nlohmann::json::parse(study_json_schema(registry));
  CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema["additionalProperties"] == false);
  CHECK(schema["required"] == nlohmann::json({"cordon", "system", "pipelines"}));
  const auto& defs = schema["$defs"];
  const auto find = [](const nlohmann::json& list, const std::string& type) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& s) {
      return s.contains("properties") && s["properties"]["type"]["const"] == type;
    });
    REQUIRE(found != list.end());
    return *found;
  };
  const auto descriptor = find(defs["observer"]["oneOf"], "descriptor");
  CHECK(descriptor["properties"]["max_generators"]["minimum"] == 1);
  CHECK(descriptor["properties"]["max_generators"]["default"] == 100);
  CHECK(descriptor["properties"]["initial_set"]["$ref"] == "#/$defs/set");
  CHECK(descriptor["additionalProperties"] == false);
  CHECK(descriptor["required"] == nlohmann::json({"type"}));
  CHECK(find(defs["observer"]["oneOf"], "all_kinds")["required"] ==
        nlohmann::json({"type", "gain"}));
  CHECK(find(defs["backend"]["oneOf"], "zonotope")["properties"]["strip"]["enum"] ==
        nlohmann::json({"segments", "volume"}));
  CHECK(defs["metric"]["oneOf"].back()["enum"] ==
        nlohmann::json(
            {"complexity", "contains_truth", "radius", "step_time", "tightness", "volume"}));
  CHECK(find(defs["system"]["oneOf"], "descriptor")["required"] ==
        nlohmann::json({"type", "E", "A", "C"}));
  CHECK(defs["set"]["oneOf"].size() == 9);  // eight types, the polytope in two forms
  CHECK(defs["signal"]["oneOf"].size() == 7);
  CHECK(find(defs["system"]["oneOf"], "lti")["properties"]["modes"]["items"]["$ref"] ==
        "#/$defs/mode");
  CHECK_FALSE(find(defs["mode_system"]["oneOf"], "lti")["properties"].contains("modes"));
  CHECK(defs["mode"]["required"] == nlohmann::json({"name"}));
  CHECK(defs["fault"]["oneOf"].size() == 2);
  const auto bank = find(defs["diagnoser"]["oneOf"], "observer_bank");
  CHECK(bank["properties"]["observer"]["$ref"] == "#/$defs/observer");
  CHECK(bank["properties"]["gains"]["items"]["$ref"] == "#/$defs/matrix");
  CHECK(bank["required"] == nlohmann::json({"type", "observer", "waiting_time"}));
  CHECK(find(defs["plant"]["oneOf"], "reactor")["properties"]["tempo"]["default"] == 0.25);
  CHECK(defs["pipeline"]["oneOf"].size() == 2);
  // every reference leads somewhere
  const std::string text = schema.dump(), mark = "#/$defs/";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t begin = at + mark.size();
    CHECK(defs.contains(text.substr(begin, text.find('"', begin) - begin)));
  }
}

TEST_CASE("the JSON Schema knows designers, and who needs data") {
  Registry registry;
  registry.add(register_fakes);
  const auto schema = nlohmann::json::parse(study_json_schema(registry));
  const auto& defs = schema["$defs"];
  CHECK(defs["designer"]["oneOf"].size() ==
        3);  // two, and the name of the one that needs no parameter
  CHECK(defs["pipeline"]["properties"]["designer"]["$ref"] == "#/$defs/designer");
  CHECK(defs["pipeline"]["oneOf"].size() == 2);
  REQUIRE(schema["allOf"].size() == 2);
  const auto& first = schema["allOf"][0];
  CHECK(first["if"]["properties"]["pipelines"]["items"]["required"] ==
        nlohmann::json({"designer"}));
  CHECK(first["then"]["properties"]["data"]["properties"]["simulate"]["properties"]["steps"] ==
        false);
  CHECK(first["else"]["anyOf"][0]["required"] == nlohmann::json({"data"}));
  CHECK(first["else"]["properties"]["data"]["properties"]["simulate"]["required"] ==
        nlohmann::json({"steps"}));
  const auto& second = schema["allOf"][1];
  CHECK(second["if"]["properties"]["pipelines"]["contains"]["required"] ==
        nlohmann::json({"designer"}));
  CHECK(second["then"]["properties"]["data"]["properties"]["csv"] == false);
}

TEST_CASE("the JSON Schema knows interval matrices and additive faults") {
  Registry registry;
  registry.add(register_fakes);
  const auto defs = nlohmann::json::parse(study_json_schema(registry))["$defs"];
  const auto find = [](const nlohmann::json& list, const std::string& type) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& s) {
      return s["properties"]["type"]["const"] == type;
    });
    REQUIRE(found != list.end());
    return (*found)["properties"];
  };
  CHECK(find(defs["system"]["oneOf"], "lti")["A"]["$ref"] == "#/$defs/matrix");
  for (const char* type : {"interval_lti", "descriptor"}) {
    for (const char* key : {"A", "B", "C"})
      CHECK(find(defs["system"]["oneOf"], type)[key]["$ref"] == "#/$defs/interval_matrix");
    CHECK(find(defs["system"]["oneOf"], type)["D"]["$ref"] == "#/$defs/matrix");
    CHECK(find(defs["system"]["oneOf"], type)["F"]["$ref"] == "#/$defs/matrix");
    CHECK_FALSE(find(defs["mode_system"]["oneOf"], type).contains("F"));
  }
  CHECK_FALSE(find(defs["system"]["oneOf"], "interval_lti").contains("E"));
  CHECK(defs["interval_matrix"]["anyOf"].size() == 3);
  const auto& simulate = defs["data"]["oneOf"][0]["properties"]["simulate"]["properties"];
  CHECK(simulate["parameters"]["enum"] == nlohmann::json({"constant", "varying"}));
  CHECK(simulate["additive_faults"]["items"]["required"] == nlohmann::json({"fault", "signal"}));
  CHECK(find(defs["gain"]["oneOf"], "optimal")["weight"]["default"] == 0.5);
  const auto gain = find(defs["observer"]["oneOf"], "luenberger")["gain"]["anyOf"];
  CHECK(gain[0]["$ref"] == "#/$defs/matrix");
  CHECK(gain[1]["$ref"] == "#/$defs/gain");
}
