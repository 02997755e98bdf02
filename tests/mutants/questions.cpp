// SPDX-License-Identifier: GPL-3.0-or-later
// Sets that answer wrongly.
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reference.hpp"

namespace mutants {

namespace {

double largest(const LineForm& X) {
  double size = 0;
  if (X.dim() > 0) size = X.c.cwiseAbs().maxCoeff();
  if (X.G.size() > 0) size = std::max(size, X.G.cwiseAbs().maxCoeff());
  return size;
}

class SupportInward final : public LineSet {
  using LineSet::LineSet;
  double do_support(VectorIn d, Certificate* why) const override {
    const double h = LineSet::do_support(d, why);
    return std::isfinite(h) ? h - 1e-6 * std::abs(h) : h;
  }
};

class HullMissesGenerator final : public LineSet {
  using LineSet::LineSet;
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    LineForm part = form();
    if (part.generators() > 0) part.G.rightCols(1).setZero();
    return cordon::interval_hull(part, why);
  }
};

class LineFormFlipsRows final : public LineSet {
  using LineSet::LineSet;
  LineForm do_line_form() const override {
    LineForm X = form();
    X.b = -X.b;
    return X;
  }
};

class LineFormLosesRows final : public LineSet {
  using LineSet::LineSet;
  LineForm do_line_form() const override {
    LineForm X = form();
    return {X.M, X.G, X.c, Matrix(0, X.lines()), Matrix(0, X.generators()), Vector(0)};
  }
};

class LineFormShrunk final : public LineSet {
  using LineSet::LineSet;
  LineForm do_line_form() const override {
    LineForm X = form();
    X.G *= 0.5;
    return X;
  }
};

class LineFormGrown final : public LineSet {
  using LineSet::LineSet;
  LineForm do_line_form() const override {
    LineForm X = form();
    X.G *= 2;
    return X;
  }
};

/// The factors may go to 1 - 1e-6 only: what should forgive rounding condemns sets that touch.
class EmptyTooEarly final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_empty(Certificate* why) const override {
    LineForm X = form();
    X.A *= 1 - 1e-6;
    return cordon::is_empty(X, why);
  }
};

/// A solver that does not get along with dependent rows is taken at its word.
class EmptyOnFailure final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_empty(Certificate* why) const override {
    const LineForm& X = form();
    Matrix rows(X.constraints(), X.lines() + X.generators());
    rows << X.S, X.A;
    return linalg::rank(rows) < X.constraints() ? Answer::yes : LineSet::do_is_empty(why);
  }
};

class ContainsNeighbours final : public LineSet {
  using LineSet::LineSet;
  Answer do_contains(VectorIn x, Certificate* why) const override {
    const Vector margin = Vector::Constant(dim(), 1e-6 * largest(form()));
    return cordon::contains(minkowski_sum(form(), make_box({-margin, margin})), x, why);
  }
};

class ContainsForgetsRows final : public LineSet {
  using LineSet::LineSet;
  Answer do_contains(VectorIn x, Certificate* why) const override {
    const LineForm& X = form();
    return cordon::contains(
        {X.M, X.G, X.c, Matrix(0, X.lines()), Matrix(0, X.generators()), Vector(0)}, x, why);
  }
};

/// Membership is tested against the set without its boundary.
class ContainsInterior final : public LineSet {
  using LineSet::LineSet;
  Answer do_contains(VectorIn x, Certificate* why) const override {
    LineForm X = form();
    X.G *= 1 - 1e-6;
    return X.constraints() > 0 ? LineSet::do_contains(x, why) : cordon::contains(X, x, why);
  }
};

class BoundedAlways final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_bounded() const override { return Answer::yes; }
};

/// The hull of a set with constraints is empty, though the set itself does not say so.
class HullDisagrees final : public LineSet {
  using LineSet::LineSet;
  double do_support(VectorIn d, Certificate* why) const override {
    return form().constraints() > 0 ? -infinity : LineSet::do_support(d, why);
  }
};

class EmptyWithoutProof final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_empty(Certificate* why) const override {
    const Answer answer = LineSet::do_is_empty(why);
    if (why) why->data = -why->data;
    return answer;
  }
};

class AnswersSwapped final : public LineSet {
  using LineSet::LineSet;
  Answer do_contains(VectorIn x, Certificate* why) const override {
    return negate(LineSet::do_contains(x, why));
  }
};

class VolumeOfHull final : public LineSet {
  using LineSet::LineSet;
  std::optional<Volume> do_volume() const override {
    const Box hull = do_interval_hull(nullptr);
    return Volume{(hull.upper - hull.lower).prod(), true};
  }
};

/// A width relative to itself, in single precision.
class NanHull final : public LineSet {
  using LineSet::LineSet;
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    Box hull = LineSet::do_interval_hull(why);
    if (hull.is_empty() || !hull.is_bounded()) return hull;
    for (Index i = 0; i < dim(); ++i) {
      const float width = static_cast<float>(hull.upper[i]) - static_cast<float>(hull.lower[i]);
      hull.upper[i] += hull.upper[i] * static_cast<double>(width / width - 1);
    }
    return hull;
  }
};

class EmptyHullIsPoint final : public LineSet {
  using LineSet::LineSet;
  Box do_interval_hull(std::vector<Certificate>* why) const override {
    const Box hull = LineSet::do_interval_hull(why);
    return hull.is_empty() ? Box{Vector::Zero(dim()), Vector::Zero(dim())} : hull;
  }
};

/// Two sets, and nothing between them.
class UnionSet final : public LineSet {
 public:
  UnionSet(const SetBackend& backend, LineForm hull, LineForm X, LineForm Y)
      : LineSet(backend, std::move(hull)), X_(std::move(X)), Y_(std::move(Y)) {}

 private:
  Answer do_contains(VectorIn x, Certificate*) const override {
    const Answer one = cordon::contains(X_, x), two = cordon::contains(Y_, x);
    if (one == Answer::yes || two == Answer::yes) return Answer::yes;
    return one == Answer::no && two == Answer::no ? Answer::no : Answer::unknown;
  }
  LineForm X_, Y_;
};

class Unions final : public Reference {
  using Reference::Reference;
  Made do_convex_hull(const Set& X, const Set& Y) const override {
    return {
        std::make_unique<UnionSet>(*this, cordon::convex_hull(form(X), form(Y)), form(X), form(Y)),
        Tightness::outer};
  }
};

}  // namespace

std::vector<Mutant> mutants_of_questions() {
  return {
      {"support_inward", "soundness.support", "support values are too small by a millionth",
       create<With<SupportInward>>},
      {"hull_misses_generator", "soundness.interval_hull", "the hull forgets the last generator",
       create<With<HullMissesGenerator>>},
      {"line_form_flips_rows", "soundness.line_form", "constraints are given out as A ξ = -b",
       create<With<LineFormFlipsRows>>},
      {"line_form_loses_rows", "algebra.import_of_line_form", "constraints are not given out",
       create<With<LineFormLosesRows>>},
      {"line_form_shrunk", "questions.is_disjoint", "generators are given out halved",
       create<With<LineFormShrunk>>},
      {"line_form_grown", "questions.is_subset", "generators are given out doubled",
       create<With<LineFormGrown>>},
      {"empty_too_early", "questions.is_empty", "the tolerance has the wrong sign",
       create<With<EmptyTooEarly>>},
      {"empty_on_failure", "questions.is_empty", "a solver's failure is taken for emptiness",
       create<With<EmptyOnFailure>>},
      {"contains_neighbours", "questions.contains", "points up to a millionth outside are inside",
       create<With<ContainsNeighbours>>},
      {"contains_forgets_rows", "questions.contains", "constraints do not count",
       create<With<ContainsForgetsRows>>},
      {"contains_interior", "questions.contains", "points of the boundary are outside",
       create<With<ContainsInterior>>},
      {"bounded_always", "questions.is_bounded", "a set with lines is bounded",
       create<With<BoundedAlways>>},
      {"support_disagrees", "questions.agree",
       "a set with constraints has the support of the empty set", create<With<HullDisagrees>>},
      {"empty_without_proof", "questions.certificates", "a certificate has the wrong sign",
       create<With<EmptyWithoutProof>>},
      {"answers_swapped", "questions.unknown_rate", "yes and no are exchanged",
       create<With<AnswersSwapped>>},
      {"volume_of_hull", "soundness.volume", "the volume of the hull is called exact",
       create<With<VolumeOfHull>>},
      {"unions", "questions.convex", "the hull of two sets is their union", create<Unions>},
      {"nan_hull", "contract.no_nan", "the hull of a flat set is not a number",
       create<With<NanHull>>},
      {"empty_hull_is_point", "questions.agree", "the hull of the empty set is the origin",
       create<With<EmptyHullIsPoint>>},
  };
}

}  // namespace mutants
