// SPDX-License-Identifier: GPL-3.0-or-later
// Backends without a defect, as unlike each other as the contract allows: a law that fails for one
// of them is wrong itself.
#include "cordon/core/error.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reference.hpp"

namespace mutants {

namespace {

/// The same set, written otherwise: factors in reverse order and with the other sign, one that does
/// nothing, and a row 0 = 0.
class Padded final : public Reference {
  using Reference::Reference;
  std::unique_ptr<const Set> make(LineForm X) const override {
    const Index l = X.lines(), g = X.generators(), m = X.constraints();
    LineForm Y{X.M,
               Matrix::Zero(X.dim(), g + 1),
               X.c,
               Matrix::Zero(m + 1, l),
               Matrix::Zero(m + 1, g + 1),
               Vector::Zero(m + 1)};
    Y.G.leftCols(g) = -X.G.rowwise().reverse();
    Y.A.topLeftCorner(m, g) = -X.A.rowwise().reverse();
    Y.S.topRows(m) = X.S;
    Y.b.head(m) = X.b;
    return std::make_unique<LineSet>(*this, std::move(Y));
  }
  Made do_reduce(const Set& X, Budget budget) const override {
    if (fits(form(X), budget)) return {};
    return {std::make_unique<LineSet>(*this, boxed(form(X), budget)), Tightness::outer};
  }
  std::unique_ptr<const Set> do_serialize(const Set* X, Archive& archive) const override {
    LineForm own = X ? form(*X) : LineForm{};
    archive(own);
    return X ? nullptr : std::make_unique<LineSet>(*this, std::move(own));
  }
};

/// Says unknown wherever that is allowed.
class SilentSet final : public LineSet {
  using LineSet::LineSet;
  Answer do_is_empty(Certificate*) const override { return Answer::unknown; }
  Answer do_contains(VectorIn, Certificate*) const override { return Answer::unknown; }
  Answer do_is_bounded() const override { return Answer::unknown; }
};

/// The least that a plugin writes: two functions of the set, one of the backend. Boxes a little
/// larger than need be, with an exchange form that is called outer.
class CoarseSet final : public Set {
 public:
  CoarseSet(const SetBackend& backend, Box box) : Set(backend, box.dim()), box_(std::move(box)) {}

 private:
  Complexity do_complexity() const override { return {dim(), 0, 0}; }
  LineForm do_line_form() const override { return make_box(box_); }

  Box box_;
};

class Coarse final : public SetBackend {
 public:
  explicit Coarse(BackendInfo info) : SetBackend(coarse(std::move(info))) {}

 private:
  static BackendInfo coarse(BackendInfo info) {
    info.unbounded = info.intersections = info.exact_exchange = false;
    return info;
  }
  Made do_import(const LineForm& X) const override {
    Box hull = cordon::interval_hull(X);
    if (!hull.is_empty()) {
      if (!hull.is_bounded()) throw Error(Errc::unsupported, "boxes hold bounded sets only");
      // wide enough for what nominal operations round
      const Vector margin =
          (hull.upper - hull.lower) / 64 + 1e-6 * (hull.upper.cwiseAbs() + hull.lower.cwiseAbs());
      hull.lower -= margin;
      hull.upper += margin;
    }
    return {std::make_unique<CoarseSet>(*this, hull), Tightness::outer};
  }
};

}  // namespace

std::vector<Mutant> controls() {
  return {
      {"reference", "all laws", "exchange forms, exact where they can be", create<Reference>,
       "keeps"},
      {"padded", "all laws", "exchange forms with factors and rows that say nothing",
       create<Padded>, "keeps"},
      {"silent", "all laws", "exchange forms that answer no question", create<With<SilentSet>>,
       "keeps"},
      {"coarse", "all laws", "outer boxes by the framework's defaults", create<Coarse>, "keeps"},
  };
}

}  // namespace mutants
