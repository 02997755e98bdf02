// SPDX-License-Identifier: GPL-3.0-or-later
// Starts that are drawn from a set.
#include <cmath>
#include <memory>
#include <set>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "data/published.hpp"
#include "data/records.hpp"
#include "data/two_states.hpp"
#include "study/data/simulate.hpp"

using namespace cordon;
using namespace data_test;

namespace {

SimulateSpec spec_from(LineForm x0_set, Noise noise = Noise::uniform) {
  SimulateSpec spec;
  spec.x0_set = std::move(x0_set);
  spec.noise = noise;
  return spec;
}

/// The first states over the seeds 1 … count.
std::vector<Vector> starts(const Study& study, int count) {
  std::vector<Vector> found;
  for (int i = 0; i < count; ++i)
    found.push_back(*open_data(study, static_cast<std::uint64_t>(i))->next()->truth);
  return found;
}

Study data_study(LineForm x0_set, Noise noise = Noise::uniform) {
  SimulateSpec spec = spec_from(std::move(x0_set), noise);
  spec.steps = 20;
  spec.input.resize(1);
  Study study = study_of(std::move(spec));
  study.modes.clear();
  return study;
}

/// x⁺ = x / 2, y = x1.
class HalvingPlant final : public Plant {
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index, VectorIn x, VectorIn) const override { return x / 2; }
  Vector do_output(Index, VectorIn x, VectorIn) const override { return x.head(1); }
};

}  // namespace

TEST_CASE("x0 is drawn from its set by the kind of the noise") {
  const Vector lower{{-1., 2.}}, upper{{3., 2.5}};
  const LineForm set = box(lower, upper);
  Vector least = upper, most = lower;
  for (const Vector& x : starts(data_study(set), 200)) {
    CHECK((x.array() >= lower.array()).all());
    CHECK((x.array() <= upper.array()).all());
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  }
  CHECK(((least - lower).array() < .05 * (upper - lower).array()).all());
  CHECK(((upper - most).array() < .05 * (upper - lower).array()).all());
  std::set<std::pair<double, double>> corners;
  for (const Vector& x : starts(data_study(set, Noise::vertex), 50)) corners.emplace(x[0], x[1]);
  CHECK(corners == std::set<std::pair<double, double>>{{-1., 2.}, {-1., 2.5}, {3., 2.}, {3., 2.5}});
  for (const Noise still : {Noise::zero, Noise::sine}) {
    for (const Vector& x : starts(data_study(set, still), 3)) CHECK(x == Vector{{1., 2.25}});
  }
}

TEST_CASE("a drawn start takes nothing from the other sequences, and repeats") {
  const Vector x0{{1.5, 2.}};
  Study given = data_study(make_point(x0));
  const auto drawn = all(*open_data(given, 4));
  std::get<SimulateSpec>(given.data).x0_set.reset();
  std::get<SimulateSpec>(given.data).x0 = x0;
  CHECK(same(drawn, all(*open_data(given, 4))));
  CHECK_FALSE(same(drawn, all(*open_data(given, 5))));
  const Study spread = data_study(unit_box(2));
  CHECK(same(all(*open_data(spread, 4)), all(*open_data(spread, 4))));
  // w_k is the same from every start
  const auto records = all(*open_data(spread, 4));
  const Matrix& A = given.model.linear.A;
  for (std::size_t k = 0; k < 20; ++k) {
    const Vector one = *records[k + 1].truth - A * *records[k].truth,
                 other = *drawn[k + 1].truth - A * *drawn[k].truth;
    CHECK((one - other).norm() < 1e-12);
  }
}

TEST_CASE("the start is not in step with w_0") {
  Study study = data_study(unit_box(2));
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto records = all(*open_data(study, seed));
    const Vector w = *records[1].truth - study.model.linear.A * *records[0].truth;
    CHECK((w - *records[0].truth).norm() > 1e-6);
  }
}

TEST_CASE("x0 lies in a set with constraints") {
  LineForm triangle = unit_box(2);  // x1 + x2 ≤ 0, as a row with a slack
  triangle.G.conservativeResizeLike(Matrix::Zero(2, 3));
  triangle.A = Matrix{{1., 1., 1.}};
  triangle.b = Vector{{-1.}};
  triangle.S = Matrix(1, 0);
  double left = 1, right = -1;
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    for (const Vector& x : starts(data_study(triangle, noise), 100)) {
      CHECK(x.cwiseAbs().maxCoeff() <= 1 + 1e-12);
      CHECK(x.sum() <= 1e-12);
      left = std::min(left, x[0]);
      right = std::max(right, x[0]);
    }
  }
  CHECK(left < -.8);
  CHECK(right > .4);
}

TEST_CASE("starts of a descriptor system meet its static rows and lie in the set") {
  const LineForm X0 = published::descriptor_model().X0;
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    Study study = descriptor_study(X0);
    std::get<SimulateSpec>(study.data).noise = noise;
    Vector least = X0.c, most = X0.c;
    for (const Vector& x : starts(study, 200)) {
      CHECK(contains(X0, x) != Answer::no);
      const double w3 = (x[0] - .5 * x[1] - x[2]) / .6;
      CHECK(std::abs(w3) <= 1 + 1e-12);
      if (noise == Noise::vertex) CHECK(std::abs(std::abs(w3) - 1) < 1e-12);
      if (noise == Noise::vertex) CHECK(std::abs(std::abs(x[1] - .5) - 1.5) < 1e-12);
      least = least.cwiseMin(x);
      most = most.cwiseMax(x);
    }
    const Vector radius = X0.G.diagonal();
    CHECK(((X0.c - least).array() > .9 * radius.array()).head(2).all());
    CHECK(((most - X0.c).array() > .9 * radius.array()).head(2).all());
    const double share =
        noise == Noise::uniform ? .8 : .4;  // vertices in the set have |x3 - .25| ≤ .25
    CHECK(X0.c[2] - least[2] > share * radius[2]);
    CHECK(most[2] - X0.c[2] > share * radius[2]);
  }
}

TEST_CASE("w_0 stays as it was drawn where the first state lies in the set") {
  LineForm wide = published::descriptor_model().X0;
  wide.G *= 100;
  Study study = descriptor_study(wide);
  const Vector x = *open_data(study)->next()->truth;
  auto& spec = std::get<SimulateSpec>(study.data);
  detail::DrawSource draws(study.model, spec, "study.json");
  CHECK(std::abs(-x[0] + .5 * x[1] + x[2] + .6 * draws.at(0).w[2]) < 1e-12);
}

TEST_CASE("sets that no draw meets are drawn together with w_0") {
  // x3 is fixed: for almost no (x1, x2, w_0) the static row gives just that
  const LineForm flat = make_zonotope(Vector{{.5, .5, .25}}, Matrix{{.1, 0.}, {0., 1.5}, {0., 0.}});
  double least = 9, most = -9;
  for (const Vector& x : starts(descriptor_study(flat), 60)) {
    CHECK(std::abs(x[2] - .25) < 1e-12);
    CHECK(std::abs(x[0] - .5) <= .1 + 1e-12);
    CHECK(std::abs(x[1] - .5) <= 1.5 + 1e-12);
    CHECK(std::abs((x[0] - .5 * x[1] - x[2]) / .6) <= 1 + 1e-12);
    least = std::min(least, x[1]);
    most = std::max(most, x[1]);
  }
  CHECK(least < 0);
  CHECK(most > 1);
  const Study nowhere = descriptor_study(box(Vector{{.4, 0., 9.}}, Vector{{.6, 1., 10.}}));
  CHECK_THROWS_WITH_AS(
      open_data(nowhere),
      doctest::Contains(
          "/data/simulate/x0: no state of the set was found that meets the static rows"),
      InputError);
}

TEST_CASE("pairs that are drawn together heed u_0") {
  const LineForm flat = make_zonotope(Vector{{.5, .5, .25}}, Matrix{{.1, 0.}, {0., 1.5}, {0., 0.}});
  Study study = descriptor_study(flat);
  study.model.linear.B(2, 0) = 1;  // in the static row
  std::get<SimulateSpec>(study.data).input[0] = {};
  std::get<SimulateSpec>(study.data).input[0].offset = .5;
  for (const Vector& x : starts(study, 20)) {
    CHECK(contains(flat, x) != Answer::no);
    CHECK(std::abs((x[0] - .5 * x[1] - x[2] - .5) / .6) <= 1 + 1e-12);
  }
}

TEST_CASE("what no state can be drawn from is refused") {
  CHECK_THROWS_WITH_AS(open_data(data_study(make_space(2))),
                       doctest::Contains("/data/simulate/x0: cannot be simulated: unbounded"),
                       InputError);
  CHECK_THROWS_WITH_AS(open_data(data_study(unit_box(3))),
                       doctest::Contains("/data/simulate/x0: has size 3, must be 2"), InputError);
  Study both = data_study(unit_box(2));
  std::get<SimulateSpec>(both.data).x0 = Vector{{0., 0.}};
  CHECK_THROWS_WITH_AS(open_data(both), doctest::Contains("both a state and a set"), InputError);
}

TEST_CASE("a plant starts in the set too") {
  Study study = data_study(box(Vector{{1., 2.}}, Vector{{3., 4.}}));
  std::get<SimulateSpec>(study.data).made_plant = std::make_shared<HalvingPlant>();
  std::set<double> seen;
  for (const Vector& x : starts(study, 20)) {
    CHECK((x.array() >= Vector{{1., 2.}}.array()).all());
    CHECK((x.array() <= Vector{{3., 4.}}.array()).all());
    seen.insert(x[0]);
  }
  CHECK(seen.size() == 20);
}
