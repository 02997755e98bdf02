// SPDX-License-Identifier: GPL-3.0-or-later
// The program on studies that use the lying plugin, as a user meets it.
#pragma once

#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "run/scratch.hpp"

namespace claims {

using Json = nlohmann::ordered_json;

struct Said {
  int code = -1;
  std::string out, err;
  bool has(const std::string& what) const { return out.find(what) != std::string::npos; }
  bool complains(const std::string& what) const { return err.find(what) != std::string::npos; }
};

/// A directory with a study and its results.
class Program {
 public:
  explicit Program(const Json& study) { scratch_.write("study.json", study.dump(1)); }

  Said operator()(const std::string& arguments) const {
    const std::string out = (scratch_ / "out.txt").string(), err = (scratch_ / "err.txt").string();
    const std::string command = "cd \"" + scratch_.path().string() +
                                "\" && \"" CORDON_PROGRAM "\" --plugins \"" CORDON_LYING_PLUGINS "\" " + arguments + " >\"" +
                                out + "\" 2>\"" + err + "\"";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(out), bytes_of(err)};
  }
  Said run() const { return (*this)("run study.json --out results"); }
  Said design(const std::string& options = "") const { return (*this)("design study.json " + options); }
  Said verify() const { return (*this)("verify results"); }
  Json results() const { return Json::parse(bytes_of(scratch_ / "results/results.json")); }
  std::string file(const std::string& name) const { return bytes_of(scratch_ / ("results/" + name)); }
  void write_results(const Json& results) const { scratch_.write("results/results.json", results.dump()); }

 private:
  Scratch scratch_;
};

}  // namespace claims
