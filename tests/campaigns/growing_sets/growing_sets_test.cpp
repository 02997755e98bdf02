// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of stable errors stay bounded: random plants, every reduction, budgets from n to 100, for as
// long as one likes.
//   CORDON_PLANTS (6), CORDON_STEPS (400): how many plants, and for how long; CORDON_SEED (1): the
//   first plant.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/sets/sampling.hpp"

using namespace cordon;

namespace {

int number_from(const char* variable, int fallback) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : fallback;
}

double spectral_radius(const Matrix& A) { return linalg::eigenvalues(A).cwiseAbs().maxCoeff(); }

Matrix random_matrix(sets::Random& random, Index rows, Index cols) {
  Matrix M(rows, cols);
  for (double& x : M.reshaped()) x = random.between(-1, 1);
  return M;
}

/// Slow modes that do not mix, rotations, chains of equal poles, dense matrices, and these in
/// unlike units.
Matrix stable_matrix(sets::Random& random, Index n, int kind) {
  Matrix A = random_matrix(random, n, n);
  if (kind == 1) {
    const Matrix Q = linalg::orthogonal_axes(A);
    Vector poles(n);
    for (double& pole : poles) pole = random.between(.8, 1);
    A = Q * poles.asDiagonal() * Q.transpose();
  } else if (kind == 2) {
    A.setZero();
    for (Index i = 0; i + 1 < n; i += 2) {
      const double angle = random.between(0, 3.1), radius = random.between(.8, 1);
      A.block(i, i, 2, 2) << radius * std::cos(angle), radius * std::sin(angle),
          -radius * std::sin(angle), radius * std::cos(angle);
    }
    if (n % 2) A(n - 1, n - 1) = random.between(.5, 1);
    const Matrix T = Matrix::Identity(n, n) + .3 * random_matrix(random, n, n);
    if (const auto inverse = linalg::solve(T, Matrix::Identity(n, n))) A = T * A * *inverse;
  } else if (kind == 3) {
    A = random.between(.8, .98) * Matrix::Identity(n, n);
    for (Index i = 0; i + 1 < n; ++i) A(i, i + 1) = random.between(.01, .3);
  }
  A *= random.between(.7, .99) / std::max(spectral_radius(A), 1e-3);
  return A;
}

Model stable_plant(int seed) {
  sets::Random random(static_cast<std::uint64_t>(seed));
  constexpr Index sizes[] = {2, 3, 4, 6, 9, 12};
  const Index n = sizes[seed % 6], p = 1 + seed % 3 % n;
  Model model;
  LinearModel& m = model.linear;
  m.A = stable_matrix(random, n, seed % 5);
  m.B = Matrix::Zero(n, 0);
  m.Bw = Matrix::Identity(n, n);
  m.C = random_matrix(random, p, n);
  m.D = Matrix::Zero(p, 0);
  m.Dv = Matrix::Identity(p, p);
  Vector w(n), v(p), units = Vector::Ones(n);
  for (double& x : w) x = random.between(0, 1) < .2 ? 0 : random.between(.001, .1);
  for (double& x : v) x = random.between(.01, 1);
  w[0] = .1;
  if (seed % 5 == 4) {
    for (double& x : units) x = std::pow(10, random.between(-3, 3));
    m.A = Matrix(units.asDiagonal() * m.A * units.cwiseInverse().asDiagonal());
    m.C = Matrix(m.C * units.cwiseInverse().asDiagonal());
    w = w.cwiseProduct(units);
  }
  model.W = make_box({-w, w});
  model.V = make_box({-v, v});
  model.X0 = make_box({-units, units});
  return model;
}

/// Half widths of the unreduced limit, Σ |Fʲ N| 1.
Vector unreduced_limit(const Model& model, const Matrix& L) {
  const LinearModel& m = model.linear;
  const Matrix F = m.A - L * m.C;
  Matrix D(F.rows(), model.W.G.cols() + model.V.G.cols());
  D << m.Bw * model.W.G, -L * m.Dv * model.V.G;
  Vector sum = Vector::Zero(F.rows());
  for (int k = 0; k < 5000; ++k, D = Matrix(F * D)) sum += D.cwiseAbs().rowwise().sum();
  return sum;
}

struct Choice {
  std::string backend, reduction;
};

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all = [] {
    std::vector<Choice> some{
        {"interval", ""}, {"constrained_zonotope", "adaptive"}, {"line_zonotope", "adaptive"}};
    for (const char* reduction : {"adaptive", "yang_scott", "girard", "combastel", "pca", "qr"})
      some.push_back({"zonotope", reduction});
    return some;
  }();
  return all;
}

/// Widest estimate over the last tenth of the steps, in units of the unreduced limit.
double widest(const Registry& registry, const Model& model, const Choice& choice, Index budget,
              int steps) {
  Params backend, params;
  if (!choice.reduction.empty()) backend.set("reduction", choice.reduction);
  params.set("max_generators", static_cast<std::int64_t>(budget));
  const auto observer = registry.make<ObserverEntry>(
      "luenberger", {model, registry.make<BackendEntry>(choice.backend, backend)}, params);
  const Vector limit = unreduced_limit(model, observer->gains().front().L);
  const Vector nothing(0), y = Vector::Zero(model.linear.outputs());
  double most = 0;
  for (Index k = 0; k < steps; ++k) {
    const Estimate estimate = observer->step({k, nothing, y});
    if (k < steps - steps / 10) continue;
    const Box hull = estimate.set->interval_hull();
    most = std::max(most, ((hull.upper - hull.lower) / 2).cwiseQuotient(limit).maxCoeff());
  }
  return most;
}

}  // namespace

TEST_CASE("sets of stable errors stay below three times their unreduced limit") {
  Registry registry;
  registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const int first = number_from("CORDON_SEED", 1), plants = number_from("CORDON_PLANTS", 6),
            steps = number_from("CORDON_STEPS", 400);
  double most = 0;
  for (int seed = first; seed < first + plants; ++seed) {
    CAPTURE(seed);
    const Model model = stable_plant(seed);
    const Index n = model.linear.states();
    for (const Index budget : {n, 2 * n, Index{30}, Index{100}}) {
      CAPTURE(budget);
      for (const Choice& choice : choices()) {
        if (choice.backend == "interval" && budget > n) continue;
        CAPTURE(choice.backend);
        CAPTURE(choice.reduction);
        const double width = widest(registry, model, choice, budget, steps);
        CHECK(width <= 3);
        most = std::max(most, width);
      }
    }
  }
  MESSAGE("widest: " << most << " times the unreduced limit");
}
