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
  ParameterRange range{name, 0, 0, false};
  const auto read_bound = [&](const char* key, double& bound) {
    const auto bound_at = at.need(key, "write {\"lower\": 0.1, \"upper\": 0.2}");
    const auto number = bound_at ? read_number(*bound_at) : std::nullopt;
    if (number) bound = *number;
    return number.has_value();
  };
  const bool has_lower = read_bound("lower", range.lower),
             has_upper = read_bound("upper", range.upper);
  if (has_lower && has_upper && range.lower > range.upper) {
    at.find("upper")->error("is " + detail::to_text(range.upper) + ", below the lower bound " +
                                detail::to_text(range.lower),
                            "exchange them");
  }
  if (const auto varying = at.find("varying"))
    range.is_varying = read_flag(*varying).value_or(false);
  written.ranges.push_back(std::move(range));
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
