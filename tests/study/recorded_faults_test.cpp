// SPDX-License-Identifier: GPL-3.0-or-later
// Three faults in one record with gaps: each is isolated while it lasts, and its size enclosed.
#include <cmath>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cordon/core/interval.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"
#include "run/program.hpp"

using namespace cordon;

namespace {

using Json = nlohmann::ordered_json;

const std::string recorded = CORDON_SOURCE_DIR "/examples/studies/three_tanks_recorded_faults";

/// What the record was made with: a mode lasts for k = from … to, its parameter is a state.
struct Phase {
  std::string mode;
  Index from, to;
  Index parameter = -1;
  double size = 0;
  /// Its bounds at the end, as the page shows them: with constrained zonotopes, with zonotopes.
  Interval constrained = {}, zonotopes = {};
};
const std::vector<Phase> phases{
    {"healthy", 0, 39},    {"weak pump", 40, 89, 3, 0.82, {.807, .830}, {.800, .833}},
    {"healthy", 90, 139},  {"sensor 3 low", 140, 189, 5, 0.89, {.863, .916}, {.860, .917}},
    {"healthy", 190, 239}, {"leak", 240, 290, 4, 0.022, {.0152, .0284}, {.0129, .0319}}};

Json text_of(const std::string& file) {
  std::ifstream in(file);
  return Json::parse(in);
}

/// What a bank finds in one phase.
struct Found {
  Index isolated_at = -1;
  Index wrong = 0;     ///< steps at which another mode is named of the time since the phase began
  Index excluded = 0;  ///< steps at which the true mode is
  Index outside = 0;   ///< bounds of the size without the true one
  Interval last = {};
};

void look(const Phase& phase, Index truth, const Diagnosis& now, Found& found) {
  if (now.since < phase.from) return;
  found.excluded += !now.modes[static_cast<std::size_t>(truth)].candidate;
  if (now.decision != Decision::monitoring) return;
  found.wrong += now.mode != truth;
  if (now.mode != truth) return;
  if (found.isolated_at < 0) found.isolated_at = now.k;
  if (phase.parameter < 0) return;
  REQUIRE(now.estimate);
  const Box hull = (*now.estimate)->interval_hull();
  const double lower = hull.lower[phase.parameter], upper = hull.upper[phase.parameter];
  found.outside += !(lower <= phase.size && phase.size <= upper);
  found.last = {lower, upper};
}

}  // namespace

TEST_CASE("each of three faults in a record is isolated while it lasts, and its size enclosed") {
  Registry registry;
  const Study study =
      read_study(recorded + ".json", registry,
                 {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const ModeBank bank = bank_of(study);
  REQUIRE(study.pipelines.size() == 2);
  for (const PipelineSpec& pipeline : study.pipelines) {
    CAPTURE(pipeline.name);
    const auto backend =
        registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
    const ComponentSpec& spec = pipeline.diagnosis()->diagnoser;
    const auto diagnoser = registry.make<DiagnoserEntry>(spec.type, {bank, backend}, spec.params);
    diagnoser->start();
    const auto data = open_data(study);
    for (const Phase& phase : phases) {
      Found found;
      for (Index k = phase.from; k <= phase.to; ++k) {
        const auto record = data->next();
        REQUIRE(record);
        REQUIRE(record->mode);
        REQUIRE(bank[*record->mode].name == phase.mode);
        look(phase, *record->mode, diagnoser->step(record->sample), found);
      }
      CAPTURE(phase.mode);
      CAPTURE(phase.from);
      CHECK(found.excluded == 0);
      CHECK(found.wrong == 0);
      CHECK(found.outside == 0);
      if (phase.parameter < 0) {
        CHECK((found.isolated_at >= 0) == (pipeline.name == "constrained zonotopes"));
        continue;
      }
      CHECK(found.isolated_at >= phase.from);
      CHECK(found.isolated_at <= phase.from + 6);
      const bool is_exact = pipeline.name == "constrained zonotopes";
      const Interval& shown = is_exact ? phase.constrained : phase.zonotopes;
      const double digit = phase.size > 0.1 ? 1e-3 : 1e-4;
      CHECK(std::abs(found.last.lower - shown.lower) <= 0.6 * digit);
      CHECK(std::abs(found.last.upper - shown.upper) <= 0.6 * digit);
    }
    CHECK_FALSE(data->next());
  }
}

TEST_CASE("the run of the record tells sizes that a mode does not know, and no others") {
  const Scratch scratch;
  const test::Outcome told = test::cordon_with(
      "run \"" + recorded + ".json\" --no-report --out \"" + (scratch / "out").string() + "\"");
  CAPTURE(told.out + told.err);
  REQUIRE(told.code == 0);
  for (const char* what :
       {"no other mode is left, gain in [0.8, 0.96]\n", "no other mode is left, leak in [0.01, ",
        "no other mode is left\n", "True mode excluded: never"})
    CHECK(told.says(what));
  for (const char* known : {"power in [1, 1]", "leak in [0, 0]", "e-32"})
    CHECK_FALSE(told.says(known));
  const test::Outcome verified = test::cordon_with("verify \"" + (scratch / "out").string() + "\"");
  CAPTURE(verified.out + verified.err);
  CHECK(verified.code == 0);
}

TEST_CASE("the record is what its simulation makes, rounded") {
  Json study = text_of(recorded + ".json");
  Json& system = study["system"];
  for (const char* set : {"W", "V"}) {
    const double bound = set[0] == 'W' ? 0.005 : 0.03;
    system[set]["lower"] = std::vector<double>(3, -bound);
    system[set]["upper"] = std::vector<double>(3, bound);
  }
  Json faults = Json::array();
  for (const Phase& phase : phases) {
    if (phase.parameter < 0) continue;
    faults.push_back({{"mode", phase.mode}, {"from", phase.from}, {"to", phase.to}});
    for (Json& mode : system["modes"])
      if (mode["name"] == phase.mode)
        for (Json& bounds : mode["parameters"])
          bounds = {{"lower", phase.size}, {"upper", phase.size}};
  }
  study["data"] = Json::parse(R"({"simulate": {"steps": 290, "seed": 31,
    "x0": [3.5, 3.6, 4.6, 1, 0, 1],
    "input": [{"type": "prbs", "offset": 1.1, "amplitude": 0.15, "period": 15, "seed": 3}],
    "dropouts": [{"outputs": [1], "probability": 0.15}, {"outputs": [2], "probability": 0.1},
                 {"outputs": [3], "probability": 0.15}, {"from": 70, "to": 73}]}})");
  study["data"]["simulate"]["faults"] = faults;
  const Scratch scratch;
  Registry registry;
  const Study simulated =
      read_study(scratch.write("s.json", study.dump()), registry,
                 {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const auto data = open_data(simulated);
  std::ifstream record(recorded + ".csv");
  std::string line;
  REQUIRE(std::getline(record, line));
  CHECK(line == "pump,h1,h2,h3,mode");
  while (const auto made = data->next()) {
    REQUIRE(std::getline(record, line));
    std::string same = fmt::format("{:g}", made->sample.u[0]);
    for (const double y : made->sample.y) same += std::isnan(y) ? "," : fmt::format(",{:.3f}", y);
    CHECK(line == same + "," + bank_of(simulated)[made->mode.value()].name);
  }
  CHECK_FALSE(std::getline(record, line));
}
