// SPDX-License-Identifier: GPL-3.0-or-later
// Starts that are drawn from a set, and experiments with one mode of a bank.
#include "study/data/experiment.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "data/published.hpp"
#include "data/records.hpp"
#include "study/data/simulate.hpp"

using namespace cordon;
using namespace data_test;
using detail::open_experiment;

namespace {

LineForm box(Vector lower, Vector upper) { return make_box({std::move(lower), std::move(upper)}); }
LineForm unit_box(Index n) { return box(-Vector::Ones(n), Vector::Ones(n)); }

Model two_states() {
  Model model;
  model.linear.A = Matrix{{.9, .1}, {0, .8}};
  model.linear.B = Matrix{{0.}, {1.}};
  model.linear.Bw = Matrix::Identity(2, 2);
  model.linear.C = Matrix{{1., 0.}};
  model.linear.D = Matrix{{.5}};
  model.linear.Dv = Matrix{{.5}};
  model.X0 = box(Vector{{1., -3.}}, Vector{{2., 5.}});
  model.W = unit_box(2);
  model.V = unit_box(1);
  return model;
}

/// Mode 1 has another A, C and D, and an X0 of its own.
Study study_of(SimulateSpec spec = {}) {
  Study study;
  study.file = "study.json";
  study.model = two_states();
  Model weak = two_states();
  weak.linear.A = Matrix{{.5, .2}, {.1, .4}};
  weak.linear.C = Matrix{{.5, 1.}};
  weak.linear.D = Matrix{{.25}};
  weak.X0 = box(Vector{{-7., 6.}}, Vector{{-6., 7.}});
  study.modes = {{"weak", weak}};
  study.data = std::move(spec);
  return study;
}

Study descriptor_study(LineForm x0_set) {
  Study study;
  study.file = "study.json";
  study.model = published::descriptor_model();
  SimulateSpec spec;
  spec.x0_set = std::move(x0_set);
  spec.steps = 5;
  spec.input = published::descriptor_input();
  study.data = std::move(spec);
  return study;
}

std::vector<Record> run(const Study& study, Index mode, const Matrix& u,
                        std::uint64_t seed_offset = 0) {
  return all(*open_experiment(study, bank_of(study), mode, u, seed_offset));
}

bool same(const std::vector<Record>& a, const std::vector<Record>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Record& p, const Record& q) {
    return p.sample.k == q.sample.k && p.sample.u == q.sample.u && p.sample.y == q.sample.y &&
           *p.truth == *q.truth && p.mode == q.mode;
  });
}

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

InputError error_of(const Study& study, Index mode, const Matrix& u) {
  try {
    run(study, mode, u);
  } catch (const InputError& error) {
    return error;
  }
  FAIL("no error");
  return InputError("", {});
}

const Matrix pulses{{1.}, {-2.}, {0.}, {3.}};

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

TEST_CASE("an experiment follows the model of its mode") {
  const Study study = study_of();
  for (const Index mode : {0, 1}) {
    const LinearModel model = bank_of(study)[mode].model.linear;
    const auto records = run(study, mode, pulses);
    REQUIRE(records.size() == 4);
    for (std::size_t k = 0; k < 4; ++k) {
      const Record& record = records[k];
      CHECK(record.sample.k == static_cast<Index>(k));
      CHECK(record.sample.u == Vector(pulses.row(static_cast<Index>(k))));
      CHECK(record.mode == mode);
      const Vector v = (record.sample.y - model.C * *record.truth - model.D * record.sample.u) / .5;
      CHECK(v.cwiseAbs().maxCoeff() <= 1 + 1e-9);
      if (k == 3) break;
      const Vector w = *records[k + 1].truth - model.A * *record.truth - model.B * record.sample.u;
      CHECK(w.cwiseAbs().maxCoeff() <= 1 + 1e-9);
    }
  }
  CHECK(open_experiment(study, bank_of(study), 1, pulses)->size() == 4);
  CHECK(run(study, 0, Matrix{{2.}}).size() == 1);
}

TEST_CASE("the static rows of the last sample hold with the last input") {
  Study study;
  study.file = "study.json";
  study.model = published::descriptor_model();
  study.model.linear.B(2, 0) = 1;
  study.model.X0.G *= 100;
  const Matrix u{{1., 0.}, {-40., 2.}, {30., 5.}};
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const auto records = run(study, 0, u, seed);
    for (const Record& record : records) {
      const Vector& x = *record.truth;
      CHECK(std::abs((-x[0] + .5 * x[1] + x[2] + record.sample.u[0]) / .6) <= 1 + 1e-12);
    }
  }
}

TEST_CASE("experiments start where the study says, else in the X0 of the mode") {
  const auto first = [](const Study& study, Index mode, std::uint64_t seed) {
    return *run(study, mode, pulses, seed)[0].truth;
  };
  const auto inside = [](const LineForm& X, const Vector& x) {
    return contains(X, x) != Answer::no;
  };
  Study study = study_of();
  std::set<double> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CHECK(inside(study.model.X0, first(study, 0, seed)));
    CHECK(inside(study.modes[0].model.X0, first(study, 1, seed)));
    seen.insert(first(study, 1, seed)[0]);
  }
  CHECK(seen.size() == 20);
  auto& spec = std::get<SimulateSpec>(study.data);
  spec.x0_set = box(Vector{{20., 30.}}, Vector{{21., 31.}});
  for (const Index mode : {0, 1}) CHECK(inside(*spec.x0_set, first(study, mode, 3)));
  spec.x0_set.reset();
  spec.x0 = Vector{{4., 5.}};
  for (const Index mode : {0, 1}) CHECK(first(study, mode, 3) == Vector{{4., 5.}});
  spec.x0.reset();
  study.modes[0].model.X0 = box(Vector{{2., -std::numeric_limits<double>::infinity()}},
                                Vector{{6., std::numeric_limits<double>::infinity()}});
  CHECK(first(study, 1, 3) == Vector{{4., 0.}});
  study.data = CsvSpec{};  // seed 1, uniform
  CHECK(same(run(study, 0, pulses), run(study_of(), 0, pulses)));
}

TEST_CASE("experiments repeat by their seed and take the noise of the study") {
  SimulateSpec spec;
  spec.seed = 5;
  const Study study = study_of(spec);
  CHECK(same(run(study, 1, pulses, 2), run(study, 1, pulses, 2)));
  CHECK_FALSE(same(run(study, 1, pulses, 2), run(study, 1, pulses, 3)));
  spec.seed = 7;
  CHECK(same(run(study, 1, pulses, 2), run(study_of(spec), 1, pulses)));
  spec.noise = Noise::vertex;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto records = run(study_of(spec), 0, pulses, seed);
    const Vector start = *records[0].truth;
    CHECK((start[0] == 1 || start[0] == 2));
    CHECK((start[1] == -3 || start[1] == 5));
    const double v = (records[0].sample.y[0] - start[0] - .5 * pulses(0, 0)) / .5;
    CHECK(std::abs(v) == doctest::Approx(1));
  }
}

TEST_CASE("experiments that cannot be simulated say which mode it is") {
  Study study = study_of();
  study.modes[0].model.W = make_space(2);
  InputError error = error_of(study, 1, pulses);
  CHECK(error.diagnostics()[0].pointer == "/system/modes/0");
  CHECK(error.diagnostics()[0].message ==
        "an experiment with mode \"weak\": cannot be simulated: unbounded");
  CHECK(run(study, 0, pulses).size() == 4);

  study = study_of();
  study.model.V = make_space(1);
  CHECK(error_of(study, 0, pulses).diagnostics()[0].pointer == "/system");

  study = study_of();
  study.modes[0].model.linear.E = Matrix{{0., 1.}, {0., 0.}};
  study.modes[0].model.linear.A = Matrix::Identity(2, 2);
  error = error_of(study, 1, pulses);
  CHECK(error.diagnostics()[0].pointer == "/system/modes/0");
  CHECK(error.diagnostics()[0].message.find("an index above 1") != std::string::npos);

  study = study_of();
  study.modes[0].model.linear.A *= 1e200;
  error = error_of(study, 1, pulses);
  CHECK(error.diagnostics()[0].pointer == "/system/modes/0");
  CHECK(error.diagnostics()[0].message.find("overflows at k = 2") != std::string::npos);

  // a start that the study gives is at fault itself
  study = descriptor_study(box(Vector{{.4, 0., 9.}}, Vector{{.6, 1., 10.}}));
  CHECK(error_of(study, 0, Matrix::Zero(2, 2)).diagnostics()[0].pointer == "/data/simulate/x0");
  auto& spec = std::get<SimulateSpec>(study.data);
  spec.x0_set.reset();
  spec.x0 = Vector{{.5, .5, 9.}};
  CHECK(error_of(study, 0, Matrix::Zero(2, 2)).diagnostics()[0].pointer == "/data/simulate/x0");
  spec.x0.reset();
  study.model.X0 = box(Vector{{.4, 0., 9.}}, Vector{{.6, 1., 10.}});
  CHECK(error_of(study, 0, Matrix::Zero(2, 2)).diagnostics()[0].pointer == "/system");
}

TEST_CASE("inputs and modes that do not fit are refused") {
  const Study study = study_of();
  const auto code_of = [&](Index mode, const Matrix& u) {
    try {
      run(study, mode, u);
    } catch (const Error& error) {
      return error.code();
    }
    return Errc::internal;
  };
  CHECK(code_of(2, pulses) == Errc::dimension);
  CHECK(code_of(-1, pulses) == Errc::dimension);
  CHECK(code_of(0, Matrix(0, 1)) == Errc::dimension);
  CHECK(code_of(0, Matrix::Zero(3, 2)) == Errc::dimension);
  CHECK(code_of(0, Matrix{{std::nan("")}}) == Errc::not_finite);
  CHECK(code_of(0, Matrix{{std::numeric_limits<double>::infinity()}}) == Errc::not_finite);
}

TEST_CASE("experiments know no additive faults, and tell so") {
  Study study = study_of();
  for (Model* model : {&study.model, &study.modes[0].model}) model->linear.F = Matrix{{1.}, {0.}};
  SimulateSpec spec;
  spec.steps = 3;
  spec.input.resize(1);
  spec.additive_faults.resize(1);
  spec.additive_faults[0].signal.offset = 5;
  study.data = spec;
  for (const Record& record : run(study, 1, pulses)) {
    REQUIRE(record.fault);
    CHECK(*record.fault == Vector{{0.}});
    CHECK(record.mode == 1);
  }
}
