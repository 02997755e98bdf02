// SPDX-License-Identifier: GPL-3.0-or-later
// The program on studies that use the lying plugin, as a user meets it.
#pragma once

#include <initializer_list>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace claims {

using Json = nlohmann::ordered_json;
using test::Outcome;

/// A directory with a study and its results.
class Program {
 public:
  explicit Program(const Json& study) { scratch_.write("study.json", study.dump(1)); }

  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with("--plugins \"" CORDON_LYING_PLUGINS "\" " + arguments,
                             "cd \"" + scratch_.path().string() + "\" &&");
  }
  Outcome run() const { return (*this)("run study.json --out results"); }
  Outcome design(const std::string& options = "") const {
    return (*this)("design study.json " + options);
  }
  Outcome verify() const { return (*this)("verify results"); }
  Json results() const { return Json::parse(bytes_of(scratch_ / "results/results.json")); }
  std::string file(const std::string& name) const {
    return bytes_of(scratch_ / ("results/" + name));
  }
  /// Without the manifest, which tells of other bytes.
  void write_results(const Json& results) const {
    scratch_.write("results/results.json", results.dump());
    std::filesystem::remove(scratch_ / "results/manifest.json");
  }

 private:
  Scratch scratch_;
};

inline Json box(std::initializer_list<double> radii) {
  Json lower = Json::array(), upper = Json::array();
  for (const double radius : radii) {
    lower.push_back(-radius);
    upper.push_back(radius);
  }
  return {{"type", "box"}, {"lower", lower}, {"upper", upper}};
}

/// The run, which speaks of no assumption.
inline Outcome check_kept(const Program& program) {
  const Outcome run = program.run();
  CAPTURE(run.out);
  CHECK(run.code == 0);
  CHECK_FALSE(run.says("Assumption failed"));
  CHECK(program.results()["pipelines"][0]["summary"]["failed_assumption"].is_null());
  CHECK(program.verify().code == 0);
  return run;
}

}  // namespace claims
