// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of sets with constraints against those of exact polytopes, with details that are hardly
// larger than rounding.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/line_form.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "published/study_models.hpp"

using namespace cordon;

namespace {

/// A set of dimension n around a point, with one column of G and A for each entry of `sizes`.
LineForm random_set(const Vector& sizes, Index constraints, std::mt19937& random, Index n = 3) {
  std::uniform_real_distribution<double> number(-1, 1);
  const Index g = sizes.size();
  LineForm X{Matrix(n, 0),           Matrix(n, g),           Vector(n),
             Matrix(constraints, 0), Matrix(constraints, g), Vector(constraints)};
  Vector xi(g);
  for (auto* part : {&X.G, &X.A}) {
    for (double& entry : part->reshaped()) entry = number(random);
  }
  for (auto* part : {&X.c, &xi}) {
    for (double& entry : *part) entry = .7 * number(random);
  }
  X.G = X.G * sizes.asDiagonal();
  X.A = X.A * sizes.asDiagonal();
  X.b = X.A * xi;
  return X;
}

}  // namespace

TEST_CASE("volumes with constraints are those of the exact polytope") {
  const Plugins plugins;
  std::mt19937 random(1);
  for (const double detail : {1., 1e-4, 1e-7, 1e-9, 3e-11, 1e-13}) {
    for (int trial = 0; trial < 6; ++trial) {
      CAPTURE(detail);
      CAPTURE(trial);
      Vector sizes = Vector::Ones(9);
      sizes.tail(3).setConstant(detail);
      const LineForm X = random_set(sizes, trial % 3, random);
      const rounding::Range truth = Polytope::from(X).volume();
      for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
        const auto backend = plugins.backend(name);
        const Volume found = backend->import(X)->volume();
        CHECK(found.exact);
        CHECK(found.value >= truth.lower * (1 - 1e-12));
        CHECK(found.value <= truth.upper * (1 + 1e-7));
      }
    }
  }
}

TEST_CASE("areas and lengths of thin and small sets are exact, or said to be bounds") {
  const Plugins plugins;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> power(-8, 0);
  Index exact = 0, all = 0;
  for (int trial = 0; trial < 300; ++trial) {
    CAPTURE(trial);
    const Index n = 1 + trial % 2;
    Vector sizes(8);
    for (double& size : sizes) size = std::pow(10, power(random));
    LineForm X = random_set(sizes, 1 + trial % 3, random, n);
    X.G.row(n - 1) *= std::pow(10, power(random));
    const rounding::Range truth = Polytope::from(X).volume();
    for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
      const Volume found = plugins.backend(name)->import(X)->volume();
      CHECK(found.value >= truth.lower * (1 - 1e-7));
      if (found.exact) CHECK(found.value <= truth.upper * (1 + 1e-7));
      exact += found.exact;
      ++all;
    }
  }
  CHECK(exact > all / 2);
}

TEST_CASE("the volume of what constraints leave of a set, and of one far from the origin") {
  const Plugins plugins;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (const Index n : {1, 2, 3}) {
    for (const double part : {.1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15}) {
      for (const double far : {0., 1e9}) {
        CAPTURE(n);
        CAPTURE(part);
        CAPTURE(far);
        // ξ_i + part ξ_{n+i} = b_i, so that ξ_i is b_i ± part
        Matrix T(n, n);
        for (double& entry : T.reshaped()) entry = number(random);
        LineForm X{Matrix(n, 0), Matrix::Zero(n, 2 * n), Vector::Constant(n, far),
                   Matrix(n, 0), Matrix(n, 2 * n),       Vector(n)};
        X.G.leftCols(n) = T;
        X.A << Matrix::Identity(n, n), part * Matrix::Identity(n, n);
        for (double& entry : X.b) entry = .7 * number(random);
        const rounding::Range truth = Polytope::from(X).volume();
        for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
          const Volume found = plugins.backend(name)->import(X)->volume();
          CHECK(found.value >= truth.lower * (1 - (found.exact ? 1e-7 : 1e-12)));
          if (found.exact) CHECK(found.value <= truth.upper * (1 + 1e-7));
          if (part >= 1e-5) CHECK(found.exact);
        }
      }
    }
  }
}

TEST_CASE("the volume of a set thinner than rounding shows is bounded and not called 0") {
  const Plugins plugins;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1, 1);
  for (const Index n : {2, 3}) {
    for (const double thickness : {1e-3, 1e-5, 1e-7, 3e-9, 1e-9, 1e-11, 1e-13, 1e-15}) {
      for (int trial = 0; trial < 10; ++trial) {
        CAPTURE(n);
        CAPTURE(thickness);
        CAPTURE(trial);
        // columns in a plane, or on a line, that lies anywhere, and one across it
        Matrix T(n, n);
        for (double& entry : T.reshaped()) entry = number(random);
        Matrix flat = Matrix::Zero(n, 6);
        for (double& entry : flat.topRows(n - 1).reshaped()) entry = number(random);
        LineForm X{Matrix(n, 0), Matrix(n, 7), Vector::Zero(n),
                   Matrix(1, 0), Matrix(1, 7), Vector{{.1}}};
        X.G.leftCols(6) = T * flat;
        X.G.col(6) = thickness * T.col(n - 1);
        for (double& entry : X.A.reshaped()) entry = number(random);
        X.A(0, 6) = 0;
        LineForm Z = X;  // the same without its constraint
        Z.S = Matrix(0, 0);
        Z.A = Matrix(0, 7);
        Z.b = Vector(0);
        const rounding::Range of_zonotope = Polytope::from(Z).volume();
        const Volume without = plugins.backend("zonotope")->import(Z)->volume();
        CHECK(without.value >= of_zonotope.lower * (1 - (without.exact ? 1e-7 : 0)));
        if (without.exact) CHECK(without.value <= of_zonotope.upper * (1 + 1e-7));
        const rounding::Range truth = Polytope::from(X).volume();
        const double hull = (2 * cordon::interval_hull(X).radius()).prod();
        for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
          const Volume found = plugins.backend(name)->import(X)->volume();
          CHECK(found.value >= truth.lower * (1 - (found.exact ? 1e-7 : 0)));
          if (found.exact) CHECK(found.value <= truth.upper * (1 + 1e-7));
          if (thickness > 1e-6) CHECK(found.exact);
          CHECK(found.value <= 20 * truth.upper + 1e-11 * hull);
        }
      }
    }
  }
}
