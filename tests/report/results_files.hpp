// SPDX-License-Identifier: GPL-3.0-or-later
// Small results directories, written by hand.
#pragma once

#include <fstream>
#include <string>

#include "run/scratch.hpp"

/// Files of a run of two pipelines, "a" and "b", over three steps of two states.
class ResultsFiles {
 public:
  ResultsFiles() {
    write(
        "results.json",
        R"({"cordon_results": 1, "cordon": {"version": "1.2", "abi_tag": "x"}, "tools": {"compiler": "c"},
  "plugins": [{"name": "p", "version": "3"}], "title": "Two <b>states</b>", "study_hash": "h",
  "study": {"title": "Two", "system": {"modes": []}},
  "pipelines": [{"name": "a", "backend": "box", "observer": "o", "steps": [{"k": 0}]},
                {"name": "b", "backend": "box", "observer": "o", "steps": []}]})");
    write("run.json", R"({"cordon_run": 1, "started": "now", "host": {"name": "h"}, "pipelines": [
  {"name": "a", "steps": [{"k": 0, "time_us": {"predict": 1, "correct": 2, "reduce": 4, "question": 8, "hull": 16}}]},
  {"name": "b", "steps": [{"k": 0, "time_us": {"predict": 1, "correct": 0, "reduce": 0, "question": 8, "hull": 16}}]}]})");
    write(
        "steps.csv",
        R"(pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2,radius,volume_of,volume,inner_lower_1,inner_lower_2,inner_upper_1,inner_upper_2
a,0,yes,exact,-1,-inf,1,inf,1,set,4,,,,
a,1,unknown,outer,-2,-3,2,3,3,set,0.5,-1,-1,1,1.5
a,2,no,outer,1,1,-1,-1,,none,,,,,
b,0,yes,outer,-5,-5,5,5,5,hull,100,,,,
)");
    write("data.csv", "k,y_1,x_1,x_2,mode\n0,0,0.25,0.5,0\n1,0,0.75,-0.5,0\n2,0,1,2,-1\n");
    write("sets.jsonl", "");
  }

  const std::filesystem::path& path() const { return scratch_.path(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(scratch_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return bytes_of(scratch_ / name); }
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = read(name);
    text.replace(text.find(from), from.size(), to);
    write(name, text);
  }

 private:
  Scratch scratch_;
};
