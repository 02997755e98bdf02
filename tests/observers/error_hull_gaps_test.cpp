// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes around all errors where outputs are missing at random: held against sums over all columns,
// of which none is ever left out, on plants that turn, are scaled badly or are unstable.
#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "observers/noisy_runs.hpp"
#include "published/gain_plants.hpp"

using namespace cordon;
using gain_plants::plugins;
using namespace noisy_runs;

namespace {

/// Of twelve or six states, which three outputs show.
struct Dynamics {
  std::string name;
  Matrix A;
  double scale = 1;  ///< of states, from 1/scale to scale
};

Matrix random_matrix(Index n, double radius, std::uint64_t seed) {
  sets::Random random(seed);
  const Matrix A = Matrix::NullaryExpr(n, n, [&] { return random.between(-1, 1); });
  return A * (radius / linalg::eigenvalues(A).cwiseAbs().maxCoeff());
}

/// Rotations by .3, .6, … that keep `radius`, in turned coordinates.
Matrix rotations(Index n, double radius) {
  Matrix A = Matrix::Zero(n, n);
  for (Index i = 0; i < n; i += 2) {
    const double angle = .15 * static_cast<double>(i + 2), c = std::cos(angle), s = std::sin(angle);
    A.block(i, i, 2, 2) << c, -s, s, c;
  }
  const Matrix Q = linalg::orthogonal_axes(random_matrix(n, 1, 11));
  return radius * Q * A * Q.transpose();
}

Model model_of(const Dynamics& plant) {
  const Index n = plant.A.rows(), p = 3;
  sets::Random random(5);
  Vector scale(n);
  for (Index i = 0; i < n; ++i) scale[i] = std::pow(plant.scale, random.between(-1, 1));
  Model model;
  LinearModel& m = model.linear;
  m.A = scale.asDiagonal() * plant.A * scale.cwiseInverse().asDiagonal();
  m.B = Matrix(n, 0);
  m.C = Matrix::NullaryExpr(p, n, [&] { return random.between(-1, 1); }) *
        scale.cwiseInverse().asDiagonal();
  m.D = Matrix(p, 0);
  m.Bw = .1 * Matrix(scale.asDiagonal());
  m.Dv = .2 * Matrix::Identity(p, p);
  model.X0 = make_box({-scale, scale});
  model.W = make_box({Vector::Constant(n, -1), Vector::Constant(n, 1)});
  model.V = make_box({Vector::Constant(p, -1), Vector::Constant(p, 1)});
  return model;
}

std::vector<Dynamics> plants() {
  return {{"stable", random_matrix(12, .9, 1)},
          {"close to the unit circle", random_matrix(12, .97, 2)},
          {"rotations", rotations(12, .98)},
          {"badly scaled", random_matrix(12, .9, 3), 1e5},
          {"unstable", random_matrix(6, 1.02, 4)}};
}

Matrix joined(const Matrix& A, const Matrix& B) {
  Matrix both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

/// e⁺ = M e + D d of the errors for these outputs; at the first sample, e = start e_0 + noise d.
struct Loop {
  Loop(const LinearModel& m, const Matrix& gain, const std::vector<Index>& present, bool current) {
    const Matrix L = gain(Eigen::all, present), C = m.C(present, Eigen::all),
                 F = m.Dv(present, Eigen::all);
    start = Matrix::Identity(m.states(), m.states()) - L * C;
    M = current ? Matrix(start * m.A) : Matrix(m.A - L * C);
    noise = -L * F;
    D = joined(current ? Matrix(start * m.Bw) : m.Bw, noise);
  }
  Matrix start, M, noise, D;
};

Params measured(bool current) {
  return Params().set("measurement", std::string(current ? "current" : "previous"));
}

std::shared_ptr<Observer> made(const Model& model, bool current) {
  return plugins().observer("error_hull", model, plugins().backend("interval"), measured(current));
}

Vector half_widths(const Enclosure& X) {
  const Box box = X->interval_hull();
  return (box.upper - box.lower) / 2;
}

Sample with_lost_outputs(Sample sample, double share, Run& run) {
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (run.unit() > share) continue;
    sample.y[i] = std::numeric_limits<double>::quiet_NaN();
    sample.missing.push_back(i);
  }
  return sample;
}

/// Of half widths to those of all columns, and whether the truth was ever lost.
struct Found {
  double least = infinity, largest = 0, mean = 0;
  bool inside = true;
};

Found found(const Dynamics& plant, bool current, double share, Index steps) {
  const Model model = model_of(plant);
  const auto observer = made(model, current);
  const Matrix L = observer->gains()[0].L;
  Run run(model, 9, true);
  Matrix all = model.X0.G;
  std::vector<Index> before;
  Found now;
  for (Index k = 0; k < steps; ++k) {
    const Sample sample = with_lost_outputs(run.sample(k), share, run);
    const std::vector<Index> present = present_outputs(sample);
    const Loop loop(model.linear, L, current ? present : before, current);
    if (k > 0) all = joined(linalg::product(loop.M, all), loop.D);
    if (k == 0 && current) all = joined(loop.start * all, loop.noise);
    before = present;
    const Enclosure X = observer->step(sample).set;
    const Vector ratio = half_widths(X).cwiseQuotient(Vector(all.cwiseAbs().rowwise().sum()));
    now.least = std::min(now.least, ratio.minCoeff());
    now.largest = std::max(now.largest, ratio.maxCoeff());
    now.mean += ratio.mean() / static_cast<double>(steps);
    now.inside = now.inside && holds(X, run.x);
    run.move_on();
  }
  return now;
}

}  // namespace

TEST_CASE("widths with outputs missing at random stay close to those of all columns") {
  for (const Dynamics& plant : plants()) {
    for (const bool current : {true, false}) {
      for (const double share : {.1, .3}) {
        CAPTURE(plant.name);
        CAPTURE(current);
        CAPTURE(share);
        const Found now = found(plant, current, share, 400);
        CHECK(now.least > 1 - 1e-12);
        CHECK(now.mean < 1.01);
        CHECK(now.largest < 1.15);
        CHECK(now.inside);
      }
    }
  }
}

TEST_CASE("the truth stays inside, whichever outputs are missing") {
  for (const Dynamics& plant : plants()) {
    CAPTURE(plant.name);
    const Model model = model_of(plant);
    for (const bool current : {true, false}) {
      CAPTURE(current);
      const auto observer = made(model, current);
      for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        Run run(model, seed, seed % 3 != 0);
        observer->start();
        bool inside = true;
        for (Index k = 0; k < 120; ++k) {
          const double share = seed % 2 == 0 ? .4 : (k / 15) % 2 == 0 ? .05 : .9;
          const Sample sample = with_lost_outputs(run.sample(k), share, run);
          inside = inside && holds(observer->step(sample).set, run.x);
          run.move_on();
        }
        CHECK(inside);
      }
    }
  }
}

TEST_CASE("errors that outgrow all numbers are told as such") {
  const Dynamics unstable{"unstable", random_matrix(6, 1.1, 4)};
  const Model model = model_of(unstable);
  for (const bool current : {true, false}) {
    CAPTURE(current);
    const auto observer = made(model, current);
    Sample sample{0, Vector(0), Vector::Zero(3)};
    observer->step(sample);
    const auto lose_all = [&] {
      for (Index k = 1; k < 20'000; ++k) {
        sample.k = k;
        sample.y.setConstant(std::numeric_limits<double>::quiet_NaN());
        sample.missing = {0, 1, 2};
        observer->step(sample);
      }
    };
    CHECK_THROWS_WITH_AS(lose_all(), doctest::Contains("beyond all numbers"), Error);
    observer->start();
    CHECK(half_widths(observer->step({0, Vector(0), Vector::Zero(3)}).set).allFinite());
  }
}

TEST_CASE("after gaps widths are again what they are without, also after long complete runs") {
  for (const Dynamics& plant : plants()) {
    if (plant.name == "unstable") continue;  // its states outgrow their last digits
    CAPTURE(plant.name);
    const Model model = model_of(plant);
    for (const bool current : {true, false}) {
      CAPTURE(current);
      const auto observer = made(model, current), complete = made(model, current);
      Run run(model, 4, false);
      Vector last, expected;
      double most = 1;
      for (Index k = 0; k < 6000; ++k) {
        const Sample sample = run.sample(k);
        const bool gap = k == 3000 || k == 3001 || k == 3500;
        const Enclosure X = observer->step(gap ? with_lost_outputs(sample, 1, run) : sample).set;
        last = half_widths(X);
        expected = half_widths(complete->step(sample).set);
        most = std::max(most, last.cwiseQuotient(expected).maxCoeff());
        REQUIRE(holds(X, run.x));
        run.move_on();
      }
      CHECK(most < 20);
      CHECK((last.array() >= expected.array() * (1 - 1e-11)).all());
      CHECK((last.array() <= expected.array() * (1 + 1e-9)).all());
    }
  }
}

TEST_CASE("estimates before and after gaps are gone back to with all that was known") {
  for (const Dynamics& plant : plants()) {
    CAPTURE(plant.name);
    const Model model = model_of(plant);
    for (const bool current : {true, false}) {
      CAPTURE(current);
      const auto plain = made(model, current), again = made(model, current);
      Run run(model, 6, false);
      for (Index k = 0; k < 150; ++k) {
        CAPTURE(k);
        const Sample sample = with_lost_outputs(run.sample(k), .2, run);
        const Box expected = plain->step(sample).set->interval_hull();
        const Estimate now = again->step(sample);
        again->replace(now.set);  // its own, of the same time
        const Box found = now.set->interval_hull();
        REQUIRE(found.lower == expected.lower);
        REQUIRE(found.upper == expected.upper);
        run.move_on();
      }
    }
  }
}

TEST_CASE("looking for outliers, which goes back at every sample, changes nothing in gaps") {
  const Model model = model_of(plants()[2]);
  for (const bool current : {true, false}) {
    CAPTURE(current);
    const auto plain = made(model, current), watching = made(model, current);
    watching->leave_out_outliers(1, 50);
    Run run(model, 3, false);
    for (Index k = 0; k < 200; ++k) {
      CAPTURE(k);
      const Sample sample = with_lost_outputs(run.sample(k), .2, run);
      const Box expected = plain->step(sample).set->interval_hull(),
                found = watching->step(sample).set->interval_hull();
      CHECK(found.lower == expected.lower);
      CHECK(found.upper == expected.upper);
      run.move_on();
    }
  }
}
