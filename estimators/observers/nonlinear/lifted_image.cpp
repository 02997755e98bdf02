// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/lifted_image.hpp"

#include <algorithm>
#include <vector>

#include "cordon/formulas/elementary.hpp"

namespace cordon::estimators {

namespace {

using Intervals = std::vector<Interval>;

double centre_of(Interval x) { return std::clamp(0.5 * x.lower + 0.5 * x.upper, x.lower, x.upper); }

/// The distance of both ends from `centre`, rounded up.
double reach(Interval x, double centre) {
  return std::max(directed::plus(x.upper, -centre).upper, directed::plus(centre, -x.lower).upper);
}

void add_up(double& sum, double part) { sum = directed::plus(sum, part).upper; }

/// The columns of the factors: ξ_i, ζ_i, ζ_ij.
struct Columns {
  Index generators;
  Index square(Index i) const { return generators + i; }
  Index product(Index i, Index j) const {  // i < j
    return 2 * generators + i * (2 * generators - i - 1) / 2 + (j - i - 1);
  }
  Index count() const { return generators * (generators + 3) / 2; }
};

/// Writes numbers that are known as intervals by their middles; the rest is added to a radius.
class Row {
 public:
  Row(Matrix& to, Index row, double& radius) : to_(to), row_(row), radius_(radius) {}
  void put(Index column, Interval value) { to_(row_, column) = middle(value); }
  double middle(Interval value) {
    const double made = centre_of(value);
    add_up(radius_, reach(value, made));
    return made;
  }

 private:
  Matrix& to_;
  Index row_;
  double& radius_;
};

/// A row of the image of second order.
class QuadraticRow {
 public:
  QuadraticRow(const formulas::BoxEnclosure& function, formulas::BoxEnclosure::Quadratic of,
               const LineForm& Z)
      : r_(function.radius()), of_(std::move(of)), Z_(Z) {
    for (Index i = 0; i < Z.dim(); ++i) p_.push_back(directed::plus(Z.c[i], -function.center()[i]));
    linear_.assign(p_.size(), {0, 0});
    for (const auto& [variable, value] : of_.gradient) linear_[as_size(variable)] = value;
  }

  /// Returns the centre.
  double write(const Columns& columns, Row& row, double& radius) {
    Interval value = of_.value;
    for (std::size_t i = 0; i < p_.size(); ++i) value = value + linear_[i] * p_[i];
    for (const auto& [i, j, range] : of_.curvature) value = value + bend(i, j, range, radius);
    for (Index k = 0; k < columns.generators; ++k) {
      Interval sum{0, 0};
      for (Index i = 0; i < Z_.dim(); ++i) sum = sum + Z_.G(i, k) * linear_[as_size(i)];
      row.put(k, sum);
    }
    for (Index k = 0; k < columns.generators; ++k) {
      const Interval square = product(k, k);
      value = value + 0.25 * square;
      row.put(columns.square(k), 0.25 * square);
      for (Index l = k + 1; l < columns.generators; ++l)
        row.put(columns.product(k, l), product(k, l));
    }
    return row.middle(value);
  }

 private:
  /// ½ (z - h)ᵀ H (z - h) of one entry of H and its mirror: what p alone gives is returned, what is
  /// linear in ξ is added to the gradient, the distance from the middle of H to the radius.
  Interval bend(Index i, Index j, Interval range, double& radius) {
    const double H = centre_of(range), factor = i == j ? 0.5 : 1.0;
    add_up(radius, (factor * (reach(range, H) * directed::times(r_[i], r_[j]))).upper);
    if (H != 0) middles_.push_back({i, j, H});
    const Interval p_i = p_[as_size(i)], p_j = p_[as_size(j)];
    linear_[as_size(i)] = linear_[as_size(i)] + H * p_j;
    if (i != j) linear_[as_size(j)] = linear_[as_size(j)] + H * p_i;
    return factor * (H * (i == j ? elementary::power(p_i, 2) : p_i * p_j));
  }

  /// Q_kl = Σ_ij G_ik H̄_ij G_jl
  Interval product(Index k, Index l) const {
    Interval sum{0, 0};
    for (const auto& [i, j, H] : middles_) {
      Interval part = directed::times(Z_.G(i, k), Z_.G(j, l));
      if (i != j) part = part + directed::times(Z_.G(j, k), Z_.G(i, l));
      sum = sum + H * part;
    }
    return sum;
  }

  struct Middle {
    Index i, j;
    double H;
  };
  const Vector& r_;
  formulas::BoxEnclosure::Quadratic of_;
  const LineForm& Z_;
  Intervals p_, linear_;
  std::vector<Middle> middles_;
};

double write_affine(const AffineRows& rows, Index q, const LineForm& Z, Row& row) {
  const auto image = [&](Interval sum, auto&& of) {
    for (Index i = 0; i < Z.dim(); ++i) sum = sum + directed::times(rows.slope(q, i), of(i));
    return sum;
  };
  for (Index k = 0; k < Z.generators(); ++k)
    row.put(k, image({0, 0}, [&](Index i) { return Z.G(i, k); }));
  return row.middle(image({rows.offset[q], rows.offset[q]}, [&](Index i) { return Z.c[i]; }));
}

/// The products of all pairs of constraints, from row `at` on.
void write_products(const LineForm& Z, const Columns& columns, LineForm& image) {
  Index at = Z.constraints();
  for (Index r = 0; r < Z.constraints(); ++r) {
    for (Index s = r; s < Z.constraints(); ++s, ++at) {
      double radius = 0;
      Row row(image.A, at, radius);
      Interval right = directed::times(Z.b[r], Z.b[s]);
      for (Index i = 0; i < columns.generators; ++i) {
        const Interval half = 0.5 * directed::times(Z.A(r, i), Z.A(s, i));
        right = right - half;
        row.put(columns.square(i), half);
        for (Index j = i + 1; j < columns.generators; ++j)
          row.put(columns.product(i, j),
                  directed::times(Z.A(r, i), Z.A(s, j)) + directed::times(Z.A(r, j), Z.A(s, i)));
      }
      image.b[at] = row.middle(right);
      image.A(at, columns.count() + at - Z.constraints()) = radius;
    }
  }
}

}  // namespace

std::optional<LiftedImage> lifted_image(const formulas::BoxEnclosure& function,
                                        const AffineRows& rows, const LineForm& Z, bool outward) {
  if (Z.lines() > 0 || Z.generators() > most_lifted) return std::nullopt;
  const Columns columns{Z.generators()};
  const Index n = rows.offset.size(), m = Z.constraints(), products = outward ? m * (m + 1) / 2 : 0,
              factors = columns.count() + products;
  LineForm image{Matrix(n, 0),
                 Matrix::Zero(n, factors),
                 Vector(n),
                 Matrix(m + products, 0),
                 Matrix::Zero(m + products, factors),
                 Vector(m + products)};
  Vector radius = Vector::Zero(n);
  for (Index q = 0; q < n; ++q) {
    Row row(image.G, q, radius[q]);
    auto quadratic = function.quadratic(q);
    if (quadratic) {
      image.c[q] = QuadraticRow(function, std::move(*quadratic), Z).write(columns, row, radius[q]);
      const double lifted = image.G.row(q).lpNorm<1>() + radius[q],
                   affine = (rows.slope.row(q) * Z.G).lpNorm<1>() + rows.radius[q];
      if (outward || lifted <= affine) continue;
      image.G.row(q).setZero();
      radius[q] = 0;
    }
    image.c[q] = write_affine(rows, q, Z, row);
    add_up(radius[q], rows.radius[q]);
  }
  image.A.topLeftCorner(m, Z.generators()) = Z.A;
  image.b.head(m) = Z.b;
  if (outward) write_products(Z, columns, image);
  if (!image.G.allFinite() || !image.c.allFinite() || !radius.allFinite() || !image.A.allFinite() ||
      !image.b.allFinite())
    return std::nullopt;
  return LiftedImage{std::move(image), std::move(radius)};
}

}  // namespace cordon::estimators
