// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/registry/schema.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "type_names.hpp"

namespace cordon {

namespace {

using registry::type_names;

constexpr std::int64_t exact_limit = std::int64_t{1} << 53;  // every integer up to here is a double

const char* expected(ParamKind kind) {
  switch (kind) {
    case ParamKind::integer:
      return type_names[0];
    case ParamKind::real:
      return type_names[1];
    case ParamKind::flag:
      return type_names[2];
    case ParamKind::choice:
    case ParamKind::text:
      return type_names[3];
    case ParamKind::vector:
      return type_names[4];
    case ParamKind::matrix:
      return type_names[5];
    case ParamKind::set:
      return type_names[6];
    case ParamKind::matrices:
      return type_names[7];
    case ParamKind::component:
      return type_names[8];
  }
  return "";
}

std::string pointer_to(std::string_view name) {
  std::string pointer = "/";
  for (const char c : name) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

std::string limits(const ParamSpec& spec) {
  const bool below = std::isfinite(spec.lowest), above = std::isfinite(spec.highest);
  if (below && above) return fmt::format("must lie in [{}, {}]", spec.lowest, spec.highest);
  return below ? fmt::format("must be at least {}", spec.lowest)
               : fmt::format("must be at most {}", spec.highest);
}

/// A reason and a suggestion; an empty reason: no problem.
struct Problem {
  std::string message, suggestion;
};

Problem wrong_type(const ParamSpec& spec, const Params::Value& value) {
  Problem problem{fmt::format("is {}, must be {}", type_names[value.index()], expected(spec.kind)),
                  ""};
  if (const double* real = std::get_if<double>(&value); real && spec.kind == ParamKind::integer) {
    if (*real == std::trunc(*real) && std::abs(*real) <= static_cast<double>(exact_limit)) {
      problem.suggestion = fmt::format("write {}", static_cast<std::int64_t>(*real));
    }
  }
  return problem;
}

Problem check_integer(const ParamSpec& spec, const Params::Value& value) {
  const auto* number = std::get_if<std::int64_t>(&value);
  if (!number) return wrong_type(spec, value);
  const auto wide = static_cast<long double>(*number);
  if (wide < spec.lowest || wide > spec.highest)
    return {fmt::format("is {}, {}", *number, limits(spec)), ""};
  return {};
}

Problem check_real(const ParamSpec& spec, Params::Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    if (*whole > exact_limit || *whole < -exact_limit)
      return {fmt::format("is {}, too large to be an exact real number", *whole), ""};
    value = static_cast<double>(*whole);
  }
  const double* number = std::get_if<double>(&value);
  if (!number) return wrong_type(spec, value);
  if (!std::isfinite(*number)) return {fmt::format("is {}, must be a finite number", *number), ""};
  if (*number < spec.lowest || *number > spec.highest)
    return {fmt::format("is {}, {}", *number, limits(spec)), ""};
  return {};
}

Problem check_choice(const ParamSpec& spec, const Params::Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text) return wrong_type(spec, value);
  if (std::find(spec.choices.begin(), spec.choices.end(), *text) == spec.choices.end()) {
    return {fmt::format("\"{}\" is not one of the choices", *text), suggest(*text, spec.choices)};
  }
  return {};
}

template <class T>
Problem check_array(const ParamSpec& spec, const Params::Value& value) {
  const T* array = std::get_if<T>(&value);
  if (!array) return wrong_type(spec, value);
  if (!array->allFinite()) return {"has a NaN or infinite entry", ""};
  return {};
}

Problem check_set(const ParamSpec& spec, const Params::Value& value) {
  const auto* set = std::get_if<LineForm>(&value);
  if (!set) return wrong_type(spec, value);
  try {
    check(*set, spec.name);
  } catch (const Error& error) {
    return {error.what(), ""};
  }
  return {};
}

Problem check_matrices(const ParamSpec& spec, const Params::Value& value) {
  const auto* list = std::get_if<std::vector<Matrix>>(&value);
  if (!list) return wrong_type(spec, value);
  for (const Matrix& A : *list) {
    if (!A.allFinite()) return {"has a NaN or infinite entry", ""};
  }
  return {};
}

Problem check_component(const ParamSpec& spec, const Params::Value& value) {
  const auto* component = std::get_if<std::shared_ptr<const ComponentSpec>>(&value);
  if (!component) return wrong_type(spec, value);
  return *component ? Problem{} : Problem{"is no component", "give the name of one"};
}

Problem check_value(const ParamSpec& spec, Params::Value& value) {
  switch (spec.kind) {
    case ParamKind::integer:
      return check_integer(spec, value);
    case ParamKind::real:
      return check_real(spec, value);
    case ParamKind::choice:
      return check_choice(spec, value);
    case ParamKind::flag:
      return std::holds_alternative<bool>(value) ? Problem{} : wrong_type(spec, value);
    case ParamKind::text:
      return std::holds_alternative<std::string>(value) ? Problem{} : wrong_type(spec, value);
    case ParamKind::vector:
      return check_array<Vector>(spec, value);
    case ParamKind::matrix:
      return check_array<Matrix>(spec, value);
    case ParamKind::set:
      return check_set(spec, value);
    case ParamKind::matrices:
      return check_matrices(spec, value);
    case ParamKind::component:
      return check_component(spec, value);
  }
  return {};
}

}  // namespace

std::string_view to_string(ParamKind kind) noexcept {
  switch (kind) {
    case ParamKind::integer:
      return "integer";
    case ParamKind::real:
      return "real";
    case ParamKind::flag:
      return "flag";
    case ParamKind::choice:
      return "choice";
    case ParamKind::text:
      return "text";
    case ParamKind::vector:
      return "vector";
    case ParamKind::matrix:
      return "matrix";
    case ParamKind::set:
      return "set";
    case ParamKind::matrices:
      return "matrices";
    case ParamKind::component:
      return "component";
  }
  return "text";
}

ParamSchema& ParamSchema::add(ParamSpec spec) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Errc::invalid, fmt::format("schema: parameter \"{}\" {}", spec.name, why));
  };
  if (spec.name.empty()) refuse("has no name");
  if (find(spec.name)) refuse("is there twice");
  if (!(spec.lowest <= spec.highest))
    refuse(fmt::format("has the empty range [{}, {}]", spec.lowest, spec.highest));
  if (spec.kind == ParamKind::choice && spec.choices.empty()) refuse("has no choices");
  if (spec.fallback) {
    if (const Problem problem = check_value(spec, *spec.fallback); !problem.message.empty())
      refuse("has a default that " + problem.message);
  }
  specs_.push_back(std::move(spec));
  return *this;
}

ParamSchema& ParamSchema::integer(std::string name, std::string doc,
                                  std::optional<std::int64_t> fallback, std::int64_t lowest,
                                  std::int64_t highest) {
  ParamSpec spec{.name = std::move(name),
                 .kind = ParamKind::integer,
                 .doc = std::move(doc),
                 .fallback = {},
                 .choices = {},
                 .component_kind = {}};
  if (fallback) spec.fallback = *fallback;
  spec.lowest = static_cast<double>(lowest);
  spec.highest = static_cast<double>(highest);
  return add(std::move(spec));
}

ParamSchema& ParamSchema::real(std::string name, std::string doc, std::optional<double> fallback,
                               double lowest, double highest) {
  ParamSpec spec{.name = std::move(name),
                 .kind = ParamKind::real,
                 .doc = std::move(doc),
                 .fallback = {},
                 .choices = {},
                 .component_kind = {}};
  if (fallback) spec.fallback = *fallback;
  spec.lowest = lowest;
  spec.highest = highest;
  return add(std::move(spec));
}

ParamSchema& ParamSchema::flag(std::string name, std::string doc, bool fallback) {
  return add({.name = std::move(name),
              .kind = ParamKind::flag,
              .doc = std::move(doc),
              .fallback = fallback,
              .choices = {},
              .component_kind = {}});
}

ParamSchema& ParamSchema::choice(std::string name, std::string doc,
                                 std::vector<std::string> choices, std::string fallback) {
  return add({.name = std::move(name),
              .kind = ParamKind::choice,
              .doc = std::move(doc),
              .fallback = std::move(fallback),
              .choices = std::move(choices),
              .component_kind = {}});
}

ParamSchema& ParamSchema::text(std::string name, std::string doc,
                               std::optional<std::string> fallback) {
  ParamSpec spec{.name = std::move(name),
                 .kind = ParamKind::text,
                 .doc = std::move(doc),
                 .fallback = {},
                 .choices = {},
                 .component_kind = {}};
  if (fallback) spec.fallback = std::move(*fallback);
  return add(std::move(spec));
}

ParamSchema& ParamSchema::vector(std::string name, std::string doc) {
  return add({.name = std::move(name),
              .kind = ParamKind::vector,
              .doc = std::move(doc),
              .fallback = {},
              .choices = {},
              .component_kind = {}});
}

ParamSchema& ParamSchema::matrix(std::string name, std::string doc) {
  return add({.name = std::move(name),
              .kind = ParamKind::matrix,
              .doc = std::move(doc),
              .fallback = {},
              .choices = {},
              .component_kind = {}});
}

ParamSchema& ParamSchema::set(std::string name, std::string doc) {
  return add({.name = std::move(name),
              .kind = ParamKind::set,
              .doc = std::move(doc),
              .fallback = {},
              .choices = {},
              .component_kind = {}});
}

ParamSchema& ParamSchema::matrices(std::string name, std::string doc) {
  return add({.name = std::move(name),
              .kind = ParamKind::matrices,
              .doc = std::move(doc),
              .fallback = {},
              .choices = {},
              .component_kind = {}});
}

ParamSchema& ParamSchema::component(std::string name, std::string doc, std::string kind) {
  return add({.name = std::move(name),
              .kind = ParamKind::component,
              .doc = std::move(doc),
              .fallback = {},
              .choices = {},
              .component_kind = std::move(kind)});
}

ParamSchema& ParamSchema::or_matrix(std::string type) {
  if (specs_.empty() || specs_.back().kind != ParamKind::component) {
    throw Error(Errc::invalid, "schema: or_matrix() stands behind something that is no component");
  }
  specs_.back().matrix_type = std::move(type);
  return *this;
}

ParamSchema& ParamSchema::or_at_most(std::string parameter) {
  if (specs_.empty() || specs_.back().kind != ParamKind::integer)
    throw Error(Errc::invalid, "schema: or_at_most() stands behind something that is no integer");
  specs_.back().at_most = std::move(parameter);
  return *this;
}

ParamSchema& ParamSchema::required() {
  if (specs_.empty())
    throw Error(Errc::invalid, "schema: required() stands before the first parameter");
  if (specs_.back().fallback) {
    throw Error(Errc::invalid, fmt::format("schema: parameter \"{}\" is required and has a default",
                                           specs_.back().name));
  }
  specs_.back().required = true;
  return *this;
}

const ParamSpec* ParamSchema::find(std::string_view name) const {
  const auto found = std::find_if(specs_.begin(), specs_.end(),
                                  [&](const ParamSpec& spec) { return spec.name == name; });
  return found == specs_.end() ? nullptr : &*found;
}

std::vector<std::string> ParamSchema::names() const {
  std::vector<std::string> names;
  for (const ParamSpec& spec : specs_) names.push_back(spec.name);
  return names;
}

std::vector<Diagnostic> ParamSchema::complete(Params& params) const {
  std::vector<Diagnostic> diagnostics;
  for (const auto& [name, value] : params.values()) {
    if (find(name)) continue;
    diagnostics.push_back({pointer_to(name), "unknown parameter",
                           specs_.empty() ? "there are none" : suggest(name, names())});
  }
  for (const ParamSpec& spec : specs_) {
    const auto given = params.values().find(spec.name);
    if (given == params.values().end()) {
      if (spec.required)
        diagnostics.push_back({pointer_to(spec.name), "is missing",
                               fmt::format("give {}: {}", expected(spec.kind), spec.doc)});
      if (spec.fallback) params.set(spec.name, *spec.fallback);
      continue;
    }
    Params::Value value = given->second;
    if (const auto* A = std::get_if<Matrix>(&value); A && !spec.matrix_type.empty()) {
      value = std::make_shared<const ComponentSpec>(
          ComponentSpec{spec.matrix_type, Params().set("matrix", *A)});
    }
    Problem problem = check_value(spec, value);
    if (problem.message.empty()) {
      params.set(spec.name, std::move(value));
    } else {
      diagnostics.push_back(
          {pointer_to(spec.name), std::move(problem.message), std::move(problem.suggestion)});
    }
  }
  return diagnostics;
}

}  // namespace cordon
