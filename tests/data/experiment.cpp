// SPDX-License-Identifier: GPL-3.0-or-later
// Experiments with one mode of a bank.
#include "study/data/experiment.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "data/published.hpp"
#include "data/records.hpp"
#include "data/two_states.hpp"

using namespace cordon;
using namespace data_test;
using detail::open_experiment;

namespace {

std::vector<Record> run(const Study& study, Index mode, const Matrix& u,
                        std::uint64_t seed_offset = 0) {
  return all(*open_experiment(study, bank_of(study), mode, u, seed_offset));
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

}  // namespace

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
