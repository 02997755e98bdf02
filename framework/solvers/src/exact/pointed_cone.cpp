// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/pointed_cone.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "solvers/double_description.hpp"

namespace cordon {

namespace {

using rational::RationalMatrix;
using rational::RationalVector;
using Integers = PointedCone::Integers;
using Ray = PointedCone::Ray;

void divide_by_gcd(Integers& z) {
  mpz_class divisor = 0;
  for (const mpz_class& x : z) {
    divisor = gcd(divisor, x);
    if (divisor == 1) return;
  }
  if (divisor <= 1) return;
  for (mpz_class& x : z) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
}

/// Words of the largest number.
std::size_t digits_of(const Integers& z) {
  std::size_t most = 1;
  for (const mpz_class& x : z) most = std::max(most, mpz_size(x.get_mpz_t()));
  return most;
}

/// The point of the cone between both where the row vanishes.
Integers combination(const Ray& p, const Ray& q) {
  Integers z(p.z.size());
  for (std::size_t k = 0; k < z.size(); ++k) {
    z[k] = p.value * q.z[k];
    mpz_submul(z[k].get_mpz_t(), q.value.get_mpz_t(), p.z[k].get_mpz_t());
  }
  divide_by_gcd(z);
  return z;
}

}  // namespace

Integers to_integers(RationalVector row) {
  rational::make_primitive(row);
  Integers out;
  for (const rational::Rational& x : row) out.push_back(x.get_num());
  return out;
}

PointedCone::PointedCone(std::vector<Integers> rows, Index dim)
    : rows_(std::move(rows)), dim_(dim) {
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
  check_work();
}

/// The simplicial cone of the first independent rows: its rays are the columns of their inverse.
std::vector<std::size_t> PointedCone::start() {
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

void PointedCone::add(std::size_t row) {
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
      const std::size_t digits = digits_of(p->z) + digits_of(q->z) + mpz_size(p->value.get_mpz_t());
      work_ +=
          static_cast<double>(p->z.size() * digits * digits);  // products, and a common divisor
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

void PointedCone::find_incidence() {
  incidence_.assign(rows_.size(), BitSet(rays_.size()));
  work_ += static_cast<double>(rows_.size() * incidence_[0].words());
  for (std::size_t r = 0; r < rays_.size(); ++r) {
    rays_[r].zeros.for_each([&](std::size_t row) { return incidence_[row].insert(r), true; });
  }
}

/// The smallest face with both rays has no other ray. `common` receives the rows on which both
/// lie.
bool PointedCone::adjacent(const Ray& p, const Ray& q, BitSet& common) {
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

// The rays on a row that is not needed lie on another one as well: a face is part of a facet, and
// each facet is that of one row.
std::vector<bool> PointedCone::needed(const std::vector<Integers>& given) const {
  if (rays_.empty()) return {};
  std::vector<BitSet> incidence(rows_.size(), BitSet(rays_.size()));
  for (std::size_t r = 0; r < rays_.size(); ++r)
    rays_[r].zeros.for_each([&](std::size_t row) { return incidence[row].insert(r), true; });
  std::vector<bool> alone(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (incidence[i].count() == static_cast<int>(rays_.size())) return {};
    std::optional<BitSet> rows;  // on which all of these rays lie
    incidence[i].for_each([&](std::size_t r) {
      if (!rows) {
        rows = rays_[r].zeros;
      } else {
        rows->assign_intersection(*rows, rays_[r].zeros);
      }
      return rows->count() > 1;
    });
    alone[i] = rows ? rows->count() == 1 : rows_.size() == 1;
  }
  std::vector<bool> answer;
  for (const Integers& row : given) {
    const auto place = std::lower_bound(rows_.begin(), rows_.end(), row);
    const auto i = static_cast<std::size_t>(place - rows_.begin());
    answer.push_back(place != rows_.end() && *place == row && alone[i]);
    if (answer.back()) alone[i] = false;  // of equal rows, one
  }
  return answer;
}

void PointedCone::check_count(std::size_t count) const {
  if (count > most_rays) refuse("rows", static_cast<double>(count), static_cast<double>(most_rays));
}

void PointedCone::check_work() {
  if (work_ > most_work) refuse("operations", work_, most_work);
  if (work_ == told_) return;
  ExactBudget::spend(work_ - told_);
  told_ = work_;
}

void PointedCone::refuse(const char* what, double amount, double limit) const {
  throw Error(Errc::unsupported, "polytope: converting " + std::to_string(rows_.size()) +
                                     " rows in dimension " + std::to_string(dim_ - 1) + " needs " +
                                     std::to_string(static_cast<long long>(amount)) + " " + what +
                                     " or more; at most " +
                                     std::to_string(static_cast<long long>(limit)) +
                                     " are supported");
}

}  // namespace cordon
