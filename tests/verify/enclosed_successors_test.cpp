// SPDX-License-Identifier: GPL-3.0-or-later
// Successors in few variables: they hold the exact ones, to the last bit, and reach hardly farther.
#include "study/verification/enclosed_successors.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/exact_questions.hpp"

using namespace cordon;
using namespace cordon::verification;

namespace {

class RandomSteps {
 public:
  explicit RandomSteps(unsigned seed) : random_(seed) {}

  /// Numbers with all their digits, in units of 1e-3 to 1e3 by row.
  Matrix matrix(Index rows, Index cols) {
    Matrix M(rows, cols);
    for (Index i = 0; i < rows; ++i) {
      const double unit = std::pow(10.0, 3 * number());
      for (Index j = 0; j < cols; ++j) M(i, j) = unit * number();
    }
    return M;
  }
  Vector vector(Index size) { return matrix(size, 1); }
  double number() { return std::uniform_real_distribution(-1.0, 1.0)(random_); }

  Model model(bool descriptor) {
    Model model;
    LinearModel& m = model.linear;
    const Index n = 3, p = 2;
    m.A = matrix(n, n);
    if (descriptor) {
      m.E = Matrix::Identity(n, n);
      m.E(0, 1) = number();
      m.E(n - 1, n - 1) = 0;
    }
    m.B = matrix(n, 1);
    m.Bw = matrix(n, 2);
    m.C = matrix(p, n);
    m.D = matrix(p, 1);
    m.Dv = matrix(p, 2);
    model.W = make_box({Vector{{-.3, -.2}}, Vector{{.1, .7}}});
    model.V = make_box({Vector{{-.3, -.1}}, Vector{{.2, .1}}});
    return model;
  }
  /// With a constraint that leaves some of it.
  LineForm set(Index n) {
    LineForm X = make_zonotope(vector(n), matrix(n, n + 2));
    X.S.resize(1, 0);
    X.A = matrix(1, n + 2);
    X.b = .3 * X.A.rowwise().sum();
    return X;
  }
  /// Of the state x, without disturbance and noise. The input satisfies the static row, the last
  /// one, of a descriptor system.
  Sample sample(Index k, const Model& model, const Vector& x) {
    const LinearModel& m = model.linear;
    Vector u = vector(1);
    if (m.is_descriptor()) u[0] = -m.A.row(2).dot(x) / m.B(2, 0);
    return {k, u, linalg::product(m.C, x) + linalg::product(m.D, u)};
  }

 private:
  std::mt19937 random_;
};

/// A x + B u as E x⁺, where x⁺ ends with .1 if the last row of E is 0.
Vector next(const Model& model, const Vector& x, const Vector& u) {
  const LinearModel& m = model.linear;
  Vector f = linalg::product(m.A, x) + linalg::product(m.B, u);
  if (!m.is_descriptor()) return f;
  f[0] -= m.E(0, 1) * f[1];
  f[2] = .1;
  return f;
}

struct Compared {
  int finite = 0;
  int close = 0;  ///< the enclosure reaches farther by less than 1e-9 of the set's size
};

void compare(const LineForm& exact, const verification::Enclosure& enclosure, Compared& found) {
  const Index n = exact.dim();
  for (Index i = 0; i < n; ++i) {
    const Vector d = Vector::Unit(n, i);
    const Interval upper = exact::support(exact, d), lower = exact::support(exact, -d);
    const Interval outer = exact::support(enclosure.widened, d);
    CHECK(upper.lower <= outer.upper);
    if (!std::isfinite(upper.upper) || !std::isfinite(outer.upper)) continue;
    ++found.finite;
    const double size = std::abs(upper.upper) + std::abs(lower.upper);
    found.close += outer.upper - upper.upper < 1e-9 * size ? 1 : 0;
  }
}

}  // namespace

TEST_CASE("an enclosure of successors holds them, and reaches hardly farther") {
  for (const bool descriptor : {false, true}) {
    Compared found;
    for (unsigned seed = 0; seed < 25; ++seed) {
      RandomSteps random(seed);
      const Model model = random.model(descriptor);
      const LineForm X = random.set(3);
      std::optional<LineForm> admissible;
      if (seed % 3 == 0)
        admissible = make_box({Vector::Constant(3, -3e4), Vector::Constant(3, 2e4)});
      const Vector x = X.c + .3 * X.G.rowwise().sum();
      const Sample first = random.sample(0, model, x),
                   second = random.sample(1, model, next(model, x, first.u));
      for (const Sample* before : {static_cast<const Sample*>(nullptr), &first}) {
        const Transition transition{before, before ? second : first};
        const auto enclosure = enclosed_successors(model, X, admissible, transition);
        REQUIRE(enclosure);
        CHECK(enclosure->set.lines() <= (descriptor ? 6 : 0));
        compare(successors(model, X, admissible, transition), *enclosure, found);
      }
    }
    CHECK(found.finite > 100);
    CHECK(found.close >
          .85 * found.finite);  // others hang on rows that nearly contradict each other
  }
}

TEST_CASE("no enclosure where the rounding of a row has no bound") {
  RandomSteps random(1);
  Model model = random.model(false);
  const Sample now = random.sample(0, model, Vector::Zero(3));
  const Transition transition{nullptr, now};
  CHECK(enclosed_successors(model, random.set(3), std::nullopt, transition));
  CHECK_FALSE(enclosed_successors(model, make_space(3), std::nullopt, transition));
  CHECK_FALSE(enclosed_successors(model, random.set(3), make_space(3), transition));
  model.linear.E = Matrix{{.1, .3, 0.}, {.3, .9, 0.}, {0., 0., 1.}};  // singular in decimals only
  CHECK_FALSE(enclosed_successors(model, random.set(3), std::nullopt, transition));
  model.linear.E.resize(0, 0);
  model.V = make_space(2);
  CHECK_FALSE(enclosed_successors(model, random.set(3), std::nullopt, transition));
}
