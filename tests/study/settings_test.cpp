// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon run --set /path=value`.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::cordon_with;
using test::Outcome;

namespace {

const std::string study = "\"" CORDON_SOURCE_DIR "/examples/studies/linear_two_states.json\"";

struct Runs {
  Outcome run(const std::string& settings) const {
    return cordon_with("run " + study + " --no-report --out \"" + (scratch / "out").string() +
                       "\" " + settings);
  }
  Json resolved() const { return Json::parse(bytes_of(scratch / "out/results.json"))["study"]; }

  Scratch scratch;
};

}  // namespace

TEST_CASE_FIXTURE(Runs, "values are put where their paths lead, and are part of the results") {
  const Outcome outcome =
      run("--set /data/simulate/seed=17 --set /title='another one' --set '/system/A/0/1=-0.25' "
          "--set '/pipelines/*/observer/max_generators=12' "
          "--set '/system/V={\"type\": \"box\", \"lower\": [-0.5], \"upper\": [0.5]}'");
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const Json study = resolved();
  CHECK(study["title"] == "another one");
  CHECK(study["data"]["simulate"]["seed"] == 17);
  CHECK(study["system"]["A"][0][1] == -0.25);
  int budgets = 0;
  for (const Json& pipeline : study["pipelines"])
    budgets += pipeline["observer"].value("max_generators", 0) == 12;
  CHECK(budgets > 0);
  // the results are a study that says the same
  std::ofstream(scratch / "again.json") << study.dump();
  const std::string sets = bytes_of(scratch / "out/sets.jsonl");
  const Outcome again = cordon_with("run \"" + (scratch / "again.json").string() +
                                    "\" --no-report --out \"" + (scratch / "out").string() + "\"");
  CHECK_MESSAGE(again.code == 0, again.err);
  CHECK(bytes_of(scratch / "out/sets.jsonl") == sets);
}

TEST_CASE_FIXTURE(Runs, "what cannot be put there is an error with its place") {
  const auto refused = [&](const std::string& settings, const std::string& what) {
    const Outcome outcome = run(settings);
    CAPTURE(settings);
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(outcome.complains(what), outcome.err);
    CHECK_MESSAGE(!outcome.complains("(line "), outcome.err);  // it is on none of the file
    CHECK_FALSE(std::filesystem::exists(scratch / "out"));
  };
  refused("--set /pipelines/*/observer/max_generator=12", "max_generators");
  refused("--set /data/simulate/seeed=3", "/data/simulate/seeed");
  refused("--set /system/A/9/9=1", "/system/A/9/9");
  refused("--set seed=3", "write --set /path=value");
  refused("--set /data/simulate/seed", "write --set /path=value");
  refused("--set '/system/A=[[1, 2'", "is no JSON");
  refused("--set /plugins='[\"x\"]'", "leads into /plugins");
  refused("--set /cordon=2", "leads into /cordon");
  refused("--set /data/simulate/steps=many", "/data/simulate/steps");
}
