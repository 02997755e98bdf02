// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/feasible_set.hpp"

#include <vector>

#include "study/data/random.hpp"

namespace cordon::verification {

namespace {

constexpr int steps_between_rounding = 8;
constexpr int most_draws = 6;
constexpr double almost_all = 0.999;  // of a radius: no rounding leads out of the interval

Vector zero(Index n) { return Vector::Zero(n); }

/// T x as a polytope of one point: the product is exact there.
Polytope image(MatrixIn T, VectorIn x) { return Polytope::from_generators(x).affine_map(T, zero(T.rows())); }

/// Rows of an exchange form, block by block. All variables but the sets' factors are lines.
class Rows {
 public:
  struct Line {
    Index first, size;
  };

  Line line(Index size) {
    const Line made{lines_, size};
    lines_ += size;
    return made;
  }

  /// A line vector that keeps to the set.
  Line element(const LineForm& X) {
    const Line x = line(X.dim()), delta = line(X.lines());
    const Index xi = factors_;
    factors_ += X.generators();
    const Index row = add(X.dim());
    put(row, x, Matrix::Identity(X.dim(), X.dim()));
    put(row, delta, -X.M);
    put_factors(row, xi, -X.G);
    right(row, X.c);
    const Index constraint = add(X.constraints());
    put(constraint, delta, X.S);
    put_factors(constraint, xi, X.A);
    right(constraint, X.b);
    return x;
  }

  Line constant(VectorIn value) {
    const Line x = line(value.size());
    const Index row = add(value.size());
    put(row, x, Matrix::Identity(value.size(), value.size()));
    right(row, value);
    return x;
  }

  struct Term {
    Line variable;
    Matrix coefficient;
  };
  /// Σ coefficient · variable = 0.
  void equation(Index rows, const std::vector<Term>& terms) {
    const Index row = add(rows);
    for (const Term& term : terms) put(row, term.variable, term.coefficient);
    right(row, zero(rows));
  }

  /// The set of all values of `x`.
  LineForm project(const Line& x) const {
    LineForm X{Matrix::Zero(x.size, lines_), Matrix::Zero(x.size, factors_), zero(x.size),
               Matrix::Zero(rows_, lines_),  Matrix::Zero(rows_, factors_),  b_};
    X.M.middleCols(x.first, x.size).setIdentity();
    for (const Entry& e : entries_) (e.factor ? X.A : X.S)(e.row, e.col) += e.value;
    return X;
  }

 private:
  struct Entry {
    Index row, col;
    bool factor;
    double value;
  };

  Index add(Index rows) {
    const Index first = rows_;
    rows_ += rows;
    b_.conservativeResize(rows_);
    return first;
  }
  void right(Index row, VectorIn b) { b_.segment(row, b.size()) = b; }
  void put(Index row, const Line& variable, const Matrix& block) { put(row, variable.first, block, false); }
  void put_factors(Index row, Index first, const Matrix& block) { put(row, first, block, true); }
  void put(Index row, Index col, const Matrix& block, bool factor) {
    for (Index j = 0; j < block.cols(); ++j) {
      for (Index i = 0; i < block.rows(); ++i) {
        if (block(i, j) != 0) entries_.push_back({row + i, col + j, factor, block(i, j)});
      }
    }
  }

  Index lines_ = 0, factors_ = 0, rows_ = 0;
  Vector b_;
  std::vector<Entry> entries_;
};

Matrix identity(Index n) { return Matrix::Identity(n, n); }

/// An enclosing polytope with doubles as coefficients, larger by some units in the last place: exact numbers grow with every
/// step, and all work with them. Unbounded and flat sets stay as they are.
Polytope with_short_numbers(const Polytope& X) {
  if (!X.is_bounded() || X.is_empty()) return X;
  Polytope::Inequalities faces = X.inequalities();
  if (faces.Q.rows() > 0) return X;
  for (Index i = 0; i < faces.h.size(); ++i) faces.h[i] = X.support(faces.H.row(i)).upper;
  return Polytope::from_inequalities(faces.H, faces.h);
}

}  // namespace

FeasibleSets::FeasibleSets(const Model& model, const LineForm& initial_set, const std::optional<LineForm>& admissible_set)
    : model_(model.linear),
      initial_(Polytope::from(initial_set)),
      admissible_(admissible_set ? std::optional(Polytope::from(*admissible_set)) : std::nullopt),
      disturbance_(Polytope::from(model.W).affine_map(model.linear.Bw, zero(model.linear.states()))),
      minus_disturbance_(Polytope::from(model.W).affine_map(-model.linear.Bw, zero(model.linear.states()))),
      minus_noise_(Polytope::from(model.V).affine_map(-model.linear.Dv, zero(model.linear.outputs()))) {}

/// C x ∈ {y} ⊕ {-D u} ⊕ (-Dv V).
Polytope FeasibleSets::measured(const LinearModel& m, const Polytope& X, const Sample& now) const {
  if (m.outputs() == 0) return X;
  const Polytope target = minus_noise_.minkowski_sum(Polytope::from_generators(now.y)).minkowski_sum(image(-m.D, now.u));
  return X.intersection(m.C, target);
}

/// P_k with the matrices of `m`.
Polytope FeasibleSets::reached(const LinearModel& m, const Sample& now) const {
  const Index n = m.states();
  Polytope P = initial_;
  if (P_) {
    const Polytope next = P_->affine_map(m.A, zero(n)).minkowski_sum(image(m.B, before_->u)).minkowski_sum(disturbance_);
    P = m.is_descriptor() ? next.preimage(m.E, zero(n)) : next;
  }
  if (admissible_) P = P.intersection(*admissible_);
  return measured(m, P, now);
}

Polytope FeasibleSets::step(const Sample& now) {
  const Index n = model_.states();
  Polytope P = reached(drawn(model_, now.k, 0), now);
  for (int draw = 1; model_.is_uncertain() && draw < most_draws && P.is_empty(); ++draw) {
    P = reached(drawn(model_, now.k, draw), now);
  }
  P_ = std::move(P);
  if (++steps_ % steps_between_rounding == 0) P_ = with_short_numbers(*P_);
  before_ = now;
  if (!model_.is_descriptor()) return *P_;
  const Polytope range = Polytope::from_generators(zero(n), Matrix(n, 0), model_.E);
  const Polytope target = minus_disturbance_.minkowski_sum(image(-model_.B, now.u)).minkowski_sum(range);
  return P_->intersection(model_.A, target);
}

LinearModel drawn(const LinearModel& model, Index k, int draw) {
  LinearModel m = model;
  if (!model.is_uncertain() || model.is_descriptor() || draw == 1) return m;
  detail::RandomStream random(static_cast<std::uint64_t>(draw), detail::Purpose::direction, static_cast<std::uint64_t>(k));
  for (const auto& [center, radius] : {std::pair(&m.A, &model.A_radius), {&m.B, &model.B_radius}, {&m.C, &model.C_radius}}) {
    for (Index j = 0; j < radius->cols(); ++j) {
      for (Index i = 0; i < radius->rows(); ++i) (*center)(i, j) += random.sign() * almost_all * (*radius)(i, j);
    }
  }
  return m;
}

LineForm successors(const Model& model, const LineForm& X, const std::optional<LineForm>& admissible_set,
                    const Transition& transition) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  const Matrix E = m.is_descriptor() ? m.E : identity(n);
  Rows rows;
  const auto measured = [&](const Rows::Line& x, const Sample& sample) {
    const Rows::Line u = rows.constant(sample.u), y = rows.constant(sample.y), v = rows.element(model.V);
    rows.equation(p, {{y, identity(p)}, {x, -m.C}, {u, -m.D}, {v, -m.Dv}});
    return u;
  };
  const auto follows = [&](const Rows::Line& next, const Rows::Line& x, const Rows::Line& u) {
    const Rows::Line w = rows.element(model.W);
    rows.equation(n, {{next, E}, {x, -m.A}, {u, -m.B}, {w, -m.Bw}});
  };
  Rows::Line x = rows.element(X);
  if (transition.before) {
    const Rows::Line u = measured(x, *transition.before), next = rows.line(n);
    follows(next, x, u);
    x = next;
  }
  const Rows::Line u = measured(x, transition.now);
  if (m.is_descriptor()) follows(rows.line(n), x, u);
  if (admissible_set) {
    const Rows::Line kept = rows.element(*admissible_set);
    rows.equation(n, {{x, identity(n)}, {kept, -identity(n)}});
  }
  return rows.project(x);
}

}  // namespace cordon::verification
