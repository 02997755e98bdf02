// SPDX-License-Identifier: GPL-3.0-or-later
// What is recorded of an ellipsoid is a box around it. Not all successors of that box have to be in
// the next estimate; the states that model and data allow have to be.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A chain of states, each fed by the next, with two outputs.
Json chain(int states, int steps) {
  Json study{{"cordon", 1}, {"title", "a chain"}};
  Json A, unit, C = Json::array(), low, high, x0;
  for (int i = 0; i < states; ++i) {
    Json row = Json::array(), one = Json::array();
    for (int j = 0; j < states; ++j) {
      row.push_back(i == j ? .9 : j == i + 1 ? .3 : j == i - 1 ? -.2 : 0);
      one.push_back(i == j ? .1 : 0);
    }
    A.push_back(row);
    unit.push_back(one);
    low.push_back(-1);
    high.push_back(1);
    x0.push_back(.3);
  }
  for (int i : {0, states - 1}) {
    Json row = Json::array();
    for (int j = 0; j < states; ++j) row.push_back(j == i ? 1 : 0);
    C.push_back(row);
  }
  const auto box = [](const Json& lower, const Json& upper) {
    return Json{{"type", "box"}, {"lower", lower}, {"upper", upper}};
  };
  study["system"] = {{"type", "lti"},
                     {"A", A},
                     {"Bw", unit},
                     {"C", C},
                     {"Dv", {{.2, 0}, {0, .2}}},
                     {"X0", box(low, high)},
                     {"W", box(low, high)},
                     {"V", box({-1, -1}, {1, 1})}};
  study["data"]["simulate"] = {{"steps", steps}, {"seed", 1}, {"noise", "uniform"}, {"x0", x0}};
  study["pipelines"].push_back(
      {{"name", "P"}, {"backend", "ellipsoid"}, {"observer", "prediction_correction"}});
  return study;
}

}  // namespace

TEST_CASE("estimates by ellipsoids are no violation, compared exactly or along directions") {
  const fs::path home = fs::temp_directory_path() / "cordon_outer_exports";
  for (const int states : {2, 6}) {  // exact sets are computed up to four states
    CAPTURE(states);
    fs::remove_all(home);
    fs::create_directories(home);
    std::ofstream(home / "study.json") << chain(states, 12).dump();
    const std::string out = (home / "out").string();
    const auto run = test::cordon_with("run --quiet --out " + out + " " +
                                       (home / "study.json").string() + " 2>&1");
    CAPTURE(run.out);
    REQUIRE(run.code == 0);
    const auto verified = test::cordon_with("verify " + out + " 2>&1");
    CAPTURE(verified.out);
    CHECK(verified.code == (states == 2 ? 0 : 5));
    CHECK(verified.out.find("violated") == std::string::npos);
  }
  fs::remove_all(home);
}

TEST_CASE("support values of ellipsoids are recorded, and held against the exact states") {
  const fs::path home = fs::temp_directory_path() / "cordon_support_values";
  fs::remove_all(home);
  fs::create_directories(home);
  std::ofstream(home / "study.json") << chain(2, 6).dump();
  const std::string out = (home / "out").string();
  REQUIRE(
      test::cordon_with("run --quiet --out " + out + " " + (home / "study.json").string()).code ==
      0);
  std::vector<Json> rows;
  std::ifstream file(home / "out" / "sets.jsonl");
  for (std::string line; std::getline(file, line);) rows.push_back(Json::parse(line));
  file.close();
  REQUIRE(rows.size() == 7);
  CHECK(rows[5]["exchange"] == "outer");
  REQUIRE(rows[5].contains("H"));
  CHECK(rows[5]["H"].size() >= 8);  // an ellipse in its box, in sixteen directions
  CHECK(rows[5]["H"].size() == rows[5]["h"].size());
  fs::remove(home / "out" / "manifest.json");
  const auto write = [&] {
    std::ofstream again(home / "out" / "sets.jsonl");
    for (const Json& row : rows) again << row.dump() << "\n";
  };
  write();
  CHECK(test::cordon_with("verify " + out + " 2>&1").code == 0);
  const double along = rows[5]["H"][0][0].get<double>() * rows[5]["c"][0].get<double>() +
                       rows[5]["H"][0][1].get<double>() * rows[5]["c"][1].get<double>();
  rows[5]["h"][0] = along - .02;  // through the middle
  write();
  const auto refuted = test::cordon_with("verify " + out + " 2>&1");
  CAPTURE(refuted.out);
  CHECK(refuted.code == 4);
  CHECK(refuted.out.find("the reported set only") != std::string::npos);
  rows[5]["h"].erase(0);  // a row fewer than H has
  write();
  CHECK(test::cordon_with("verify " + out + " 2>&1").code == 2);
  fs::remove_all(home);
}
