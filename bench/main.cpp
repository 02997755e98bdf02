// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the median of every benchmark, in microseconds, and those of its counters. Options are those of Google Benchmark
// (--benchmark_filter=REGEX, …).
#include <cstdio>
#include <string>

#include <benchmark/benchmark.h>

namespace {

class MedianReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override {
    std::printf("%d cores at %.0f MHz; medians of 7 repetitions\n%-52s %12s\n", context.cpu_info.num_cpus,
                context.cpu_info.cycles_per_second / 1e6, "benchmark", "median");
    return true;
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Aggregate || run.aggregate_name != "median") continue;
      std::string name = run.run_name.str();
      for (const char* suffix : {"/repeats:7", "/manual_time", "/min_time:0.050"}) {
        if (const auto at = name.find(suffix); at != std::string::npos) name.erase(at, std::string(suffix).size());
      }
      std::printf("%-52s %9.2f µs", name.c_str(), run.GetAdjustedRealTime());
      for (const auto& [counter, value] : run.counters) std::printf("  %s %.3g", counter.c_str(), value.value);
      std::printf("\n");
      std::fflush(stdout);
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
