// SPDX-License-Identifier: GPL-3.0-or-later
#include "earlier_results.hpp"

#include "cordon/core/error.hpp"
#include "study/text/input_file.hpp"
#include "study/text/json_text.hpp"

namespace cordon::detail {

std::vector<std::string> files_of_earlier_results(const std::filesystem::path& directory) {
  constexpr std::size_t longest = json::max_bytes;
  try {
    InputFile file(directory / "results.json");
    std::string line;
    if (!file.line(line, longest) || line != "{") return {};
    if (!file.line(line, longest) || !line.starts_with("  \"cordon_results\": ")) return {};
    bool sweep = false;
    while (!sweep && file.line(line, longest)) sweep = line == "  \"points\": [";
    if (sweep) return {"points.csv", "times.csv", "report.html"};
    return {"data.csv", "sets.jsonl", "steps.csv", "diagnosis.csv", "inputs.csv", "report.html"};
  } catch (const InputError&) {
    return {};  // nothing that this program wrote
  }
}

}  // namespace cordon::detail
