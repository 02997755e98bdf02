// SPDX-License-Identifier: GPL-3.0-or-later
// Systems in continuous time: sampled when a study is read, with all that belongs to them.
#include <cmath>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

/// A motor with a load that nobody knows, and its faults.
Json motor() {
  return Json::parse(R"({"cordon": 1, "title": "motor", "system": {"type": "lti",
    "continuous": true, "sampling_time": 0.1,
    "A": [[0, 1], [-4, -0.6]], "B": [[0], [2]], "Bw": [[0], [1]], "C": [[1, 0]],
    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
    "W": {"type": "box", "lower": [-0.1], "upper": [0.3]},
    "V": {"type": "box", "lower": [-0.02], "upper": [0.02]},
    "names": {"states": ["angle [rad]", "speed [rad/s]"], "disturbances": ["load [Nm]"]}},
    "data": {"simulate": {"steps": 40, "noise": "vertex",
      "input": [{"type": "square", "amplitude": 1, "period": 20}]}},
    "pipelines": [{"name": "P", "backend": "zonotope", "observer": "prediction_correction"}],
    "metrics": ["contains_truth"]})");
}

Json with_modes(Json study) {
  study["system"]["modes"] = Json::parse(R"([{"name": "weak", "actuator": [0.5]},
    {"name": "brake", "additive": {"F": [[0], [1]],
      "f": {"type": "box", "lower": [-1], "upper": [-0.5]}}},
    {"name": "gusts", "W": {"type": "box", "lower": [-1], "upper": [1]}},
    {"name": "stiff", "system": {"type": "lti", "A": [[0, 1], [-9, -0.6]], "B": [[0], [2]],
      "Bw": [[0], [1]], "C": [[1, 0]], "W": {"type": "box", "lower": [-0.1], "upper": [0.3]},
      "V": {"type": "box", "lower": [-0.02], "upper": [0.02]}}}])");
  study["data"]["simulate"]["faults"] = Json::parse(R"([{"mode": "brake", "from": 10, "to": 19},
    {"name": "clutch", "from": 30, "additive": {"F": [[0], [1]],
      "f": {"type": "box", "lower": [-2], "upper": [-1]}}}])");
  study["pipelines"] = Json::parse(
      R"([{"name": "D", "backend": "constrained_zonotope", "diagnoser": "tube_membership"}])");
  study["metrics"] = Json::array();
  return study;
}

struct Files {
  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with(arguments + " 2>&1", "cd \"" + scratch.path().string() + "\" &&");
  }
  Json results(const std::string& directory) const {
    return Json::parse(bytes_of(scratch.path() / directory / "results.json"));
  }
  Scratch scratch;
};

/// The study as it is resolved: from sample to sample.
Json resolved(const Files& files, const std::string& file) {
  const Outcome told = files("validate --json " + file);
  REQUIRE_MESSAGE(told.code == 0, told.out);
  const Json all = Json::parse(told.out);
  return (all.is_array() ? all : all.at("studies"))[0].at("study");
}

void check_refused(const Json& study, const std::string& message) {
  const Files files;
  files.scratch.write("s.json", study.dump(1));
  const Outcome told = files("validate s.json");
  CHECK(told.code == 2);
  CHECK_MESSAGE(told.says(message), told.out);
}

/// The motor under a load that switches twice a sample, by the solution of its equations: angle and
/// speed around an equilibrium turn and decay.
std::string recorded(int samples) {
  constexpr double h = 0.1, decay = 0.3;
  const double frequency = std::sqrt(4 - decay * decay);
  double angle = 0.5, speed = -0.2;
  std::string csv = "u,y,angle,speed\n";
  const auto text = [](double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.17g", x);
    return std::string(buffer);
  };
  const auto move = [&](double t, double force) {
    const double rest = force / 4, off = angle - rest;
    const double swing = (speed + decay * off) / frequency;
    const double c = std::cos(frequency * t), s = std::sin(frequency * t), e = std::exp(-decay * t);
    angle = rest + e * (off * c + swing * s);
    speed = e * ((swing * frequency - decay * off) * c - (off * frequency + decay * swing) * s);
  };
  for (int k = 0; k < samples; ++k) {
    const double u = k % 20 < 10 ? 1 : -1, v = k % 3 == 0 ? 0.02 : -0.02;
    csv +=
        text(u) + "," + text(angle + v * 0.999999) + "," + text(angle) + "," + text(speed) + "\n";
    const double early = k % 2 ? 0.3 : -0.1, late = 0.2 - early;
    const double part = h * (1 + k % 7) / 8;
    move(part, 2 * u + early);
    move(h - part, 2 * u + late);
  }
  return csv;
}

}  // namespace

TEST_CASE("a system in continuous time is sampled, and told so") {
  const Files files;
  files.scratch.write("s.json", motor().dump(1));
  const Outcome told = files("validate s.json");
  CHECK(told.code == 0);
  CHECK_MESSAGE(told.says("sampled every 0.1 s from continuous time"), told.out);
  const Json system = resolved(files, "s.json")["system"];
  CHECK_FALSE(system.contains("continuous"));
  CHECK(system["A"][0][1].get<double>() == doctest::Approx(0.096413381554155).epsilon(1e-14));
  CHECK(system["B"][0][0].get<double>() == doctest::Approx(0.009770462447114).epsilon(1e-12));
  CHECK(system["Bw"] == Json::parse("[[1.0, 0.0], [0.0, 1.0]]"));
  CHECK_FALSE(system["names"].contains("disturbances"));
  CHECK(files("run --no-report s.json --out out").says("Sampled every 0.1 s: what is said"));
  Json held = motor();
  held["system"]["disturbance"] = "held";
  files.scratch.write("held.json", held.dump(1));
  const Json kept = resolved(files, "held.json")["system"];
  CHECK(kept["Bw"][1][0].get<double>() == doctest::Approx(0.096413381554155).epsilon(1e-13));
  CHECK(kept["names"].contains("disturbances"));
}

TEST_CASE("no observer loses a state whose disturbance jumps inside samples") {
  const Files files;
  Json study = motor();
  study["data"] = Json::parse(R"({"csv": {"file": "d.csv", "inputs": ["u"], "outputs": ["y"],
    "truth": ["angle", "speed"]}})");
  study["pipelines"] = Json::array();
  const Json gain = Json::parse("[[0.5], [1]]");
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    for (const char* observer : {"prediction_correction", "gain_correction", "error_hull",
                                 "luenberger", "zonotope_uncertain", "interval_trajectory"}) {
      Json spec = {{"type", observer}};
      if (std::string(observer) != "prediction_correction") spec["gain"] = gain;
      study["pipelines"].push_back({{"name", std::string(backend) + " " + observer},
                                    {"backend", backend},
                                    {"observer", spec}});
    }
  }
  files.scratch.write("d.csv", recorded(200));
  files.scratch.write("s.json", study.dump(1));
  const Outcome ran = files("run --quiet --no-report --out out s.json");
  REQUIRE_MESSAGE(ran.code == 0, ran.out);
  for (const Json& pipeline : files.results("out")["pipelines"]) {
    CAPTURE(pipeline["name"].get<std::string>());
    REQUIRE(pipeline["steps"].size() == 200);
    int outside = 0;
    for (const Json& step : pipeline["steps"])
      outside += !step["contains_truth"].get<double>() || !step["consistent"].get<bool>();
    CHECK(outside == 0);
  }
  const Outcome verified = files("verify --directions 2 out");
  CHECK_MESSAGE(verified.code == 0, verified.out);
}

TEST_CASE("modes and faults are sampled with their system, once") {
  const Files files;
  files.scratch.write("s.json", with_modes(motor()).dump(1));
  const Outcome ran = files("run --quiet --no-report --out first s.json");
  REQUIRE_MESSAGE(ran.code == 0, ran.out);
  // The resolved study says the same of all models.
  files.scratch.write("again.json", resolved(files, "s.json").dump(1));
  REQUIRE(files("run --quiet --no-report --out second again.json").code == 0);
  CHECK(files.results("first")["study"] == files.results("second")["study"]);
  CHECK(files.results("first")["pipelines"][0]["steps"].size() ==
        files.results("second")["pipelines"][0]["steps"].size());
  const Json modes = files.results("first")["study"]["system"]["modes"];
  CHECK(modes[1]["additive"]["F"] == Json::parse("[[1.0, 0.0], [0.0, 1.0]]"));
  CHECK(modes[2]["W"]["center"].size() == 2);
  CHECK(modes[3]["system"]["A"][1][0].get<double>() ==
        doctest::Approx(-0.860488634580597).epsilon(1e-14));
  CHECK(files("verify first").code == 0);
}

TEST_CASE("sweeps reach into systems in continuous time") {
  const Files files;
  Json study = with_modes(motor());
  study["sweep"] = Json::parse(R"([{"name": "time", "path": "/system/sampling_time",
    "values": [0.05, 0.1]}, {"name": "seed", "path": "/data/simulate/seed", "values": [1, 2]}])");
  files.scratch.write("s.json", study.dump(1));
  const Outcome swept = files("run --quiet --out out s.json");
  REQUIRE_MESSAGE(swept.code == 0, swept.out);
  // Its resolved text is one of the same studies.
  const Json kept = resolved(files, "s.json");
  CHECK(kept["system"]["continuous"] == true);
  files.scratch.write("again.json", kept.dump(1));
  CHECK(resolved(files, "again.json") == kept);
}

TEST_CASE("what cannot be sampled is told with its place") {
  Json study = motor();
  study["system"].erase("sampling_time");
  check_refused(study, "/system/continuous (line 6): needs a \"sampling_time\"");
  study = motor();
  study["system"]["continuous"] = false;
  study["system"]["disturbance"] = "held";
  check_refused(study, "belongs to systems in continuous time");
  study = motor();
  study["system"]["disturbance"] = "white";
  check_refused(study, "/system/disturbance");
  study = motor();
  study["system"]["type"] = "descriptor";
  study["system"]["E"] = Json::parse("[[1, 0], [0, 0]]");
  check_refused(study, "a descriptor system is not sampled");
  study = motor();
  study["system"]["W"] = Json::parse(R"({"type": "space", "dim": 1})");
  check_refused(study, "/system/W");
  study = motor();
  study["system"]["A"][0][0] = 20000;
  check_refused(study, "is A in 1/s?");
  study = motor();
  study["system"]["type"] = "interval_lti";
  study["system"]["A"] =
      Json::parse(R"({"center": [[0, 1], [-4, -0.6]], "radius": [[0, 0], [0.1, 0]]})");
  study["system"]["F"] = Json::parse("[[0], [1]]");
  check_refused(study, "cannot be sampled with an A that is known by an interval");
  study = with_modes(motor());
  study["system"]["modes"][1]["additive"]["Fy"] = Json::parse("[[1]]");
  check_refused(study, "/system/modes/1/additive");
  study = with_modes(motor());
  study["system"]["modes"][1]["additive"]["f"] = Json::parse(R"({"type": "space", "dim": 1})");
  check_refused(study, "/system/modes/1/additive/f");
  study = with_modes(motor());
  study["system"]["modes"][3]["system"]["continuous"] = true;
  check_refused(study, "unknown key of a mode's system");
}

TEST_CASE("an interval model without radii encloses the last digits") {
  // x_1 = 2^60 / e = 424136118829305329.67…, and no double next to e^-1 is exact enough.
  const Files files;
  Json study = Json::parse(R"({"cordon": 1, "title": "decay", "system": {"type": "interval_lti",
    "continuous": true, "sampling_time": 1, "A": [[-1]], "C": [[1]],
    "X0": {"type": "point", "center": [1152921504606846976]}, "W": {"type": "point", "center": [0]},
    "V": {"type": "box", "lower": [-1e18], "upper": [1e18]}},
    "data": {"csv": {"file": "d.csv", "outputs": ["y"]}}, "pipelines": [{"name": "P",
    "backend": {"type": "interval", "rounding": "outward"}, "observer":
      {"type": "interval_trajectory", "gain": [[0]]}}]})");
  files.scratch.write("d.csv", "y\n0\n0\n");
  files.scratch.write("s.json", study.dump(1));
  CHECK(resolved(files, "s.json")["system"]["A"]["radius"][0][0].get<double>() > 0);
  const Outcome ran = files("run --quiet --no-report --out out s.json");
  REQUIRE_MESSAGE(ran.code == 0, ran.out);
  const Json hull = files.results("out")["pipelines"][0]["steps"][1]["hull"];
  CHECK(hull["lower"][0].get<double>() <= 424136118829305280.0);
  CHECK(hull["upper"][0].get<double>() >= 424136118829305344.0);
  // so do modes of their own
  study["system"]["modes"] = Json::parse(R"([{"name": "slow", "system": {"type": "interval_lti",
    "A": [[-0.5]], "C": [[1]], "W": {"type": "point", "center": [0]},
    "V": {"type": "box", "lower": [-1e18], "upper": [1e18]}}}])");
  files.scratch.write("modes.json", study.dump(1));
  const Json mode = resolved(files, "modes.json")["system"]["modes"][0]["system"];
  CHECK(mode["A"]["radius"][0][0].get<double>() > 0);
}

TEST_CASE("what is enclosed badly, or not at all, is told") {
  Json study = motor();
  study["system"]["A"] = Json::parse("[[0, 1], [-1000000, 0]]");
  const Files files;
  files.scratch.write("s.json", study.dump(1));
  const Outcome told = files("validate s.json");
  CHECK_MESSAGE(told.says("sample more often"), told.out);
  study = motor();
  study["system"]["type"] = "interval_lti";
  study["system"]["A"] = Json::parse(R"({"center": [[-10]], "radius": [[8000]]})");
  study["system"]["B"] = study["system"]["Bw"] = study["system"]["C"] = Json::parse("[[1]]");
  study["system"]["X0"] = Json::parse(R"({"type": "box", "lower": [-1], "upper": [1]})");
  study["system"].erase("names");
  check_refused(study, "are too large for a double");
  study = with_modes(motor());
  study["system"]["modes"][2]["W"] =
      Json::parse(R"({"type": "box", "lower": [-1e308], "upper": [1e308]})");
  study["system"]["Bw"] = Json::parse("[[0], [1e10]]");
  check_refused(study, "/system/modes/2/W");
  study = with_modes(motor());
  study["system"]["disturbance"] = "held";
  study["system"]["sampling_time"] = 100;
  study["system"]["modes"][1]["additive"]["F"] = Json::parse("[[0], [1e308]]");
  study["system"]["A"] = Json::parse("[[0, 1], [0, 0]]");
  check_refused(study, "/system/modes/1/additive/F");
}

TEST_CASE("what has decayed within a sample is 0") {
  Json study = motor();
  study["system"]["A"] = Json::parse("[[-1e10, 0], [0, -1e11]]");
  study["system"]["W"] = Json::parse(R"({"type": "point", "center": [0]})");
  const Files files;
  files.scratch.write("s.json", study.dump(1));
  const Json A = resolved(files, "s.json")["system"]["A"];
  CHECK(A == Json::parse("[[0.0, 0.0], [0.0, 0.0]]"));
}

TEST_CASE("an interval model is sampled to an interval model") {
  const Files files;
  Json study = motor();
  study["system"]["type"] = "interval_lti";
  study["system"]["A"] =
      Json::parse(R"({"center": [[0, 1], [-4, -0.6]], "radius": [[0, 0], [0.4, 0.1]]})");
  study["data"]["simulate"]["parameters"] = "varying";
  study["pipelines"][0]["observer"] =
      Json::parse(R"({"type": "zonotope_uncertain", "gain": [[0.5], [1]]})");
  files.scratch.write("s.json", study.dump(1));
  const Json system = resolved(files, "s.json")["system"];
  CHECK(system["A"]["radius"][1][0].get<double>() > 0.03);
  CHECK(system["A"]["radius"][1][0].get<double>() < 0.05);
  CHECK(system["B"]["radius"][1][0].get<double>() > 0);
  const Outcome ran = files("run --quiet --no-report --out out s.json");
  CHECK_MESSAGE(ran.code == 0, ran.out);
}
