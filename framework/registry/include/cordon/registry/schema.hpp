// SPDX-License-Identifier: GPL-3.0-or-later
// Typed parameters of components. One schema drives validation, defaults, `cordon info`, the tables
// of the manual and the JSON Schema for editors. No JSON type appears here: parameters can be built
// from C++ as well.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon {

struct ComponentSpec;

/// Values by name. Asking for a name that is absent, or for another type, throws Errc::invalid:
/// validated parameters hold every name of their schema that is required or has a default.
class Params {
 public:
  using Value = std::variant<std::int64_t, double, bool, std::string, Vector, Matrix, LineForm,
                             std::vector<Matrix>, std::shared_ptr<const ComponentSpec>>;

  Params& set(std::string name, Value value);
  bool has(std::string_view name) const;
  const std::map<std::string, Value, std::less<>>& values() const { return values_; }

  std::int64_t integer(std::string_view name) const;
  double real(std::string_view name) const;
  bool flag(std::string_view name) const;
  const std::string& text(std::string_view name) const;  ///< also for choices
  const Vector& vector(std::string_view name) const;
  const Matrix& matrix(std::string_view name) const;
  const LineForm& set_form(std::string_view name) const;
  const std::vector<Matrix>& matrices(std::string_view name) const;
  const ComponentSpec& component(std::string_view name) const;

 private:
  std::map<std::string, Value, std::less<>> values_;
};

/// A component by name, with its parameters.
struct ComponentSpec {
  std::string type;
  Params params;  ///< in studies complete: every default filled in
};

/// `matrices` is a list of matrices; `component` a nested component of the kind
/// `ParamSpec::component_kind`.
enum class ParamKind {
  integer,
  real,
  flag,
  choice,
  text,
  vector,
  matrix,
  set,
  matrices,
  component
};
std::string_view to_string(ParamKind kind) noexcept;

/// One parameter of a component.
struct ParamSpec {
  std::string name;
  ParamKind kind;
  std::string doc;  ///< one sentence, with unit and meaning of the limits
  bool required = false;
  std::optional<Params::Value>
      fallback;  ///< value when absent; none and not required: the parameter stays absent
  double lowest = -infinity, highest = infinity;
  std::vector<std::string> choices;
  std::string component_kind;  ///< "observer", …
  /// A component that may be written as a matrix: the component of this type with the matrix as the
  /// parameter "matrix".
  std::string matrix_type = {};
  /// Of an integer that may be written as {"at_most": n}: the integer parameter that n is given to.
  std::string at_most = {};
};

/// The parameters a component takes, in the order of the manual. A schema that contradicts itself
/// (a name twice, a default outside its own limits, a choice without choices) throws Errc::invalid
/// where it is written.
class ParamSchema {
 public:
  ParamSchema& integer(std::string name, std::string doc, std::optional<std::int64_t> fallback,
                       std::int64_t lowest, std::int64_t highest);
  ParamSchema& real(std::string name, std::string doc, std::optional<double> fallback,
                    double lowest, double highest);
  ParamSchema& flag(std::string name, std::string doc, bool fallback);
  ParamSchema& choice(std::string name, std::string doc, std::vector<std::string> choices,
                      std::string fallback);
  ParamSchema& text(std::string name, std::string doc, std::optional<std::string> fallback = {});
  ParamSchema& vector(std::string name, std::string doc);
  ParamSchema& matrix(std::string name, std::string doc);
  ParamSchema& set(std::string name, std::string doc);
  ParamSchema& matrices(std::string name, std::string doc);
  /// Checked against its own schema by whoever makes it: the study reader, or the registry.
  ParamSchema& component(std::string name, std::string doc, std::string kind);
  /// The last added component may be written as a matrix, which stands for {type, "matrix": …}.
  ParamSchema& or_matrix(std::string type);
  /// The last added integer may be written as {"at_most": n}, which gives n to another integer
  /// parameter in its place.
  ParamSchema& or_at_most(std::string parameter);
  ParamSchema& required();  ///< makes the last added parameter required

  const std::vector<ParamSpec>& specs() const { return specs_; }
  const ParamSpec* find(std::string_view name) const;
  std::vector<std::string> names() const;

  /// Fills in defaults, makes an integer real where a real is asked for, and returns every problem
  /// (unknown name, wrong type, out of range, NaN or infinite, missing); pointers are "/name". An
  /// integer beyond ±2⁵³ is no exact real and is refused as one.
  std::vector<Diagnostic> complete(Params& params) const;

 private:
  ParamSchema& add(ParamSpec spec);
  std::vector<ParamSpec> specs_;
};

}  // namespace cordon
