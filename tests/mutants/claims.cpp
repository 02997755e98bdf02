// SPDX-License-Identifier: GPL-3.0-or-later
// Operations that enclose, but claim to be exact where they are not.
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reference.hpp"

namespace mutants {

namespace {

/// The interval hull where it is bounded and there is one, else the set itself.
LineForm hull_of(const LineForm& X) {
  const Box hull = cordon::interval_hull(X);
  return hull.is_empty() || !hull.is_bounded() ? X : make_box(hull);
}

class ImportBoxes final : public Reference {
  using Reference::Reference;
  Made do_import(const LineForm& X) const override { return {make(hull_of(X)), Tightness::exact}; }
};

class SumBoxesTerms final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    LineForm sum = cordon::affine_map(form(X), p.A, p.f);
    for (const Term& term : p.terms) {
      sum = minkowski_sum(
          sum, hull_of(cordon::affine_map(form(*term.set), term.T, Vector::Zero(p.A.rows()))));
    }
    return {make(sum), Tightness::exact};
  }
};

/// Sums of many generators are cut down on the way.
class LongSumsAreBoxed final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    const LineForm sum = predicted(X, p);
    return {make(!p.terms.empty() && form(X).generators() > 4 ? hull_of(sum) : sum),
            Tightness::exact};
  }
};

class MapBoxes final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    return {make(hull_of(predicted(X, p))), Tightness::exact};
  }
};

class ProductBoxes final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    const LineForm sum = predicted(X, p);
    return {make(p.A.rows() > p.A.cols() && !p.terms.empty() ? hull_of(sum) : sum),
            Tightness::exact};
  }
};

class IntersectionOfHulls final : public Reference {
  using Reference::Reference;
  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override {
    return {make(cordon::intersection(form(X), R, hull_of(form(Y)))), Tightness::exact};
  }
};

class CorrectByHull final : public Reference {
  using Reference::Reference;
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    const LineForm target = cordon::affine_map(form(*c.noise.set), -c.noise.T, c.z);
    return {make(cordon::intersection(form(X), c.C, hull_of(target))), Tightness::exact};
  }
};

class IntervalMapExact final : public Reference {
  using Reference::Reference;
  Made do_interval_map(const Set& X, const IntervalMatrix& A) const override {
    Made made = Reference::do_interval_map(X, A);
    made.tightness = Tightness::exact;
    return made;
  }
};

class ConvexHullIsBox final : public Reference {
  using Reference::Reference;
  Made do_convex_hull(const Set& X, const Set& Y) const override {
    return {make(hull_of(cordon::convex_hull(form(X), form(Y)))), Tightness::exact};
  }
};

class ReduceExact final : public Reference {
  using Reference::Reference;
  Made do_reduce(const Set& X, Budget budget) const override {
    Made made = Reference::do_reduce(X, budget);
    made.tightness = Tightness::exact;
    return made;
  }
};

class SelfIntersectionIsBox final : public Reference {
  using Reference::Reference;
  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override {
    if (&X == &Y && R.isIdentity(0)) return {make(hull_of(form(X))), Tightness::exact};
    return Reference::do_intersection(X, R, Y);
  }
};

class ZeroIsNotNeutral final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    LineForm sum = predicted(X, p);
    for (const Term& term : p.terms) {
      if (form(*term.set).generators() == 0) sum = hull_of(sum);
    }
    return {make(sum), Tightness::exact};
  }
};

}  // namespace

std::vector<Mutant> mutants_of_claims() {
  return {
      {"import_boxes", "tightness.import", "an imported set is its interval hull",
       create<ImportBoxes>},
      {"sum_boxes_terms", "tightness.sum algebra.sum_commutes",
       "the second operand of a sum is replaced by its hull", create<SumBoxesTerms>},
      {"long_sums_are_boxed", "algebra.sum_associates",
       "a sum is its hull where the first operand has many generators", create<LongSumsAreBoxed>},
      {"map_boxes",
       "tightness.affine_map tightness.predict algebra.map_composes algebra.map_distributes",
       "the image of a map is its hull", create<MapBoxes>},
      {"product_boxes", "tightness.product", "a product is its hull", create<ProductBoxes>},
      {"intersection_of_hulls", "tightness.intersection",
       "the second operand is replaced by its hull", create<IntersectionOfHulls>},
      {"correct_by_hull", "tightness.correct", "T V is replaced by its hull",
       create<CorrectByHull>},
      {"interval_map_exact", "tightness.interval_map",
       "the map by an interval matrix claims to be exact", create<IntervalMapExact>},
      {"convex_hull_is_box", "tightness.convex_hull", "the convex hull is the interval hull",
       create<ConvexHullIsBox>},
      {"reduce_exact", "tightness.reduce", "a reduced set claims to be exact", create<ReduceExact>},
      {"self_intersection_is_box", "algebra.self_intersection", "X ∩ X is the hull of X",
       create<SelfIntersectionIsBox>},
      {"zero_is_not_neutral", "algebra.zero_neutral", "X ⊕ {0} is the hull of X",
       create<ZeroIsNotNeutral>},
  };
}

}  // namespace mutants
