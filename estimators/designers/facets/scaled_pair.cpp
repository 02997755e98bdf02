// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/scaled_pair.hpp"

#include <cmath>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

using linalg::product;
using linalg::transposed_product;

namespace {

constexpr double outer_rounding =
    1e-14;  ///< of the terms: γ_n of the sums below, with room for thousands of them
constexpr double inner_rounding = tube_row_noise;  ///< of the terms, see forbidden_set

}  // namespace

ScaledPair::ScaledPair(const PairProgram& pair, const InputSequences& U, double epsilon)
    : G(pair.G), N(product(pair.N, U.G)), c(pair.c - product(pair.N, U.c)), factor(1 + epsilon) {
  terms = factor * pair.terms(U.c.cwiseAbs() + U.G.cwiseAbs().rowwise().sum());
  scale = Vector::Ones(c.size());
  for (Index i = 0; i < c.size(); ++i) {
    if (terms[i] > 0) scale[i] = std::exp2(-std::ilogb(terms[i]));
    G.row(i) *= scale[i];
    N.row(i) *= scale[i];
    c[i] *= scale[i];
    terms[i] *= scale[i];
  }
}

SeparatingFacet facet_of(const ScaledPair& pair, const Vector& y, double distance, double below) {
  SeparatingFacet facet;
  const double terms = y.cwiseAbs().dot(pair.terms);
  facet.a = transposed_product(pair.N, y);
  facet.out = pair.factor * transposed_product(pair.G, y).cwiseAbs().sum() + y.dot(pair.c) +
              outer_rounding * terms;
  facet.in = facet.out - below - inner_rounding * terms;
  facet.out += distance * terms;
  const double scale = facet.a.size() ? facet.a.cwiseAbs().maxCoeff() : 0;
  if (scale > 0) {
    facet.a /= scale;
    facet.out /= scale;
    facet.in /= scale;
  }
  return facet;
}

}  // namespace cordon::designers
