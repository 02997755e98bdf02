// SPDX-License-Identifier: GPL-3.0-or-later
// Sets {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b} in rational arithmetic, with exact support functions:
// what results with outward rounding are compared with. Independent of the library: nothing of it
// is called, linear programs are solved by cddlib.
#pragma once

#include <cmath>
#include <gmpxx.h>
#include <stdexcept>
#include <vector>

#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"

// cdd.h needs setoper.h before it
// clang-format off
#include <setoper.h>
#include <cdd.h>
// clang-format on

namespace cordon::test {

/// An affine function of the variables of a set: constant + Σ coefficient · variable.
struct Affine {
  mpq_class constant = 0;
  std::vector<mpq_class> coefficients;

  explicit Affine(std::size_t variables = 0) : coefficients(variables) {}
  void add(const mpq_class& factor, const Affine& other) {
    constant += factor * other.constant;
    for (std::size_t j = 0; j < other.coefficients.size(); ++j)
      coefficients[j] += factor * other.coefficients[j];
  }
};

/// Points x_i over variables of which some lie in [-1,1] and the others are free, subject to rows =
/// 0.
struct RationalSet {
  std::vector<bool> is_free;
  std::vector<Affine> x, rows;

  std::size_t variables() const { return is_free.size(); }

  static RationalSet of(const LineForm& X) {
    RationalSet set;
    const auto l = static_cast<std::size_t>(X.lines()),
               g = static_cast<std::size_t>(X.generators());
    set.is_free.assign(l + g, false);
    for (std::size_t j = 0; j < l; ++j) set.is_free[j] = true;
    const auto affine = [&](const Matrix& lines, const Matrix& generators, Index i,
                            double constant) {
      Affine a(l + g);
      a.constant = constant;
      for (Index j = 0; j < lines.cols(); ++j)
        a.coefficients[static_cast<std::size_t>(j)] = lines(i, j);
      for (Index j = 0; j < generators.cols(); ++j)
        a.coefficients[l + static_cast<std::size_t>(j)] = generators(i, j);
      return a;
    };
    for (Index i = 0; i < X.dim(); ++i) set.x.push_back(affine(X.M, X.G, i, X.c[i]));
    for (Index i = 0; i < X.constraints(); ++i) set.rows.push_back(affine(X.S, X.A, i, -X.b[i]));
    return set;
  }

  static RationalSet of(const Box& X) {
    RationalSet set;
    const auto n = static_cast<std::size_t>(X.dim());
    set.is_free.assign(n, false);
    for (std::size_t i = 0; i < n; ++i) {
      const double lower = X.lower[static_cast<Index>(i)], upper = X.upper[static_cast<Index>(i)];
      Affine a(n);
      if (std::isinf(upper)) {
        set.is_free[i] = true;
        a.coefficients[i] = 1;
      } else {
        a.constant = (mpq_class(lower) + mpq_class(upper)) / 2;
        a.coefficients[i] = (mpq_class(upper) - mpq_class(lower)) / 2;
      }
      set.x.push_back(a);
    }
    if (X.is_empty()) {
      set.rows.emplace_back(n);
      set.rows.back().constant = 1;
    }
    return set;
  }

  /// The variables of both, the rows of both; x is that of this set. `shifted` receives the other's
  /// x.
  RationalSet beside(const RationalSet& other, std::vector<Affine>& shifted) const {
    RationalSet both = *this;
    both.is_free.insert(both.is_free.end(), other.is_free.begin(), other.is_free.end());
    for (auto* list : {&both.x, &both.rows}) {
      for (Affine& a : *list) a.coefficients.resize(both.variables());
    }
    const auto shift = [&](const Affine& a) {
      Affine moved(both.variables());
      moved.constant = a.constant;
      for (std::size_t j = 0; j < a.coefficients.size(); ++j)
        moved.coefficients[variables() + j] = a.coefficients[j];
      return moved;
    };
    for (const Affine& a : other.rows) both.rows.push_back(shift(a));
    shifted.clear();
    for (const Affine& a : other.x) shifted.push_back(shift(a));
    return both;
  }

  static std::vector<Affine> map(const Matrix& T, const std::vector<Affine>& x,
                                 std::size_t variables) {
    std::vector<Affine> y(static_cast<std::size_t>(T.rows()), Affine(variables));
    for (Index i = 0; i < T.rows(); ++i) {
      for (Index j = 0; j < T.cols(); ++j) {
        if (T(i, j) != 0)
          y[static_cast<std::size_t>(i)].add(mpq_class(T(i, j)), x[static_cast<std::size_t>(j)]);
      }
    }
    return y;
  }

  /// A X ⊕ {f} ⊕ T Y.
  static RationalSet affine_sum(const RationalSet& X, const Matrix& A, const Vector& f,
                                const RationalSet& Y, const Matrix& T) {
    std::vector<Affine> y;
    RationalSet sum = X.beside(Y, y);
    std::vector<Affine> image = map(A, sum.x, sum.variables());
    const std::vector<Affine> other = map(T, y, sum.variables());
    for (std::size_t i = 0; i < image.size(); ++i) {
      image[i].constant += mpq_class(f[static_cast<Index>(i)]);
      image[i].add(1, other[i]);
    }
    sum.x = std::move(image);
    return sum;
  }

  /// {x ∈ X : z - C x ∈ T V}.
  static RationalSet strip_intersection(const RationalSet& X, const Matrix& C, const Vector& z,
                                        const Matrix& T, const RationalSet& V) {
    std::vector<Affine> v;
    RationalSet cut = X.beside(V, v);
    std::vector<Affine> rows = map(C, cut.x, cut.variables());
    const std::vector<Affine> noise = map(T, v, cut.variables());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].add(1, noise[i]);
      rows[i].constant -= mpq_class(z[static_cast<Index>(i)]);
      cut.rows.push_back(rows[i]);
    }
    return cut;
  }

  /// h(d) = sup{dᵀx}, exactly.
  struct Support {
    enum Kind { empty, finite, infinite } kind = finite;
    mpq_class value = 0;
  };
  Support support(const Vector& d) const {
    Affine objective(variables());
    for (std::size_t i = 0; i < x.size(); ++i)
      objective.add(mpq_class(d[static_cast<Index>(i)]), x[i]);
    if (rows.empty()) {
      Support h{Support::finite, objective.constant};
      for (std::size_t j = 0; j < variables(); ++j) {
        if (objective.coefficients[j] == 0) continue;
        if (is_free[j]) return {Support::infinite, 0};
        h.value += abs(objective.coefficients[j]);
      }
      return h;
    }
    return by_linear_program(objective);
  }

 private:
  Support by_linear_program(const Affine& objective) const {
    [[maybe_unused]] static const bool ready = (dd_set_global_constants(), true);
    std::size_t count = rows.size();
    for (const bool free : is_free) count += free ? 0 : 2;
    dd_MatrixPtr P =
        dd_CreateMatrix(static_cast<dd_rowrange>(count), static_cast<dd_colrange>(variables() + 1));
    P->representation = dd_Inequality;
    P->numbtype = dd_Rational;
    std::size_t row = 0;
    for (const Affine& equation : rows) {
      mpq_set(P->matrix[row][0], equation.constant.get_mpq_t());
      for (std::size_t j = 0; j < variables(); ++j)
        mpq_set(P->matrix[row][j + 1], equation.coefficients[j].get_mpq_t());
      set_addelem(P->linset, static_cast<long>(++row));
    }
    for (std::size_t j = 0; j < variables(); ++j) {
      for (const int sign : {1, -1}) {
        if (is_free[j]) continue;
        mpq_set_si(P->matrix[row][0], 1, 1);
        mpq_set_si(P->matrix[row++][j + 1], sign, 1);
      }
    }
    P->objective = dd_LPmax;
    mpq_set(P->rowvec[0], objective.constant.get_mpq_t());
    for (std::size_t j = 0; j < variables(); ++j)
      mpq_set(P->rowvec[j + 1], objective.coefficients[j].get_mpq_t());
    dd_ErrorType error = dd_NoError;
    dd_LPPtr lp = dd_Matrix2LP(P, &error);
    dd_LPSolve0(lp, dd_DualSimplex, &error);  // without the floating-point solve that dd_LPSolve
                                              // tries first: it corrupts memory
    Support h;
    const dd_LPStatusType status = lp->LPS;
    h.value = mpq_class(lp->optvalue);
    dd_FreeLPData(lp);
    dd_FreeMatrix(P);
    if (error != dd_NoError) throw std::runtime_error("cddlib failed");
    switch (status) {
      case dd_Optimal:
        return h;
      case dd_Inconsistent:
      case dd_StrucInconsistent:
        return {Support::empty, 0};
      case dd_Unbounded:
      case dd_DualInconsistent:
      case dd_StrucDualInconsistent:  // unbounded, if there is a point at all
        return by_linear_program(Affine(variables())).kind == Support::empty
                   ? Support{Support::empty, 0}
                   : Support{Support::infinite, 0};
      default:
        throw std::runtime_error("cddlib left a linear program undecided");
    }
  }
};

}  // namespace cordon::test
