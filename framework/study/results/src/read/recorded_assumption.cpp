// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/recorded_assumption.hpp"

#include <algorithm>
#include <array>

#include "study/text/input_file.hpp"

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;
using What = FailedAssumption::What;

constexpr std::array all_assumptions{
    What::initial_set, What::restart_set, What::admissible_set, What::U,         What::modes,
    What::W,           What::V,           What::W_exactly,      What::V_exactly, What::invariants};

/// Index of a mode by its name; -1 for null.
std::optional<Index> read_mode(const Cursor& at, const std::vector<std::string>& names) {
  if (at.is(Kind::null)) return -1;
  const auto name = read_choice(at, names);
  if (!name) return std::nullopt;
  return static_cast<Index>(std::find(names.begin(), names.end(), *name) - names.begin());
}

}  // namespace

std::optional<RecordedAssumption> read_failed_assumption(const Cursor& summary,
                                                         const SystemPart& system) {
  const auto at = summary.find("failed_assumption");
  if (!at || at->is(Kind::null) || !at->expect(Kind::object, not_as_written)) return std::nullopt;
  const auto what = at->need("what", not_as_written), k = at->need("k", not_as_written),
             mode = at->need("mode", not_as_written),
             seed = at->need("seed_offset", not_as_written),
             text = at->need("text", not_as_written),
             from = summary.need("assumptions_until", not_as_written);
  if (!what || !k || !mode || !seed || !text || !from) return std::nullopt;
  std::vector<std::string> words, names{system.nominal};
  for (const Mode& each : system.modes) names.push_back(each.name);
  for (const What one : all_assumptions) words.emplace_back(to_string(one));
  const auto word = read_choice(*what, words);
  const auto time = read_integer(*k, 0, max_integer), since = read_integer(*from, 0, max_integer),
             offset = read_integer(*seed, 0, max_integer);
  const auto of = read_mode(*mode, names);
  auto told = read_text(*text, 10'000);
  if (!word || !time || !since || !offset || !of || !told) return std::nullopt;
  const auto place = std::find(words.begin(), words.end(), *word) - words.begin();
  const FailedAssumption failed{all_assumptions[static_cast<std::size_t>(place)], *time, *of,
                                *offset};
  if (*since != failed.from())
    from->error("must be " + std::to_string(failed.from()) + ", by what has failed",
                not_as_written);
  if (*told != text_of(failed, names)) text->error("is not what has failed", not_as_written);
  return RecordedAssumption{failed, std::move(*told)};
}

}  // namespace cordon::verification
