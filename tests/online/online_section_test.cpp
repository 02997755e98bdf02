// SPDX-License-Identifier: GPL-3.0-or-later
// "online" in studies: read, resolved, described for editors, and every problem told at once.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "online/study.hpp"
#include "run/program.hpp"

using namespace online_test;

TEST_CASE("the rules are read, and written into the resolved study where they are not the usual") {
  const Loaded usual;
  CHECK(usual.study.online.jumps == JumpRule::refuse);
  CHECK(usual.study.online.late == LateRule::drop);
  CHECK(usual.study.online.repeated == RepeatRule::refuse);
  CHECK_FALSE(nlohmann::json::parse(usual.study.resolved).contains("online"));
  const Loaded given(R"({"jumps": "fill", "longest_gap": 7, "late": "correct", "lag": 3})");
  CHECK(given.study.online.jumps == JumpRule::fill);
  CHECK(given.study.online.longest_gap == 7);
  CHECK(given.study.online.late == LateRule::correct);
  CHECK(given.study.online.lag == 3);
  const auto resolved = nlohmann::json::parse(given.study.resolved)["online"];
  CHECK(resolved == nlohmann::json{{"jumps", "fill"},
                                   {"longest_gap", 7},
                                   {"late", "correct"},
                                   {"lag", 3},
                                   {"repeated", "refuse"},
                                   {"clock_tolerance", 0.01},
                                   {"clock_drift", 0.001}});
  const Loaded again(resolved.dump());
  CHECK(again.study.resolved == given.study.resolved);
}

TEST_CASE("everything that is wrong with the rules is told at once") {
  try {
    const Loaded wrong(R"({"jumps": "fil", "late": 3, "lag": 0, "repeat": "ignore"})");
    FAIL("wrong rules were taken");
  } catch (const InputError& error) {
    std::vector<std::string> places;
    for (const Diagnostic& problem : error.diagnostics()) places.push_back(problem.pointer);
    CHECK(places == std::vector<std::string>{"/online/repeat", "/online/jumps", "/online/late",
                                             "/online/lag"});
    CHECK(std::string(error.what()).find("fill") != std::string::npos);
  }
  for (const char* share : {"-0.1", "0.5", "1e300"}) {
    for (const char* key : {"clock_tolerance", "clock_drift"}) {
      CHECK_THROWS_WITH_AS(Loaded(std::string("{\"") + key + "\": " + share + "}"),
                           doctest::Contains("from 0 to below 0.5"), InputError);
    }
  }
  CHECK_THROWS_WITH_AS(Loaded(R"({"longest_gap": 5})"), doctest::Contains("jumps are refused"),
                       InputError);
}

TEST_CASE("a study needs no data for `cordon validate` where samples come on line") {
  const Scratch scratch;
  const auto file = [&](const std::string& online) {
    return scratch.write("study.json", study_text(online)).string();
  };
  const test::Outcome without = test::cordon_with("validate " + file(""));
  CHECK(without.code == 2);
  CHECK(without.err.find("/data") != std::string::npos);
  const test::Outcome with = test::cordon_with("validate " + file("{}"));
  CHECK_MESSAGE(with.code == 0, with.err);
  CHECK(with.out.find("samples come on line") != std::string::npos);
  const test::Outcome ran = test::cordon_with("run " + file("{}"));
  CHECK(ran.code == 2);
  CHECK(ran.err.find("/data") != std::string::npos);
  const Loaded loaded("{}");
  CHECK_FALSE(nlohmann::json::parse(loaded.study.resolved).contains("data"));
  const auto schema = nlohmann::json::parse(study_json_schema(loaded.registry));
  CHECK(schema["allOf"][0]["else"]["anyOf"][1]["required"][0] == "online");
}

TEST_CASE("editors know the rules") {
  const Loaded loaded;
  const auto schema = nlohmann::json::parse(study_json_schema(loaded.registry));
  const auto& rules = schema["properties"]["online"]["properties"];
  CHECK(rules["jumps"]["enum"] == nlohmann::json{"refuse", "fill"});
  CHECK(rules["late"]["enum"] == nlohmann::json{"drop", "correct"});
  CHECK(rules["repeated"]["enum"] == nlohmann::json{"refuse", "ignore"});
  CHECK(rules["lag"]["maximum"] == 10'000);
}
