// SPDX-License-Identifier: GPL-3.0-or-later
// Offline conditions of random banks: their sets against simulation.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "banks.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "diagnosers/observer_bank/fdi_conditions.hpp"

using namespace fdi_test;
using Invariant = OfflineOptions::Invariant;

namespace {

/// A mode of a random bank: stable plants, with a gain that keeps A - L C stable.
struct Random {
  ModeBank bank;
  std::vector<Matrix> gains;
};

Matrix draw_matrix(Draw& draw, Index rows, Index cols, double size) {
  Matrix M(rows, cols);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < cols; ++j) M(i, j) = size * draw();
  }
  return M;
}

enum class Differ { inputs, sensors, models, ranges };

Random random_bank(Index modes, Index n, Index p, Index q, Differ what, unsigned seed) {
  Draw draw{std::mt19937_64(seed)};
  const double size = .7 / static_cast<double>(n);
  const Matrix A = draw_matrix(draw, n, n, size) + .3 * Matrix::Identity(n, n),
               B = draw_matrix(draw, n, p, 1), C = draw_matrix(draw, q, n, 1),
               L = draw_matrix(draw, n, q, .2 / static_cast<double>(n * q));
  Random random;
  for (Index i = 0; i < modes; ++i) {
    Model model = model_of(A, B, C);
    model.linear.D = draw_matrix(draw, q, p, .3);
    model.X0 = box_around(Vector::Zero(n), Vector::Constant(n, .3));
    model.W = box_around(draw_matrix(draw, n, 1, .05), Vector::Constant(n, .02));
    model.V = box_around(draw_matrix(draw, q, 1, .05), Vector::Constant(q, .03));
    model.U = box_around(Vector::Constant(p, 1), Vector::Constant(p, .4));
    Vector lower(p), upper(p);
    for (Index k = 0; k < p; ++k) {
      lower[k] = .4 + .3 * draw();
      upper[k] = lower[k] + .1 * (1 + draw());
    }
    model.linear.actuator = {lower, upper};
    if (what == Differ::sensors) model.linear.C *= 1 - .1 * static_cast<double>(i);
    if (what == Differ::models)
      model.linear.A += draw_matrix(draw, n, n, .1 / static_cast<double>(n));
    if (what == Differ::ranges)
      model.linear.sensor = {Vector::Constant(q, .8), Vector::Constant(q, .9)};
    random.bank.modes.push_back({mode_name(i), model});
    random.gains.push_back(L + draw_matrix(draw, n, q, .02));
  }
  return random;
}

/// How far x lies beyond the box, relative to its width.
double beyond(const Box& box, const Vector& x) {
  const Vector width = box.radius();
  return std::max(((x - box.upper).array() / width.array()).maxCoeff(),
                  ((box.lower - x).array() / width.array()).maxCoeff());
}

/// Residuals in the steady state of each mode stay in R̊_ij; where `tight`, that is not larger by an
/// order of magnitude. (Vertices drawn at random rarely line up.)
void check_by_sampling(const Random& random, const OfflineOptions& options, bool tight) {
  const Guarantees all = fdi_guarantees(random.bank, random.gains, options);
  const Index modes = random.bank.size();
  for (Index i = 0; i < modes; ++i) {
    for (const bool vertex : {false, true}) {
      Simulation simulation(random.bank, random.gains,
                            Draw{std::mt19937_64(static_cast<unsigned>(7 + i)), vertex});
      std::vector<double> reached(static_cast<std::size_t>(modes), -2);
      for (int k = 0; k < 2000; ++k) {
        const std::vector<Vector> residuals = simulation.step(i);
        if (k < 100) continue;
        for (Index j = 0; j < modes; ++j) {
          double& far = reached[static_cast<std::size_t>(j)];
          far = std::max(
              far, beyond(pair(all, i, j, modes).residual, residuals[static_cast<std::size_t>(j)]));
        }
      }
      for (Index j = 0; j < modes; ++j) {
        CAPTURE(i);
        CAPTURE(j);
        CHECK(reached[static_cast<std::size_t>(j)] <= 1e-9);
        if (tight && vertex) CHECK(reached[static_cast<std::size_t>(j)] >= -.9);
      }
    }
  }
}

/// Errors of points of all observers stay in the error set while modes switch at random.
void check_errors_by_sampling(const Random& random, const OfflineOptions& options) {
  const ErrorSetCheck check = check_error_set(random.bank, random.gains, options);
  CHECK(check.computed);
  CHECK(check.factor <= 1);
  CHECK(check.factor > .999);
  CHECK(check.steady_factor <= check.factor + 1e-12);
  const Box box = interval_hull(check.set);
  const Index modes = random.bank.size();
  for (unsigned seed = 0; seed < 20; ++seed) {
    Draw draw{std::mt19937_64(seed), seed % 2 == 0};
    Simulation simulation(random.bank, random.gains, draw, true);
    Index mode = 0;
    double reached = -2;
    for (int k = 0; k < 300; ++k) {
      if (draw.engine() % 10 == 0)
        mode = static_cast<Index>(draw.engine() % static_cast<unsigned>(modes));
      for (Index j = 0; j < modes; ++j)
        reached = std::max(reached, beyond(box, simulation.error(j)));
      simulation.step(mode);
    }
    CHECK(reached <= 1e-9);
  }
}

}  // namespace

TEST_CASE("simulated residuals and errors stay in their sets") {
  for (const Differ what : {Differ::inputs, Differ::sensors, Differ::models, Differ::ranges}) {
    CAPTURE(static_cast<int>(what));
    Random random = random_bank(3, 2, 2, 2, what, 11);
    OfflineOptions options;
    if (what == Differ::models) {
      const auto missing = check_offline(random.bank, random.gains, {});
      REQUIRE(missing.size() == 1);
      CHECK(missing[0].pointer == "/state_set");
      options.state_set = box_around(Vector::Zero(2), Vector::Constant(2, 10));
      for (Mode& mode : random.bank.modes)
        REQUIRE(mode.model.linear.A.cwiseAbs().rowwise().sum().maxCoeff() < 1);
    }
    check_by_sampling(random, options, true);
    options.separate_inputs = true;
    check_by_sampling(random, options, true);
    options.separate_inputs = false;
    options.invariant = Invariant::rpi;
    check_by_sampling(random, options, false);
    options.iterations = {20};
    options.max_columns = 30;
    check_by_sampling(random, options, false);
    for (Index j = 1; j < 3; ++j)
      random.bank.modes[static_cast<std::size_t>(j)].model.X0 = make_point(Vector::Constant(2, .1));
    check_errors_by_sampling(random, options);
  }
}

TEST_CASE("equal gains and no transient: R̊_ij = -R̊_ji") {
  for (const bool separate : {false, true}) {
    OfflineOptions options;
    options.separate_inputs = separate;
    Random random = random_bank(3, 3, 2, 1, Differ::inputs, 4);
    for (Index j = 0; j < 3; ++j) {
      random.gains[static_cast<std::size_t>(j)] = random.gains[0];
      random.bank.modes[static_cast<std::size_t>(j)].model.linear.D = random.bank[0].model.linear.D;
    }
    const Guarantees all = fdi_guarantees(random.bank, random.gains, options);
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        const Box &a = pair(all, i, j).residual, &b = pair(all, j, i).residual;
        CHECK(a.lower[0] == doctest::Approx(-b.upper[0]).epsilon(1e-8));
        CHECK(pair(all, i, i).holds == Answer::yes);
      }
    }
  }
}

TEST_CASE("error sets of other shapes") {
  Random random = random_bank(2, 3, 1, 2, Differ::inputs, 8);
  const ErrorSetCheck computed = check_error_set(random.bank, random.gains, {});
  const Box box = interval_hull(computed.set);
  OfflineOptions options;
  const Matrix widths = box.radius().asDiagonal();
  Matrix more(3, 4);
  more << .9 * widths, .1 * box.radius();  // not larger than the box, not a box
  options.error_set = make_zonotope(box.center(), more);
  const ErrorSetCheck zonotope = check_error_set(random.bank, random.gains, options);
  CHECK(zonotope.factor >= computed.factor);
  CHECK(zonotope.factor < 1.3);
  options.error_set = make_zonotope(box.center(), 2 * more);
  CHECK(check_error_set(random.bank, random.gains, options).factor ==
        doctest::Approx(zonotope.factor / 2));
  options.error_set = make_zonotope(box.center(), Matrix(more.leftCols(2)));
  CHECK(std::isinf(check_error_set(random.bank, random.gains, options).factor));
  CHECK(check_offline(random.bank, random.gains, options).at(0).message.find("flat") !=
        std::string::npos);
  // many generators in many dimensions: facets are not enumerated, the bound stays one
  Random large = random_bank(2, 8, 1, 1, Differ::inputs, 9);
  const ErrorSetCheck around = check_error_set(large.bank, large.gains, {});
  Matrix many(8, 40);
  Draw draw{std::mt19937_64(2)};
  many << 1.2 * around.set.G, draw_matrix(draw, 8, 32, .01);
  options.error_set = make_zonotope(around.set.c, many);
  const double factor = check_error_set(large.bank, large.gains, options).factor;
  CHECK(factor <= 1 / 1.19);
  CHECK(factor > .2);
}

TEST_CASE("ranges of sensors that are too wide for a bounded error are refused") {
  Random random = random_bank(2, 1, 1, 1, Differ::ranges, 3);
  for (Mode& mode : random.bank.modes) {
    mode.model.linear.A = Matrix{{.9}};
    mode.model.linear.C = Matrix{{1}};
    mode.model.linear.sensor = {Vector{{0}}, Vector{{1}}};
  }
  random.gains.assign(2, Matrix{{1.6}});  // A - L C̄ = .1, K = .5 · 1.6 / .9
  CHECK(check_offline(random.bank, random.gains, {}).empty());
  random.gains.assign(2, Matrix{{3.2}});  // A - L C̄ = -.7, K = .5 · 3.2 / .3
  const auto found = check_offline(random.bank, random.gains, {});
  REQUIRE(found.size() == 1);
  CHECK(found[0].message.find("too wide") != std::string::npos);
}
