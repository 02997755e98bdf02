// SPDX-License-Identifier: GPL-3.0-or-later
// The program of this build as a process of its own.
#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "run/scratch.hpp"

namespace program {

/// Two pipelines with `seeds` seeds each.
inline std::string study(int seeds, int steps = 100) {
  return R"({
  "cordon": 1, "title": "two states",
  "system": {
    "type": "lti", "A": [[0, -0.5], [1, 1]], "Bw": [[-0.12], [0.02]], "C": [[-2, 1]], "Dv": [[0.2]],
    "X0": {"type": "box", "lower": [-3, -3], "upper": [3, 3]},
    "W": {"type": "box", "lower": [-1], "upper": [1]}, "V": {"type": "box", "lower": [-1], "upper": [1]}
  },
  "data": {"simulate": {"steps": )" +
         std::to_string(steps) + R"(, "x0": [1, -1]}},
  "pipelines": [
    {"name": "Zonotope", "backend": "zonotope", "observer": "prediction_correction"},
    {"name": "Interval", "backend": "interval", "observer": "prediction_correction"}
  ],
  "metrics": ["radius", "volume", "contains_truth", "step_time"],
  "sweep": [{"name": "seed", "path": "/data/simulate/seed", "range": [1, )" +
         std::to_string(seeds) + R"(]}]
})";
}

/// A process that runs `cordon` with its output in a file.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& output)
      : output_(output) {
    child_ = ::fork();
    if (child_ != 0) return;
    std::FILE* const file = std::fopen(output.c_str(), "w");
    ::dup2(::fileno(file), STDOUT_FILENO);
    ::dup2(::fileno(file), STDERR_FILENO);
    ::unsetenv("CORDON_PLUGIN_PATH");
    std::vector<char*> words{const_cast<char*>(CORDON_PROGRAM)};
    for (const std::string& argument : arguments)
      words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    ::execv(CORDON_PROGRAM, words.data());
    ::_exit(127);
  }
  ~Process() {
    if (!ended_) kill_it(SIGKILL);
    wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void kill_it(int signal) const { ::kill(child_, signal); }
  /// Its exit code; minus the signal that killed it.
  int wait() {
    if (!ended_) {
      int status = 0;
      while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
      }
      ended_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    return *ended_;
  }
  std::string output() const { return bytes_of(output_); }

 private:
  std::filesystem::path output_;
  pid_t child_ = -1;
  std::optional<int> ended_;
};

struct Outcome {
  int exit = -1;
  std::string text;
};

inline Outcome run(const Scratch& scratch, const std::vector<std::string>& arguments) {
  Process process(arguments, scratch / "output");
  const int exit = process.wait();
  return {exit, process.output()};
}

/// The files of a sweep that do not hold times.
inline std::map<std::string, std::string> reproducible(const std::filesystem::path& out) {
  static const std::set<std::string> with_times{"run.json",     "times.csv",      "summary.tex",
                                                "summary.md",   "benchmarks.csv", "report.html",
                                                "manifest.json"};
  std::map<std::string, std::string> files = tree(out);
  std::erase_if(files, [](const auto& file) { return with_times.count(file.first) > 0; });
  return files;
}

}  // namespace program
