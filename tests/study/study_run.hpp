// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace test {

/// A study with its data, run.
class StudyRun {
 public:
  StudyRun(const nlohmann::ordered_json& study, const std::string& csv = "") {
    scratch_.write("s.json", study.dump(1));
    if (!csv.empty()) scratch_.write("d.csv", csv);
    outcome = (*this)("run s.json --out out --no-report");
  }
  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with(arguments + " 2>&1", "cd \"" + scratch_.path().string() + "\" &&");
  }
  nlohmann::ordered_json pipeline(std::size_t i = 0) const {
    return nlohmann::ordered_json::parse(bytes_of(scratch_ / "out/results.json"))["pipelines"][i];
  }
  void exchange(const std::string& from, const std::string& to) const {
    std::string results = bytes_of(scratch_ / "out/results.json");
    const std::size_t at = results.find(from);
    REQUIRE(at != std::string::npos);
    results.replace(at, from.size(), to);
    scratch_.write("out/results.json", results);
    std::filesystem::remove(scratch_ / "out/manifest.json");
  }

  Outcome outcome;

 private:
  Scratch scratch_;
};

}  // namespace test
