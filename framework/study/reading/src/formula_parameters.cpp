// SPDX-License-Identifier: GPL-3.0-or-later
#include "formula_parameters.hpp"

#include <algorithm>
#include <cctype>

#include "study/text/numbers.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

void read_range(const Cursor& at, const std::string& name, WrittenFormulas& written) {
  at.expect_keys({"lower", "upper", "varying"}, "key of a parameter", "");
  const std::string form = "write {\"lower\": 0.1, \"upper\": 0.2}";
  const auto lower_at = at.need("lower", form), upper_at = at.need("upper", form);
  const auto lower = lower_at ? read_number(*lower_at) : std::nullopt;
  const auto upper = upper_at ? read_number(*upper_at) : std::nullopt;
  if (lower && upper && *lower > *upper) {
    upper_at->error(
        "is " + detail::to_text(*upper) + ", below the lower bound " + detail::to_text(*lower),
        "exchange them");
  }
  const auto varying = at.find("varying") ? read_flag(*at.find("varying")) : std::nullopt;
  written.ranges.push_back({name, lower.value_or(0), upper.value_or(0), varying.value_or(false)});
}

/// Does the name stand in the text? Letters within numbers, 1e5, are none.
bool stands_in(const std::string& name, const std::string& text) {
  const auto continues = [&](std::size_t i) {
    return i < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_' || text[i] == '.');
  };
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
    if (!(at > 0 && continues(at - 1)) && !continues(at + name.size())) return true;
  return false;
}

}  // namespace

void read_parameters(const Cursor& system,
                     const std::function<void(const Cursor&, const std::string&)>& take_name,
                     WrittenFormulas& written) {
  const auto at = system.find("parameters");
  if (!at || !at->expect(Kind::object, "numbers with names: {\"dt\": 0.1}")) return;
  for (const std::string& name : at->value().keys()) {
    const Cursor item = *at->find(name);
    take_name(item, name);
    if (item.is(Kind::object)) {
      read_range(item, name, written);
    } else {
      written.parameters.emplace_back(name, read_number(item).value_or(0));
    }
  }
}

std::vector<ParameterRange> constant_ranges(const WrittenFormulas& written) {
  std::vector<ParameterRange> all;
  std::ranges::copy_if(written.ranges, std::back_inserter(all),
                       [](const ParameterRange& range) { return !range.is_varying; });
  return all;
}

std::vector<ParameterRange> varying_ranges(const WrittenFormulas& written,
                                           const std::vector<std::string>& formulas) {
  std::vector<ParameterRange> all;
  std::ranges::copy_if(written.ranges, std::back_inserter(all), [&](const ParameterRange& range) {
    return range.is_varying && std::ranges::any_of(formulas, [&](const std::string& formula) {
             return stands_in(range.name, formula);
           });
  });
  return all;
}

LineForm box_of(const std::vector<ParameterRange>& ranges) {
  Box box = Box::space(static_cast<Index>(ranges.size()));
  for (Index i = 0; i < box.dim(); ++i) {
    box.lower[i] = ranges[as_size(i)].lower;
    box.upper[i] = ranges[as_size(i)].upper;
  }
  return make_box(box);
}

}  // namespace cordon::json
