// SPDX-License-Identifier: GPL-3.0-or-later
// What proves exclusions once more must never exclude a trajectory: on random linear modes of any
// kind, and on formulas. And it must not be idle: known bounds are found.
#include "study/verification/mode_trajectories.hpp"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <doctest/doctest.h>

#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"

using namespace cordon;
using verification::ModeTrajectories;

namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double operator()(double from = -1, double to = 1) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  bool one_of(int count) { return random_() % static_cast<std::uint64_t>(count) == 0; }
  Index below(Index end) { return static_cast<Index>(random_() % static_cast<std::uint64_t>(end)); }
  Matrix matrix(Index rows, Index cols, double size) {
    Matrix M(rows, cols);
    for (double& entry : M.reshaped()) entry = size * (*this)();
    return M;
  }
  /// Half of them at vertices.
  Vector point_of(const LineForm& zonotope) {
    Vector factors = matrix(zonotope.generators(), 1, 1);
    if (one_of(2)) factors = factors.array().sign();
    return zonotope.c + zonotope.G * factors;
  }

 private:
  std::mt19937_64 random_;
};

/// The sets that the proofs are asked with have room for what a simulation in doubles is off by.
Model with_room(Model model) {
  for (LineForm* set : {&model.X0, &model.W, &model.V}) set->G *= 1 + 1e-6;
  return model;
}

Model random_linear(Draw& draw) {
  Model model;
  LinearModel& m = model.linear;
  const Index n = 1 + draw.below(5), p = 1 + draw.below(2), q = 1 + draw.below(3);
  m.A = draw.matrix(n, n, 1.2 / std::sqrt(static_cast<double>(n)));
  m.B = draw.matrix(n, p, 1);
  m.Bw = draw.matrix(n, n, 1);
  m.C = draw.matrix(q, n, 1);
  m.D = draw.matrix(q, p, .3);
  m.Dv = Matrix::Identity(q, q);
  if (draw.one_of(3)) {
    m.A_radius = draw.matrix(n, n, .02).cwiseAbs();
    m.C_radius = draw.matrix(q, n, .02).cwiseAbs();
  }
  if (draw.one_of(3)) m.actuator = {Vector::Constant(p, .6), Vector::Constant(p, .8)};
  if (draw.one_of(3)) m.sensor = {Vector::Constant(q, .9), Vector::Ones(q)};
  if (draw.one_of(4) && !m.is_uncertain())
    m.E = Matrix::Identity(n, n) + draw.matrix(n, n, .3 / static_cast<double>(n));
  model.X0 = make_zonotope(draw.matrix(n, 1, 1), draw.matrix(n, n + 1, .5));
  model.W = make_zonotope(Vector::Zero(n), draw.matrix(n, n, .05));
  model.V = make_zonotope(Vector::Zero(q), draw.matrix(q, q, .1));
  return model;
}

Matrix within(Draw& draw, const Matrix& center, const Matrix& radius) {
  if (radius.size() == 0) return center;
  return center + radius.cwiseProduct(draw.matrix(center.rows(), center.cols(), 1));
}
Vector effectiveness(Draw& draw, const Box& range, Index size) {
  if (range.dim() == 0) return Vector::Ones(size);
  return range.lower + (range.upper - range.lower) * draw(0, 1);
}

/// What the proofs must not say of a true state.
void check_holds(ModeTrajectories& proofs, const Vector& x, bool with_bounds) {
  CHECK((x.array() >= proofs.hull().lower.array() - 1e-9).all());
  CHECK((x.array() <= proofs.hull().upper.array() + 1e-9).all());
  CHECK_FALSE(proofs.proves_none());
  for (Index i = 0; with_bounds && i < x.size(); ++i) {
    const double room = 1e-7 * (1 + std::abs(x[i]));
    CHECK_FALSE(proofs.proves_bound(i, 1, x[i] - room));
    CHECK_FALSE(proofs.proves_bound(i, -1, x[i] + room));
  }
}

}  // namespace

TEST_CASE("no trajectory of a random linear mode is excluded") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Draw draw(seed);
    const Model model = random_linear(draw), wide = with_room(model);
    const LinearModel& m = model.linear;
    Vector x = draw.point_of(model.X0);
    ModeTrajectories proofs(wide, draw.one_of(3) ? make_space(m.states()) : wide.X0, {});
    for (Index k = 0; k < 12; ++k) {
      const Vector u = draw.matrix(m.inputs(), 1, 2);
      const Vector driven = effectiveness(draw, m.actuator, m.inputs()).cwiseProduct(u);
      const Vector seen = within(draw, m.C, m.C_radius) * x + m.D * driven;
      Vector y = effectiveness(draw, m.sensor, m.outputs()).cwiseProduct(seen) +
                 m.Dv * draw.point_of(model.V);
      Sample sample{k, u, y};
      if (draw.one_of(4)) sample = missing_outputs(std::move(sample), {0});
      proofs.step(sample);
      check_holds(proofs, x, k % 4 == 3);
      const Vector next =
          within(draw, m.A, m.A_radius) * x + m.B * driven + m.Bw * draw.point_of(model.W);
      x = m.is_descriptor() ? Vector(m.E.fullPivLu().solve(next)) : next;
    }
  }
}

TEST_CASE("no trajectory of formulas is excluded") {
  const cordon::test::Json all = cordon::test::reference()["examples"];
  int taken = 0;
  for (const cordon::test::Json& example : all) {
    if (example["system"].contains("invariants")) continue;  // which doubles do not meet
    ++taken;
    const std::string name = example["name"];
    CAPTURE(name);
    const Model model = cordon::test::model_of(example["system"]), wide = with_room(model);
    const auto inputs = example["u"];
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(seed);
      cordon::test::Trajectory truth(model, seed);
      ModeTrajectories proofs(wide, wide.X0, {});
      for (Index k = 0; k < 8; ++k) {
        const Vector u = cordon::test::vector_of(inputs[as_size(k)]);
        proofs.step({k, u, truth.output(u, k)});
        check_holds(proofs, truth.x(), k % 3 == 2);
        truth.advance(u, k);
      }
    }
  }
  CHECK(taken >= 3);
}

TEST_CASE("bounds by rows are those that are known") {
  // x⁺ = x + w, |w| ≤ 1/4, y = x + v, |v| ≤ 1: by y = 0 the state is in [-1, 1], then by y = 3/2
  // in [1/2, 5/4], up to a rounding.
  Model model;
  LinearModel& m = model.linear;
  m.A = m.Bw = m.C = m.Dv = Matrix::Identity(1, 1);
  m.B = m.D = Matrix(1, 0);
  model.X0 = make_box({Vector{{-4.}}, Vector{{4.}}});
  model.W = make_box({Vector{{-.25}}, Vector{{.25}}});
  model.V = make_box({Vector{{-1.}}, Vector{{1.}}});
  for (const LineForm& start : {model.X0, make_space(1)}) {
    ModeTrajectories proofs(model, start, {});
    proofs.step({0, Vector(0), Vector{{0.}}});
    CHECK(proofs.proves_bound(0, 1, 1 + 1e-12));
    CHECK_FALSE(proofs.proves_bound(0, 1, 1 - 1e-9));
    proofs.step({1, Vector(0), Vector{{1.5}}});
    CHECK(proofs.proves_bound(0, 1, 1.25 + 1e-12));
    CHECK_FALSE(proofs.proves_bound(0, 1, 1.25 - 1e-9));
    CHECK(proofs.proves_bound(0, -1, .5 - 1e-12));
    CHECK_FALSE(proofs.proves_none());
    proofs.step({2, Vector(0), Vector{{2.5}}});  // x = 3/2, where both meet
    CHECK_FALSE(proofs.proves_none());
    CHECK(proofs.proves_bound(0, -1, 1.5 - 1e-12));
    CHECK(proofs.proves_bound(0, 1, 1.5 + 1e-12));
  }
  ModeTrajectories proofs(model, make_space(1), {});
  for (const auto& [k, y] : {std::pair<Index, double>{0, 0.}, {1, 1.5}, {2, 2.5 + 1e-6}})
    proofs.step({k, Vector(0), Vector{{y}}});
  CHECK(proofs.proves_none());
  ModeTrajectories nowhere(model, make_empty(1), {});
  nowhere.step({0, Vector(0), Vector{{0.}}});
  CHECK(nowhere.proves_none());
}

TEST_CASE("two states that are told apart by rows alone") {
  // x1⁺ = x1 + x2, x2⁺ = x2, y = x1 exactly, begun anywhere: y = 0, 1, 3 is none.
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{1, 1}, {0, 1}};
  m.C = Matrix{{1, 0}};
  m.B = Matrix(2, 0);
  m.D = Matrix(1, 0);
  m.Bw = Matrix(2, 0);
  m.Dv = Matrix(1, 0);
  model.W = model.V = make_point(Vector(0));
  for (const double last : {2., 2. + 1e-9, 3.}) {
    ModeTrajectories proofs(model, make_space(2), {});
    proofs.step({0, Vector(0), Vector{{0.}}});
    proofs.step({1, Vector(0), Vector{{1.}}});
    proofs.step({2, Vector(0), Vector{{last}}});
    CHECK(proofs.proves_none() == (last > 2.5));  // less is below what a solver sees
  }
}

TEST_CASE("an actuator drives all rows by the same effectiveness") {
  // x1⁺ = f u, x2⁺ = x1 - x2 + f u with f ∈ [.4, .6] and u = 1, from 0: x1 = x2 after one step.
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{0, 0}, {1, -1}};
  m.B = Matrix{{1}, {1}};
  m.C = Matrix{{1, 0}};
  m.D = Matrix::Zero(1, 1);
  m.Bw = Matrix(2, 0);
  m.Dv = Matrix(1, 0);
  m.actuator = {Vector{{.4}}, Vector{{.6}}};
  model.W = model.V = make_point(Vector(0));
  ModeTrajectories proofs(model, make_point(Vector::Zero(2)), {});
  for (Index k = 0; k < 3; ++k) proofs.step(missing_outputs({k, Vector{{1.}}, Vector{{0.}}}, {0}));
  CHECK(proofs.proves_bound(1, 1, .6 + 1e-12));
  CHECK(proofs.proves_bound(1, -1, .4 - 1e-12));
  CHECK_FALSE(proofs.proves_bound(1, 1, .6 - 1e-9));
}

TEST_CASE("that a linear model holds is told to be open where the state may leave its region") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.B = m.C = m.Dv = Matrix::Identity(1, 1);
  m.D = Matrix::Zero(1, 1);
  m.Bw = Matrix(1, 0);
  model.W = make_point(Vector(0));
  model.X0 = make_box({Vector{{-1.}}, Vector{{1.}}});
  model.V = make_box({Vector{{-.1}}, Vector{{.1}}});
  model.region = ValidRegion{{Vector{{-2.}}, Vector{{2.}}}, {Vector{{-3.}}, Vector{{3.}}}, false};
  const auto left_at = [&](const Model& of, const std::vector<double>& u) {
    ModeTrajectories proofs(of, of.X0, {});
    double x = .5;
    for (Index k = 0; k < static_cast<Index>(u.size()); ++k) {
      proofs.step({k, Vector{{u[as_size(k)]}}, Vector{{x}}});
      if (!proofs.left_region().empty()) return k;
      x = .5 * x + u[as_size(k)];
    }
    return Index{-1};
  };
  CHECK(left_at(model, {0, 0, 0, 0}) == -1);
  CHECK(left_at(model, {1, 2, 0, 0}) == 3);  // x = 2.6 at k = 2, from which the next step goes
  CHECK(left_at(model, {0, 3.5, 0, 0}) == 2);
  model.region->nonlinear_outputs = true;  // then it is used with the output
  CHECK(left_at(model, {1, 2, 0, 0}) == 2);
}
