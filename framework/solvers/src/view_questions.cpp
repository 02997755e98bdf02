// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/view_questions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/lp.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "question_rows.hpp"
#include "rational_effort.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

namespace {

using rational::Rational;
using rational::RationalVector;
using Kind = Certificate::Kind;

void require_vector(const View& X, VectorIn x) {
  check(X, "a question about a view");
  if (x.size() != X.dim())
    throw Error(Errc::dimension, "a question about a view: the vector has another dimension");
  if (!x.allFinite())
    throw Error(Errc::not_finite, "a question about a view: an entry is NaN or infinite");
}

/// The program max{gᵀ(δ, ξ, s, t)} over the rows of the form and H(c + Mδ + Gξ) + s - t = h with
/// s ≥ 0, and 0 ≤ t by which the inequalities may be missed, all by the same (`slack`), or t = 0.
LinearProgram program_of(const View& X, bool slack) {
  const LineForm& F = X.form;
  const Index l = F.lines(), g = F.generators(), m = F.constraints(), r = X.rows.rows();
  Matrix A = Matrix::Zero(m + r, l + g + r + 1);
  A.block(0, 0, m, l) = F.S;
  A.block(0, l, m, g) = F.A;
  A.block(m, 0, r, l) = linalg::product(X.rows.H, F.M);
  A.block(m, l, r, g) = linalg::product(X.rows.H, F.G);
  A.block(m, l + g, r, r).setIdentity();
  if (slack) A.block(m, l + g + r, r, 1).setConstant(-1);
  Vector b(m + r), lower = Vector::Zero(A.cols()), upper = Vector::Constant(A.cols(), infinity);
  b << F.b, X.rows.h - linalg::product(X.rows.H, F.c);
  lower.head(l).setConstant(-infinity);
  lower.segment(l, g).setConstant(-1);
  upper.segment(l, g).setConstant(1);
  if (!slack) upper[l + g + r] = 0;
  return {A, b, lower, upper};
}

/// dᵀ(Mδ + Gξ), and 0 for `others` variables behind them.
Vector objective_of(const LineForm& X, VectorIn d, Index others) {
  Vector g = Vector::Zero(X.lines() + X.generators() + others);
  g.head(X.lines()) = linalg::transposed_product(X.M, d);
  g.segment(X.lines(), X.generators()) = linalg::transposed_product(X.G, d);
  return g;
}

/// The solver takes small entries for 0, whatever their unit is.
double size_of_objective(const Vector& g) {
  const double size = g.size() ? g.cwiseAbs().maxCoeff() : 0;
  return size > 0 ? size : 1;
}

/// Would rational arithmetic take more than about a second?
bool is_in_reach(const View& X) {
  const LineForm& F = X.form;
  Matrix S(F.constraints() + X.rows.rows(), F.lines()), A(S.rows(), F.generators());
  S.setOnes();
  A.setOnes();
  return is_small(S, A);
}

/// λ ≥ 0 and y in one vector, as certificates hold them.
std::optional<Vector> multipliers(const View& X, const LinearProgram::Solution& solution) {
  const Index m = X.form.constraints(), r = X.rows.rows();
  if (solution.y.size() != m + r || !solution.y.allFinite()) return std::nullopt;
  Vector data = solution.y;
  data.tail(r) = data.tail(r).cwiseMax(0.0);
  return data;
}

/// The rows of the form, and those of the inequalities Hc + HMδ + HGξ ≤ h below.
rational::System system_of(const View& X) {
  const LineForm& F = X.form;
  const Index l = F.lines(), g = F.generators(), m = F.constraints(), r = X.rows.rows();
  rational::System system(rows_of(F));
  rational::RationalMatrix K(m + r, l + g);
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < l + g; ++j) K(i, j) = system.K(i, j);
  }
  Matrix both(F.dim(), l + g);
  both << F.M, F.G;
  const auto products =
      rational::product(rational::exact_matrix(X.rows.H), rational::exact_matrix(both));
  const RationalVector c = rational::exact(F.c);
  for (Index i = 0; i < r; ++i) {
    for (Index j = 0; j < l + g; ++j) K(m + i, j) = products(i, j);
    const Vector row = X.rows.H.row(i);
    system.r.push_back(rational::exact(X.rows.h[i]) - rational::dot(rational::exact(row), c));
  }
  system.K = std::move(K);
  return system;
}

/// The bound of h(d) that (y, λ) prove; nothing if they do not fit.
std::optional<Rational> bound_of(const View& X, VectorIn d, VectorIn data) {
  const LineForm& F = X.form;
  const RationalVector direction = rational::exact(d);
  RationalVector t(as_size(F.lines())), g(as_size(F.generators()));
  for (Index i = 0; i < F.dim(); ++i) {
    if (d[i] == 0) continue;
    for (Index j = 0; j < F.lines(); ++j)
      t[as_size(j)] += direction[as_size(i)] * rational::exact(F.M(i, j));
    for (Index j = 0; j < F.generators(); ++j)
      g[as_size(j)] += direction[as_size(i)] * rational::exact(F.G(i, j));
  }
  const auto bound = rational::dual_bound(system_of(X), t, g, data, X.rows.rows());
  if (!bound) return std::nullopt;
  return rational::dot(direction, rational::exact(F.c)) + *bound;
}

/// Does x keep to the inequalities, in exact arithmetic? Otherwise `missed` is one of those that it
/// does not keep to.
bool keeps_to(const Inequalities& rows, const RationalVector& x, Index* missed = nullptr) {
  for (Index i = 0; i < rows.rows(); ++i) {
    const Vector row = rows.H.row(i);
    if (rational::dot(rational::exact(row), x) > rational::exact(rows.h[i])) {
      if (missed) *missed = i;
      return false;
    }
  }
  return true;
}

/// Is there a point of the form near (δ, ξ) that keeps to the inequalities?
bool has_point_near(const View& X, VectorIn both) {
  const LineForm& F = X.form;
  const auto point = rational::solution_near(rational::System(rows_of(F)), both);
  if (!point) return false;
  RationalVector x = rational::exact(F.c);
  for (Index i = 0; i < F.dim(); ++i) {
    for (Index j = 0; j < F.lines(); ++j)
      x[as_size(i)] += rational::exact(F.M(i, j)) * (*point)[as_size(j)];
    for (Index j = 0; j < F.generators(); ++j)
      x[as_size(i)] += rational::exact(F.G(i, j)) * (*point)[as_size(F.lines() + j)];
  }
  return keeps_to(X.rows, x);
}

/// What rounding leaves of Mᵀd - `products`, entry by entry added up.
Rational rounding_of(VectorIn products, MatrixIn M, const RationalVector& d) {
  Rational sum = 0;
  for (Index j = 0; j < M.cols(); ++j) {
    const Vector column = M.col(j);
    sum += abs(rational::dot(rational::exact(column), d) - rational::exact(products[j]));
  }
  return sum;
}

/// X with the constraint lower ≤ dᵀx ≤ upper; false where lines make an error of rounding
/// unbounded.
bool add_strip(LineForm& X, const Vector& d, double lower, double upper) {
  const Vector along = linalg::transposed_product(X.G, d),
               lines = linalg::transposed_product(X.M, d);
  const double middle = lower / 2 + upper / 2;
  if (!std::isfinite(middle) || !along.allFinite() || !lines.allFinite()) return false;
  const RationalVector direction = rational::exact(d);
  if (sgn(rounding_of(lines, X.M, direction)) != 0) return false;
  const Rational right = rational::exact(middle) - rational::dot(direction, rational::exact(X.c));
  const double b = rational::nearest(right);
  if (!std::isfinite(b)) return false;
  // what is rounded widens the strip
  const Rational half = std::max(Rational(rational::exact(upper) - rational::exact(middle)),
                                 Rational(rational::exact(middle) - rational::exact(lower)));
  const double radius =
      rational::enclose(half + rounding_of(along, X.G, direction) + abs(right - rational::exact(b)))
          .upper;
  if (!std::isfinite(radius) || radius < 0) return false;
  const Index g = X.generators(), m = X.constraints();
  X.G.conservativeResize(Eigen::NoChange, g + 1);
  X.G.col(g).setZero();
  X.S.conservativeResize(m + 1, X.lines());
  X.S.row(m) = lines.transpose();
  X.A.conservativeResize(m + 1, g + 1);
  X.A.col(g).setZero();
  X.A.row(m).head(g) = along.transpose();
  X.A(m, g) = radius;
  X.b.conservativeResize(m + 1);
  X.b[m] = b;
  return true;
}

Answer decided(Answer answer, Certificate proof, Certificate* why) {
  if (why) *why = std::move(proof);
  return answer;
}

}  // namespace

Answer is_empty(const View& X, Certificate* why) {
  const Answer alone = is_empty(X.form, why);
  if (X.rows.rows() == 0 || alone == Answer::yes) return alone;
  if (why) *why = {};
  if (!is_in_reach(X)) return Answer::unknown;
  LinearProgram program = program_of(X, true);
  const Index variables = X.form.lines() + X.form.generators();
  const auto solution =
      program.maximize(-Vector::Unit(variables + X.rows.rows() + 1, variables + X.rows.rows()));
  if (solution.status != LinearProgram::Status::optimal) return Answer::unknown;
  const Vector both = solution.x.head(variables);
  if (has_point_near(X, both)) return decided(Answer::no, {Kind::point, both, 0}, why);
  const auto data = multipliers(X, solution);
  if (!data) return Answer::unknown;
  const auto bound = bound_of(X, Vector::Zero(X.dim()), *data);
  if (!bound || sgn(*bound) >= 0) return Answer::unknown;
  const double margin = -rational::enclose(*bound).upper;
  const Vector lambda = data->tail(X.rows.rows());
  const Vector of_center = linalg::product(X.rows.H.cwiseAbs(), X.form.c.cwiseAbs());
  const Vector y = data->head(X.form.constraints()).cwiseAbs();
  const Vector of_rows = X.form.b.cwiseAbs() + X.form.A.cwiseAbs().rowwise().sum();
  const double terms = lambda.dot(X.rows.h.cwiseAbs() + of_center) + y.dot(of_rows);
  if (margin <= tolerances::proof_margin * terms) return Answer::unknown;
  return decided(Answer::yes, {Kind::rows, *data, margin}, why);
}

Answer contains(const View& X, VectorIn x, Certificate* why) {
  require_vector(X, x);
  Index missed = 0;
  if (!keeps_to(X.rows, rational::exact(x), &missed)) {
    Vector data = Vector::Zero(X.form.constraints() + X.rows.rows());
    data[X.form.constraints() + missed] = 1;
    const double margin = X.rows.H.row(missed).dot(x) - X.rows.h[missed];
    return decided(Answer::no, {Kind::rows, std::move(data), margin}, why);
  }
  return contains(X.form, x, why);
}

double support(const View& X, VectorIn d, Certificate* why) {
  require_vector(X, d);
  const double alone = support(X.form, d, why);
  if (X.rows.rows() == 0 || alone == -infinity || !is_in_reach(X)) return alone;
  LinearProgram program = program_of(X, false);
  const Vector g = objective_of(X.form, d, X.rows.rows() + 1);
  if (!g.allFinite()) return alone;
  const double size = size_of_objective(g);
  auto solution = program.maximize(g / size);
  solution.y *= size;
  if (solution.status == LinearProgram::Status::infeasible) {
    Certificate proof;
    if (is_empty(X, &proof) != Answer::yes) return alone;
    if (why) *why = std::move(proof);
    return -infinity;
  }
  if (solution.status != LinearProgram::Status::optimal) return alone;
  const auto data = multipliers(X, solution);
  const auto bound = data ? bound_of(X, d, *data) : std::nullopt;
  const double value = bound ? rational::enclose(*bound).upper : infinity;
  if (value >= alone) return alone;
  if (why) *why = {Kind::rows, *data, value};
  return value;
}

Answer is_disjoint(const View& X, const View& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_disjoint: the dimensions differ");
  const Answer forms = is_disjoint(X.form, Y.form, why);
  if (X.rows.rows() + Y.rows.rows() == 0 || forms == Answer::yes) return forms;
  const Index n = X.dim();
  View both{intersection(X.form, Matrix::Identity(n, n), Y.form), X.rows, meet(X.claim, Y.claim)};
  return is_empty(with_rows(std::move(both), Y.rows), why);
}

Folded folded(const View& X) {
  check(X, "a view");
  Folded result{X.form, X.claim};
  for (Index i = 0; i < X.rows.rows(); ++i) {
    const Vector d = X.rows.H.row(i);
    const double upper = X.rows.h[i];
    if (support(X.form, d) <= upper) continue;  // says nothing new
    const double lower = -support(X, -d);
    if (!add_strip(result.form, d, lower, upper)) result.claim = Tightness::outer;
  }
  return result;
}

Vector maximizer(const LineForm& X, VectorIn d) {
  require_vector({X}, d);
  LinearProgram program = program_of({X}, false);
  const Vector g = objective_of(X, d, 1);
  if (!g.allFinite()) return Vector(0);
  const auto solution = program.maximize(g / size_of_objective(g));
  if (solution.status != LinearProgram::Status::optimal) return Vector(0);
  Vector x = X.c + linalg::product(X.M, solution.x.head(X.lines())) +
             linalg::product(X.G, solution.x.segment(X.lines(), X.generators()));
  return x.allFinite() ? x : Vector(0);
}

bool proves_empty(const View& X, const Certificate& why) {
  check(X, "certificate");
  if (why.kind != Kind::rows) return proves_empty(X.form, why);
  const auto bound = bound_of(X, Vector::Zero(X.dim()), why.data);
  return bound && sgn(*bound) < 0;
}

bool proves_excludes(const View& X, VectorIn x, const Certificate& why) {
  require_vector(X, x);
  if (why.kind != Kind::rows) return proves_excludes(X.form, x, why);
  const Index m = X.form.constraints();
  if (why.data.size() != m + X.rows.rows() || (why.data.tail(X.rows.rows()).array() < 0).any() ||
      !why.data.allFinite())
    return false;
  const RationalVector point = rational::exact(x);
  Rational sum = 0;
  for (Index i = 0; i < X.rows.rows(); ++i) {
    const Vector row = X.rows.H.row(i);
    sum += rational::exact(why.data[m + i]) *
           (rational::dot(rational::exact(row), point) - rational::exact(X.rows.h[i]));
  }
  return sgn(sum) > 0;
}

bool proves_support(const View& X, VectorIn d, double bound, const Certificate& why) {
  require_vector(X, d);
  if (bound == infinity) return true;
  if (why.kind != Kind::rows) return proves_support(X.form, d, bound, why);
  if (bound == -infinity) return proves_empty(X, why);
  const auto proven = bound_of(X, d, why.data);
  return proven && *proven <= rational::exact(bound);
}

bool proves_not_empty(const View& X, const Certificate& why) {
  check(X, "certificate");
  if (X.rows.rows() == 0) return proves_not_empty(X.form, why);
  return why.kind == Kind::point && why.data.size() == X.form.lines() + X.form.generators() &&
         has_point_near(X, why.data);
}

}  // namespace cordon
