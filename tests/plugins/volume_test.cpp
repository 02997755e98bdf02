// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of sets with constraints against those of exact polytopes, with details that are hardly
// larger than rounding.
#include <cmath>
#include <random>
#include <vector>

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
      const Interval truth = Polytope::from(X).volume();
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
    const Interval truth = Polytope::from(X).volume();
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

namespace {

LineForm with_constraints(const Vector& c, const Matrix& G, const Matrix& A, const Vector& b) {
  return {Matrix(c.size(), 0), G, c, Matrix(b.size(), 0), A, b};
}

/// Two are a millionth as thick as long; of one the constraints leave a millionth.
std::vector<LineForm> with_hidden_vertices() {
  return {
      with_constraints(
          Vector{{-0.0777584645943552, 0.19160714219145003}},
          Matrix{
              {-0.03438417624818078, 0.7305315880858705, -0.2082623129953735, -0.7495386805959816},
              {-0.014194057401216778, 0.30157149575676545, -0.08597339872303536,
               -0.309417460171123}},
          Matrix{{-0.6907127727707041, 0.0, -0.38473352321336884, 0.7763652521133038},
                 {0.5378660193382079, 0.465548773420823, -0.9612340988108561, 0.4694330075740587}},
          Vector{{0.17736885355832066, 0.2661416358134784}}),
      with_constraints(Vector{{-0.9619035573340462, -0.6395466192294978}},
                       Matrix{{0.6198430011773227, 0.42907919129979266, -0.38281031086314177,
                               0.5333442673170048, 0.42466523781849885, 0.48966350407180226},
                              {0.5840875657460961, 0.4043273599105776, -0.3607283685492084,
                               0.5025788293283567, 0.40016898058814915, 0.4614181542239586}},
                       Matrix{{0.28764570736866624, -0.3151498114317244, 0.6759065216119804,
                               0.9705978174431924, -0.36781950459402113, -0.9275888219288633},
                              {-0.26645543426339136, -0.7289699541301806, -0.362327103849041,
                               0.13434595867604315, 0.0, 0.7807915029482191}},
                       Vector{{-0.5186260314133839, 0.10944179387551854}}),
      with_constraints(Vector{{-0.9008091060040093, 0.7185100669860982}},
                       Matrix{{0.3632165247111132, -0.20970668731650632, -0.08880423849542063,
                               0.9373448354790224, 0.5810727117876855, 0.764686842214316},
                              {-0.03759100598132403, -0.028989239539643163, -0.6897531200429898,
                               -0.8131820395256912, 0.9499713283711393, 0.3076759535914937}},
                       Matrix{{0.68790724173759, -0.20409226771853994, -0.6440485600522929,
                               -0.2563411179813535, 0.8793051568069392, -0.8629220447610131},
                              {0.8379746380072839, -0.5453573645691694, 0.542402565141185,
                               -0.13015293229115898, -0.635732643003325, 0.6257853223626182}},
                       Vector{{3.5346161275044095, -0.29043559563604193}})};
}

}  // namespace

TEST_CASE("a vertex that the solver takes for another is missed by no area that is called exact") {
  const Plugins plugins;
  for (const LineForm& X : with_hidden_vertices()) {
    const Interval truth = Polytope::from(X).volume();
    for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
      const Volume found = plugins.backend(name)->import(X)->volume();
      CHECK(found.value >= truth.lower * (1 - 1e-7));
      if (found.exact) CHECK(found.value <= truth.upper * (1 + 1e-7));
    }
  }
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
        const Interval truth = Polytope::from(X).volume();
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
        const Interval of_zonotope = Polytope::from(Z).volume();
        const Volume without = plugins.backend("zonotope")->import(Z)->volume();
        CHECK(without.value >= of_zonotope.lower * (1 - (without.exact ? 1e-7 : 0)));
        if (without.exact) CHECK(without.value <= of_zonotope.upper * (1 + 1e-7));
        const Interval truth = Polytope::from(X).volume();
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

TEST_CASE("rows that nearly depend on each other do not make a volume that is none") {
  // .3 ξ₁ + .1 ξ₂ + ξ₃ = .25 twice, but for a hair of ξ₁: ξ₁ = 0
  const Plugins plugins;
  for (int digits = 6; digits <= 16; ++digits) {
    const double hair = std::pow(10.0, -digits);
    for (const Index n : {1, 2}) {
      LineForm X{Matrix(n, 0), Matrix::Zero(n, 3), Vector::Zero(n),
                 Matrix(2, 0), Matrix(2, 3),       Vector{{.25, .25}}};
      X.G.leftCols(n) = Matrix::Identity(n, n);
      X.A << .3, .1, 1, .3 + hair, .1, 1;
      if (X.A.row(0) == X.A.row(1)) continue;
      for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
        const auto found = plugins.backend(name)->import(X)->volume();
        CAPTURE(hair);
        CAPTURE(n);
        CHECK_FALSE((found.exact && found.value > 1e-6));
      }
    }
  }
}

TEST_CASE("a factor that a row lets barely move makes no volume of a larger set") {
  // ξ₁ + b ξ₂ + a ξ₃ = 1 + a (1 + δ) - b: ξ₂ is no less than a δ / b - 1, where a solver that
  // passes over a δ finds -1
  const Plugins plugins;
  for (const auto& [a, b] :
       {std::pair(.01, 1e-6), std::pair(0x1p-7, 0x1p-34), std::pair(.01, .001)}) {
    for (const double delta : {1e-11, 1e-10, 8e-10, 1e-9}) {
      for (const Index n : {1, 2, 3}) {
        LineForm X{Matrix(n, 0), Matrix::Zero(n, n + 2), Vector::Zero(n),
                   Matrix(1, 0), Matrix::Zero(1, n + 2), Vector{{1 + a * (1 + delta) - b}}};
        X.G(0, 1) = 1;
        for (Index i = 1; i < n; ++i) X.G(i, i + 2) = 1;
        X.A(0, 0) = 1;
        X.A(0, 1) = b;
        X.A(0, 2) = a;
        const double share = std::max(0.0, X.b[0] - 1 - a + b) / b;  // of the length 2 of ξ₂
        const double truth = (2 - share) * std::ldexp(1., static_cast<int>(n) - 1);
        for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
          CAPTURE(a);
          CAPTURE(delta);
          CAPTURE(n);
          const auto found = plugins.backend(name)->import(X)->volume();
          if (found.exact) CHECK(found.value == doctest::Approx(truth).epsilon(1.1e-7));
        }
      }
    }
  }
}
