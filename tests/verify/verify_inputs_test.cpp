// SPDX-License-Identifier: GPL-3.0-or-later
// Designs that a run has written, proven again: what is true holds, what is false is found.
#include <fstream>
#include <functional>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "cordon/study/run.hpp"
#include "cordon/study/verify.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using Json = nlohmann::ordered_json;

namespace {

/// Two scalar models, any initial state, and two given inputs: one separates, the other does not.
Json scalar_study() {
  return Json::parse(R"({
    "cordon": 1, "title": "given inputs",
    "system": {"type": "lti", "A": [[1]], "B": [[1]], "C": [[1]], "X0": {"type": "space", "dim": 1},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]}, "V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "U": {"type": "box", "lower": [-2], "upper": [2]},
      "modes": [{"name": "fast", "system": {"type": "lti", "A": [[0.2]], "B": [[1]], "C": [[1]],
        "W": {"type": "box", "lower": [-0.1], "upper": [0.1]}, "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}}}]},
    "pipelines": [
      {"name": "apart", "backend": "line_zonotope", "designer": {"type": "given", "input": [[0], [0.99], [0], [0]]}},
      {"name": "together", "backend": "line_zonotope", "designer": {"type": "given", "input": [[0], [0], [0], [0]]}}]})");
}

/// A static row, 0 = x_2 - u: states beyond the admissible set leave no output.
Json descriptor_study() {
  Json study = scalar_study();
  study["system"] = Json::parse(
      R"({"type": "descriptor", "E": [[1, 0], [0, 0]], "A": [[0.5, 0], [0, 1]], "B": [[0], [-1]], "C": [[0, 1]],
    "Dv": [[1]], "W": {"type": "box", "lower": [0, 0], "upper": [0, 0]}, "X0": {"type": "space", "dim": 2}, "V": {"type": "box", "lower": [-1], "upper": [1]},
    "U": {"type": "box", "lower": [-4], "upper": [4]},
    "modes": [{"name": "opposite", "system": {"type": "descriptor", "E": [[1, 0], [0, 0]], "A": [[0.5, 0], [0, 1]], "B": [[0], [1]],
      "C": [[0, 1]], "Dv": [[1]], "W": {"type": "box", "lower": [0, 0], "upper": [0, 0]}, "V": {"type": "box", "lower": [-1], "upper": [1]}}}]})");
  const Json unit = Json::parse(R"({"type": "box", "lower": [-1, -1], "upper": [1, 1]})");
  study["pipelines"] = Json::parse(R"([
    {"name": "fits", "backend": "line_zonotope", "designer": {"type": "given", "input": [[2], [0.5]], "outputs": "last"}},
    {"name": "empty", "backend": "line_zonotope", "designer": {"type": "given", "input": [[0], [2]]}}])");
  for (Json& pipeline : study["pipelines"]) pipeline["designer"]["admissible_set"] = unit;
  return study;
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class Run {
 public:
  explicit Run(const Json& study) {
    write("study.json", study);
    Registry registry;
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    RunOptions options;
    options.out = scratch_ / "out";
    run_study(read_study(scratch_ / "study.json", registry, {}), registry, options);
    results_ = Json::parse(text_of(scratch_ / "out/results.json"));
  }

  VerifyOutcome with(const std::function<void(Json&)>& change) const {
    Json changed = results_;
    change(changed["pipelines"]);
    write("out/results.json", changed);
    std::filesystem::remove(scratch_ / "out/manifest.json");  // which knows it as it was
    return verify_run(scratch_ / "out");
  }

  const Json& results() const { return results_; }

 private:
  void write(const char* name, const Json& value) const {
    std::ofstream(scratch_ / name) << value.dump(1);
  }

  Scratch scratch_;
  Json results_;
};

std::string refused(const Run& run, const std::function<void(Json&)>& change) {
  try {
    run.with(change);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("recorded designs are proven again, and false ones are found") {
  const Run run(scalar_study());
  const VerifyOutcome fine = run.with([](Json&) {});
  CHECK_FALSE(fine.violation);
  REQUIRE(fine.pipelines.size() == 2);
  for (const VerifiedPipeline& pipeline : fine.pipelines) {
    CHECK(pipeline.kind == PipelineKind::design);
    CHECK(pipeline.proofs == 3);  // one pair, two tubes
    CHECK(pipeline.undecided == 0);
    CHECK(pipeline.steps == 0);
  }

  const VerifyOutcome called_apart =
      run.with([](Json& p) { p[1]["design"]["pairs"][0]["disjoint"] = "yes"; });
  REQUIRE(called_apart.violation);
  CHECK(called_apart.violation->pipeline == "together");
  CHECK(called_apart.violation->pointer == "/pipelines/1/design/pairs/0");
  CHECK(called_apart.violation->k == 3);
  CHECK(called_apart.violation->what.find("called disjoint, and meet") != std::string::npos);

  CHECK(run.with([](Json& p) { p[0]["design"]["pairs"][0]["disjoint"] = "no"; }).violation);
  CHECK(run.with([](Json& p) { p[0]["design"]["u"] = p[1]["design"]["u"]; }).violation);
  const VerifyOutcome called_empty =
      run.with([](Json& p) { p[0]["design"]["tubes"][1]["empty"] = "yes"; });
  REQUIRE(called_empty.violation);
  CHECK(called_empty.violation->pointer == "/pipelines/0/design/tubes/1");
}

TEST_CASE("what the host has proven of a design is proven again") {
  const Run run(scalar_study());
  const auto refuted = [&](const std::function<void(Json&)>& change) {
    const VerifyOutcome outcome = run.with(change);
    return outcome.violation ? outcome.violation->pointer : "";
  };
  CHECK(refuted([](Json& p) { p[1]["exact"]["separates"] = "yes"; }) ==
        "/pipelines/1/exact/separates");
  CHECK(refuted([](Json& p) { p[1]["design"]["separates"] = "yes"; }) ==
        "/pipelines/1/design/separates");
  CHECK(refuted([](Json& p) {
          p[1]["exact"]["pairs"][0]["disjoint"] = "yes";
          p[1]["exact"]["pairs"][0]["kappa_lower"] = 1;
        }) == "/pipelines/1/exact/pairs/0");
  CHECK(refuted([](Json& p) { p[0]["exact"]["pairs"][0]["disjoint"] = "no"; }) ==
        "/pipelines/0/exact/pairs/0");
  CHECK(refuted([](Json& p) {
          Json& kappa = p[0]["exact"]["pairs"][0]["kappa_lower"];
          kappa = kappa.get<double>() * (1 + 1e-12);
        }) == "/pipelines/0/exact/pairs/0");
  // a positive bound says that the pair is apart, whatever word stands beside it
  for (const char* word : {"no", "unknown"}) {
    for (const char* part : {"design", "exact"}) {
      CHECK(refuted([&](Json& p) {
              p[1][part]["pairs"][0]["disjoint"] = word;
              p[1][part]["pairs"][0]["kappa_lower"] = .5;
              if (p[1][part]["pairs"][0].contains("kappa")) p[1][part]["pairs"][0]["kappa"] = .5;
            }) == std::string("/pipelines/1/") + part + "/pairs/0");
    }
  }
  CHECK(refuted([](Json& p) { p[0]["exact"]["tubes"][1]["empty"] = "yes"; }) ==
        "/pipelines/0/exact/tubes/1");
  CHECK(refuted([](Json& p) { p[0]["exact"] = nullptr; }) == "");
  for (const double bound : {-.5, -1e-6, 0.})  // of a pair that meets nothing is proven
    CHECK(refuted([&](Json& p) { p[1]["exact"]["pairs"][0]["kappa_lower"] = bound; }) ==
          "/pipelines/1/exact/pairs/0");
}

TEST_CASE("a bound of κ that is too large stays open") {
  const Run run(scalar_study());
  const VerifyOutcome larger = run.with([](Json& p) {
    Json& pair = p[0]["design"]["pairs"][0];
    pair["kappa_lower"] = pair["kappa"] = pair["kappa_lower"].get<double>() + .01;
  });
  CHECK_FALSE(larger.violation);
  CHECK(larger.pipelines[0].undecided == 1);
  CHECK(larger.pipelines[0].proofs == 2);
  CHECK(larger.pipelines[0].first_undecided.find("in place of") != std::string::npos);
  CHECK(run.with([](Json& p) {
             Json& pair = p[0]["design"]["pairs"][0];
             pair["kappa_lower"] = pair["kappa"] = "inf";
           })
            .pipelines[0]
            .undecided == 1);
  CHECK(run.with([](Json& p) { p[0]["design"]["pairs"][0]["kappa_lower"] = 0; })
            .pipelines[0]
            .proofs == 3);
}

TEST_CASE("a design that claims nothing is passed over") {
  const Run run(scalar_study());
  const auto nothing = run.with([](Json& p) {
    p[0]["design"]["pairs"][0]["disjoint"] = "unknown";
    p[0]["design"]["pairs"][0]["kappa_lower"] = nullptr;
    p[0]["design"]["separates"] = "unknown";
    for (const char* key : {"u", "cost", "separates", "pairs", "tubes"})
      p[1]["design"][key] = nullptr;
    p[1]["exact"] = nullptr;
  });
  REQUIRE(nothing.pipelines.size() == 2);
  CHECK(nothing.pipelines[0].proofs == 2);
  CHECK(nothing.pipelines[1].proofs == 0);
  CHECK(run.with([](Json& p) { p[1]["design"] = p[1]["exact"] = nullptr; }).pipelines[1].proofs ==
        0);
}

TEST_CASE("files of designs that are not as they were written") {
  const Run run(scalar_study());
  CHECK(refused(run, [](Json& p) {
          p[0]["design"]["u"] = Json::array();
        }).find("/pipelines/0/design/u") != std::string::npos);
  CHECK(refused(run, [](Json& p) { p[0]["design"]["u"][1] = {1, 2}; }) != "");
  CHECK(refused(run, [](Json& p) { p[0]["design"]["pairs"] = Json::array(); }).find("every pair") !=
        std::string::npos);
  CHECK(refused(run, [](Json& p) { p[0]["design"]["tubes"].erase(0); }).find("every mode") !=
        std::string::npos);
  CHECK(refused(run, [](Json& p) { p[0]["design"].erase("outputs"); }) != "");
  CHECK(refused(run, [](Json& p) { p[0]["design"]["outputs"] = "some"; }) != "");
  CHECK(refused(run, [](Json& p) { p[0].erase("design"); }) != "");
  const auto refuses = [&](const std::function<void(Json&)>& change, const std::string& place) {
    const std::string message = refused(run, change);
    CHECK_MESSAGE(message.find(place) != std::string::npos, message);
  };
  // a statement about other modes than those that are proven again
  for (const char* part : {"design", "exact"}) {
    const std::string at = std::string("/pipelines/0/") + part;
    const auto set = [&](const char* list, const char* key, const Json& value) {
      return [=](Json& p) { p[0][part][list][0][key] = value; };
    };
    refuses(set("pairs", "modes", {"fast", "nominal"}), at + "/pairs/0/modes/0");
    refuses(set("pairs", "modes", {"nominal", "nominal"}), at + "/pairs/0/modes/1");
    refuses(set("pairs", "modes", {"nominal"}), at + "/pairs/0/modes");
    refuses(set("pairs", "modes", nullptr), at + "/pairs/0/modes");
    refuses(set("tubes", "mode", "fast"), at + "/tubes/0/mode");
  }
  // an input that is not the one that is spoken of
  refuses([](Json& p) { p[0]["design"]["horizon"] = 2; }, "/pipelines/0/design/horizon");
  refuses([](Json& p) { p[0]["design"]["status"] = "infeasible"; }, "/pipelines/0/design/status");
  refuses([](Json& p) { p[0]["design"]["status"] = "best"; }, "/pipelines/0/design/status");
  refuses(
      [](Json& p) {
        for (const char* key : {"u", "cost", "separates", "pairs", "tubes"})
          p[1]["design"][key] = nullptr;
        p[1]["exact"] = nullptr;
        p[1]["design"]["status"] = "optimal";
      },
      "/pipelines/1/design/status");
  refuses([](Json& p) { p[1]["design"]["u"] = nullptr; }, "/pipelines/1/design/pairs");
  refuses([](Json& p) { p[1]["design"] = nullptr; }, "/pipelines/1/exact");
}

TEST_CASE("numbers of a design that contradict each other") {
  const Run run(scalar_study());
  const auto refuted = [&](const std::function<void(Json&)>& change) {
    const VerifyOutcome outcome = run.with(change);
    return outcome.violation ? outcome.violation->pointer : "";
  };
  CHECK(refuted([](Json& p) { p[0]["design"]["pairs"][0]["kappa"] = -5; }) ==
        "/pipelines/0/design/pairs/0");
  const auto above = [](Json& p) {
    p[0]["design"]["status"] = "feasible";
    p[0]["design"]["lower_bound"] = p[0]["design"]["cost"].get<double>() + 1;
  };
  CHECK(refuted(above) == "/pipelines/0/design/lower_bound");
  CHECK(refuted([](Json& p) {
          p[0]["design"]["status"] = "optimal";
          p[0]["design"]["lower_bound"] = "inf";
        }) == "/pipelines/0/design/lower_bound");
  CHECK(refuted([](Json& p) { p[0]["design"]["status"] = "feasible"; }) == "");
  CHECK(refuted([&](Json& p) {  // a given input that separates the modes costs less
          above(p);
          p[0]["design"]["status"] = "given";
        }) == "/pipelines/0/design/lower_bound");
}

TEST_CASE("a bound of κ of a pair that meets is proven too") {
  Json study = scalar_study();
  study["pipelines"][1]["designer"]["input"] = {{0}, {.3}, {0}, {0}};
  const Run run(study);
  const double kappa = run.results()["pipelines"][1]["design"]["pairs"][0]["kappa"].get<double>();
  REQUIRE(kappa > -1);
  REQUIRE(kappa < -.01);
  const auto pointer = [&](double bound, double computed) {
    const VerifyOutcome outcome = run.with([&](Json& p) {
      p[1]["design"]["pairs"][0]["kappa_lower"] = bound;
      p[1]["design"]["pairs"][0]["kappa"] = computed;
    });
    return outcome.violation ? outcome.violation->pointer : "";
  };
  for (const double true_bound : {-1., kappa - .01, kappa - 1e-7, kappa})
    CHECK(pointer(true_bound, kappa) == "");
  for (const double false_bound : {kappa + 1e-7, kappa / 2, -1e-6, 0.})
    CHECK(pointer(false_bound, 0) == "/pipelines/1/design/pairs/0");
  CHECK(pointer(kappa / 2, kappa) == "/pipelines/1/design/pairs/0");  // beside the file's own κ
}

TEST_CASE("an input that is called found, and does not separate") {
  const Run run(descriptor_study());
  for (const char* status : {"feasible", "optimal"}) {
    const auto altered = [&](Json& p) {
      for (Json& pipeline : p) pipeline["design"]["status"] = status;
    };
    const VerifyOutcome outcome = run.with(altered);
    REQUIRE(outcome.violation);
    CHECK(outcome.violation->pointer.find("/design/status") != std::string::npos);
  }
}

TEST_CASE("the admissible set and the outputs that count are taken from the record") {
  const Run run(descriptor_study());
  const VerifyOutcome fine = run.with([](Json&) {});
  CHECK_FALSE(fine.violation);
  CHECK(fine.pipelines[0].proofs == 3);
  CHECK(fine.pipelines[1].proofs == 3);
  // without the set there are outputs; with all outputs the first ones tell the modes apart
  CHECK(run.with([](Json& p) { p[1]["design"]["admissible_set"] = nullptr; }).violation->pointer ==
        "/pipelines/1/design/tubes/0");
  CHECK(run.with([](Json& p) { p[0]["design"]["outputs"] = "all"; }).violation->pointer ==
        "/pipelines/0/design/pairs/0");
}
