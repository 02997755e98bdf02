// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the median of every benchmark in microseconds, the share of its budget (budget.hpp) and
// its ratio to the stored baseline, where there are such, and the medians of its counters. Options
// are those of Google Benchmark
// (--benchmark_filter=REGEX, …), and
//   --baseline=FILE       compare with this file instead of bench/baseline.txt
//   --save-baseline=FILE  write the medians there
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include <benchmark/benchmark.h>

#include "budget.hpp"

namespace {

using Medians = std::map<std::string, double>;

/// Lines of a name and microseconds.
Medians read_medians(const std::string& path) {
  Medians medians;
  std::ifstream file(path);
  std::string name;
  for (double median = 0; file >> name >> median;) medians[name] = median;
  return medians;
}

class MedianReporter final : public benchmark::BenchmarkReporter {
 public:
  explicit MedianReporter(Medians baseline) : baseline_(std::move(baseline)) {}
  const Medians& medians() const { return medians_; }

  bool ReportContext(const Context& context) override {
    std::printf("%d cores at %.0f MHz; medians of 7 repetitions\n%-46s %13s %8s %10s\n",
                context.cpu_info.num_cpus, context.cpu_info.cycles_per_second / 1e6, "benchmark",
                "median", "× budget", "× baseline");
    return true;
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Aggregate || run.aggregate_name != "median") continue;
      std::string name = run.run_name.str();
      for (const char* suffix :
           {"/repeats:7", "/manual_time", "/min_time:0.050", "/min_time:0.010"}) {
        if (const auto at = name.find(suffix); at != std::string::npos)
          name.erase(at, std::strlen(suffix));
      }
      const double median = run.GetAdjustedRealTime();
      medians_[name] = median;
      std::printf("%-46s %10.2f µs", name.c_str(), median);
      const auto budget = cordon::bench::budget_of(name);
      const auto before = baseline_.find(name);
      if (budget || before != baseline_.end() || !run.counters.empty()) {
        print_ratio(8, budget ? median / *budget : 0);
        print_ratio(10, before != baseline_.end() ? median / before->second : 0);
      }
      for (const auto& [counter, value] : run.counters)
        std::printf("  %s %.3g", counter.c_str(), value.value);
      std::printf("\n");
      std::fflush(stdout);
    }
  }

 private:
  static void print_ratio(int width, double ratio) {
    if (ratio > 0) {
      std::printf(" %*.2f", width, ratio);
    } else {
      std::printf(" %*s", width, "");
    }
  }

  Medians baseline_, medians_;
};

/// The value of --NAME=VALUE, taken out of the arguments.
std::string take_option(int& argc, char** argv, const char* name, std::string value) {
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], name, std::strlen(name)) == 0) {
      value = argv[i] + std::strlen(name);
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string baseline =
      take_option(argc, argv, "--baseline=", CORDON_SOURCE_DIR "/bench/baseline.txt");
  const std::string saved = take_option(argc, argv, "--save-baseline=", "");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  MedianReporter reporter(read_medians(baseline));
  benchmark::RunSpecifiedBenchmarks(&reporter);
  if (saved.empty()) return 0;
  std::ofstream file(saved);
  for (const auto& [name, median] : reporter.medians()) file << name << ' ' << median << '\n';
  if (!file.flush()) {
    std::fprintf(stderr, "%s cannot be written\n", saved.c_str());
    return 1;
  }
  return 0;
}
