// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut_box.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "cordon/core/linalg.hpp"

namespace cordon::plugins {

namespace {

/// Factors of the box, and for each row its slack's half width.
struct CutBox {
  std::vector<Index> factors;
  Vector slack;
};

std::optional<CutBox> cut_box(const LineForm& X) {
  if (!X.S.isZero(0)) return std::nullopt;
  CutBox out{{}, Vector::Zero(X.constraints())};
  for (Index j = 0; j < X.generators(); ++j) {
    const Index entries = (X.G.col(j).array() != 0).count();
    if (entries > 1) return std::nullopt;
    Index row = 0;
    if (entries == 1) {
      X.G.col(j).cwiseAbs().maxCoeff(&row);
      if ((X.G.row(row).array() != 0).count() > 1) return std::nullopt;
      out.factors.push_back(j);
      continue;
    }
    if (X.constraints() == 0 || (X.A.col(j).array() != 0).count() != 1) return std::nullopt;
    X.A.col(j).cwiseAbs().maxCoeff(&row);
    if (out.slack[row] != 0) return std::nullopt;
    out.slack[row] = std::abs(X.A(row, j));
  }
  return out;
}

/// {x : |x_i| ≤ r_i}
Polytope centred_box(const Vector& r) {
  const Index n = r.size();
  Matrix H(2 * n, n);
  H << Matrix::Identity(n, n), -Matrix::Identity(n, n);
  Vector h(2 * n);
  h << r, r;
  return Polytope::from_inequalities(H, h);
}

}  // namespace

std::optional<Polytope> polytope_of_cut_box(const LineForm& X) {
  const std::optional<CutBox> parts = cut_box(X);
  if (!parts) return std::nullopt;
  const Index k = static_cast<Index>(parts->factors.size()), l = X.lines();
  // Aξ - b within the slacks, so that b ± slack is not rounded
  const Polytope cuts =
      centred_box(parts->slack).preimage(X.A(Eigen::all, parts->factors), Vector(-X.b));
  const Polytope factors = centred_box(Vector::Ones(k)).intersection(cuts);
  Matrix map(X.dim(), k + l);
  map << X.G(Eigen::all, parts->factors), X.M;
  if (l == 0) return factors.affine_map(map, X.c);
  return factors.cartesian_product(Polytope::space(l)).affine_map(map, X.c);
}

namespace {

/// How deep each row cuts the box, as a share of what it reaches there.
Vector depths(const LineForm& X, const CutBox& parts) {
  // Aξ reaches ±‖A‖₁ on the box and b ± slack behind the cut
  const Vector reach = X.A(Eigen::all, parts.factors).cwiseAbs().rowwise().sum();
  return ((reach - parts.slack + X.b.cwiseAbs()).array() / reach.array().max(1e-300)).matrix();
}

/// For each row, how large the facet is in which it cuts the set with these vertices, in units of
/// the box: length, area, volume. Rounded, for it decides over nothing but an order.
Vector facet_sizes(const LineForm& X, const CutBox& parts, const Matrix& vertices) {
  constexpr double on_it = 1e-9, least = 1e-9, next_to_nothing = 1e-12;
  const Matrix G = X.G(Eigen::all, parts.factors), A = X.A(Eigen::all, parts.factors);
  // each factor is the coordinate of one row of G
  const Matrix xi = G.cwiseAbs2().colwise().sum().cwiseInverse().asDiagonal() * G.transpose() *
                    (vertices.colwise() - X.c);
  const Matrix beyond = (A * xi).colwise() - X.b;
  const Vector depth = depths(X, parts);
  Vector sizes(X.constraints());
  for (Index i = 0; i < sizes.size(); ++i) {
    const double room = on_it * A.row(i).cwiseAbs().sum();
    const double end = X.b[i] > 0 ? -1 : 1;  // the one that cuts deeper
    std::vector<Index> incident;
    for (Index j = 0; j < xi.cols(); ++j) {
      if (end * beyond(i, j) >= parts.slack[i] - room) incident.push_back(j);
    }
    sizes[i] = 0;
    if (incident.empty() || depth[i] < next_to_nothing) continue;  // one of the box
    const Matrix facet = xi(Eigen::all, incident);
    const Matrix spread = facet.colwise() - facet.rowwise().mean();
    const Matrix covariance = spread * spread.transpose() / static_cast<double>(incident.size());
    const Vector widths = linalg::svd(covariance).sigma.cwiseSqrt();
    sizes[i] = widths.head(xi.rows() - 1).cwiseMax(least).prod();
  }
  return sizes;
}

}  // namespace

LineForm with_largest_facets(const LineForm& X, const Matrix& vertices, Index facets) {
  const std::optional<CutBox> parts = cut_box(X);
  if (!parts || parts->factors.empty() || X.constraints() <= facets) return X;
  const Vector size = X.lines() > 0 ? depths(X, *parts) : facet_sizes(X, *parts, vertices);
  std::vector<Index> rows(static_cast<std::size_t>(X.constraints()));
  std::iota(rows.begin(), rows.end(), Index{0});
  std::stable_sort(rows.begin(), rows.end(), [&](Index i, Index j) { return size[i] > size[j]; });
  rows.resize(static_cast<std::size_t>(facets));
  std::sort(rows.begin(), rows.end());

  std::vector<Index> columns = parts->factors;
  for (Index j = 0; j < X.generators(); ++j) {
    const bool is_slack = (X.G.col(j).array() != 0).count() == 0;
    const auto has_entry = [&](Index i) { return X.A(i, j) != 0; };
    if (is_slack && std::any_of(rows.begin(), rows.end(), has_entry)) columns.push_back(j);
  }
  LineForm Y = X;
  Y.G = X.G(Eigen::all, columns);
  Y.A = X.A(rows, columns);
  Y.b = X.b(rows);
  Y.S = Matrix::Zero(Y.b.size(), X.lines());
  return Y;
}

}  // namespace cordon::plugins
