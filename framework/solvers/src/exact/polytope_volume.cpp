// SPDX-License-Identifier: GPL-3.0-or-later
// Volume by pulling: a polytope is the union of the pyramids over its facets that miss one of its
// vertices, and so are these.
#include <algorithm>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon::polytope {

namespace {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;
using Face = std::vector<int>;  ///< numbers of its vertices, increasing

constexpr Index most_dimensions = 6;
constexpr int most_simplices = 200'000;

class Triangulation {
 public:
  Triangulation(const Description& generators, const Description& inequalities)
      : vertices_(generators.rows),
        dim_(generators.dim),
        simplex_work_(static_cast<double>(dim_ * dim_ * dim_) * words(generators)) {
    ExactBudget::spend(product_work(generators, inequalities));
    for (const RationalVector& row : inequalities.rows) {
      Face facet;
      for (std::size_t v = 0; v < vertices_.size(); ++v) {
        if (sgn(rational::dot(row, vertices_[v])) == 0) facet.push_back(static_cast<int>(v));
      }
      facets_.push_back(std::move(facet));
    }
    Face all;
    for (std::size_t v = 0; v < vertices_.size(); ++v) all.push_back(static_cast<int>(v));
    pull(all, facets_, dim_);
  }
  const Rational& sum_of_determinants() const { return sum_; }

 private:
  /// `facets` of the face of dimension `dim`.
  void pull(const Face& face, const std::vector<Face>& facets, Index dim) {
    if (static_cast<Index>(face.size()) == dim + 1) {
      apexes_.insert(apexes_.end(), face.begin(), face.end());
      add_simplex();
      apexes_.resize(apexes_.size() - face.size());
      return;
    }
    apexes_.push_back(face.front());
    for (const Face& facet : facets) {
      if (facet.front() != face.front()) pull(facet, facets_of(facet, facets), dim - 1);
    }
    apexes_.pop_back();
  }

  /// Facets of a face's facet: its largest proper sections with the others.
  static std::vector<Face> facets_of(const Face& face, const std::vector<Face>& others) {
    std::vector<Face> sections;
    ExactBudget::spend(static_cast<double>(face.size() * others.size()));
    for (const Face& other : others) {
      Face section;
      std::set_intersection(face.begin(), face.end(), other.begin(), other.end(),
                            std::back_inserter(section));
      if (!section.empty() && section.size() < face.size()) sections.push_back(std::move(section));
    }
    std::sort(sections.begin(), sections.end(),
              [](const Face& a, const Face& b) { return a.size() > b.size(); });
    std::vector<Face> largest;
    for (Face& section : sections) {
      const bool covered = std::any_of(largest.begin(), largest.end(), [&](const Face& other) {
        return std::includes(other.begin(), other.end(), section.begin(), section.end());
      });
      if (!covered) largest.push_back(std::move(section));
    }
    return largest;
  }

  void add_simplex() {
    if (++simplices_ > most_simplices) {
      throw Error(Errc::unsupported, "polytope: the volume needs more than " +
                                         std::to_string(most_simplices) + " simplices");
    }
    ExactBudget::spend(simplex_work_);
    RationalMatrix edges(dim_, dim_);
    const RationalVector& origin = vertices_[static_cast<std::size_t>(apexes_[0])];
    for (Index i = 0; i < dim_; ++i) {
      const RationalVector& vertex =
          vertices_[static_cast<std::size_t>(apexes_[static_cast<std::size_t>(i + 1)])];
      for (Index j = 0; j < dim_; ++j) {
        edges(i, j) =
            vertex[static_cast<std::size_t>(j + 1)] - origin[static_cast<std::size_t>(j + 1)];
      }
    }
    sum_ += abs(rational::determinant(edges));
  }

  const std::vector<RationalVector>& vertices_;
  Index dim_;
  double simplex_work_;
  std::vector<Face> facets_;
  std::vector<int> apexes_;
  Rational sum_ = 0;
  int simplices_ = 0;
};

}  // namespace

Rational volume(const Description& generators, const Description& inequalities) {
  if (generators.dim > most_dimensions) {
    throw Error(Errc::unsupported, "polytope: dimension " + std::to_string(generators.dim) +
                                       " exceeds 6, the limit of exact volumes");
  }
  Rational value = Triangulation(generators, inequalities).sum_of_determinants();
  for (Index i = 2; i <= generators.dim; ++i) value /= static_cast<long>(i);
  return value;
}

}  // namespace cordon::polytope
