// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings.hpp"

#include "cordon/core/error.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sweep.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::json {

namespace {

constexpr const char* setting_form =
    "write --set /path=value, for example --set /data/simulate/seed=3";

/// The same value, of no line of the file.
Value without_lines(Value value) {
  value.line = 0;
  if (value.parts) {
    Parts parts = *value.parts;
    for (Value& item : parts.items) item = without_lines(std::move(item));
    value.parts = std::make_shared<const Parts>(std::move(parts));
  }
  return value;
}

/// JSON, or the text itself where it cannot have been meant as JSON.
Value setting_value(const std::string& text) {
  Problems problems;
  Value value = parse(text, problems);
  if (!problems.any()) return without_lines(std::move(value));
  const bool is_word =
      text.empty() || std::string("[{\"-0123456789").find(text[0]) == std::string::npos;
  if (!is_word) throw Error(Errc::invalid, "--set: " + in_quotes(text) + " is no JSON");
  problems = {};
  return without_lines(parse(detail::json_string(text), problems));
}

}  // namespace

Value with_settings(Value tree, const std::vector<std::string>& settings, const Registry& registry,
                    Problems& problems) {
  for (const std::string& setting : settings) {
    const std::size_t end = setting.find('=');
    const std::string text = setting.substr(0, end);
    auto steps = end == std::string::npos ? std::nullopt : path_steps(text);
    if (!steps || steps->empty() || steps->size() > static_cast<std::size_t>(max_depth))
      throw Error(Errc::invalid, "--set " + in_quotes(setting) + ": " + setting_form);
    if (const std::string reason = why_not_varied(*steps); !reason.empty())
      throw Error(Errc::invalid, "--set " + in_quotes(text) + ": " + reason);
    const SweepPath path{text, std::move(*steps)};
    Placement placement = place(tree, path, setting_value(setting.substr(end + 1)), registry);
    if (!placement.problem.empty())
      problems.add(text, 0, "(--set) " + placement.problem, placement.suggestion);
    tree = std::move(placement.tree);
  }
  return tree;
}

}  // namespace cordon::json
