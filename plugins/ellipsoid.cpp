// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/ellipsoid.hpp"

#include <algorithm>
#include <variant>

#include "adapter.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/sets/outward.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/solvers/view_questions.hpp"
#include "rounding_parameter.hpp"

namespace {

using namespace cordon;
using plugins::Operand;
using sets::Ellipsoid;
using sets::EllipsoidCriterion;

/// Of its terms, an output may be off by this: it was rounded before it came here.
constexpr double rounding_of_data = 1e-14;

/// A set that was imported, as it is: not empty and without lines. It is enclosed by an ellipsoid
/// when an operation asks for one, after the operation's map. `around` is the ellipsoid of a form
/// with constraints, made once.
struct Given {
  LineForm form;
  std::optional<Ellipsoid> around;

  bool is_zonotope() const { return form.constraints() == 0; }
  sets::Zonotope zonotope() const { return {form.c, form.G}; }
};

struct Held {
  Index n = 0;
  std::variant<std::monostate, Given, Ellipsoid> set;  ///< ∅, or what is held

  bool is_empty() const { return set.index() == 0; }
  const Given* given() const { return std::get_if<Given>(&set); }
  const Ellipsoid* ellipsoid() const { return std::get_if<Ellipsoid>(&set); }
};

void serialize(Ellipsoid& X, Index n, Archive& archive) {
  archive(X.c, X.L, X.r);
  const bool fits = X.c.size() == n && X.L.rows() == n && X.r.size() == n;
  const bool is_finite = X.c.allFinite() && X.L.allFinite() && X.r.allFinite();
  if (!fits || !is_finite || (X.r.array() < 0).any()) archive.refuse("no ellipsoid");
}

void serialize(Given& X, Index n, Archive& archive) {
  bool has_around = X.around.has_value();
  archive(X.form, has_around);
  if (X.form.dim() != n || X.form.lines() > 0) archive.refuse("a set that no ellipsoid is around");
  if (!has_around) return;
  if (!X.around) X.around.emplace();
  serialize(*X.around, n, archive);
}

/// Puts coordinates elsewhere, each at one place at most: nothing is rounded, and no two add up.
bool only_places(MatrixIn T, std::vector<bool>& taken) {
  for (Index i = 0; i < T.rows(); ++i) {
    Index entries = 0;
    for (Index j = 0; j < T.cols(); ++j) {
      if (T(i, j) != 0 && T(i, j) != 1) return false;
      entries += T(i, j) != 0 ? 1 : 0;
    }
    const auto row = static_cast<std::size_t>(i);
    if (entries > (taken[row] ? 0 : 1)) return false;
    taken[row] = taken[row] || entries == 1;
  }
  return true;
}

struct Ellipsoids {
  using Value = Held;
  using Result = plugins::ResultOf<Held>;

  EllipsoidCriterion criterion = EllipsoidCriterion::trace;
  bool outward = false;

  static Result empty(Index n) { return {{n, {}}, Tightness::exact}; }
  static Result outer(Ellipsoid X) {
    const Index n = X.dim();
    return {{n, std::move(X)}, Tightness::outer};
  }
  /// What rounds is not exact outward.
  Result result(sets::EnclosingEllipsoid X) const {
    const Index n = X.set.dim();
    return {{n, std::move(X.set)}, X.exact && !outward ? Tightness::exact : Tightness::outer};
  }

  Index dim(const Value& X) const { return X.n; }
  LineForm line_form(const Value& X) const {
    if (X.given()) return X.given()->form;
    if (X.is_empty()) return make_empty(X.n);
    const sets::Zonotope box = sets::principal_box(*X.ellipsoid());
    return make_zonotope(box.c, box.G);
  }
  /// What was imported is held as it is; an ellipsoid is not of the form.
  bool has_exact_form(const Value& X) const { return !X.ellipsoid(); }
  void serialize(Value& X, Archive& archive) const {
    auto kind = static_cast<Index>(X.set.index());
    archive(X.n, kind);
    if (X.n < 0 || kind < 0 || kind > 2) archive.refuse("a set of no kind");
    if (archive.is_reading() && kind == 1) X.set = Given{};
    if (archive.is_reading() && kind == 2) X.set = Ellipsoid{};
    if (auto* given = std::get_if<Given>(&X.set)) ::serialize(*given, X.n, archive);
    if (auto* ellipsoid = std::get_if<Ellipsoid>(&X.set)) ::serialize(*ellipsoid, X.n, archive);
  }
  Complexity complexity(const Value& X) const {
    if (const Given* given = X.given())
      return {given->form.generators(), 0, given->form.constraints()};
    return {X.is_empty() ? 0 : X.ellipsoid()->axes(), 0, 0};
  }
  Answer is_empty(const Value& X, Certificate* why) const {
    if (X.given() && !X.given()->is_zonotope()) return cordon::is_empty(X.given()->form, why);
    if (why) *why = {Certificate::Kind::structure, Vector(0), 0};
    return X.is_empty() ? Answer::yes : Answer::no;  // a centre is a point of the set
  }
  Answer contains(const Value& X, VectorIn x, Certificate* why) const {
    if (const Ellipsoid* E = X.ellipsoid()) return sets::contains(*E, x);
    return cordon::contains(line_form(X), x, why);
  }
  Answer is_bounded(const Value&) const { return Answer::yes; }
  double support(const Value& X, VectorIn d, Certificate* why) const {
    if (const Ellipsoid* E = X.ellipsoid()) return sets::support(*E, d);
    if (X.is_empty()) return -infinity;
    const Given& given = *X.given();
    return given.is_zonotope() ? sets::support(given.zonotope(), d)
                               : cordon::outward::support(given.form, d, why);
  }
  Vector maximizer(const Value& X, VectorIn d) const {
    const Ellipsoid* E = X.ellipsoid();
    if (!E) return cordon::maximizer(line_form(X), d);
    const Vector along = linalg::transposed_product(E->L, d);
    const double length = along.norm();
    Vector x = E->c + E->r.cwiseProduct(Vector(d).cwiseSign());
    if (length > 0) x += linalg::product(E->L, Vector(along / length));
    return x;
  }
  Box interval_hull(const Value& X, std::vector<Certificate>* why) const {
    if (X.given() && !X.given()->is_zonotope())
      return cordon::outward::interval_hull(X.given()->form, why);
    if (why)
      why->assign(static_cast<std::size_t>(2 * X.n), {Certificate::Kind::structure, Vector(0), 0});
    if (X.is_empty()) return Box::empty(X.n);
    return X.given() ? sets::interval_hull(X.given()->zonotope())
                     : sets::interval_hull(*X.ellipsoid());
  }
  std::optional<Volume> volume(const Value& X) const {
    if (X.is_empty()) return Volume{0, true};
    const Ellipsoid* E = X.given() ? nullptr : X.ellipsoid();
    if (!E) return std::nullopt;
    const auto found = sets::volume(*E);
    if (!found) return std::nullopt;
    return Volume{found->value, found->exact};
  }

  /// The set as it is. Lines that rows determine are eliminated.
  Result import(const LineForm& X) const {
    if (X.constraints() > 0 && cordon::is_empty(X) == Answer::yes) return empty(X.dim());
    sets::Reduced Y =
        X.lines() > 0 ? sets::outward::enclose_without_lines(X) : sets::Reduced{X, true};
    if (Y.set.lines() > 0)
      throw Error(Errc::unsupported,
                  "ellipsoid: the set is unbounded, which this representation cannot hold; use "
                  "line_zonotope, or bound the set");
    Given given{std::move(Y.set), {}};
    if (!given.is_zonotope()) {
      auto around = sets::enclose(given.form, criterion);
      if (!around) return empty(X.dim());
      given.around = std::move(around->set);
    }
    return {{X.dim(), std::move(given)}, Y.exact ? Tightness::exact : Tightness::outer};
  }

  /// Whether what is added is T X itself.
  static bool add(sets::EllipsoidSum& sum, MatrixIn T, const Value& X) {
    const Given* given = X.given();
    if (given && given->is_zonotope()) {
      sum.add(T, given->zonotope());
      return true;
    }
    sum.add(T, given ? *given->around : *X.ellipsoid());
    return !given;
  }

  Result predict(const Value& X, MatrixIn A, VectorIn f,
                 std::span<const Operand<Value>> operands) const {
    if (X.is_empty()) return empty(A.rows());
    for (const auto& operand : operands) {
      if (operand.value.is_empty()) return empty(A.rows());
    }
    if (auto kept = placed(X, A, f, operands)) return {{A.rows(), std::move(*kept)}};
    sets::EllipsoidSum sum(f);
    bool exact = add(sum, A, X);
    for (const auto& operand : operands) exact = add(sum, operand.T, operand.value) && exact;
    Result found = result(sum.enclosed());
    if (!exact) found.tightness = Tightness::outer;
    return found;
  }

  /// Products of zonotopes that were imported, and they themselves, stay what they are.
  static std::optional<Given> placed(const Value& X, MatrixIn A, VectorIn f,
                                     std::span<const Operand<Value>> operands) {
    plugins::Few<Operand<Value>> all;
    all.push_back({A, X});
    for (const auto& operand : operands) all.push_back(operand);
    Index columns = 0;
    std::vector<bool> taken(static_cast<std::size_t>(A.rows()), false);
    for (const auto& [T, value] : all) {
      if (!value.given() || !value.given()->is_zonotope() || !only_places(T, taken))
        return std::nullopt;
      columns += value.given()->form.generators();
    }
    if (!f.isZero(0)) return std::nullopt;
    Vector c = Vector::Zero(A.rows());
    Matrix G(A.rows(), columns);
    Index at = 0;
    for (const auto& [T, value] : all) {
      const LineForm& form = value.given()->form;
      c += linalg::product(T, Matrix(form.c));
      G.middleCols(at, form.generators()) = linalg::product(T, form.G);
      at += form.generators();
    }
    return Given{make_zonotope(c, G), {}};
  }

  /// The ellipsoid in place of X.
  Ellipsoid around(const Value& X) const {
    if (X.ellipsoid()) return *X.ellipsoid();
    const Given& given = *X.given();
    return given.around ? *given.around : sets::enclose(given.zonotope(), criterion).set;
  }

  /// Row by row: z_i - C_i x ∈ T_i V is a strip, whose width is the support of V along T_i.
  Result correct(const Value& X, MatrixIn C, VectorIn z, const Operand<Value>& noise) const {
    if (X.is_empty() || noise.value.is_empty()) return empty(X.n);
    std::optional<Ellipsoid> E = around(X);
    for (Index i = 0; i < C.rows() && E; ++i) {
      const Vector row = noise.T.row(i).transpose(), a = C.row(i).transpose();
      const double above = support(noise.value, row, nullptr),
                   below = support(noise.value, -row, nullptr);
      const double terms = std::abs(z[i]) + std::abs(above) + std::abs(below) +
                           (outward ? 0 : a.cwiseAbs().dot(E->c.cwiseAbs()));
      E = cut_by(*E, {a, rounding::down(z[i] - above), rounding::up(z[i] + below),
                      outward ? 0 : rounding_of_data * terms});
    }
    return E ? outer(*std::move(E)) : empty(X.n);
  }

  std::optional<Ellipsoid> cut_by(const Ellipsoid& E, const sets::EllipsoidStrip& strip) const {
    return sets::cut(E, strip, criterion, outward ? 0 : tolerances::proof_margin);
  }

  /// {A x}: the middle's image, and a box of |rad(A)| |x|.
  Result interval_map(const Value& X, const IntervalMatrix& A) const {
    if (X.is_empty()) return empty(A.rows());
    sets::EllipsoidSum sum(Vector::Zero(A.rows()));
    const bool exact = add(sum, A.center, X) && A.is_exact();
    if (!A.is_exact()) {
      const Box hull = interval_hull(X, nullptr);
      const Vector reach = hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
      Vector radius(A.rows());
      for (Index i = 0; i < A.rows(); ++i)
        radius[i] = std::max(0.0, rounding::dot(A.radius.row(i).transpose(), reach).upper);
      sum.add_box(radius);
    }
    Result image = result(sum.enclosed());
    if (!exact) image.tightness = Tightness::outer;
    return image;
  }

  /// {x ∈ X : R x ∈ Y}, by strips along the axes of Y.
  Result intersection(const Value& X, MatrixIn R, const Value& Y) const {
    if (X.is_empty() || Y.is_empty()) return empty(X.n);
    const Matrix& columns = Y.given() ? Y.given()->form.G : Y.ellipsoid()->L;
    const Matrix directions =
        columns.cols() > 0 ? linalg::svd(columns).U : Matrix::Identity(Y.n, Y.n);
    const Matrix rows = linalg::transposed_product(R, directions),
                 errors = rounding::product_error(R.transpose(), directions);
    std::optional<Ellipsoid> E = around(X);
    for (Index j = 0; j < directions.cols() && E; ++j) {
      const Box hull = sets::interval_hull(*E);
      const Vector reach = hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
      const double uncertain = rounding::dot(errors.col(j), reach).upper;
      const Vector d = directions.col(j);
      E = cut_by(*E, {rows.col(j), -support(Y, -d, nullptr), support(Y, d, nullptr),
                      std::max(0.0, uncertain)});
    }
    return E ? outer(*std::move(E)) : empty(X.n);
  }

  Result convex_hull(const Value& X, const Value& Y) const {
    if (X.is_empty()) return {Y, Tightness::exact};
    if (Y.is_empty()) return {X, Tightness::exact};
    return outer(sets::convex_hull(around(X), around(Y)));
  }

  /// An ellipsoid's size does not grow. A set that was imported may be larger than the budget.
  std::optional<Result> reduce(const Value& X, Budget budget) const {
    const Given* given = X.given();
    if (!given || (given->form.generators() <= budget.generators &&
                   given->form.constraints() <= budget.constraints))
      return std::nullopt;
    return outer(around(X));
  }
};

ParamSchema schema() {
  ParamSchema schema;
  schema.choice("criterion",
                "what an ellipsoid makes smallest where it is cut by a measurement: the sum of "
                "squared half axes, in the units of the states, or the volume",
                {"trace", "volume"}, "trace");
  plugins::add_rounding(schema);
  return schema;
}

std::unique_ptr<SetBackend> create(const Params& params) {
  BackendInfo info;
  info.name = "ellipsoid";
  info.exact_exchange = false;
  info.summary = "ellipsoids, possibly flat, of a size that does not grow";
  info.citation = "Kurzhanski1997; Fogel1982; Maksarov1996";
  info.rounding = plugins::rounding_from(params);
  Ellipsoids ellipsoids;
  ellipsoids.criterion =
      params.text("criterion") == "volume" ? EllipsoidCriterion::volume : EllipsoidCriterion::trace;
  ellipsoids.outward = info.rounding == Rounding::outward;
  return std::make_unique<plugins::ValueBackend<Ellipsoids>>(info, ellipsoids);
}

void register_components(Registrar& registrar) {
  registrar.add(
      BackendEntry{{"ellipsoid", "ellipsoids, possibly flat, of a size that does not grow",
                    "Kurzhanski1997; Fogel1982; Maksarov1996", schema()},
                   create});
}

}  // namespace

CORDON_PLUGIN("ellipsoid", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "ellipsoids",
              register_components)
