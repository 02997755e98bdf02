// SPDX-License-Identifier: GPL-3.0-or-later
#include "making.hpp"

#include <algorithm>

#include "cordon/core/error.hpp"

namespace cordon::conformance {

namespace {

/// What other components are tried with: the project's own, so that a case does not depend on who
/// else has plugins.
const std::vector<std::string> project_backends{"zonotope", "constrained_zonotope", "line_zonotope",
                                                "interval"};
const std::vector<std::string> project_observers{"prediction_correction", "gain_correction",
                                                 "luenberger", "nonlinear"};
const std::vector<std::string> project_gains{"kalman", "w_radius"};

constexpr Index attempts = 6;

std::string text_of(const Params::Value& value) {
  struct Text {
    std::string operator()(std::int64_t x) const { return std::to_string(x); }
    std::string operator()(double x) const { return describe(x); }
    std::string operator()(bool x) const { return x ? "true" : "false"; }
    std::string operator()(const std::string& x) const { return "\"" + x + "\""; }
    std::string operator()(const Vector& x) const { return describe_vector(x); }
    std::string operator()(const Matrix& x) const { return describe(x); }
    std::string operator()(const LineForm& x) const { return describe(x); }
    std::string operator()(const std::vector<Matrix>& list) const {
      std::string text;
      for (const Matrix& x : list) text += (text.empty() ? "" : ", ") + describe(x);
      return "[" + text + "]";
    }
    std::string operator()(const std::shared_ptr<const ComponentSpec>& spec) const {
      return "\"" + spec->type + "\"";
    }
  };
  return std::visit(Text{}, value);
}

/// The value of a required parameter that is tried for the so-many-th time.
std::optional<Params::Value> guess(const Context& context, const TestCase& test,
                                   const ParamSpec& spec, Index attempt) {
  const Index n = test.dim('n'), y = test.dim('y'), u = std::max<Index>(test.dim('u'), 0);
  switch (spec.kind) {
    case ParamKind::matrix:
      if (attempt % 3 == 2) return Matrix(Matrix::Identity(n, n));
      if (attempt % 3 == 1) return Matrix(Matrix::Constant(2, u, 0.5));
      return attempt == 0 ? Matrix(Matrix::Zero(n, y)) : Matrix(Matrix::Constant(n, y, 0.125));
    case ParamKind::vector: {
      Vector x(attempt % 2 == 0 ? n : u);
      for (Index i = 0; i < x.size(); ++i) x[i] = 0.125 * static_cast<double>(i + 1);
      return x;
    }
    case ParamKind::set:
      return make_box({Vector::Constant(n, -0x1p40), Vector::Constant(n, 0x1p40)});
    case ParamKind::integer:
      return static_cast<std::int64_t>(
          std::clamp(static_cast<double>(attempt), spec.lowest, spec.highest));
    case ParamKind::real:
      return std::clamp(0.5, spec.lowest, spec.highest);
    case ParamKind::text:
      return std::string();
    case ParamKind::component: {
      const std::vector<std::string> there = context.registry().names(spec.component_kind);
      std::vector<std::string> names =
          spec.component_kind == "observer" ? project_observers : project_gains;
      std::erase_if(names, [&](const std::string& name) {
        return std::find(there.begin(), there.end(), name) == there.end();
      });
      if (names.empty()) return std::nullopt;
      const auto place = (test.seed / 7 + static_cast<std::uint64_t>(attempt)) % names.size();
      return std::make_shared<const ComponentSpec>(ComponentSpec{names[place], {}});
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

DrawnBackend backend_for(const Context& context, const TestCase& test) {
  const Registry& registry = context.registry();
  std::vector<std::string> names;
  for (const std::string& name : project_backends) {
    if (registry.info("backend", name)) names.push_back(name);
  }
  if (names.empty())
    throw Error(Errc::unsupported, "no backend of the project is on the search path");
  const std::string& name = names[(test.seed >> 8) % names.size()];
  Params params;
  const bool outward = (test.seed >> 16) % 2 == 0;
  std::string text = "\"" + name + "\"";
  if (outward && registry.info("backend", name)->schema.find("rounding")) {
    params.set("rounding", std::string("outward"));
    text = "{\"type\": " + text + ", \"rounding\": \"outward\"}";
  }
  return {registry.make<BackendEntry>(name, params), text};
}

std::string describe(const Params& params) {
  std::string text;
  for (const auto& [name, value] : params.values())
    text += (text.empty() ? "" : ", ") + ("\"" + name + "\": " + text_of(value));
  return "{" + text + "}";
}

ParameterDraw::ParameterDraw(const Context& context, const TestCase& test,
                             const ParamSchema& schema)
    : context_(context),
      test_(test),
      schema_(schema),
      random_(seed_of(test.seed, "parameters", 0)) {}

bool ParameterDraw::fill(Params& params, Index attempt) const {
  for (const ParamSpec& spec : schema_.specs()) {
    if (!spec.required || spec.fallback || params.has(spec.name)) continue;
    const auto value = guess(context_, test_, spec, attempt);
    if (!value) return false;
    params.set(spec.name, *value);
  }
  return true;
}

Params ParameterDraw::varied(const Params& params) {
  Params result = params;
  for (const ParamSpec& spec : schema_.specs()) {
    if (params.has(spec.name) || !random_.chance(0.3)) continue;
    if (spec.kind == ParamKind::choice)
      result.set(spec.name,
                 spec.choices[as_size(random_.below(static_cast<Index>(spec.choices.size())))]);
    if (spec.kind == ParamKind::flag) result.set(spec.name, random_.chance(0.5));
    if (spec.kind == ParamKind::integer && spec.fallback) {
      const double value =
          std::clamp(spec.lowest, -1e6, 1e6) + static_cast<double>(random_.below(6));
      result.set(spec.name, static_cast<std::int64_t>(std::min(value, spec.highest)));
    }
  }
  return result;
}

Params ParameterDraw::find(const std::function<std::vector<Diagnostic>(const Params&)>& accepts) {
  std::string refusal = "no value for its required parameters is known; give them by --params";
  const bool varies = random_.chance(1.0 / 3);
  for (Index attempt = 0; attempt < attempts; ++attempt) {
    Params params = context_.subject.params;
    if (!fill(params, attempt)) break;
    if (varies) {
      Params other = varied(params);
      if (accepts(other).empty()) return other;
    }
    const std::vector<Diagnostic> problems = accepts(params);
    if (problems.empty()) return params;
    if (attempt == 0) {
      refusal = problems.front().message;
      if (!problems.front().pointer.empty()) refusal = problems.front().pointer + ": " + refusal;
    }
    const bool has_guesses =
        std::any_of(schema_.specs().begin(), schema_.specs().end(), [&](const ParamSpec& spec) {
          return spec.required && !spec.fallback && !context_.subject.params.has(spec.name);
        });
    if (!has_guesses) break;
  }
  throw Error(Errc::unsupported, refusal);
}

}  // namespace cordon::conformance
