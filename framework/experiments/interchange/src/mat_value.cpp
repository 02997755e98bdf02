// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/interchange/mat_value.hpp"

#include <algorithm>
#include <set>

#include "cordon/core/error.hpp"

namespace cordon::mat {

namespace {

constexpr std::size_t longest_name = 63;

/// Words of the language, of MATLAB or Octave, that are no names.
constexpr std::string_view keywords[] = {"break",
                                         "case",
                                         "catch",
                                         "classdef",
                                         "continue",
                                         "do",
                                         "else",
                                         "elseif",
                                         "end",
                                         "endfor",
                                         "endfunction",
                                         "endif",
                                         "endparfor",
                                         "endswitch",
                                         "endwhile",
                                         "end_try_catch",
                                         "end_unwind_protect",
                                         "for",
                                         "function",
                                         "global",
                                         "if",
                                         "otherwise",
                                         "parfor",
                                         "persistent",
                                         "return",
                                         "spmd",
                                         "switch",
                                         "try",
                                         "until",
                                         "unwind_protect",
                                         "unwind_protect_cleanup",
                                         "while"};

}  // namespace

const Value* Value::field(std::string_view name, Index element) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (kind != Kind::structs || found == names.end() || element < 0 || element >= rows * cols)
    return nullptr;
  return &items[static_cast<std::size_t>(element) * names.size() +
                static_cast<std::size_t>(found - names.begin())];
}

Value number(double x) { return matrix(Matrix::Constant(1, 1, x)); }

Value matrix(Matrix numbers) {
  Value value;
  value.numbers = std::move(numbers);
  return value;
}

Value text(std::string utf8) {
  Value value;
  value.kind = Value::Kind::text;
  value.text = std::move(utf8);
  return value;
}

Value cell(std::vector<Value> items) {
  Value value;
  value.kind = Value::Kind::cell;
  value.rows = 1, value.cols = static_cast<Index>(items.size());
  value.items = std::move(items);
  return value;
}

Value cell(const std::vector<std::string>& texts) {
  std::vector<Value> items;
  for (const std::string& one : texts) items.push_back(text(one));
  return cell(std::move(items));
}

Value refused(std::string why) {
  Value value;
  value.kind = Value::Kind::refused;
  value.text = std::move(why);
  return value;
}

Struct& Struct::set(std::string name, Value value) {
  names_.push_back(std::move(name));
  fields_.push_back(std::move(value));
  return *this;
}

Value Struct::value() && {
  Value value;
  value.kind = Value::Kind::structs;
  value.rows = value.cols = 1;
  value.names = std::move(names_);
  value.items = std::move(fields_);
  return value;
}

Value Struct::array(std::vector<Struct> elements) {
  Value value;
  value.kind = Value::Kind::structs;
  value.rows = 1, value.cols = static_cast<Index>(elements.size());
  if (!elements.empty()) value.names = elements.front().names_;
  for (Struct& element : elements) {
    if (element.names_ != value.names)
      throw Error(Errc::internal, "a struct array of different structs");
    std::move(element.fields_.begin(), element.fields_.end(), std::back_inserter(value.items));
  }
  return value;
}

std::string valid_name(std::string_view name) {
  std::string valid;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'),
               digit = c >= '0' && c <= '9';
    if (!letter && valid.empty()) valid += 'x';
    if (letter || digit) {
      valid += c;
    } else if (!valid.ends_with('_')) {
      valid += '_';
    }
  }
  const bool keyword =
      std::find(std::begin(keywords), std::end(keywords), valid) != std::end(keywords);
  if (valid.empty() || keyword) valid.insert(valid.begin(), 'x');
  return valid.substr(0, longest_name);
}

std::vector<std::string> valid_names(const std::vector<std::string>& names) {
  std::vector<std::string> all;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    const std::string first = valid_name(name);
    std::string own = first;
    for (int n = 2; !taken.insert(own).second; ++n) {
      std::string number(1, '_');
      number += std::to_string(n);
      own = first.substr(0, longest_name - number.size()) + number;
    }
    all.push_back(own);
  }
  return all;
}

}  // namespace cordon::mat
