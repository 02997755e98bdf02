// SPDX-License-Identifier: GPL-3.0-or-later
// Names of swept values, wherever these are shown.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "sweep/program.hpp"

using nlohmann::json;

namespace {

json study(const json& labels) {
  json study = json::parse(program::study(2, 3));
  const auto noise = [](double radius) {
    return json{{"type", "box"}, {"lower", {-radius}}, {"upper", {radius}}};
  };
  study["sweep"].push_back({{"name", "noise"},
                            {"path", "/system/V"},
                            {"values", json::array({noise(0.5), noise(1)})},
                            {"labels", labels}});
  return study;
}

program::Outcome run(const Scratch& scratch, const json& labels) {
  scratch.write("s.json", study(labels).dump(1));
  return program::run(scratch,
                      {"run", scratch / "s.json", "--out", scratch / "out", "--jobs", "1"});
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("labels stand for values in tables, figures and files") {
  const Scratch scratch;
  const auto outcome = run(scratch, {"quiet", "loud, =1+1"});
  REQUIRE_MESSAGE(outcome.exit == 0, outcome.text);
  CHECK(holds(outcome.text, "quiet"));
  CHECK_FALSE(holds(outcome.text, "\"type\""));
  const std::string points = bytes_of(scratch / "out/points.csv");
  CHECK(holds(points, ",quiet,"));
  CHECK(holds(points, "\"loud, =1+1\""));
  CHECK(holds(bytes_of(scratch / "out/summary.md"), "quiet"));
  CHECK(holds(bytes_of(scratch / "out/report.html"), "quiet"));
  const json results = json::parse(bytes_of(scratch / "out/results.json"));
  CHECK(results["study"]["sweep"][1]["labels"] == json({"quiet", "loud, =1+1"}));
  CHECK(results["study"]["sweep"][1]["values"].size() == 2);
  // the resolved study is the same study, and what was written is read again
  const auto again =
      program::run(scratch, {"run", scratch / "s.json", "--resume", "--out", scratch / "out"});
  CHECK_MESSAGE(holds(again.text, "finished before"), again.text);
  CHECK(holds(again.text, "quiet"));
  const auto mat = program::run(scratch, {"convert", scratch / "out", scratch / "out.mat"});
  CHECK_MESSAGE(mat.exit == 0, mat.text);
}

TEST_CASE("labels name every value, each otherwise") {
  const Scratch scratch;
  const auto short_of_one = run(scratch, json::array({"quiet"}));
  CHECK(short_of_one.exit == 2);
  CHECK_MESSAGE(holds(short_of_one.text, "/sweep/1/labels"), short_of_one.text);
  CHECK(holds(short_of_one.text, "has 1 text for 2 values"));
  const auto twice = run(scratch, {"quiet", "quiet"});
  CHECK(twice.exit == 2);
  CHECK(holds(twice.text, "/sweep/1/labels/1"));
  CHECK(holds(twice.text, "repeats"));
  CHECK(run(scratch, {"quiet", 3}).exit == 2);
  CHECK(run(scratch, "quiet").exit == 2);
}
