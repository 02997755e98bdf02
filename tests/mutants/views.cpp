// SPDX-License-Identifier: GPL-3.0-or-later
// Sets that tell others wrongly of themselves, and answers of their own that are wrong.
#include <cmath>

#include "cordon/solvers/set_questions.hpp"
#include "cordon/solvers/view_questions.hpp"
#include "reference.hpp"

namespace mutants {

namespace {

/// An inequality through the centre.
class ViewCut final : public LineSet {
  using LineSet::LineSet;
  View do_view() const override {
    View X{form()};
    if (dim() == 0) return X;
    X.rows = {Matrix(Vector::Unit(dim(), 0).transpose()), form().c.head(1)};
    return X;
  }
};

class MaximizerOfTheOtherEnd final : public LineSet {
  using LineSet::LineSet;
  Vector do_maximizer(VectorIn d) const override {
    return form().lines() > 0 ? Vector(0) : maximizer(form(), -d);
  }
};

class MaximizerBeyond final : public LineSet {
  using LineSet::LineSet;
  Vector do_maximizer(VectorIn d) const override {
    const Vector x = maximizer(form(), d);
    return x.size() > 0 ? Vector(x + 0.1 * (x - form().c)) : x;
  }
};

/// Subsets by their hulls.
class SubsetOfHull final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_subset_of(const Set& other, Certificate*) const override {
    const Box X = interval_hull(), Y = other.interval_hull();
    const bool within = X.is_empty() || ((X.lower.array() >= Y.lower.array()).all() &&
                                         (X.upper.array() <= Y.upper.array()).all());
    return within ? Answer::yes : Answer::no;
  }
};

/// Disjoint if the centres are far apart.
class DisjointCentres final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_disjoint_from(const Set& other, Certificate*) const override {
    const auto& Y = static_cast<const LineSet&>(other);
    return (form().c - Y.form().c).norm() > 1e-3 ? Answer::yes : Answer::unknown;
  }
};

class ImportTightens final : public Reference {
  using Reference::Reference;
  Made do_import_view(const View& X) const override {
    View tighter = X;
    tighter.rows.h.array() -= 0.3 * (1 + X.rows.h.array().abs());
    return Reference::do_import_view(tighter);
  }
};

/// The second factor twice.
class ProductMixed final : public Reference {
  using Reference::Reference;
  Made do_product(const Set& X, const Set& Y) const override {
    if (X.dim() != Y.dim()) return {};
    return {std::make_unique<LineSet>(*this, cordon::cartesian_product(form(Y), form(Y))),
            Tightness::exact};
  }
};

}  // namespace

std::vector<Mutant> mutants_of_views() {
  return {
      {"view_cut", "views.view views.view_along", "the view has an inequality through the centre",
       create<With<ViewCut>>},
      {"maximizer_of_the_other_end", "views.maximizer", "the point is the farthest along -d",
       create<With<MaximizerOfTheOtherEnd>>},
      {"maximizer_beyond", "views.maximizer", "the point lies beyond the set",
       create<With<MaximizerBeyond>>},
      {"subset_of_hull", "questions.is_subset", "a set whose hull lies in another's is a subset",
       create<With<SubsetOfHull>>},
      {"disjoint_centres", "questions.is_disjoint",
       "sets whose centres are apart are called disjoint", create<With<DisjointCentres>>},
      {"import_tightens", "views.import", "inequalities of others are taken too tight",
       create<ImportTightens>},
      {"product_mixed", "soundness.product", "X × Y is Y × Y", create<ProductMixed>},
  };
}

}  // namespace mutants
