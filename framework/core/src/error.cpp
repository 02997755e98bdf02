// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <numeric>
#include <utility>

#include "core/text.hpp"

namespace cordon {

namespace {

std::string place_of(const Diagnostic& d) {
  const std::string line = d.line > 0 ? "line " + std::to_string(d.line) : "";
  if (d.pointer.empty()) return line.empty() ? "the file" : line;
  return detail::printable(d.pointer) + (line.empty() ? "" : " (" + line + ")");
}

/// One mistake that was made in many places is told once, with the first place and the last.
std::string render(const std::string& file, const std::vector<Diagnostic>& diagnostics) {
  constexpr std::size_t many = 6;
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> alike;
  for (std::size_t i = 0; i < diagnostics.size(); ++i)
    alike[{diagnostics[i].message, diagnostics[i].suggestion}].push_back(i);
  std::string text = detail::printable(file) + ": " + std::to_string(diagnostics.size()) +
                     (diagnostics.size() == 1 ? " error" : " errors");
  for (std::size_t i = 0; i < diagnostics.size(); ++i) {
    const Diagnostic& d = diagnostics[i];
    const std::vector<std::size_t>& same = alike[{d.message, d.suggestion}];
    const bool repeats = same.size() >= many;
    if (repeats && i != same.front()) continue;
    text += "\n  " + place_of(d);
    if (repeats) {
      text += " and " + std::to_string(same.size() - 1) + " other places, the last " +
              place_of(diagnostics[same.back()]);
    }
    text += ": " + detail::printable_lines(d.message);
    if (!d.suggestion.empty()) text += "; " + detail::printable_lines(d.suggestion);
  }
  return text;
}

/// Insertions, deletions, replacements and swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (a[i] == b[j] ? 0 : 1), row[j] + 1, last[j + 1] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row[j + 1] = std::min(row[j + 1], before_last[j - 1] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string_view to_string(Errc code) noexcept {
  switch (code) {
    case Errc::dimension:
      return "dimension";
    case Errc::not_finite:
      return "not_finite";
    case Errc::invalid:
      return "invalid";
    case Errc::unsupported:
      return "unsupported";
    case Errc::not_enclosed:
      return "not_enclosed";
    case Errc::solver:
      return "solver";
    case Errc::time_limit:
      return "time_limit";
    case Errc::plugin:
      return "plugin";
    case Errc::io:
      return "io";
    case Errc::violated:
      return "violated";
    case Errc::internal:
      return "internal";
  }
  return "internal";
}

Error::~Error() = default;
InputError::~InputError() = default;

InputError::InputError(std::string file, std::vector<Diagnostic> diagnostics)
    : Error(Errc::invalid, render(file, diagnostics)),
      file_(std::move(file)),
      diagnostics_(std::move(diagnostics)) {}

namespace {

/// Another word altogether is no spelling of one with a single letter, or with none.
bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > 200) return "";  // hostile input: the distance is quadratic
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && (distance < word.size() || same_letters(word, candidate))) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggest(std::string_view word, const std::vector<std::string>& candidates) {
  if (const std::string near = nearest(word, candidates); !near.empty())
    return "did you mean \"" + detail::printable(near) + "\"?";
  if (candidates.empty()) return "";
  std::string text = candidates.size() == 1 ? "there is only" : "there are";
  for (std::size_t i = 0; i < candidates.size(); ++i)
    text += (i == 0 ? " \"" : ", \"") + detail::printable(candidates[i]) + "\"";
  return text;
}

}  // namespace cordon
