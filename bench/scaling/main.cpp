// SPDX-License-Identifier: GPL-3.0-or-later
// How time and memory of a step grow with the states, the generators and the constraints: prints a
// table.
//   --csv FILE  writes the measurements there
//   --svg FILE  writes a figure of the times there
#include <cstdio>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "figure.hpp"
#include "registry.hpp"
#include "study.hpp"
#include "table.hpp"

namespace {

using namespace cordon;
using namespace cordon::bench;

constexpr int rounds = 4;

struct Options {
  std::string csv, svg;
};

bool failed(const std::vector<AxisResult>& results) {
  for (const AxisResult& result : results) {
    for (const Curve& curve : result.curves) {
      if (!curve.troubles.empty()) return true;
    }
  }
  return false;
}

/// Leaves the options as they are and returns false after a message, where an argument is none.
bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    std::string* const value = name == "--csv"   ? &options.csv
                               : name == "--svg" ? &options.svg
                                                 : nullptr;
    if (!value) {
      fmt::print(stderr, "scaling: unknown option {}; there are --csv FILE and --svg FILE\n", name);
      return false;
    }
    if (++i == argc) {
      fmt::print(stderr, "scaling: {} needs a file\n", name);
      return false;
    }
    *value = argv[i];
  }
  return true;
}

/// Writes the text, or with none finds out whether the file can be written; says so if not.
bool write(const std::string& path, const std::string* text) {
  if (path.empty()) return true;
  std::ofstream file(path, text ? std::ios::trunc : std::ios::app);
  if (text) file << *text;
  if (file.flush()) return true;
  fmt::print(stderr, "scaling: {} cannot be written\n", path);
  return false;
}

/// Plugins that are missing or were built against other headers would fail every case.
void require_components() {
  for (const std::string& backend : all_backends()) registry().make<BackendEntry>(backend, {});
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options)) return 2;
  if (!write(options.csv, nullptr) || !write(options.svg, nullptr)) return 1;
  try {
    require_components();
    const std::vector<AxisResult> results = measure_all(registry(), rounds);
    print_preamble(rounds);
    for (const AxisResult& result : results) print(result);
    const std::string table = csv(results), drawing = figure(results);
    const bool written = write(options.csv, &table) && write(options.svg, &drawing);
    return written && !failed(results) ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "scaling: {}\n", error.what());
    return 1;
  }
}
