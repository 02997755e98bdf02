// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/interval.hpp"

#include <cmath>
#include <limits>

#include "adapter.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/sets/zonotope.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "rounding_parameter.hpp"

namespace {

using namespace cordon;
using plugins::Operand;

/// A point that is outside by less than this share of the bound may be so by rounding errors.
/// Of its terms, an output may be off by this: it was rounded before it came here.
constexpr double rounding_of_data = 1e-14;

bool is_plain_box(const LineForm& X) {
  const auto axis_parallel = [](const Matrix& columns) {
    for (Index j = 0; j < columns.cols(); ++j) {
      if ((columns.col(j).array() != 0).count() > 1) return false;
    }
    return true;
  };
  return X.constraints() == 0 && axis_parallel(X.G) && axis_parallel(X.M);
}

/// The box of such a form: bounds c ± r without a detour where they are doubles, else the certified
/// ones.
Box plain_box(const LineForm& X, bool& exact) {
  Box box = cordon::outward::interval_hull(X);
  exact = true;
  for (Index i = 0; i < X.dim(); ++i) {
    if (!std::isfinite(box.upper[i])) continue;
    const double radius = X.generators() ? X.G.row(i).lpNorm<Eigen::Infinity>() : 0.0;
    const bool one = (X.G.row(i).array() != 0).count() <= 1;
    const auto bound = [&](double r, double& place) {
      const double s = X.c[i] + r, part = s - X.c[i];
      const bool rounded = !one || (X.c[i] - (s - part)) + (r - part) != 0 || !std::isfinite(s);
      exact = exact && !rounded;
      if (!rounded) place = s;
    };
    bound(radius, box.upper[i]);
    bound(-radius, box.lower[i]);
  }
  return box;
}

/// The hull of {c + Gξ}. Boxes come with one generator along a coordinate at most, which needs no
/// sum.
Box hull_of(const Vector& c, const Matrix& G) {
  Vector radius = Vector::Zero(c.size());
  bool single = true;
  for (Index j = 0; j < G.cols(); ++j) {
    Index entries = 0;
    for (Index i = 0; i < c.size(); ++i) {
      if (G(i, j) == 0) continue;
      single = single && radius[i] == 0 && ++entries == 1;
      radius[i] = std::abs(G(i, j));
    }
  }
  if (!single) return sets::interval_hull(sets::Zonotope{c, G});
  Box hull{c, c};
  for (Index i = 0; i < c.size(); ++i) {
    if (radius[i] == 0) continue;
    hull.lower[i] = rounding::down(c[i] - radius[i]);
    hull.upper[i] = rounding::up(c[i] + radius[i]);
  }
  return hull;
}

/// At most one entry per row over all matrices, each 0 or ±1: coordinates are only put elsewhere.
bool only_places(std::span<const MatrixIn* const> maps, VectorIn f) {
  for (Index i = 0; i < f.size(); ++i) {
    Index entries = f[i] != 0 ? 1 : 0;
    for (const MatrixIn* T : maps) {
      for (Index j = 0; j < T->cols(); ++j) {
        const double a = (*T)(i, j);
        if (a != 0 && std::abs(a) != 1) return false;
        entries += a != 0 ? 1 : 0;
      }
    }
    if (entries > 1) return false;
  }
  return true;
}

/// Kernels round outward in either mode. The modes differ in what they call exact and in how the
/// set is read from others.
struct Intervals {
  using Value = Box;
  using Result = plugins::ResultOf<Box>;

  bool outward = false;

  Index dim(const Box& X) const { return X.dim(); }
  LineForm line_form(const Box& X) const { return make_box(X); }
  /// With outward rounding a form whose centre or radius is rounded is another set.
  bool has_exact_form(const Box& X) const { return !outward || is_exact_form_of(X); }
  Complexity complexity(const Box& X) const {
    Complexity c;
    for (Index i = 0; i < X.dim(); ++i) {
      if (std::isinf(X.upper[i])) {
        ++c.lines;
      } else if (X.upper[i] > X.lower[i]) {
        ++c.generators;
      }
    }
    return c;
  }
  Answer is_empty(const Box& X, Certificate* why) const {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 0};
    return X.is_empty() ? Answer::yes : Answer::no;
  }
  Answer contains(const Box& X, VectorIn x, Certificate*) const {
    if (X.is_empty()) return Answer::no;
    Answer answer = Answer::yes;
    for (Index i = 0; i < X.dim(); ++i) {
      const double beyond = std::max(X.lower[i] - x[i], x[i] - X.upper[i]);
      if (beyond <= 0) continue;
      const double bound = x[i] > X.upper[i] ? X.upper[i] : X.lower[i];
      if (beyond > tolerances::proof_margin * (std::abs(x[i]) + std::abs(bound))) return Answer::no;
      answer = Answer::unknown;
    }
    return answer;
  }
  Answer is_bounded(const Box& X) const {
    return X.is_empty() || X.is_bounded() ? Answer::yes : Answer::no;
  }
  double support(const Box& X, VectorIn d, Certificate*) const {
    if (X.is_empty()) return -infinity;
    Vector terms = Vector::Zero(X.dim());
    for (Index i = 0; i < X.dim(); ++i) {
      if (d[i] == 0) continue;
      terms[i] = d[i] > 0 ? rounding::up(d[i] * X.upper[i]) : rounding::up(d[i] * X.lower[i]);
      if (std::isinf(terms[i])) return infinity;
    }
    return rounding::sum(terms).upper;
  }
  Vector maximizer(const Box& X, VectorIn d) const {
    Vector corner(X.dim());
    for (Index i = 0; i < X.dim(); ++i) {
      const double lower = std::isinf(X.lower[i]) ? 0 : X.lower[i];
      corner[i] = d[i] > 0 ? X.upper[i] : d[i] < 0 ? X.lower[i] : lower;
    }
    return corner;
  }
  Box interval_hull(const Box& X, std::vector<Certificate>* why) const {
    if (why)
      why->assign(static_cast<std::size_t>(2 * X.dim()),
                  {Certificate::Kind::structure, Vector(0), 0});
    return X;
  }
  std::optional<Volume> volume(const Box& X) const {
    return Volume{(X.upper - X.lower).prod(), true};
  }
  void serialize(Box& X, Archive& archive) const {
    archive(X);
    if (X.lower.hasNaN() || X.upper.hasNaN()) archive.refuse("a box with NaN for a bound");
  }

  Result import(const LineForm& X) const {
    if (outward) {
      if (!is_plain_box(X)) return {cordon::outward::interval_hull(X), Tightness::outer};
      bool exact = true;
      Box box = plain_box(X, exact);
      return {std::move(box), exact ? Tightness::exact : Tightness::outer};
    }
    const Tightness tightness = is_plain_box(X) ? Tightness::exact : Tightness::outer;
    if (X.lines() == 0 && X.constraints() == 0) return {hull_of(X.c, X.G), tightness};
    return {cordon::interval_hull(X), tightness};
  }

  Result predict(const Box& X, MatrixIn A, VectorIn f,
                 std::span<const Operand<Box>> operands) const {
    plugins::Few<sets::MappedBox> summands;
    bool exact = sets::is_monomial(A);
    for (const auto& operand : operands) {
      summands.push_back({operand.T, operand.value});
      exact = exact && sets::is_monomial(operand.T);
    }
    Box sum = sets::affine_sum(X, A, f, {summands.data(), summands.size()});
    if (outward && exact) {
      std::vector<const MatrixIn*> maps{&A};
      for (const auto& operand : operands) maps.push_back(&operand.T);
      exact = only_places(maps, f);
    }
    return {std::move(sum), exact ? Tightness::exact : Tightness::outer};
  }
  Result correct(const Box& X, MatrixIn C, VectorIn z, const Operand<Box>& noise) const {
    const bool exact = !outward && sets::has_monomial_rows(C) && sets::is_monomial(noise.T);
    const double off = outward ? 0 : rounding_of_data;
    return {sets::contract(X, C, z, noise.T, noise.value, off),
            exact ? Tightness::exact : Tightness::outer};
  }
  Result interval_map(const Box& X, const IntervalMatrix& A) const {
    return {sets::interval_map(X, A), Tightness::outer};
  }
  Result intersection(const Box& X, MatrixIn R, const Box& Y) const {
    if (R.rows() == R.cols() && R.isIdentity(0))
      return {sets::intersection(X, Y), Tightness::exact};
    // R x ∈ Y ⇔ 0 - R x ∈ -Y
    const Matrix minus = -Matrix::Identity(Y.dim(), Y.dim());
    return {sets::contract(X, R, Vector::Zero(Y.dim()), minus, Y),
            !outward && sets::has_monomial_rows(R) ? Tightness::exact : Tightness::outer};
  }
  Result convex_hull(const Box& X, const Box& Y) const {
    return {sets::convex_hull(X, Y), Tightness::outer};
  }
  std::optional<Result> reduce(const Box&, Budget) const { return std::nullopt; }
};

ParamSchema schema() {
  ParamSchema schema;
  plugins::add_rounding(schema);
  return schema;
}

std::unique_ptr<SetBackend> create(const Params& params) {
  BackendInfo info;
  info.name = "interval";
  info.unbounded = true;
  info.intersections = false;
  info.summary = "axis-aligned boxes; a coordinate is bounded or free";
  info.citation = "Moore2009";
  info.rounding = plugins::rounding_from(params);
  const bool outward = info.rounding == Rounding::outward;
  info.exact_exchange = !outward;  // centre and radius of a box are rounded
  return std::make_unique<plugins::ValueBackend<Intervals>>(info, Intervals{outward});
}

void register_components(Registrar& registrar) {
  registrar.add(BackendEntry{
      {"interval", "axis-aligned boxes; a coordinate is bounded or free", "Moore2009", schema()},
      create});
}

}  // namespace

CORDON_PLUGIN("interval", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "interval vectors",
              register_components)
