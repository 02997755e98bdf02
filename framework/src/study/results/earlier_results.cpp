// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/earlier_results.hpp"

#include <fstream>

namespace cordon::detail {

std::vector<std::string> files_of_earlier_results(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / "results.json";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  if (!std::getline(stream, line) || line != "{" || !std::getline(stream, line) || !line.starts_with("  \"cordon_results\": "))
    return {};
  bool sweep = false;
  while (!sweep && std::getline(stream, line)) sweep = line == "  \"points\": [";
  if (sweep) return {"points.csv", "times.csv", "report.html"};
  return {"data.csv", "sets.jsonl", "steps.csv", "diagnosis.csv", "inputs.csv", "report.html"};
}

}  // namespace cordon::detail
