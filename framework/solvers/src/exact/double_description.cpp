// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/double_description.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "cordon/core/error.hpp"
#include "solvers/exact_engine.hpp"

namespace cordon {

namespace {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;
using Integers = std::vector<mpz_class>;

class BitSet {
 public:
  explicit BitSet(std::size_t size) : words_((size + 63) / 64) {}
  void insert(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << i % 64; }
  int count() const {
    int bits = 0;
    for (const std::uint64_t word : words_) bits += std::popcount(word);
    return bits;
  }
  void assign_intersection(const BitSet& a, const BitSet& b) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] = a.words_[i] & b.words_[i];
  }
  /// Calls f(i) for the elements until it returns false.
  template <class F>
  void for_each(F f) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1) {
        if (!f(w * 64 + static_cast<std::size_t>(std::countr_zero(rest)))) return;
      }
    }
  }
  std::size_t words() const { return words_.size(); }

 private:
  std::vector<std::uint64_t> words_;
};

struct Ray {
  Integers z;
  BitSet zeros;         ///< rows on which it lies
  mpz_class value = 0;  ///< of the row that is being added
};

void divide_by_gcd(Integers& z) {
  mpz_class divisor = 0;
  for (const mpz_class& x : z) {
    divisor = gcd(divisor, x);
    if (divisor == 1) return;
  }
  if (divisor <= 1) return;
  for (mpz_class& x : z) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
}

Integers to_integers(RationalVector row) {
  rational::make_primitive(row);
  Integers out;
  for (const Rational& x : row) out.push_back(x.get_num());
  return out;
}

/// Extreme rays of the pointed cone {z : rows z ≥ 0}, where the rows have full column rank.
class PointedCone {
 public:
  PointedCone(std::vector<Integers> rows, Index dim) : rows_(std::move(rows)), dim_(dim) {
    std::sort(rows_.begin(), rows_.end());  // neighbours in this order tend to cut off few rays
    rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
    const std::vector<std::size_t> basis = start();
    for (std::size_t i = 0, next = 0; i < rows_.size(); ++i) {
      if (next < basis.size() && basis[next] == i) {
        ++next;
      } else {
        add(i);
      }
    }
  }
  const std::vector<Ray>& rays() const { return rays_; }

 private:
  /// The simplicial cone of the first independent rows: its rays are the columns of their inverse.
  std::vector<std::size_t> start() {
    RationalMatrix rows(static_cast<Index>(rows_.size()), dim_);
    for (Index i = 0; i < rows.rows(); ++i) {
      for (Index k = 0; k < dim_; ++k) rows(i, k) = rows_[as_size(i)][as_size(k)];
    }
    std::vector<std::size_t> basis;
    for (const Index i : rational::independent_rows(rows)) basis.push_back(as_size(i));
    RationalMatrix system(dim_, 2 * dim_);
    for (Index i = 0; i < dim_; ++i) {
      for (Index k = 0; k < dim_; ++k) system(i, k) = rows_[basis[as_size(i)]][as_size(k)];
      system(i, dim_ + i) = 1;
    }
    rational::reduce_rows(system, dim_);
    for (Index j = 0; j < dim_; ++j) {
      RationalVector z;
      for (Index i = 0; i < dim_; ++i) z.push_back(system(i, dim_ + j));
      Ray ray{to_integers(std::move(z)), BitSet(rows_.size())};
      for (Index i = 0; i < dim_; ++i) {
        if (i != j) ray.zeros.insert(basis[as_size(i)]);
      }
      rays_.push_back(std::move(ray));
    }
    return basis;
  }

  void add(std::size_t row) {
    std::vector<const Ray*> inside, outside;
    for (Ray& ray : rays_) {
      ray.value = 0;
      for (std::size_t k = 0; k < ray.z.size(); ++k) {
        mpz_addmul(ray.value.get_mpz_t(), rows_[row][k].get_mpz_t(), ray.z[k].get_mpz_t());
      }
      work_ += static_cast<double>(ray.z.size() * digits_of(rows_[row]) * digits_of(ray.z));
      const int sign = sgn(ray.value);
      if (sign > 0) inside.push_back(&ray);
      if (sign < 0) outside.push_back(&ray);
    }
    check_work();
    if (!outside.empty() && !inside.empty()) find_incidence();
    std::vector<Ray> created;
    BitSet common(rows_.size());
    for (const Ray* p : inside) {
      for (const Ray* q : outside) {
        if (!adjacent(*p, *q, common)) continue;
        created.push_back({combination(*p, *q), common});
        const std::size_t digits =
            digits_of(p->z) + digits_of(q->z) + mpz_size(p->value.get_mpz_t());
        work_ += static_cast<double>(p->z.size() * digits *
                                     digits);  // products, and a greatest common divisor
        created.back().zeros.insert(row);
        check_count(rays_.size() + created.size());
      }
    }
    std::erase_if(rays_, [](const Ray& ray) { return sgn(ray.value) < 0; });
    for (Ray& ray : rays_) {
      if (sgn(ray.value) == 0) ray.zeros.insert(row);
    }
    std::move(created.begin(), created.end(), std::back_inserter(rays_));
  }

  /// Words of the largest number.
  static std::size_t digits_of(const Integers& z) {
    std::size_t most = 1;
    for (const mpz_class& x : z) most = std::max(most, mpz_size(x.get_mpz_t()));
    return most;
  }

  void find_incidence() {
    incidence_.assign(rows_.size(), BitSet(rays_.size()));
    for (std::size_t r = 0; r < rays_.size(); ++r) {
      rays_[r].zeros.for_each([&](std::size_t row) { return incidence_[row].insert(r), true; });
    }
  }

  /// The smallest face with both rays has no other ray. `common` receives the rows on which both
  /// lie.
  bool adjacent(const Ray& p, const Ray& q, BitSet& common) {
    common.assign_intersection(p.zeros, q.zeros);
    work_ += static_cast<double>(common.words());
    if (common.count() < dim_ - 2) return false;
    check_work();
    if (dim_ == 2) return true;  // there are two rays
    std::optional<BitSet> face;
    bool alone = false;
    common.for_each([&](std::size_t row) {
      if (!face) {
        face = incidence_[row];
      } else {
        face->assign_intersection(*face, incidence_[row]);
      }
      work_ += static_cast<double>(face->words());
      alone = face->count() == 2;
      return !alone;
    });
    return alone;
  }

  /// The point of the cone between both where the row vanishes.
  static Integers combination(const Ray& p, const Ray& q) {
    Integers z(p.z.size());
    for (std::size_t k = 0; k < z.size(); ++k) {
      z[k] = p.value * q.z[k];
      mpz_submul(z[k].get_mpz_t(), q.value.get_mpz_t(), p.z[k].get_mpz_t());
    }
    divide_by_gcd(z);
    return z;
  }

  void check_count(std::size_t count) const {
    if (count > most_rays)
      refuse("rows", static_cast<double>(count), static_cast<double>(most_rays));
  }
  void check_work() const {
    if (work_ > most_work) refuse("operations", work_, most_work);
  }
  [[noreturn]] void refuse(const char* what, double amount, double limit) const {
    throw Error(Errc::unsupported, "polytope: converting " + std::to_string(rows_.size()) +
                                       " rows in dimension " + std::to_string(dim_ - 1) +
                                       " needs " + std::to_string(static_cast<long long>(amount)) +
                                       " " + what + " or more; at most " +
                                       std::to_string(static_cast<long long>(limit)) +
                                       " are supported");
  }

  std::vector<Integers> rows_;
  Index dim_;
  std::vector<Ray> rays_;
  std::vector<BitSet> incidence_;  ///< rays on each row
  double work_ = 0;
};

/// Rays and lines of a cone in homogeneous coordinates.
struct ConeGenerators {
  std::vector<RationalVector> rays, lines;
};

RationalMatrix to_matrix(const std::vector<RationalVector>& rows, Index cols) {
  RationalMatrix A(static_cast<Index>(rows.size()), cols);
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < cols; ++j) A(i, j) = rows[as_size(i)][as_size(j)];
  }
  return A;
}

/// Aᵀ of a basis: Σ y_i basis_i.
RationalVector combine(const RationalMatrix& basis, const std::vector<Index>& chosen,
                       const RationalVector& y) {
  RationalVector z(as_size(basis.cols()));
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (sgn(y[i]) == 0) continue;
    for (Index j = 0; j < basis.cols(); ++j) {
      if (sgn(basis(chosen[i], j)) != 0) z[as_size(j)] += y[i] * basis(chosen[i], j);
    }
  }
  return z;
}

/// {z ∈ Rᵈ : inequalities z ≥ 0, equations z = 0}. Solved for the equations, cut free of its lines,
/// and then pointed.
ConeGenerators cone(const std::vector<RationalVector>& inequalities,
                    const std::vector<RationalVector>& equations, Index d) {
  const RationalMatrix solutions = rational::null_space(to_matrix(equations, d));
  const Index k = solutions.rows();
  RationalMatrix A(static_cast<Index>(inequalities.size()), k);
  for (Index j = 0; j < k; ++j) {
    const RationalVector solution = solutions.row(j);
    for (Index i = 0; i < A.rows(); ++i) {
      A(i, j) = equations.empty() ? inequalities[as_size(i)][as_size(j)]
                                  : rational::dot(inequalities[as_size(i)], solution);
    }
  }
  const std::vector<Index> independent = rational::independent_rows(A);
  RationalMatrix spanning(static_cast<Index>(independent.size()), k);  // the same space as all rows
  for (Index i = 0; i < spanning.rows(); ++i) {
    for (Index j = 0; j < k; ++j) spanning(i, j) = A(independent[as_size(i)], j);
  }
  RationalMatrix echelon = spanning;
  const std::vector<Index> pivots = rational::reduce_rows(echelon, k);
  std::vector<Index> all(as_size(k));
  for (Index j = 0; j < k; ++j) all[as_size(j)] = j;

  ConeGenerators out;
  const RationalMatrix lines = rational::null_space(spanning);
  for (Index i = 0; i < lines.rows(); ++i)
    out.lines.push_back(combine(solutions, all, lines.row(i)));
  if (pivots.empty()) return out;
  std::vector<Integers> rows;
  for (Index i = 0; i < A.rows(); ++i) {
    RationalVector row;
    for (const Index j : pivots) row.push_back(A(i, j));
    if (std::any_of(row.begin(), row.end(), [](const Rational& x) { return sgn(x) != 0; }))
      rows.push_back(to_integers(row));
  }
  const PointedCone pointed(std::move(rows), static_cast<Index>(pivots.size()));
  for (const Ray& ray : pointed.rays()) {
    out.rays.push_back(combine(solutions, pivots, RationalVector(ray.z.begin(), ray.z.end())));
  }
  return out;
}

/// Rows of the description by kind.
ConeGenerators split(const Description& in) {
  if (in.dim > most_dimensions) {
    throw Error(Errc::unsupported, "polytope: dimension " + std::to_string(in.dim) +
                                       " to convert; at most " + std::to_string(most_dimensions) +
                                       " are supported");
  }
  if (in.rows.size() > most_rows) {
    throw Error(Errc::unsupported, "polytope: " + std::to_string(in.rows.size()) +
                                       " rows to convert; at most " + std::to_string(most_rows) +
                                       " are supported");
  }
  ConeGenerators out;
  for (std::size_t i = 0; i < in.rows.size(); ++i)
    (in.linear[i] ? out.lines : out.rays).push_back(in.rows[i]);
  return out;
}

Description converted_to_generators(const Description& inequalities) {
  const Index n = inequalities.dim;
  ConeGenerators rows = split(inequalities);
  rows.rays.emplace_back(as_size(n + 1));
  rows.rays.back()[0] = 1;  // the homogenising coordinate is not negative
  const ConeGenerators found = cone(rows.rays, rows.lines, n + 1);
  Description out{n, {}, {}};
  bool has_point = false;
  for (RationalVector ray : found.rays) {
    const Rational height = ray[0];
    if (sgn(height) > 0) {
      for (Rational& x : ray) x /= height;
      has_point = true;
    } else {
      rational::make_primitive(ray);
    }
    out.add(std::move(ray), false);
  }
  if (!has_point) return {n, {}, {}};
  for (RationalVector line : found.lines) {
    rational::make_primitive(line);
    out.add(std::move(line), true);
  }
  return out;
}

Description converted_to_inequalities(const Description& generators) {
  const Index n = generators.dim;
  Description out{n, {}, {}};
  if (generators.rows.empty()) {
    out.add(RationalVector(as_size(n + 1)), false);
    out.rows[0][0] = -1;
    return out;
  }
  const ConeGenerators rows = split(generators);
  ConeGenerators found = cone(rows.rays, rows.lines, n + 1);
  for (RationalVector& row : found.rays) {
    // the plane at infinity, 1 ≥ 0, is no inequality
    const bool constant =
        std::all_of(row.begin() + 1, row.end(), [](const Rational& x) { return sgn(x) == 0; });
    if (constant) continue;
    rational::make_primitive(row);
    out.add(std::move(row), false);
  }
  for (RationalVector& row : found.lines) {
    rational::make_primitive(row);
    out.add(std::move(row), true);
  }
  return out;
}

}  // namespace

Description generators_of(const Description& inequalities) {
  Description answer = converted_to_generators(inequalities);
  tell_exact_observer(
      [&](ExactObserver& observer) { observer.converted_to_generators(inequalities, answer); });
  return answer;
}

Description inequalities_of(const Description& generators) {
  Description answer = converted_to_inequalities(generators);
  tell_exact_observer(
      [&](ExactObserver& observer) { observer.converted_to_inequalities(generators, answer); });
  return answer;
}

}  // namespace cordon
