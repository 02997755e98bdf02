// SPDX-License-Identifier: GPL-3.0-or-later
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/tubes/output_tube.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using namespace cordon::designers;
using examples::backend;
using examples::numbers;
using examples::random_model;

namespace {

void check_hull(const Box& hull, const Vector& lower, const Vector& upper) {
  REQUIRE(hull.dim() == lower.size());
  CHECK((hull.lower - lower).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((hull.upper - upper).cwiseAbs().maxCoeff() < 1e-9);
}

struct Expected {
  Vector lower, upper;
};

/// A random output sequence of a model without E, by its own recursion.
Vector simulated(const Model& model, const Vector& u, Index N, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&](const LineForm& X) {
    Vector xi(X.generators());
    for (double& entry : xi) entry = uniform(random);
    return Vector(X.c + X.G * xi);
  };
  const LinearModel& m = model.linear;
  Vector x = draw(model.X0), y(m.outputs() * (N + 1));
  for (Index k = 0; k <= N; ++k) {
    const Vector now = u.segment(k * m.inputs(), m.inputs());
    y.segment(k * m.outputs(), m.outputs()) = m.C * x + m.D * now + m.Dv * draw(model.V);
    x = m.A * x + m.B * now + m.Bw * draw(model.W);
  }
  return y;
}

}  // namespace

TEST_CASE("The tubes of four descriptor models have the published hulls") {
  const ModeBank bank = examples::four_descriptor_models();
  const auto hull = [&](Index mode, const Vector& u) {
    return interval_hull(output_tube(bank[mode].model, *backend("line_zonotope"), {3}).at(u));
  };
  const Expected by_lines[] = {
      {numbers({-1.46, -.79, -4.3464, 7.657145}), numbers({1.46, 2.54, -.7459, 11.46462})},
      {numbers({-1.46, -.965, -4.3929, 5.92552}), numbers({1.46, 2.965, .1631, 10.36322})},
      {numbers({-1.51, -.89, -4.5414, 6.765575}), numbers({1.37, 2.364, -1.0131, 10.50446})},
      {numbers({-1.495, -.7935, -4.719465, 8.01464975}),
       numbers({1.545, 2.706, -.93394, 12.0184985})}};
  const Expected by_reference[] = {
      {numbers({-1.46, -.79, -.4065, -.173425}), numbers({1.46, 2.54, 3.194, 3.63405})},
      {numbers({-1.46, -.965, -.453, .0649}), numbers({1.46, 2.965, 4.103, 4.5026})},
      {numbers({-1.51, -.89, -.6015, -.458675}), numbers({1.37, 2.364, 2.9268, 3.28021})},
      {numbers({-1.495, -.7935, -.385575, -.13822125}),
       numbers({1.545, 2.706, 3.39995, 3.8656275})}};
  for (Index mode = 0; mode < bank.size(); ++mode) {
    check_hull(hull(mode, examples::published_line_input()), by_lines[mode].lower,
               by_lines[mode].upper);
    check_hull(hull(mode, examples::reference_input()), by_reference[mode].lower,
               by_reference[mode].upper);
  }
}

TEST_CASE("The last output alone is the last part of the tube") {
  const ModeBank bank = examples::four_descriptor_models();
  const Vector u = examples::published_line_input();
  for (const Mode& mode : bank.modes) {
    const Box all = interval_hull(output_tube(mode.model, *backend("line_zonotope"), {3}).at(u));
    const OutputTube tube = output_tube(mode.model, *backend("line_zonotope"), {3, true});
    CHECK(tube.outputs() == 1);
    check_hull(interval_hull(tube.at(u)), all.lower.tail(1), all.upper.tail(1));
  }
}

TEST_CASE("A tube holds what its model can show, and little else") {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Model model = random_model(random);
    const Index N = trial % 4;
    Vector u(2 * (N + 1));
    for (double& entry : u) entry = std::uniform_real_distribution<double>(-1, 1)(random);
    for (const char* name : {"line_zonotope", "zonotope", "constrained_zonotope"}) {
      const LineForm tube = output_tube(model, *backend(name), {N}).at(u);
      for (int run = 0; run < 5; ++run)
        CHECK(contains(tube, simulated(model, u, N, random)) == Answer::yes);
    }
    // The support in a direction is that of a zonotope, whose generators are the responses to each
    // factor.
    const OutputTube tube = output_tube(model, *backend("zonotope"), {N});
    Vector d(tube.outputs());
    for (double& entry : d) entry = std::uniform_real_distribution<double>(-1, 1)(random);
    const LinearModel& m = model.linear;
    double expected = 0;
    for (Index k = 0; k <= N; ++k) {
      const Vector part = d.segment(2 * k, 2);
      expected += part.dot(m.D * u.segment(2 * k, 2)) + part.dot(m.Dv * model.V.c) +
                  (model.V.G.transpose() * m.Dv.transpose() * part).lpNorm<1>();
    }
    // adjoint recursion: λ_N = Cᵀ d_N, λ_k = Cᵀ d_k + Aᵀ λ_{k+1}
    Vector lambda = m.C.transpose() * d.segment(2 * N, 2);
    for (Index k = N - 1; k >= 0; --k) {
      expected += lambda.dot(m.B * u.segment(2 * k, 2) + m.Bw * model.W.c) +
                  (model.W.G.transpose() * m.Bw.transpose() * lambda).lpNorm<1>();
      lambda = m.C.transpose() * d.segment(2 * k, 2) + m.A.transpose() * lambda;
    }
    expected += lambda.dot(model.X0.c) + (model.X0.G.transpose() * lambda).lpNorm<1>();
    CHECK(support(tube.at(u), d) == doctest::Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("E = I, and a regular E, are no special case") {
  std::mt19937 random(2);
  for (int trial = 0; trial < 10; ++trial) {
    Model plain = random_model(random), other = plain;
    const Matrix E = Matrix::Identity(3, 3) * 2 + Matrix::NullaryExpr(3, 3, [&] {
                       return std::uniform_real_distribution<double>(-.5, .5)(random);
                     });
    other.linear.E = E;
    other.linear.A = E * plain.linear.A;
    other.linear.B = E * plain.linear.B;
    other.linear.Bw = E * plain.linear.Bw;
    const Vector u = Vector::Ones(6);
    const OutputTube a = output_tube(plain, *backend("line_zonotope"), {2}),
                     b = output_tube(other, *backend("line_zonotope"), {2});
    CHECK(conditions_of(a).b.size() == 0);
    CHECK(conditions_of(b).b.size() == 0);  // the rows of k = N say nothing: x_{N+1} is free
    for (int direction = 0; direction < 5; ++direction) {
      const Vector d = Vector::NullaryExpr(
          6, [&] { return std::uniform_real_distribution<double>(-1, 1)(random); });
      CHECK(support(a.at(u), d) == doctest::Approx(support(b.at(u), d)).epsilon(1e-8));
    }
  }
}

TEST_CASE("Constraints of the sets stand in the tube") {
  Model model = examples::three_scalar_models()[0].model;
  // X0 = {(ξ1 + ξ2) : ξ1 = ξ2} = [-2, 2] cut to ξ1 + 3 ξ2 = 2: the point 1
  model.X0 = {Matrix(1, 0), (Matrix(1, 2) << 1, 1).finished(),        Vector::Zero(1),
              Matrix(2, 0), (Matrix(2, 2) << 1, -1, 1, 3).finished(), numbers({0, 2})};
  const Box hull =
      interval_hull(output_tube(model, *backend("constrained_zonotope"), {1}).at(Vector::Zero(2)));
  check_hull(hull, numbers({.9, .8}), numbers({1.1, 1.2}));
}

TEST_CASE("An unbounded start leaves lines in the tube, bounded where outputs differ") {
  const ModeBank bank = examples::three_scalar_models();
  const OutputTube tube = output_tube(bank[0].model, *backend("line_zonotope"), {2});
  CHECK(is_bounded(tube.at(Vector::Zero(3))) == Answer::no);
  // y_1 - y_0 = w_0 + v_1 - v_0 + u_0
  const Vector difference = numbers({-1, 1, 0});
  CHECK(support(tube.at(numbers({.5, 0, 0})), difference) == doctest::Approx(.8));
  CHECK(support(tube.at(numbers({.5, 0, 0})), -difference) == doctest::Approx(-.2));
  CHECK_THROWS_AS(output_tube(bank[0].model, *backend("zonotope"), {2}), Error);
}

TEST_CASE("With the published admissible set the tubes of both published inputs are empty") {
  const ModeBank bank = examples::four_descriptor_models();
  const TubeSpan span{3, false, examples::cube(3, 1)};
  for (const Vector& u :
       {examples::published_line_input(), examples::published_constrained_input()}) {
    for (const Mode& mode : bank.modes) {
      const LineForm tube = output_tube(mode.model, *backend("constrained_zonotope"), span).at(u);
      CAPTURE(mode.name);
      CHECK(is_empty(tube) == Answer::yes);
      CHECK(exact::is_empty(tube) == Answer::yes);
    }
  }
  // What E determines is not restricted, and a set that is wide in the rest changes nothing: hulls
  // are those without it.
  const LineForm wide =
      output_tube(bank[0].model, *backend("constrained_zonotope"),
                  {3, false, make_box({numbers({-.01, -.01, -1000}), numbers({.01, .01, 1000})})})
          .at(examples::published_line_input());
  check_hull(interval_hull(wide), numbers({-1.46, -.79, -4.3464, 7.657145}),
             numbers({1.46, 2.54, -.7459, 11.46462}));
}

TEST_CASE("Conditions tell for which inputs a tube is empty") {
  // 0 = -x1 + x2 + u + w: with x2 of the start in 1 ± 1, u must not be large.
  Model model;
  model.linear.E = examples::diagonal({1, 0});
  model.linear.A = (Matrix(2, 2) << .5, 0, -1, 1).finished();
  model.linear.B = (Matrix(2, 1) << 1, 1).finished();
  model.linear.Bw = (Matrix(2, 1) << 0, 1).finished();
  model.linear.C = (Matrix(1, 2) << 1, 0).finished();
  model.linear.D = Matrix::Zero(1, 1);
  model.linear.Dv = Matrix::Ones(1, 1);
  model.X0 = make_zonotope(numbers({0, 1}), Matrix::Identity(2, 2));
  model.W = model.V = examples::cube(1, .5);
  const TubeConditions rows = conditions_of(output_tube(model, *backend("line_zonotope"), {2}));
  REQUIRE(rows.b.size() == 1);
  for (const double u0 : {0.0, 1.4, -3.4, 1.6, -3.6}) {
    const Vector u = numbers({u0, 5, -5});
    const double reach = rows.A.row(0).lpNorm<1>(),
                 needed = std::abs(rows.b[0] + rows.Omega.row(0).dot(u));
    CHECK((needed <= reach) == (std::abs(u0 + 1) < 2.5));
  }
}
