// SPDX-License-Identifier: GPL-3.0-or-later
// The studies of the examples with three outputs of ten missing at random: no truth is lost, no
// true mode excluded, and what the results claim is proven again.
//   CORDON_SEEDS       how many seeds of each study (1)
//   CORDON_GAP_SEEDS   how many of the same without the proofs, in sweeps (5)
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::Outcome;

constexpr int steps = 100;
constexpr double lost = 0.3;

Outcome program(const std::string& arguments) { return test::cordon_with(arguments + " 2>&1"); }

std::uint64_t number_of(const char* variable, std::uint64_t usual) {
  const char* wanted = std::getenv(variable);
  return wanted ? std::strtoull(wanted, nullptr, 10) : usual;
}
std::uint64_t seeds() { return number_of("CORDON_SEEDS", 1); }

std::vector<fs::path> example_studies() {
  std::vector<fs::path> studies;
  for (const auto& entry : fs::directory_iterator(CORDON_SOURCE_DIR "/examples/studies")) {
    if (entry.path().extension() == ".json") studies.push_back(entry.path());
  }
  std::sort(studies.begin(), studies.end());
  return studies;
}

/// The sum of a column of a CSV file, but for what is no number; 0 without that column.
double sum_of(const fs::path& file, const std::string& name) {
  std::ifstream in(file);
  std::string line;
  const auto fields = [&] {
    std::vector<std::string> all(1);
    bool quoted = false;  // as names with commas are
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted) {
        all.emplace_back();
      } else {
        all.back() += c;
      }
    }
    return all;
  };
  std::getline(in, line);
  const auto names = fields();
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  double sum = 0;
  while (std::getline(in, line)) {
    const auto row = fields();
    if (at < static_cast<std::ptrdiff_t>(row.size()))
      sum += std::strtod(row[static_cast<std::size_t>(at)].c_str(), nullptr);
  }
  return sum;
}

/// Bounds of states that hold those of the simulations by far.
Json wide_box(std::size_t states) {
  const std::vector<double> half(states, 1e3);
  std::vector<double> lower;
  for (const double x : half) lower.push_back(-x);
  return {{"type", "box"}, {"lower", lower}, {"upper", half}};
}

/// The type of a component that may be given by its name alone.
std::string type_of(const Json& component) {
  return component.is_string() ? component.get<std::string>()
                               : component["type"].get<std::string>();
}

/// Gives components that need one a set which holds the state in place of the missing outputs.
void bound_states(Json& study) {
  const Json A = study["system"].value("A", Json::array());
  const std::size_t states = A.is_array() ? A.size() : 0;
  for (Json& pipeline : study["pipelines"]) {
    for (const char* kind : {"observer", "diagnoser"}) {
      if (!pipeline.contains(kind)) continue;
      const std::string type = type_of(pipeline[kind]);
      if (type != "fault_estimation_filter" && type != "descriptor") continue;
      if (pipeline[kind].is_string()) pipeline[kind] = {{"type", type}};
      if (!pipeline[kind].contains("admissible_set"))
        pipeline[kind]["admissible_set"] = wide_box(states);
    }
  }
}

/// The study of an example with gaps in its simulation; null if it has none.
Json with_gaps(const fs::path& file, std::uint64_t seed) {
  Json study = Json::parse(std::ifstream(file), nullptr, true, true);
  if (!study["data"].contains("simulate") || !study["data"]["simulate"].contains("steps"))
    return nullptr;
  Json& simulate = study["data"]["simulate"];
  simulate["steps"] = std::min(steps, simulate["steps"].get<int>());
  simulate["seed"] = seed;
  simulate["dropouts"] = {{{"probability", lost}}};
  study.erase("sweep");
  bound_states(study);
  return study;
}

struct Counts {
  std::uint64_t runs = 0, verified = 0, undecided = 0;
};

void run_and_verify(const Json& study, const fs::path& home, Counts& count) {
  std::ofstream(home / "study.json") << study.dump(1) << '\n';
  fs::remove_all(home / "out");
  const Outcome ran = program("run --quiet --no-report --out " + (home / "out").string() + " " +
                              (home / "study.json").string());
  CAPTURE(ran.out);
  CHECK(ran.code == 0);
  ++count.runs;
  if (ran.code != 0) return;
  const Outcome verified = program("verify --directions 2 " + (home / "out").string());
  CAPTURE(verified.out);
  CHECK((verified.code == 0 || verified.code == 5));
  if (verified.says("nothing was checked")) return;  // diagnosers alone
  // Successors by formulas are drawn, and none of those drawn need be consistent.
  if (verified.code == 5 && study["system"]["type"] == "nonlinear") return;
  ++(verified.code == 0 ? count.verified : count.undecided);
}

}  // namespace

TEST_CASE("examples whose outputs are missing in three samples of ten keep the truth") {
  const fs::path home =
      fs::temp_directory_path() / ("cordon_example_gaps_" + std::to_string(::getpid()));
  Counts count;
  std::uint64_t taken = 0;
  for (const fs::path& file : example_studies()) {
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      const Json study = with_gaps(file, seed);
      if (study.is_null()) break;
      taken += seed == 1;
      CAPTURE(file.filename().string());
      CAPTURE(seed);
      fs::remove_all(home);
      fs::create_directories(home);
      run_and_verify(study, home, count);
    }
  }
  fs::remove_all(home);
  MESSAGE(count.runs, " runs of ", taken, " studies: ", count.verified, " verified, ",
          count.undecided, " undecided");
  CHECK(taken >= 12);
  CHECK(count.undecided * 10 <= count.runs);
}

TEST_CASE("no truth is lost over many seeds with gaps") {
  const fs::path home =
      fs::temp_directory_path() / ("cordon_gap_seeds_" + std::to_string(::getpid()));
  const std::uint64_t most = number_of("CORDON_GAP_SEEDS", 5);
  double told = 0;
  int studies = 0;
  for (const fs::path& file : example_studies()) {
    Json study = with_gaps(file, 1);
    if (study.is_null()) continue;
    CAPTURE(file.filename().string());
    study["data"]["simulate"].erase("seed");
    study["data"]["simulate"].erase("seeds");
    study["sweep"] = {{{"name", "seed"},
                       {"path", "/data/simulate/seed"},
                       {"range", {1, most}},
                       {"repeat", true}}};
    fs::remove_all(home);
    fs::create_directories(home);
    std::ofstream(home / "study.json") << study.dump(1) << '\n';
    const Outcome ran = program("run --quiet --no-report --out " + (home / "out").string() + " " +
                                (home / "study.json").string());
    CAPTURE(ran.out);
    CHECK(ran.code == 0);
    CHECK(sum_of(home / "out" / "points.csv", "contains_truth_no") == 0);
    told += sum_of(home / "out" / "points.csv", "contains_truth_yes");
    ++studies;
  }
  fs::remove_all(home);
  MESSAGE(studies, " studies, ", most, " seeds each: ", told, " true states proven inside");
  CHECK(studies >= 12);
  CHECK(told > 1000);
}
