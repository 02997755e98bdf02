// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "gains/interval_plants.hpp"

using namespace cordon;
using namespace interval_plants;

namespace {

const Plugins& plugins() {
  static const Plugins loaded;
  return loaded;
}

GainDesign design(const Model& model, const std::optional<Matrix>& theta) {
  Params params;
  if (theta) params.set("theta", *theta);
  CHECK(plugins().registry.check<GainEntry>("peak", {model}, params).empty());
  return plugins().registry.make<GainEntry>("peak", params)->design(model);
}

/// h = (I - (A - L C))⁻¹ (r + |L Ev| 1) for unit boxes W and V.
Vector half_widths(const Model& model, const Matrix& L, const Matrix& theta) {
  const LinearModel& m = model.linear;
  const Vector r = m.Bw.cwiseAbs().rowwise().sum() + theta.cwiseAbs().rowwise().sum() +
                   (L * m.Dv).cwiseAbs().rowwise().sum();
  return linalg::solve(Matrix::Identity(m.states(), m.states()) - (m.A - L * m.C), r).value();
}

void check_numbers(const Model& model, const Matrix& theta, const Matrix& L, const Vector& widths) {
  const GainDesign found = design(model, theta);
  REQUIRE(found.feasible == Answer::yes);
  CHECK((found.gain.L - L).norm() < 1e-7);
  const GainCertificate& c = found.gain.certificate;
  CHECK(c.monotone == Answer::yes);
  CHECK(c.optimum == doctest::Approx(widths.sum()).epsilon(1e-8));
  CHECK(c.optimum_bound == doctest::Approx(widths.sum()).epsilon(1e-8));
  CHECK((half_widths(model, found.gain.L, theta) - widths).norm() < 1e-6 * widths.norm());
}

}  // namespace

TEST_CASE("the gains of least steady widths of the published plants") {
  check_numbers(three_states(), .01 * Matrix::Identity(3, 3), Matrix{{.3}, {.2}, {.8}},
                Vector{{1.075, .65, .26075}});
  check_numbers(three_states(), Matrix::Identity(3, 3), Matrix{{.3}, {.2}, {.8}},
                Vector{{8.5, 5.6, 1.325}});
  check_numbers(two_tanks(), tank_theta(), Matrix{{0}, {.9903}}, Vector{{6.476315789474, .57498}});
  check_numbers(two_tanks(), Matrix::Identity(2, 2), Matrix{{0}, {.9903}},
                Vector{{88.245614035088, 2.50715}});
}

TEST_CASE("the norms of published gains") {
  const auto norm = [](const Model& model, const Matrix& theta, const Matrix& L) {
    const GainDesign given =
        plugins().registry.make<GainEntry>("given", Params().set("matrix", L))->design(model);
    REQUIRE(given.feasible == Answer::yes);
    Model with = model;  // Eθ as further disturbances: "given" takes it from the radii of A only
    with.linear.Bw = Matrix(model.linear.states(), model.linear.Bw.cols() + theta.cols());
    with.linear.Bw << model.linear.Bw, theta;
    with.W = make_box(cube(with.linear.Bw.cols(), 1));
    return plugins()
        .registry.make<GainEntry>("given", Params().set("matrix", L))
        ->design(with)
        .gain.certificate;
  };
  struct Case {
    Model model;
    Matrix theta, L;
    double expected, radius;
  };
  const Matrix I2 = Matrix::Identity(2, 2), I3 = Matrix::Identity(3, 3);
  for (const Case& c :
       {Case{three_states(), I3, Matrix{{.2781}, {.2855}, {.7982}}, 6.4320429082656965,
             .8002710107923026},
        Case{three_states(), I3, Matrix{{.3}, {.2}, {.8}}, 6.439588006455294, .8},
        Case{three_states(), .01 * I3, Matrix{{.3}, {.2}, {.8}}, .6897414397581098, .8},
        Case{three_states(-.1), I3, Matrix{{.2754}, {1.0571}, {.7724}}, 8.292974176314026,
             .8327795356378738},
        Case{three_states(-.1), I3, Matrix{{1.1376}, {1.9167}, {1.2604}}, 8.245913222458496,
             .8333335267659779},
        Case{two_tanks(), I2, Matrix{{.6647}, {.6542}}, 62.02840354726771, .9767724586444169},
        Case{two_tanks(), tank_theta(), Matrix{{.01}, {.9903}}, 5.914486526340579,
             .9884846719597846}}) {
    const GainCertificate found = norm(c.model, c.theta, c.L);
    CHECK(found.norm_lower <= c.expected * (1 + 1e-9));
    CHECK(found.norm_upper >= c.expected * (1 - 1e-9));
    CHECK(found.norm_upper - found.norm_lower <= 2e-9 * c.expected);
    CHECK(found.spectral_radius == doctest::Approx(c.radius).epsilon(1e-9));
  }
}

TEST_CASE("the least widths of disturbances of any size") {
  for (const double w : {1., std::exp2(-30), std::exp2(-300), std::exp2(200)}) {
    for (const double unit : {1., std::exp2(40), std::exp2(-40)}) {
      // h(L) = (w + 8 w |L|) / (1/4 + L) for -1/4 < L ≤ 3/4: least at 0
      Model model = with_unit_boxes(Matrix{{.75}}, Matrix(1, 0), Matrix{{unit}}, w, 8 * w * unit);
      const GainDesign far = design(model, {});
      REQUIRE(far.feasible == Answer::yes);
      CHECK(std::abs(far.gain.L(0, 0) * unit) < 1e-9);
      CHECK(far.gain.certificate.optimum / w == doctest::Approx(4).epsilon(1e-9));
      CHECK(far.gain.certificate.optimum_bound / w == doctest::Approx(4).epsilon(1e-9));
      // the output is next to useless, and w small beside its noise
      model.linear.Dv = Matrix{{1e9 * w * unit}};
      const GainDesign useless = design(model, {});
      REQUIRE(useless.feasible == Answer::yes);
      CHECK(std::abs(useless.gain.L(0, 0) * unit) < 1e-12);
      CHECK(useless.gain.certificate.optimum / w == doctest::Approx(4).epsilon(1e-6));
    }
  }
}

TEST_CASE("a plant so slow that the solver takes it for an integrator") {
  const Model model = with_unit_boxes(Matrix{{.9999999}}, Matrix(1, 0), Matrix{{1}}, 1e-9, 1);
  const GainDesign slow = design(model, {});  // h(0) = 1e-9 / 1e-7
  REQUIRE(slow.feasible == Answer::yes);
  CHECK(slow.gain.certificate.optimum <= .01 * (1 + 1e-6));
  CHECK(slow.gain.certificate.optimum_bound <= .01 * (1 + 1e-6));
}

TEST_CASE("no monotone gain: proven, and why") {
  const GainDesign found = design(three_states(-.1), Matrix(Matrix::Identity(3, 3)));
  CHECK(found.feasible == Answer::no);
  CHECK(found.reason == "no monotone gain exists: column 2 of C is zero and A(1,2) < 0");
  CHECK_FALSE(found.suggestion.empty());
}

TEST_CASE("the uncertainty of A is used where theta is not given") {
  Model model = three_states();
  model.linear.A_radius = Matrix{{.01, 0, 0}, {.004, .003, .003}, {0, 0, .01}};
  const GainDesign found = design(model, {});
  REQUIRE(found.feasible == Answer::yes);
  CHECK(found.gain.certificate.optimum == doctest::Approx(1.98575));
  CHECK(design(three_states(), {}).gain.certificate.optimum < 1.9);
}

TEST_CASE("a theta of another height is refused, an unbounded W too") {
  const Model model = three_states();
  const auto problems =
      plugins().registry.check<GainEntry>("peak", {model}, Params().set("theta", Matrix{{1}}));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/theta");
  Model open = model;
  open.W = make_space(3);
  CHECK(design(open, {}).feasible == Answer::unknown);
}

TEST_CASE("no random monotone gain has smaller widths") {
  CHECK(rc::check("random systems with a monotone gain", [] {
    const auto random = [](Index rows, Index cols, double low, double high) {
      Matrix A(rows, cols);
      for (Index i = 0; i < A.size(); ++i)
        A(i) = low + (high - low) * (*rc::gen::inRange(0, 10'001)) * 1e-4;
      return A;
    };
    const Index n = *rc::gen::inRange(1, 4), p = *rc::gen::inRange(1, 3);
    Matrix M = random(n, n, -.2, 1).cwiseMax(0);
    M *= .9 / std::max(.9, invariant::spectral_radius(M));
    const Matrix C = random(p, n, -1, 1), L0 = random(n, p, -1, 1);
    Model model = with_unit_boxes(M + L0 * C, Matrix(n, 0), C, .1, .2);
    model.linear.Dv = random(p, 2, -.3, .3);
    model.V = make_box(cube(2, 1));
    const Matrix none(n, 0);
    const GainDesign found = design(model, {});
    RC_ASSERT(found.feasible == Answer::yes);
    RC_ASSERT((model.linear.A - found.gain.L * C).minCoeff() >=
              -1e-12);  // a single L may be left, which rounding misses
    const double best = half_widths(model, found.gain.L, none).sum();
    RC_ASSERT(best == doctest::Approx(found.gain.certificate.optimum).epsilon(1e-6));
    RC_ASSERT(found.gain.certificate.optimum_bound == doctest::Approx(best).epsilon(1e-6));
    RC_ASSERT(best <= half_widths(model, L0, none).sum() * (1 + 1e-7));
    for (int i = 0; i < 30; ++i) {
      const Matrix other = found.gain.L + random(n, p, -.2, .2);
      const Matrix loop = model.linear.A - other * C;
      if (loop.minCoeff() < 0 || invariant::spectral_radius(loop) >= 1) continue;
      RC_ASSERT(best <= half_widths(model, other, none).sum() * (1 + 1e-7));
    }
  }));
}

TEST_CASE("the gain of badly scaled states is monotone, or none is given") {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto random = [&](Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& entry : A.reshaped()) entry = 2 * unit(engine) - 1;
    return A;
  };
  int given = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 2 + trial % 3, p = 1 + trial % 2;
    Matrix closed = random(n, n).cwiseMax(0);  // monotone and stable with the gain L
    closed *= .9 / std::max(.9, closed.rowwise().sum().maxCoeff());
    Vector scale(n);
    for (double& s : scale) s = std::pow(10, 10 * unit(engine) - 5);
    const Matrix T = scale.asDiagonal(), back = scale.cwiseInverse().asDiagonal(), C = random(p, n),
                 L = random(n, p);
    Model model;
    LinearModel& m = model.linear;
    m.A = T * (closed + L * C) * back;
    m.B = Matrix(n, 0);
    m.C = C * back;
    m.D = Matrix(p, 0);
    m.Bw = T;
    m.Dv = .1 * Matrix::Identity(p, p);
    model.X0 = model.W = make_box(cube(n, 1));
    model.V = make_box(cube(p, 1));
    model.U = make_space(0);
    const GainDesign found = design(model, Matrix(.1 * T));
    if (found.feasible != Answer::yes) continue;
    ++given;
    const Matrix& K = found.gain.L;
    const Matrix left = m.A - K * m.C, terms = m.A.cwiseAbs() + K.cwiseAbs() * m.C.cwiseAbs();
    CHECK((left.array() >= -1e-12 * terms.array()).all());
  }
  CHECK(given > 150);
}

TEST_CASE("a system without outputs has a gain without columns") {
  Model model = three_states();
  LinearModel& m = model.linear;
  m.A = .5 * m.A.cwiseAbs() / m.A.cwiseAbs().rowwise().sum().maxCoeff();
  m.C = Matrix(0, 3);
  m.D = Matrix(0, m.inputs());
  m.Dv = Matrix(0, 0);
  model.V = make_point(Vector(0));
  for (const char* type : {"h_infinity", "h_infinity_monotone", "w_radius", "peak", "kalman"}) {
    CAPTURE(type);
    const GainDesign found = plugins().registry.make<GainEntry>(type, {})->design(model);
    CHECK(found.feasible == Answer::yes);
    CHECK(found.gain.L.rows() == 3);
    CHECK(found.gain.L.cols() == 0);
  }
}
