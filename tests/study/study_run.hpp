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
  nlohmann::ordered_json pipeline(std::size_t i = 0) const { return results()["pipelines"][i]; }
  std::string text(const std::string& file) const { return bytes_of(scratch_ / file); }
  nlohmann::ordered_json results() const {
    return nlohmann::ordered_json::parse(bytes_of(scratch_ / "out/results.json"));
  }
  void exchange(const std::string& from, const std::string& to,
                const std::string& file = "out/results.json") const {
    std::string text = bytes_of(scratch_ / file);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    scratch_.write(file, text);
    std::filesystem::remove(scratch_ / "out/manifest.json");
  }

  Outcome outcome;

 private:
  Scratch scratch_;
};

}  // namespace test
