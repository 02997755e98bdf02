// SPDX-License-Identifier: GPL-3.0-or-later
// From exchange form to inequalities. The set is the section of the lifted zonotope {(c; -b) + (M;
// S)δ + (G; A)ξ} by the subspace where its constraint coordinates vanish, and the facets of a
// zonotope are known in closed form: normals are orthogonal to all but one of as many generators as
// there are dimensions. No vertices are enumerated in the space of the factors.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon::polytope {

namespace {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

constexpr double most_subsets = 20'000;
constexpr Index most_coordinates = 40, most_columns = 300;

double binomial(Index n, Index k) {
  double value = 1;
  for (Index i = 0; i < k; ++i) value *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  return value;
}

RationalMatrix transpose(const RationalMatrix& A) {
  RationalMatrix B(A.cols(), A.rows());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) B(j, i) = A(i, j);
  }
  return B;
}

struct Less {
  bool operator()(const RationalVector& a, const RationalVector& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }
};

/// A positive or negative multiple: integers without a common factor, the first nonzero one
/// positive.
void make_direction(RationalVector& x) {
  rational::make_primitive(x);
  const auto first =
      std::find_if(x.begin(), x.end(), [](const Rational& value) { return sgn(value) != 0; });
  if (first == x.end() || sgn(*first) > 0) return;
  for (Rational& value : x) value = -value;
}

/// The different directions among the columns, as rows of integers.
std::vector<RationalVector> directions(const RationalMatrix& W) {
  std::set<RationalVector, Less> all;
  const RationalMatrix rows = transpose(W);
  for (Index j = 0; j < W.cols(); ++j) {
    RationalVector w = rows.row(j);
    make_direction(w);
    if (std::any_of(w.begin(), w.end(), [](const Rational& value) { return sgn(value) != 0; }))
      all.insert(std::move(w));
  }
  return {all.begin(), all.end()};
}

/// Collects the normals of a full-dimensional zonotope's facets. Rows of the chosen generators are
/// kept in echelon form, so that subsets with a common beginning share its elimination.
class Normals {
 public:
  explicit Normals(const RationalMatrix& W) : r_(W.rows()), generators_(directions(W)) {
    const double subsets = binomial(static_cast<Index>(generators_.size()), r_ - 1);
    if (subsets > most_subsets) {
      throw Error(Errc::unsupported,
                  "polytope: a set with " + std::to_string(generators_.size()) +
                      " generators, of rank " + std::to_string(r_) + " with its constraints, has " +
                      std::to_string(std::llround(std::min(subsets, 1e15))) +
                      " candidates for facets; at most " +
                      std::to_string(std::llround(most_subsets)) + " are supported");
    }
    extend(0, RationalMatrix(0, r_), {});
  }
  const std::set<RationalVector, Less>& all() const { return normals_; }

 private:
  void extend(std::size_t next, const RationalMatrix& echelon, const std::vector<Index>& pivots) {
    if (echelon.rows() == r_ - 1) {
      constexpr double per_entry = 32;  // numbers are short, fractions are not cheap
      ExactBudget::spend(per_entry * static_cast<double>(r_ * r_));
      RationalVector normal = rational::null_space(echelon).row(0);
      make_direction(normal);
      normals_.insert(std::move(normal));
      return;
    }
    const std::size_t missing = as_size(r_ - 1 - echelon.rows());
    for (std::size_t j = next; j + missing <= generators_.size(); ++j) {
      RationalMatrix longer(echelon.rows() + 1, r_);
      for (Index i = 0; i < echelon.rows(); ++i) {
        for (Index k = 0; k < r_; ++k) longer(i, k) = echelon(i, k);
      }
      RationalVector rest = generators_[j];
      for (std::size_t i = 0; i < pivots.size(); ++i) {
        const Rational factor = rest[as_size(pivots[i])];
        if (sgn(factor) == 0) continue;
        for (Index k = 0; k < r_; ++k)
          rest[as_size(k)] -= factor * echelon(static_cast<Index>(i), k);
      }
      const auto pivot =
          std::find_if(rest.begin(), rest.end(), [](const Rational& x) { return sgn(x) != 0; });
      if (pivot == rest.end()) continue;
      const Rational inverse = 1 / *pivot;
      std::vector<Index> more = pivots;
      more.push_back(pivot - rest.begin());
      for (Index k = 0; k < r_; ++k) longer(echelon.rows(), k) = rest[as_size(k)] * inverse;
      extend(j + 1, longer, more);
    }
  }

  Index r_;
  std::vector<RationalVector> generators_;
  std::set<RationalVector, Less> normals_;
};

/// X's blocks, lifted and freed of lines: {y : K y ∈ z0 + Zξ}, of which X is the section y = (x,
/// 0).
struct Lifted {
  RationalMatrix K, Z;
  RationalVector z0;
};

Lifted lift(const LineForm& X) {
  const Index n = X.dim(), m = X.constraints(), l = X.lines(), g = X.generators();
  RationalMatrix lines(l, n + m), generators(n + m, g), center(n + m, 1);
  for (Index i = 0; i < n + m; ++i) {
    for (Index j = 0; j < l; ++j) lines(j, i) = rational::exact(i < n ? X.M(i, j) : X.S(i - n, j));
    for (Index j = 0; j < g; ++j)
      generators(i, j) = rational::exact(i < n ? X.G(i, j) : X.A(i - n, j));
    center(i, 0) = rational::exact(i < n ? X.c[i] : -X.b[i - n]);
  }
  RationalMatrix K = rational::null_space(lines);
  RationalMatrix Z = product(K, generators);
  RationalVector z0 = transpose(product(K, center)).row(0);
  return {std::move(K), std::move(Z), std::move(z0)};
}

}  // namespace

Description inequalities_of(const LineForm& X) {
  const Index n = X.dim();
  if (n + X.constraints() > most_coordinates || X.generators() + X.lines() > most_columns) {
    throw Error(Errc::unsupported,
                "polytope: a set in dimension " + std::to_string(n) + " with " +
                    std::to_string(X.constraints()) + " constraints, " +
                    std::to_string(X.generators()) + " generators and " +
                    std::to_string(X.lines()) + " lines; at most " +
                    std::to_string(most_coordinates) + " dimensions and constraints with " +
                    std::to_string(most_columns) + " generators and lines are supported");
  }
  const Lifted lifted = lift(X);
  const Index k = lifted.K.rows(), g = lifted.Z.cols();
  Description out{n, {}, {}};
  // aᵀK y compared with `value`
  const auto row = [&](const RationalVector& a, const Rational& value, int sign) {
    RationalVector entries(as_size(n + 1));
    entries[0] = -sign * value;
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < k; ++i) {
        if (sgn(a[as_size(i)]) != 0)
          entries[as_size(j + 1)] += sign * a[as_size(i)] * lifted.K(i, j);
      }
    }
    return entries;
  };

  RationalMatrix echelon = transpose(lifted.Z);
  const std::vector<Index> pivots = rational::reduce_rows(echelon, k);
  const auto r = static_cast<Index>(pivots.size());
  const RationalMatrix flat = rational::null_space(transpose(lifted.Z));
  for (Index i = 0; i < flat.rows(); ++i) {
    const RationalVector a = flat.row(i);
    out.add(row(a, rational::dot(a, lifted.z0), 1), true);
  }
  if (r == 0) return out;

  RationalMatrix W(r, g);  // the zonotope seen along coordinates in which it is full-dimensional
  for (Index i = 0; i < r; ++i) {
    for (Index j = 0; j < g; ++j) W(i, j) = lifted.Z(pivots[as_size(i)], j);
  }
  const RationalMatrix columns = transpose(W);
  const Normals normals(W);
  for (const RationalVector& normal : normals.all()) {
    RationalVector a(as_size(k));
    for (Index i = 0; i < r; ++i) a[as_size(pivots[as_size(i)])] = normal[as_size(i)];
    Rational reach = 0;
    for (Index j = 0; j < g; ++j) reach += abs(rational::dot(normal, columns.row(j)));
    const Rational middle = rational::dot(a, lifted.z0);
    out.add(row(a, middle - reach, 1), false);
    out.add(row(a, middle + reach, -1), false);
  }
  return out;
}

}  // namespace cordon::polytope
