// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that a mode explains, by a trajectory in rational numbers, in coordinates of unlike sizes
// that are mixed: |A|ᵏ grows without limit there though Aᵏ does not, and magnitudes that are added
// up along a chain of states say nothing of the sizes of its numbers. The mode is not excluded, and
// the rows of the experiment are not called a contradiction.
#include <gmpxx.h>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "diagnosers/tube_membership/membership.hpp"
#include "input_design/plugins.hpp"

using namespace cordon;

namespace {

using Rationals = std::vector<mpq_class>;

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  int below(int end) { return static_cast<int>(engine_() % static_cast<unsigned>(end)); }
  /// A multiple of 1/8 within ±most/8.
  double eighths(int most) { return (below(2 * most + 1) - most) / 8.; }
  Matrix matrix(Index rows, Index cols, int most) {
    return Matrix::NullaryExpr(rows, cols, [&] { return eighths(most); });
  }

 private:
  std::mt19937 engine_;
};

Rationals product(const Matrix& A, const Rationals& x) {
  Rationals y(static_cast<std::size_t>(A.rows()));
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j)
      y[static_cast<std::size_t>(i)] += mpq_class(A(i, j)) * x[static_cast<std::size_t>(j)];
  }
  return y;
}

void add(Rationals& x, const Rationals& y) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += y[i];
}

/// Within ±1/4.
Rationals disturbance(Draw& draw, Index size) {
  Rationals w;
  for (Index i = 0; i < size; ++i) w.emplace_back(draw.eighths(2));
  return w;
}

/// A plant of small numbers seen in other coordinates: powers of two, then a shear, all exact.
Model mixed_model(Draw& draw, int exponent) {
  const Index n = 2 + draw.below(2);
  Matrix T = Matrix::Identity(n, n), inverse = T;
  const double shear = 1 + draw.below(3);
  T(1, 0) = shear;
  inverse(1, 0) = -shear;
  Matrix units = Matrix::Identity(n, n);
  units(0, 0) = std::ldexp(1., draw.below(2) ? exponent : -exponent);
  T = T * units;
  inverse = Matrix(units.diagonal().cwiseInverse().asDiagonal()) * inverse;
  Model model;
  LinearModel& m = model.linear;
  m.A = T * draw.matrix(n, n, 5) * inverse;
  m.B = T * draw.matrix(n, 1, 4);
  m.Bw = T * draw.matrix(n, 1, 8);
  m.C = draw.matrix(1, n, 8) * inverse;
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix::Identity(1, 1);
  model.X0 = make_zonotope(Vector::Zero(n), T);
  model.W = make_box({Vector{{-.25}}, Vector{{.25}}});
  model.V = make_box({Vector{{-.25}}, Vector{{.25}}});
  model.U = make_space(1);
  return model;
}

/// u and y of k = 0 … steps, of a trajectory inside all sets; y is rounded, within the noise.
struct Experiment {
  Vector u, y;
};
Experiment experiment(const Model& model, Draw& draw, Index steps) {
  const LinearModel& m = model.linear;
  Experiment made{Vector(steps + 1), Vector(steps + 1)};
  Rationals x;
  for (Index i = 0; i < m.states(); ++i) x.emplace_back(draw.eighths(8));
  x = product(model.X0.G, x);
  for (Index k = 0; k <= steps; ++k) {
    made.u[k] = draw.eighths(8);
    Rationals y = product(m.C, x);
    add(y, disturbance(draw, 1));
    y[0] = y[0] * mpq_class(127, 128);  // room for rounding, if y is no more than V
    made.y[k] = y[0].get_d();
    const mpq_class v = mpq_class(made.y[k]) - product(m.C, x)[0];
    if (abs(v) > mpq_class(.25)) made.y[k] = product(m.C, x)[0].get_d();
    Rationals next = product(m.A, x);
    add(next, product(m.B, {mpq_class(made.u[k])}));
    add(next, product(m.Bw, disturbance(draw, 1)));
    x = std::move(next);
  }
  return made;
}

}  // namespace

TEST_CASE("a mode that explains the samples is not excluded, in whatever coordinates") {
  const auto backend = examples::backend("line_zonotope");
  int proven = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Draw draw(seed);
    const Model model = mixed_model(draw, (draw.below(5)) * 4);
    const Index steps = 7;
    const Experiment all = experiment(model, draw, steps);
    for (Index k = 0; k <= steps; ++k) {
      const OutputTube tube = output_tube(model, *backend, {k});
      const Vector u = all.u.head(k + 1), y = all.y.head(k + 1);
      const Answer answer = diagnosers::membership(tube, u, y);
      CHECK(answer != Answer::no);
      proven += answer == Answer::yes;
      // the same rows as a set
      const LineForm Y = tube.at(u);
      const LineForm explained = intersection(Y, Matrix::Identity(k + 1, k + 1), make_point(y));
      CHECK(is_empty(eliminate_lines(explained)) != Answer::yes);
    }
  }
  CHECK(proven > 1000);
}
