// SPDX-License-Identifier: GPL-3.0-or-later
// Operations that lose points.
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reference.hpp"

namespace mutants {

namespace {

/// Ones on the diagonal, in any shape: what is left of a matrix that was forgotten.
Matrix ones(Index rows, Index cols) { return Matrix::Identity(rows, cols); }

/// X with its last factor fixed at 0.
LineForm without_last_generator(LineForm X) {
  const Index g = X.generators();
  if (g == 0) return X;
  X.G.conservativeResize(Eigen::NoChange, g - 1);
  X.A.conservativeResize(Eigen::NoChange, g - 1);
  return X;
}

class ImportDropsGenerator final : public Reference {
  using Reference::Reference;
  Made do_import(const LineForm& X) const override {
    return {make(without_last_generator(X)), Tightness::exact};
  }
};

class SumDropsGenerator final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    const LineForm sum = predicted(X, p);
    return {make(p.terms.empty() ? sum : without_last_generator(sum)), Tightness::exact};
  }
};

class MapOfOneSign final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    LineForm sum = predicted(X, p);
    const Index g = form(X).generators();
    sum.G.leftCols(g) = linalg::product(p.A.cwiseMax(0.0), form(X).G);
    return {make(sum), Tightness::exact};
  }
};

class PredictForgetsTranslation final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    return {make(predicted(X, {p.A, Vector::Zero(p.f.size()), p.terms})), Tightness::exact};
  }
};

class PredictForgetsMap final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    LineForm sum = cordon::affine_map(form(X), p.A, p.f);
    for (const Term& term : p.terms) {
      const Matrix T = ones(term.T.rows(), term.T.cols());
      sum = minkowski_sum(sum, cordon::affine_map(form(*term.set), T, Vector::Zero(p.A.rows())));
    }
    return {make(sum), Tightness::exact};
  }
};

class ProductSwapsBlocks final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    const LineForm sum = predicted(X, p);
    const Index n = p.A.cols(), m = p.A.rows() - n;
    const bool product = p.terms.size() == 1 && p.terms.front().T.cols() == m && m > 0 &&
                         p.A == ones(n + m, n) && p.terms.front().T.topRows(n).isZero(0);
    if (!product) return {make(sum), Tightness::exact};
    Matrix swap = Matrix::Zero(n + m, n + m);
    swap.topRightCorner(m, m).setIdentity();
    swap.bottomLeftCorner(n, n).setIdentity();
    return {make(cordon::affine_map(sum, swap, Vector::Zero(n + m))), Tightness::exact};
  }
};

class IntersectionForgetsMap final : public Reference {
  using Reference::Reference;
  Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const override {
    return {make(cordon::intersection(form(X), ones(R.rows(), R.cols()), form(Y))),
            Tightness::exact};
  }
};

class CorrectForgetsNoiseMap final : public Reference {
  using Reference::Reference;
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    const MatrixIn& T = c.noise.T;
    return {make(corrected(X, c.C, c.z, ones(T.rows(), T.cols()), *c.noise.set)), Tightness::exact};
  }
};

class CorrectMirrorsNoise final : public Reference {
  using Reference::Reference;
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    return {make(corrected(X, c.C, c.z, -c.noise.T, *c.noise.set)), Tightness::exact};
  }
};

class CorrectIgnoresPointNoise final : public Reference {
  using Reference::Reference;
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    const bool point = form(*c.noise.set).generators() == 0;
    const Matrix T =
        point ? Matrix(Matrix::Zero(c.noise.T.rows(), c.noise.T.cols())) : Matrix(c.noise.T);
    return {make(corrected(X, c.C, c.z, T, *c.noise.set)), Tightness::exact};
  }
};

/// Where a set knows C_i x already, rounding decides where it moves.
class DividesByNoise final : public Reference {
  using Reference::Reference;
  Made do_correct(const Set& X, const CorrectionArgs& c) const override {
    LineForm known = form(X);
    for (Index i = 0; i < c.C.rows(); ++i) {
      const Box seen =
          cordon::interval_hull(cordon::affine_map(known, c.C.row(i), Vector::Zero(1)));
      if (seen.upper[0] - seen.lower[0] <= 1e-9 * known.G.cwiseAbs().sum()) known.G.setZero();
      const LineForm noise =
          cordon::affine_map(form(*c.noise.set), -c.noise.T.row(i), c.z.segment(i, 1));
      known = cordon::intersection(known, c.C.row(i), noise);
    }
    return {make(known), Tightness::exact};
  }
};

class IntervalMapIgnoresRadius final : public Reference {
  using Reference::Reference;
  Made do_interval_map(const Set& X, const IntervalMatrix& A) const override {
    return {make(cordon::affine_map(form(X), A.center, Vector::Zero(A.rows()))), Tightness::outer};
  }
};

class HullOfFirst final : public Reference {
  using Reference::Reference;
  Made do_convex_hull(const Set& X, const Set&) const override {
    return {make(form(X)), Tightness::outer};
  }
};

class ReduceShrinks final : public Reference {
  using Reference::Reference;
  Made do_reduce(const Set& X, Budget budget) const override {
    if (fits(form(X), budget)) return {};
    LineForm box = boxed(form(X), budget);
    box.G *= 1 - 1e-6;
    return {make(box), Tightness::outer};
  }
};

class ReduceDropsGenerators final : public Reference {
  using Reference::Reference;
  Made do_reduce(const Set& X, Budget budget) const override {
    if (fits(form(X), budget)) return {};
    LineForm rest = form(X).constraints() > 0 ? boxed(form(X), budget) : form(X);
    while (rest.generators() > budget.generators) rest = without_last_generator(rest);
    return {make(rest), Tightness::outer};
  }
};

class ReduceExceedsBudget final : public Reference {
  using Reference::Reference;
  Made do_reduce(const Set& X, Budget budget) const override {
    if (form(X).generators() - 1 <= budget.generators &&
        form(X).constraints() <= budget.constraints)
      return {};
    return {make(boxed(form(X), budget)), Tightness::outer};
  }
};

class EmptyNeutralInSum final : public Reference {
  using Reference::Reference;
  Made do_predict(const Set& X, const PredictionArgs& p) const override {
    LineForm sum = cordon::affine_map(form(X), p.A, p.f);
    for (const Term& term : p.terms) {
      if (term.set->is_empty() == Answer::yes) continue;
      sum =
          minkowski_sum(sum, cordon::affine_map(form(*term.set), term.T, Vector::Zero(p.A.rows())));
    }
    return {make(sum), Tightness::exact};
  }
};

class NominalButOutward final : public Reference {
 public:
  explicit NominalButOutward(BackendInfo info) : Reference(outward(std::move(info))) {}

 private:
  static BackendInfo outward(BackendInfo info) {
    info.rounding = Rounding::outward;
    return info;
  }
};

}  // namespace

std::vector<Mutant> mutants_of_operations() {
  return {
      {"import_drops_generator", "soundness.import", "the last generator is lost",
       create<ImportDropsGenerator>},
      {"sum_drops_generator", "soundness.sum algebra.monotone",
       "the last generator of a sum is lost", create<SumDropsGenerator>},
      {"map_of_one_sign", "soundness.affine_map", "negative entries of a map count as zero",
       create<MapOfOneSign>},
      {"predict_forgets_translation", "soundness.predict", "f of A X + f is forgotten",
       create<PredictForgetsTranslation>},
      {"predict_forgets_map", "soundness.predict", "T of T S is the identity",
       create<PredictForgetsMap>},
      {"product_swaps_blocks", "soundness.product", "X × Y is Y × X", create<ProductSwapsBlocks>},
      {"intersection_forgets_map", "soundness.intersection", "R of R x ∈ Y is the identity",
       create<IntersectionForgetsMap>},
      {"correct_forgets_noise_map", "soundness.correct", "z - C x ∈ V instead of T V",
       create<CorrectForgetsNoiseMap>},
      {"correct_mirrors_noise", "soundness.correct",
       "C x - z ∈ T V: right for symmetric noise only", create<CorrectMirrorsNoise>},
      {"correct_ignores_point_noise", "soundness.point_noise",
       "z - C x ∈ T V without T V if V is a point", create<CorrectIgnoresPointNoise>},
      {"divides_by_noise",
       "soundness.repeated_strips soundness.proportional_strips soundness.dependent_strips "
       "soundness.flat_strips "
       "soundness.noise_free_steps",
       "a row that says what is known moves the set", create<DividesByNoise>},
      {"interval_map_ignores_radius", "soundness.interval_map", "only the centre of [A] is used",
       create<IntervalMapIgnoresRadius>},
      {"hull_of_first", "soundness.convex_hull", "the hull is the first operand",
       create<HullOfFirst>},
      {"reduce_shrinks", "soundness.reduce", "a reduced set is smaller by a millionth",
       create<ReduceShrinks>},
      {"reduce_drops_generators", "algebra.reduce_encloses",
       "generators above the budget are dropped", create<ReduceDropsGenerators>},
      {"reduce_exceeds_budget", "algebra.reduce_budget", "one generator above the budget is kept",
       create<ReduceExceedsBudget>},
      {"empty_neutral_in_sum", "algebra.empty_absorbs", "X ⊕ ∅ is X", create<EmptyNeutralInSum>},
      {"nominal_but_outward", "soundness.rational", "claims outward rounding, computes nominally",
       create<NominalButOutward>},
  };
}

}  // namespace mutants
