// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a study that serve nothing are told.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::cordon_with;
using test::Outcome;

namespace {

Outcome validated(const Scratch& scratch, const Json& study) {
  scratch.write("s.json", study.dump());
  return cordon_with("validate --trust-plugins \"" + (scratch / "s.json").string() + "\"");
}

Json example(const char* name) {
  return Json::parse(bytes_of(std::string(CORDON_SOURCE_DIR "/examples/studies/") + name));
}

}  // namespace

TEST_CASE("a directory of plugins without any") {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "empty");
  Json study = example("linear_two_states.json");
  CHECK_FALSE(validated(scratch, study).complains("warning"));
  study["plugins"] = {"empty"};
  const Outcome outcome = validated(scratch, study);
  CHECK(outcome.code == 0);
  CHECK_MESSAGE(outcome.complains("there is no plugin (no .so file) in \"empty\""), outcome.err);
}

TEST_CASE("metrics where nothing is estimated") {
  const Scratch scratch;
  Json study = example("fault_estimation_descriptor.json");
  CHECK_FALSE(validated(scratch, study).complains("/metrics"));
  study["metrics"] = {"radius"};
  const Outcome outcome = validated(scratch, study);
  CHECK(outcome.code == 0);
  CHECK_MESSAGE(outcome.complains("/metrics: they measure pipelines with an observer"),
                outcome.err);
}
