// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/zonotope.hpp"

#include <limits>

#include "adapter.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/sets/constraint_elimination.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "cordon/sets/outward.hpp"
#include "cordon/sets/strip.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reduction_parameter.hpp"
#include "rounding_parameter.hpp"

namespace {

using namespace cordon;
using plugins::Operand;

/// A zonotope, or the empty set, which has no generators' form of its own.
struct MaybeZonotope {
  Index n = 0;
  std::optional<sets::Zonotope> Z;
};

struct Zonotopes {
  using Value = MaybeZonotope;
  using Result = plugins::ResultOf<MaybeZonotope>;

  sets::GeneratorReduction reduction = sets::GeneratorReduction::adaptive;
  sets::StripMethod strip = sets::StripMethod::box;
  bool outward = false;

  static Result result(sets::Zonotope Z, Tightness tightness) {
    const Index n = Z.dim();
    if (!Z.c.allFinite() || !Z.G.allFinite())
      throw Error(Errc::not_finite, "zonotope: an operation overflows; scale the problem");
    return {{n, std::move(Z)}, tightness};
  }
  /// Of an operation on forms without lines and constraints.
  static Result result(const sets::Reduced& form) {
    return result({form.set.c, form.set.G}, form.exact ? Tightness::exact : Tightness::outer);
  }
  static Result empty(Index n) { return {{n, std::nullopt}, Tightness::exact}; }

  Index dim(const Value& X) const { return X.n; }
  LineForm line_form(const Value& X) const {
    return X.Z ? make_zonotope(X.Z->c, X.Z->G) : make_empty(X.n);
  }
  void serialize(Value& X, Archive& archive) const {
    bool there = X.Z.has_value();
    archive(X.n, there);
    if (X.n < 0) archive.refuse("a set of negative dimension");
    if (!there) return;
    if (!X.Z) X.Z.emplace();
    archive(X.Z->c, X.Z->G);
    const bool fits = X.Z->c.size() == X.n && X.Z->G.rows() == X.n;
    if (!fits || !X.Z->c.allFinite() || !X.Z->G.allFinite()) archive.refuse("no zonotope");
  }
  Complexity complexity(const Value& X) const { return {X.Z ? X.Z->generators() : 0, 0, 0}; }
  Answer is_empty(const Value& X, Certificate* why) const {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 0};
    return X.Z ? Answer::no : Answer::yes;
  }
  Answer contains(const Value& X, VectorIn x, Certificate* why) const {
    return cordon::contains(line_form(X), x, why);
  }
  Answer is_bounded(const Value&) const { return Answer::yes; }
  double support(const Value& X, VectorIn d, Certificate*) const {
    return X.Z ? sets::support(*X.Z, d) : -infinity;
  }
  Vector maximizer(const Value& X, VectorIn d) const {
    if (!X.Z) return Vector(0);
    const Vector along = linalg::transposed_product(X.Z->G, d);
    return X.Z->c + linalg::product(X.Z->G, along.cwiseSign());
  }
  Box interval_hull(const Value& X, std::vector<Certificate>* why) const {
    if (why)
      why->assign(static_cast<std::size_t>(2 * X.n), {Certificate::Kind::structure, Vector(0), 0});
    return X.Z ? sets::interval_hull(*X.Z) : Box::empty(X.n);
  }
  std::optional<Volume> volume(const Value& X) const {
    if (!X.Z) return Volume{0, true};
    const auto found = sets::volume_with_error(*X.Z);
    if (!found) return std::nullopt;
    const bool exact = found->upper <= found->lower * (1 + 1e-7);
    return exact || found->upper == 0 ? Volume{found->value, true} : Volume{found->upper, false};
  }

  /// Constraints are eliminated one by one, each forgetting one factor's bound: an outer enclosure.
  Result import(const LineForm& X) const {
    if (outward) return import_outward(X);
    LineForm Y = eliminate_lines(X);
    if (Y.constraints() > 0 && cordon::is_empty(Y) == Answer::yes) return empty(X.dim());
    if (Y.lines() > 0) refuse_lines();
    if (Y.constraints() == 0) return result({Y.c, Y.G}, Tightness::exact);
    const sets::Reduced reduced = sets::eliminate_constraints(Y, 0, {.rescale = true});
    return result({reduced.set.c, reduced.set.G}, reduced.exact && reduced.set.constraints() == 0
                                                      ? Tightness::exact
                                                      : Tightness::outer);
  }

  static Result import_outward(const LineForm& X) {
    if (X.constraints() > 0 && cordon::is_empty(X) == Answer::yes) return empty(X.dim());
    const sets::Reduced Y = sets::outward::enclose_without_lines(X);
    if (Y.set.lines() > 0) refuse_lines();
    sets::Reduced Z = sets::outward::eliminate_constraints(Y.set, 0, {.rescale = true});
    if (Z.set.constraints() > 0 && cordon::is_empty(Z.set) == Answer::yes) return empty(X.dim());
    Z.exact = Z.exact && Y.exact && Z.set.constraints() == 0;
    return result(Z);
  }
  [[noreturn]] static void refuse_lines() {
    throw Error(Errc::unsupported,
                "zonotope: the set is unbounded, which this representation cannot hold; use "
                "line_zonotope, or bound the set");
  }

  Result predict(const Value& X, MatrixIn A, VectorIn f,
                 std::span<const Operand<Value>> operands) const {
    if (!X.Z) return empty(A.rows());
    if (outward) return predict_outward(X, A, f, operands);
    plugins::Few<sets::MappedZonotope> summands;
    for (const auto& operand : operands) {
      if (!operand.value.Z) return empty(A.rows());
      summands.push_back({operand.T, *operand.value.Z});
    }
    return result(sets::affine_sum(*X.Z, A, f, {summands.data(), summands.size()}),
                  Tightness::exact);
  }
  Result predict_outward(const Value& X, MatrixIn A, VectorIn f,
                         std::span<const Operand<Value>> operands) const {
    std::vector<LineForm> forms;
    forms.reserve(operands.size());
    std::vector<sets::Summand> summands;
    for (const auto& operand : operands) {
      if (!operand.value.Z) return empty(A.rows());
      summands.push_back({operand.T, forms.emplace_back(line_form(operand.value))});
    }
    return result(sets::outward::affine_sum(line_form(X), A, f, summands));
  }
  Result correct(const Value& X, MatrixIn C, VectorIn z, const Operand<Value>& noise) const {
    if (!X.Z || !noise.value.Z) return empty(X.n);
    if (outward)
      return {{X.n, sets::outward::correct(*X.Z, C, z, noise.T, *noise.value.Z, strip)},
              Tightness::outer};
    return {{X.n, sets::correct(*X.Z, C, z, noise.T, *noise.value.Z, strip)}, Tightness::outer};
  }
  Result interval_map(const Value& X, const IntervalMatrix& A) const {
    if (!X.Z) return empty(A.rows());
    if (outward)
      return result(sets::outward::interval_map(line_form(X), A, sets::interval_hull(*X.Z)));
    return result(sets::interval_map(*X.Z, A), A.is_exact() ? Tightness::exact : Tightness::outer);
  }
  Result intersection(const Value& X, MatrixIn R, const Value& Y) const {
    // R x ∈ Y ⇔ 0 - R x ∈ -Y
    const Matrix minus = -Matrix::Identity(Y.n, Y.n);
    return correct(X, R, Vector::Zero(Y.n), {minus, Y});
  }
  Result convex_hull(const Value& X, const Value& Y) const {
    if (!X.Z) return {Y, Tightness::exact};
    if (!Y.Z) return {X, Tightness::exact};
    return result(outward ? sets::outward::convex_hull(*X.Z, *Y.Z) : sets::convex_hull(*X.Z, *Y.Z),
                  Tightness::outer);
  }
  std::optional<Result> reduce(const Value& X, Budget budget) const {
    if (!X.Z || X.Z->generators() <= budget.generators) return std::nullopt;
    const sets::Zonotope& Z = *X.Z;
    return result(
        {Z.c, outward ? sets::outward::reduce_generators(Z.G, budget.generators, reduction)
                      : sets::reduce_generators(Z.G, budget.generators, reduction)},
        Tightness::outer);
  }
};

ParamSchema schema() {
  ParamSchema schema;
  plugins::add_reduction(schema);
  schema.choice("strip",
                "how a strip is intersected: smallest F-radius of Z (segment) or of a box around "
                "it along its principal axes "
                "(box), smallest "
                "interval hull (hull), smallest volume among zonotopes cut "
                "along one generator (bravo), or smallest volume of all; where g generators in n "
                "dimensions have more than "
                "20,000 subsets of n - 1, volume is bravo, and both compare squared determinants",
                {"box", "segment", "hull", "bravo", "volume"}, "box");
  plugins::add_rounding(schema);
  return schema;
}

std::unique_ptr<SetBackend> create(const Params& params) {
  BackendInfo info;
  info.name = "zonotope";
  info.summary = "centrally symmetric polytopes given by generators";
  info.citation = "Combastel2003; Alamo2005";
  info.rounding = plugins::rounding_from(params);
  Zonotopes zonotopes;
  zonotopes.reduction = plugins::reduction_from(params);
  const std::string& strip = params.text("strip");
  zonotopes.strip = strip == "segment"  ? sets::StripMethod::segment
                    : strip == "hull"   ? sets::StripMethod::hull
                    : strip == "bravo"  ? sets::StripMethod::bravo
                    : strip == "volume" ? sets::StripMethod::volume
                                        : sets::StripMethod::box;
  zonotopes.outward = info.rounding == Rounding::outward;
  return std::make_unique<plugins::ValueBackend<Zonotopes>>(info, zonotopes);
}

void register_components(Registrar& registrar) {
  registrar.add(BackendEntry{{"zonotope", "centrally symmetric polytopes given by generators",
                              "Combastel2003; Alamo2005", schema()},
                             create});
}

}  // namespace

CORDON_PLUGIN("zonotope", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "zonotopes",
              register_components)
