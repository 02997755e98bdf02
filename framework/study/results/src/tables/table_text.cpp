// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/table_text.hpp"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/text.hpp"
#include "study/results/results_parts.hpp"

namespace cordon::detail {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Replaces what stands in `pairs`, longest first where one begins like another.
template <std::size_t Count>
std::string replaced(
    std::string_view text,
    const std::array<std::pair<std::string_view, std::string_view>, Count>& pairs) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t taken = 1;
    std::string by(1, is_control(text[i]) ? ' ' : text[i]);
    for (const auto& [what, with] : pairs) {
      if (!text.substr(i).starts_with(what)) continue;
      taken = what.size();
      by = with;
      break;
    }
    out += by;
    i += taken;
  }
  return out;
}

}  // namespace

std::string axis_value(const ResultTable& table, std::size_t axis, std::size_t index,
                       std::size_t limit) {
  const std::vector<std::string>& values = table.axes.at(axis).values;
  std::string text = index < values.size() ? values[index] : "?";
  if (index < table.axes[axis].labels.size()) {
    text = table.axes[axis].labels[index];
  } else if (text.starts_with('"')) {
    const nlohmann::json parsed = nlohmann::json::parse(text, nullptr, false);
    if (parsed.is_string()) text = parsed.get<std::string>();
  }
  text = printable(text);
  if (text.size() <= limit) return text;
  std::size_t end = limit;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u)
    --end;  // never inside a character
  return text.substr(0, end) + "…";
}

std::string latex_text(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 21> pairs{
      {{"\\", "\\textbackslash{}"},
       {"{", "\\{"},
       {"}", "\\}"},
       {"$", "\\$"},
       {"&", "\\&"},
       {"#", "\\#"},
       {"%", "\\%"},
       {"_", "\\_"},
       {"^", "\\textasciicircum{}"},
       {"~", "\\textasciitilde{}"},
       {"<", "\\textless{}"},
       {">", "\\textgreater{}"},
       {"|", "\\textbar{}"},
       {"\"", "\\textquotedbl{}"},
       {"±", "$\\pm$"},
       {"×", "$\\times$"},
       {"∞", "$\\infty$"},
       {"µ", "$\\mu$"},
       {"κ", "$\\kappa$"},
       {"†", "$\\dagger$"},
       {"–", "--"}}};
  return replaced(text, pairs);
}

std::string markdown_text(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> pairs{
      {{"\\", "\\\\"},
       {"|", "\\|"},
       {"`", "\\`"},
       {"$", "\\$"},
       {"*", "\\*"},
       {"_", "\\_"},
       {"[", "\\["},
       {"]", "\\]"},
       {"#", "\\#"},
       {"~", "\\~"},
       {"&", "&amp;"},
       {"<", "&lt;"},
       {">", "&gt;"}}};
  return replaced(text, pairs);
}

}  // namespace cordon::detail
