// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/polytope.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon {

namespace {

using polytope::Form;
using polytope::require;
using polytope::require_finite;
using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

/// Without repeated rows; inequalities that differ in β only are merged into the tightest.
Description tidy(const Description& in, Form form) {
  struct Less {
    bool operator()(const std::pair<RationalVector, bool>& a,
                    const std::pair<RationalVector, bool>& b) const {
      return a.second != b.second ? a.second < b.second
                                  : std::lexicographical_compare(a.first.begin(), a.first.end(),
                                                                 b.first.begin(), b.first.end());
    }
  };
  std::map<std::pair<RationalVector, bool>, std::size_t, Less> seen;  // to the place in `out`
  Description out{in.dim, {}, {}};
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    RationalVector row = in.rows[i];
    if (form == Form::generators && sgn(row[0]) != 0) {
      if (seen.emplace(std::pair(row, false), out.rows.size()).second) out.add(row, false);
      continue;
    }
    RationalVector normal(row.begin() + 1, row.end());
    const bool zero =
        std::all_of(normal.begin(), normal.end(), [](const Rational& x) { return sgn(x) == 0; });
    if (zero && form == Form::generators) continue;
    if (!zero) {
      const auto first =
          std::find_if(normal.begin(), normal.end(), [](const Rational& x) { return sgn(x) != 0; });
      const Rational before = *first;
      rational::make_primitive(normal);
      row[0] *= *first / before;
    }
    std::copy(normal.begin(), normal.end(), row.begin() + 1);
    if (form == Form::generators || in.linear[i]) {
      if (seen.emplace(std::pair(row, bool(in.linear[i])), out.rows.size()).second)
        out.add(row, in.linear[i]);
      continue;
    }
    const auto [place, is_new] = seen.emplace(std::pair(normal, false), out.rows.size());
    if (is_new) {
      out.add(row, false);
    } else {
      Rational& beta = out.rows[place->second][0];
      if (row[0] < beta) beta = row[0];
    }
  }
  return out;
}

/// Value of β + aᵀx, or of its homogeneous part for a direction: both are (row)ᵀ(generator).
int side_of(const RationalVector& inequality, const RationalVector& generator) {
  return sgn(rational::dot(inequality, generator));
}

bool satisfies(const RationalVector& generator, bool is_line, const Description& inequalities) {
  for (std::size_t i = 0; i < inequalities.rows.size(); ++i) {
    const int side = side_of(inequalities.rows[i], generator);
    if (side < 0 || (side > 0 && (is_line || inequalities.linear[i]))) return false;
  }
  return true;
}

void append_columns(Description& out, MatrixIn V, int first, bool linear) {
  for (Index j = 0; j < V.cols(); ++j) {
    RationalVector row = rational::exact(VectorIn(V.col(j)));
    row.insert(row.begin(), Rational(first));
    out.add(std::move(row), linear);
  }
}

void append_rows(Description& out, MatrixIn H, VectorIn h, bool linear) {
  for (Index i = 0; i < H.rows(); ++i) {
    RationalVector row{rational::exact(h[i])};
    for (Index j = 0; j < H.cols(); ++j) row.push_back(-rational::exact(H(i, j)));
    out.add(std::move(row), linear);
  }
}

}  // namespace

namespace polytope {

void require(bool holds, const std::string& message) {
  if (!holds) throw Error(Errc::dimension, "polytope: " + message);
}

void require_finite(MatrixIn A, const char* what) {
  if (!A.allFinite())
    throw Error(Errc::not_finite,
                std::string("polytope: ") + what + " has a NaN or infinite entry");
}

double words(const Description& in) {
  constexpr std::size_t looked_at = 16;
  std::size_t most = 1;
  for (std::size_t i = 0; i < std::min(in.rows.size(), looked_at); ++i) {
    for (const Rational& x : in.rows[i])
      most = std::max(most, mpz_size(x.get_num_mpz_t()) + mpz_size(x.get_den_mpz_t()));
  }
  return static_cast<double>(most);
}

double product_work(const Description& a, const Description& b) {
  constexpr double common_divisors = 8;
  return static_cast<double>(a.rows.size() * b.rows.size() * as_size(a.dim + 1)) *
         (words(a) + words(b)) * common_divisors;
}

}  // namespace polytope

// ---- representation
// -----------------------------------------------------------------------------------------------------------

Polytope::Representation::Representation(Form form, Description description)
    : dim(description.dim) {
  (form == Form::inequalities ? given_inequalities_ : given_generators_) = tidy(description, form);
}

Polytope::Representation::Representation(Description generators,
                                         std::optional<Description> inequalities)
    : dim(generators.dim),
      given_generators_(generators),
      minimal_inequalities_(std::move(inequalities)),
      minimal_generators_(std::move(generators)) {}

Polytope Polytope::Representation::make(Form form, Description description) {
  return Polytope(std::make_shared<const Representation>(form, std::move(description)));
}

Polytope Polytope::Representation::minimal(Description generators,
                                           std::optional<Description> inequalities) {
  return Polytope(
      std::make_shared<const Representation>(std::move(generators), std::move(inequalities)));
}

void Polytope::Representation::convert_generators() const {
  Conversion found = inequalities_and_points(*given_generators_);
  minimal_inequalities_ = std::move(found.answer);
  if (!minimal_generators_) minimal_generators_ = std::move(found.needed);
}

const Description& Polytope::Representation::locked_generators() const {
  if (minimal_generators_) return *minimal_generators_;
  if (given_inequalities_) {
    Conversion found = generators_and_rows(*given_inequalities_);
    minimal_generators_ = std::move(found.answer);
    minimal_inequalities_ = std::move(found.needed);
  } else {
    if (!minimal_inequalities_) convert_generators();
    if (!minimal_generators_) minimal_generators_ = cordon::generators_of(*minimal_inequalities_);
  }
  return *minimal_generators_;
}

const Description& Polytope::Representation::generators() const {
  const std::lock_guard lock(lock_);
  return locked_generators();
}

const Description& Polytope::Representation::inequalities() const {
  const std::lock_guard lock(lock_);
  if (!minimal_inequalities_ && given_generators_) convert_generators();
  if (!minimal_inequalities_) {
    const Description& generators = locked_generators();
    if (!minimal_inequalities_) minimal_inequalities_ = cordon::inequalities_of(generators);
  }
  return *minimal_inequalities_;
}

const Description& Polytope::Representation::any_inequalities() const {
  if (!given_inequalities_) return inequalities();
  const std::lock_guard lock(lock_);
  return minimal_inequalities_ ? *minimal_inequalities_ : *given_inequalities_;
}

const Description* Polytope::Representation::known_inequalities() const {
  const std::lock_guard lock(lock_);
  return minimal_inequalities_ ? &*minimal_inequalities_ : nullptr;
}

// ---- construction
// -------------------------------------------------------------------------------------------------------------

Polytope Polytope::from_inequalities(MatrixIn H, VectorIn h) {
  return from_inequalities(H, h, Matrix(0, H.cols()), Vector(0));
}

Polytope Polytope::from_inequalities(MatrixIn H, VectorIn h, MatrixIn Q, VectorIn q) {
  require(H.rows() == h.size() && Q.rows() == q.size() && H.cols() == Q.cols(),
          "H must have one row per entry of h, Q one per entry of q, and as many columns as H");
  require_finite(H, "H"), require_finite(h, "h"), require_finite(Q, "Q"), require_finite(q, "q");
  Description out{H.cols(), {}, {}};
  append_rows(out, H, h, false);
  append_rows(out, Q, q, true);
  return Representation::make(Form::inequalities, std::move(out));
}

Polytope Polytope::from_generators(MatrixIn V) {
  return from_generators(V, Matrix(V.rows(), 0), Matrix(V.rows(), 0));
}

Polytope Polytope::from_generators(MatrixIn V, MatrixIn rays, MatrixIn lines) {
  require(rays.rows() == V.rows() && lines.rows() == V.rows(),
          "points, rays and lines must have the same number of rows");
  require_finite(V, "the list of points"), require_finite(rays, "the list of rays"),
      require_finite(lines, "the list of lines");
  if (V.cols() == 0) return empty(V.rows());
  Description out{V.rows(), {}, {}};
  append_columns(out, V, 1, false);
  append_columns(out, rays, 0, false);
  append_columns(out, lines, 0, true);
  return Representation::make(Form::generators, std::move(out));
}

Polytope Polytope::from(const LineForm& X) {
  check(X, "Polytope::from");
  return Representation::make(Form::inequalities, polytope::inequalities_of(X));
}

Polytope Polytope::empty(Index n) { return Representation::make(Form::generators, {n, {}, {}}); }
Polytope Polytope::space(Index n) { return Representation::make(Form::inequalities, {n, {}, {}}); }

// ---- questions
// ----------------------------------------------------------------------------------------------------------------

Index Polytope::dim() const { return representation_->dim; }
bool Polytope::is_empty() const { return representation_->generators().rows.empty(); }

bool Polytope::is_bounded() const {
  const auto& rows = representation_->generators().rows;
  return std::all_of(rows.begin(), rows.end(),
                     [](const RationalVector& row) { return sgn(row[0]) != 0; });
}

std::size_t Polytope::bits() const {
  std::size_t sum = 0;
  for (const RationalVector& row : representation_->generators().rows) {
    for (const Rational& x : row)
      sum += mpz_sizeinbase(x.get_num_mpz_t(), 2) + mpz_sizeinbase(x.get_den_mpz_t(), 2);
  }
  return sum;
}

bool Polytope::contains(VectorIn x) const {
  require(x.size() == dim(), "the point has another dimension than the set");
  require_finite(x, "the point");
  RationalVector point = rational::exact(x);
  point.insert(point.begin(), Rational(1));
  return satisfies(point, false, representation_->any_inequalities());
}

bool Polytope::contains(const Polytope& X) const {
  require(X.dim() == dim(), "the dimensions " + std::to_string(dim()) + " and " +
                                std::to_string(X.dim()) + " differ");
  const Description& generators = X.representation_->generators();
  const Description& inequalities = representation_->any_inequalities();
  ExactBudget::spend(polytope::product_work(generators, inequalities));
  for (std::size_t i = 0; i < generators.rows.size(); ++i) {
    if (!satisfies(generators.rows[i], generators.linear[i], inequalities)) return false;
  }
  return true;
}

bool operator==(const Polytope& X, const Polytope& Y) {
  return X.dim() == Y.dim() && X.contains(Y) && Y.contains(X);
}

Interval Polytope::support(VectorIn d) const {
  require(d.size() == dim(), "the direction has another dimension than the set");
  require_finite(d, "the direction");
  RationalVector direction = rational::exact(d);
  direction.insert(direction.begin(), Rational(0));
  const Description& generators = representation_->generators();
  ExactBudget::spend(static_cast<double>(generators.rows.size() * direction.size()) *
                     polytope::words(generators));
  std::optional<Rational> largest;
  for (std::size_t i = 0; i < generators.rows.size(); ++i) {
    const RationalVector& row = generators.rows[i];
    const Rational value = rational::dot(direction, row);
    if (sgn(row[0]) == 0) {
      if (sgn(value) > 0 || (sgn(value) < 0 && generators.linear[i])) return {infinity, infinity};
    } else if (!largest || value > *largest) {
      largest = value;
    }
  }
  return largest ? rational::enclose(*largest) : Interval{-infinity, -infinity};
}

Interval Polytope::volume() const {
  const Description& generators = representation_->generators();
  if (generators.rows.empty()) return {0, 0};
  if (!is_bounded()) throw Error(Errc::unsupported, "polytope: an unbounded set has no volume");
  const Description& inequalities = representation_->inequalities();
  if (std::find(inequalities.linear.begin(), inequalities.linear.end(), true) !=
      inequalities.linear.end())
    return {0, 0};
  return rational::enclose(polytope::volume(generators, inequalities));
}

Box Polytope::interval_hull() const {
  const Index n = dim();
  if (n > 0 && is_empty()) return Box::empty(n);
  Box hull = Box::space(n);
  for (Index i = 0; i < n; ++i) {
    hull.upper[i] = support(Vector::Unit(n, i)).upper;
    hull.lower[i] = -support(-Vector::Unit(n, i)).upper;
  }
  return hull;
}

}  // namespace cordon
