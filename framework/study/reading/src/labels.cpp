// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/labels.hpp"

#include <fmt/format.h>

namespace cordon {

namespace {

const std::string* name_of(const Labels::Names& names, Index i) {
  return i < static_cast<Index>(names.size()) ? &names[static_cast<std::size_t>(i)] : nullptr;
}

}  // namespace

bool Labels::any() const {
  for (const Names* names : {&states, &inputs, &outputs, &disturbances, &noises, &faults}) {
    if (!names->empty()) return true;
  }
  return false;
}

std::string label_of(const Labels::Names& names, const std::string& symbol, Index i) {
  const std::string* const name = name_of(names, i);
  return name ? *name : fmt::format("{}_{}", symbol, i + 1);
}

std::string unit_of(const std::string& name) {
  const std::size_t begin = name.rfind('[');
  const bool has_unit = begin != std::string::npos && name.ends_with(']');
  return has_unit ? name.substr(begin + 1, name.size() - begin - 2) : "";
}

std::string heading_of(const Labels::Names& names, const std::string& symbol, Index i) {
  const std::string* const name = name_of(names, i);
  return fmt::format("{}_{}{}{}", symbol, i + 1, name ? " " : "", name ? *name : "");
}

std::string time_text(const Labels& labels, std::int64_t k) {
  if (!(labels.sampling_time > 0)) return fmt::format("k = {}", k);
  return fmt::format("k = {} ({:.6g} s)", k, static_cast<double>(k) * labels.sampling_time);
}

}  // namespace cordon
