// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <complex>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "gains/interval_plants.hpp"

using namespace cordon;

namespace {

const Plugins& plugins() {
  static const Plugins loaded;
  return loaded;
}

Model plant(const Matrix& A, const Matrix& C) {
  return interval_plants::with_unit_boxes(A, Matrix(A.rows(), 0), C, .1, .1);
}

Params poles(const Vector& real, const Vector& imaginary = {}) {
  Params params;
  params.set("poles", real);
  if (imaginary.size() > 0) params.set("poles_imaginary", imaginary);
  return params;
}

GainDesign design(const Model& model, const Params& params) {
  CHECK(plugins().registry.check<GainEntry>("poles", {model}, params).empty());
  return plugins().registry.make<GainEntry>("poles", params)->design(model);
}

/// Coefficients of det(zI - A), from the traces of its powers.
Vector characteristic(const Matrix& A) {
  const Index n = A.rows();
  Vector c = Vector::Zero(n + 1);
  c[0] = 1;
  Matrix M = Matrix::Zero(n, n);
  for (Index k = 1; k <= n; ++k) {
    M = (A * M + c[k - 1] * Matrix::Identity(n, n)).eval();
    c[k] = -(A * M).trace() / static_cast<double>(k);
  }
  return c;
}

Vector characteristic(const Vector& real, const Vector& imaginary) {
  Eigen::VectorXcd c = Eigen::VectorXcd::Zero(real.size() + 1);
  c[0] = 1;
  for (Index i = 0; i < real.size(); ++i) {
    const std::complex<double> pole(real[i], imaginary[i]);
    for (Index k = i + 1; k > 0; --k) c[k] -= pole * c[k - 1];
  }
  return c.real();
}

double number(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 10'001)) * 1e-4;
}

Matrix random_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index i = 0; i < A.size(); ++i) A(i) = number(-1, 1);
  return A;
}

}  // namespace

TEST_CASE("one output: the gain by hand") {
  // A - L C = [1 - l1, 1; -l2, 1]: z² - (2 - l1) z + 1 - l1 + l2
  const GainDesign real =
      design(plant(Matrix{{1, 1}, {0, 1}}, Matrix{{1, 0}}), poles(Vector{{.5, .2}}));
  REQUIRE(real.feasible == Answer::yes);
  CHECK(real.gain.L(0) == doctest::Approx(1.3).epsilon(1e-12));
  CHECK(real.gain.L(1) == doctest::Approx(.4).epsilon(1e-12));
  CHECK(real.gain.certificate.spectral_radius == doctest::Approx(.5));
  const GainDesign pair = design(plant(Matrix{{1, 1}, {0, 1}}, Matrix{{1, 0}}),
                                 poles(Vector{{.5, .5}}, Vector{{.2, -.2}}));
  REQUIRE(pair.feasible == Answer::yes);
  CHECK(pair.gain.L(0) == doctest::Approx(1).epsilon(1e-12));
  CHECK(pair.gain.L(1) == doctest::Approx(.29).epsilon(1e-12));
}

TEST_CASE("poles that A has already, and sensors of half effectiveness") {
  Model model = plant(Matrix{{.5, 1}, {0, 2}}, Matrix{{1, 0}});
  GainDesign found = design(model, poles(Vector{{.5, .25}}));
  REQUIRE(found.feasible == Answer::yes);
  const Matrix whole = found.gain.L;
  model.linear.sensor = Box{Vector{{0}}, Vector{{1}}};
  found = design(model, poles(Vector{{.5, .25}}));
  REQUIRE(found.feasible == Answer::yes);
  CHECK((found.gain.L - 2 * whole).norm() < 1e-9);
}

TEST_CASE("with every state measured the closed loop is normal: poles cannot move less") {
  const Matrix A{{.3, 1, .2}, {-.7, 1.1, .4}, {.1, -.9, .6}}, C{{1, 2, 0}, {0, 1, -1}, {.5, 0, 2}};
  for (const auto& [real, imaginary] : {std::pair{Vector{{.1, .1, .8}}, Vector{{0, 0, 0}}},
                                        {Vector{{.1, .3, .3}}, Vector{{0, .6, -.6}}}}) {
    const GainDesign found = design(plant(A, C), poles(real, imaginary));
    REQUIRE(found.feasible == Answer::yes);
    const Matrix closed = A - found.gain.L * C;
    CHECK((closed * closed.transpose() - closed.transpose() * closed).norm() < 1e-9);
  }
}

TEST_CASE("several outputs are used for independent eigenvectors") {
  const Matrix A{{.9, .5, 0, .1}, {-.4, .8, .3, 0}, {0, .2, .7, .6}, {.1, 0, -.5, .6}},
      C{{1, 0, 0, 0}, {0, 0, 0, 1}};
  struct Case {
    Vector real, imaginary;
    double condition;  // the first choice of eigenvectors has 58, 17 and 748
  };
  for (const Case& c : {Case{Vector{{.5, .2, .4, .7}}, Vector{{0, 0, 0, 0}}, 6.5},
                        Case{Vector{{.5, .5, .4, .7}}, Vector{{.3, -.3, 0, 0}}, 4},
                        Case{Vector{{.5, .5, .3, .3}}, Vector{{.3, -.3, .1, -.1}}, 10.5}}) {
    const GainDesign found = design(plant(A, C), poles(c.real, c.imaginary));
    REQUIRE(found.feasible == Answer::yes);
    const linalg::ComplexEigen eigen = linalg::complex_eigen(A - found.gain.L * C);
    Matrix vectors(8, 8);
    vectors << eigen.vectors.real(), -eigen.vectors.imag(), eigen.vectors.imag(),
        eigen.vectors.real();
    const Vector sigma = linalg::svd(vectors).sigma;
    CHECK(sigma[0] / sigma[7] < c.condition);
  }
  CHECK(design(plant(A, C), poles(Vector{{.5, .5, .4, .4}})).feasible ==
        Answer::yes);  // twice each, which one output could not
}

TEST_CASE("random observable pairs get their poles, by the characteristic polynomial") {
  int done = 0, all = 0;
  CHECK(rc::check("placement", [&] {
    ++all;
    const Index n = *rc::gen::inRange(1, 6), p = *rc::gen::inRange<Index>(1, n + 1);
    const Model model = plant(random_matrix(n, n), random_matrix(p, n));
    Vector real(n), imaginary = Vector::Zero(n);
    for (Index i = 0; i < n; ++i)
      real[i] = -.6 + 1.2 * (static_cast<double>(i) + number(0, .5)) / static_cast<double>(n);
    if (n >= 2 && *rc::gen::arbitrary<bool>()) {
      real[1] = real[0];
      imaginary[0] = number(.1, .7);
      imaginary[1] = -imaginary[0];
    }
    const GainDesign found =
        plugins().registry.make<GainEntry>("poles", poles(real, imaginary))->design(model);
    if (found.feasible != Answer::yes) return;  // nearly unobservable pairs
    ++done;
    const Matrix closed = model.linear.A - found.gain.L * model.linear.C;
    const double size = 1 + closed.norm();
    RC_ASSERT((characteristic(closed) - characteristic(real, imaginary)).norm() <
              1e-7 * std::pow(size, static_cast<double>(n)));
    std::vector<std::complex<double>> left;
    for (const auto& value : linalg::eigenvalues(closed)) left.push_back(value);
    for (Index i = 0; i < n; ++i) {
      const std::complex<double> pole(real[i], imaginary[i]);
      RC_ASSERT(std::any_of(left.begin(), left.end(),
                            [&](auto value) { return std::abs(value - pole) <= 1e-8; }));
    }
  }));
  CHECK(done * 10 > all * 9);
}

TEST_CASE("what cannot be placed is refused with the reason") {
  const auto refused = [](const Matrix& A, const Matrix& C, const Params& params,
                          const std::string& words, Answer answer) {
    const GainDesign found = design(plant(A, C), params);
    CAPTURE(found.reason);
    CHECK(found.feasible == answer);
    CHECK(found.reason.find(words) != std::string::npos);
    CHECK_FALSE(found.suggestion.empty());
  };
  refused(Matrix{{.5, 0}, {0, .9}}, Matrix{{1, 0}}, poles(Vector{{.1, .2}}),
          "the mode 0.9 of A, along (0, 1)", Answer::no);
  refused(Matrix{{1, 1}, {0, 1}}, Matrix{{1, 0}}, poles(Vector{{.3, .3}}),
          "the pole 0.3 is asked for 2 times, the outputs have rank 1", Answer::no);
  refused(Matrix{{1, 1}, {0, 1}}, Matrix{{1, 0}, {2, 0}}, poles(Vector{{.3, .3}}),
          "the outputs have rank 1", Answer::no);
  refused(Matrix{{1, 1}, {0, 1}}, Matrix{{1, 0}}, poles(Vector{{.3, .3 + 1e-13}}),
          "were not placed", Answer::unknown);
}

TEST_CASE("numbers that make no sense are refused, each with its place") {
  const Model model = plant(Matrix{{1, 1}, {0, 1}}, Matrix{{1, 0}});
  const auto has = [&](const Params& params, const std::string& pointer, const std::string& words) {
    const auto problems = plugins().registry.check<GainEntry>("poles", {model}, params);
    return std::any_of(problems.begin(), problems.end(), [&](const Diagnostic& d) {
      return d.pointer == pointer && d.message.find(words) != std::string::npos;
    });
  };
  CHECK(has(poles(Vector{{.1}}), "/poles", "holds 1 number, there are 2 states"));
  CHECK(has(poles(Vector{{.1, .2}}, Vector{{.1}}), "/poles_imaginary",
            "holds 1 number, poles holds 2"));
  CHECK(has(poles(Vector{{.1, 1}}), "/poles", "1 lies outside the unit circle"));
  CHECK(has(poles(Vector{{.1, .1}}, Vector{{.2, .2}}), "/poles_imaginary",
            "0.1 + 0.2i has no conjugate"));
  CHECK(has(poles(Vector{{.8, .8}}, Vector{{.7, -.7}}), "/poles", "0.8 - 0.7i lies outside"));
  CHECK(has(poles(Vector{{.1, .2}}, Vector{{.2, -.2}}), "/poles_imaginary",
            "0.2 - 0.2i has no conjugate"));
  CHECK(plugins()
            .registry
            .check<GainEntry>("poles", {plant(Matrix::Identity(3, 3), Matrix::Identity(3, 3))},
                              poles(Vector{{.1, .1, .1}}, Vector{{.2, .2, -.2}}))
            .size() == 2);  // neither has as many conjugates
  CHECK(plugins().registry.make<GainEntry>("poles", poles(Vector{{.1}}))->design(model).feasible ==
        Answer::no);
  CHECK_THROWS_AS(
      plugins().registry.make<GainEntry>("poles", poles(Vector{{.1, .2}}, Vector{{.1}})), Error);
}
