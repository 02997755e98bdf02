// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::conformance {

namespace {

constexpr double nominal = 1e-9;
/// Outward rounding of a zero.
constexpr double underflow = 1e-290;

bool is_moderate(const Matrix& A) {
  return A.size() == 0 ||
         ((A.array() == 0) || (A.array().abs() > 1e-4 && A.array().abs() < 1e4)).all();
}

}  // namespace

double size_of(const LineForm& X) {
  if (X.dim() == 0) return 0;
  Vector size = X.c.cwiseAbs();
  if (X.generators()) size += X.G.cwiseAbs().rowwise().sum();
  if (X.lines()) size += 2 * X.M.cwiseAbs().rowwise().sum();
  return size.maxCoeff();
}

Reference::Reference(const LineForm& X, std::vector<Vector> known, double terms, double row_terms)
    : Reference(eliminate_lines_traced(X, Vector(0)), std::move(known), std::max(terms, size_of(X)),
                row_terms) {
  trusted_ = X.lines() == 0 || (is_moderate(X.M) && is_moderate(X.S));
  if (X.lines() > 0) whole_ = X;
}

Reference::Reference(LinesEliminated eliminated, std::vector<Vector> known, double terms,
                     double row_terms)
    : X_(std::move(eliminated.set)),
      row_magnitude_(std::move(eliminated.row_magnitude)),
      vanished_(eliminated.vanished),
      program_(X_.A, X_.b, {row_magnitude_, {}}),
      known_(std::move(known)),
      terms_(std::max(terms, size_of(X_))),
      row_terms_(row_terms),
      moderate_(is_moderate(X_.G) && is_moderate(X_.A) && is_moderate(X_.c) && is_moderate(X_.b) &&
                row_terms < 1e4) {}

Reference::Along Reference::along(VectorIn d) const {
  if (!trusted_) return Along::unclear;
  double share = 0;
  for (Index j = 0; j < X_.lines(); ++j) {
    const double size = X_.M.col(j).cwiseAbs().dot(d.cwiseAbs());
    if (size > 0) share = std::max(share, std::abs(X_.M.col(j).dot(d)) / size);
  }
  return share > 1e-6 ? Along::line : share > 0 ? Along::unclear : Along::bounded;
}

const BoxedProgram::Bound& Reference::solve(VectorIn d) {
  if (asked_.size() != d.size() || asked_ != d) {
    asked_ = d;
    bound_ = program_.maximum(linalg::product(X_.G.transpose(), d));
  }
  return bound_;
}

double Reference::lower(VectorIn d) {
  double value = -infinity;
  for (const Vector& x : known_) value = std::max(value, d.dot(x));
  const Along line = along(d);
  if (line == Along::line) {
    const bool has_point = !known_.empty() || (vanished_ == 0 && program_.is_empty() == Answer::no);
    return has_point ? infinity : -infinity;
  }
  // rows that are left out may say more than the others: what these reach proves nothing
  if (line == Along::unclear || vanished_ > 0) return value;
  double reached = -infinity;
  if (const BoxedProgram::Bound bound = solve(d); bound.xi) {
    reached = program_.lower_support(linalg::product(X_.G.transpose(), d), *bound.xi);
  }
  if (reached > -infinity) return std::max(value, d.dot(X_.c) + reached);
  // dependent rows, or a set without interior: floating point proves nothing, rational arithmetic
  // does where it is affordable
  if (!moderate_ || X_.generators() > 16 || X_.constraints() > 8) return value;
  // +inf here is a direction that misses being normal to a line by its own rounding
  const double exact = exact::support(X_, d).lower;
  if (exact == -infinity && !whole_)
    return exact;  // empty by a hair: the known points were rounded
  return exact < infinity ? std::max(value, exact) : value;
}

double Reference::upper(VectorIn d) {
  if (along(d) != Along::bounded) return infinity;
  if (whole_)
    return cordon::support(*whole_, d);  // with lines, what rational arithmetic makes of it
  if (solve(d).upper == -infinity) return -infinity;
  const double gradient_error = rounding::product_error(X_.G.transpose(), d).sum();
  return rounding::up(d.dot(X_.c) + solve(d).upper) + gradient_error;
}

double Reference::tolerance(VectorIn d) {
  double size = d.lpNorm<1>() * terms_;
  if (along(d) == Along::bounded) {
    const Vector& y = solve(d).y;
    for (Index i = 0; i < y.size() && i < X_.constraints(); ++i) {
      double row = std::abs(X_.b[i]) + row_terms_;
      if (X_.generators()) row += X_.A.row(i).cwiseAbs().sum();
      if (i < row_magnitude_.size()) row += row_magnitude_[i];
      size += std::abs(y[i]) * row;
    }
  }
  return nominal * size + underflow;
}

bool Reference::robust() {
  if (vanished_ > 0) return false;  // rows that agree up to rounding, or do not
  if (X_.constraints() == 0) return true;
  if (X_.generators() == 0) return false;  // 0 = b: any rounding error decides
  const auto xi = program_.central_point();
  if (!xi) return false;
  const double slack = 1 - xi->cwiseAbs().maxCoeff();
  for (Index i = 0; i < X_.constraints(); ++i) {
    const double reach = X_.A.row(i).cwiseAbs().sum();
    const double magnitude = i < row_magnitude_.size() ? row_magnitude_[i] : 0.0;
    if (!(slack * reach > nominal * (std::abs(X_.b[i]) + row_terms_ + magnitude + reach)))
      return false;
  }
  return true;
}

std::optional<Vector> Reference::maximizer(VectorIn d) {
  if (along(d) != Along::bounded) return std::nullopt;
  const BoxedProgram::Bound& bound = solve(d);
  if (!bound.xi) return std::nullopt;
  return Vector(X_.c + linalg::product(X_.G, *bound.xi));
}

void Truth::add(const LineForm& part, std::vector<Vector> known, double terms, double row_terms) {
  forms_.push_back(part);
  parts_.push_back(std::make_shared<Reference>(part, std::move(known), terms, row_terms));
}

double Truth::lower(VectorIn d) {
  double value = -infinity;
  for (const auto& part : parts_) value = std::max(value, part->lower(d));
  return value;
}
double Truth::upper(VectorIn d) {
  double value = -infinity;
  for (const auto& part : parts_) value = std::max(value, part->upper(d));
  return value;
}
double Truth::tolerance(VectorIn d) {
  double value = 0;
  for (const auto& part : parts_) value = std::max(value, part->tolerance(d));
  return value;
}

bool Truth::robust() {
  return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->robust(); });
}

Truth truth_of(const LineForm& X, double terms) {
  Truth truth;
  truth.add(X, {}, terms, 0);
  return truth;
}

std::vector<Vector> directions(const std::vector<LineForm>& forms, Index n, Random& random,
                               int count) {
  std::vector<Vector> found;
  for (Index i = 0; i < n; ++i) {
    found.push_back(Vector::Unit(n, i));
    found.push_back(-Vector::Unit(n, i));
  }
  for (int k = 0; k < count && n > 1; ++k) {
    Vector d(n);
    for (double& entry : d) entry = static_cast<double>(random.between(-8, 8)) / 8;
    if (!d.isZero(0)) found.push_back(d);
  }
  // normals of facets of a zonotope: to one generator in the plane, to two in space
  for (const LineForm& X : forms) {
    const Index g = X.generators();
    if (g == 0 || n < 2 || n > 3) continue;
    for (int k = 0; k < count; ++k) {
      const Vector u = X.G.col(random.below(g)), v = X.G.col(random.below(g));
      Vector d = n == 2 ? Vector{{-u[1], u[0]}}
                        : Vector{{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                  u[0] * v[1] - u[1] * v[0]}};
      const double size = d.cwiseAbs().maxCoeff();
      if (!(size > 0) || !std::isfinite(size)) continue;
      found.push_back(d / size * random.sign());
    }
  }
  return found;
}

std::vector<Vector> points_of(const LineForm& X, const Vector& delta, const Vector& xi,
                              Random& random, int count) {
  const Index l = X.lines(), g = X.generators(), m = X.constraints();
  std::vector<Vector> points{X.c + X.M * delta + X.G * xi};
  if (l + g == 0) return points;
  Matrix rows(m, l + g), columns(X.dim(), l + g);
  rows << X.S, X.A;
  columns << X.M, X.G;
  Vector full(l + g);
  full << delta, xi;
  const auto within = [&](const Vector& f) {
    return g == 0 || f.tail(g).cwiseAbs().maxCoeff() <= 1;
  };
  for (int k = 0; k < count; ++k) {
    for (Index j = 0; m == 0 && j < l + g; ++j) {
      full[j] = j >= l && random.chance(0.5) ? random.sign()
                                             : static_cast<double>(random.between(-4, 4)) / 4;
    }
    for (int trial = 0; m > 0 && trial < 8; ++trial) {
      const Index i = random.below(l + g), j = random.below(l + g), row = random.below(m);
      Vector moved = full;
      const double length =
          random.sign() * std::ldexp(1.0, static_cast<int>(random.between(-4, 0)));
      moved[i] += length * (i == j ? 1 : rows(row, j));
      if (i != j) moved[j] -= length * rows(row, i);
      if (within(moved) && (rows * (moved - full)).isZero(0)) full = moved;
    }
    points.push_back(X.c + columns * full);
  }
  return points;
}

}  // namespace cordon::conformance
