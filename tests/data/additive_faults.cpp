// SPDX-License-Identifier: GPL-3.0-or-later
// Simulations with additive faults.
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "data/records.hpp"
#include "data/uncertain_studies.hpp"
#include "study/data/draws.hpp"

using namespace cordon;
using namespace data_test;

namespace {

/// What n_k is by its definition.
Vector fault_at(const SimulateSpec& spec, std::int64_t k) {
  Vector n = Vector::Zero(2);
  for (const AdditiveFaultSpec& f : spec.additive_faults) {
    const double angle = f.signal.omega * static_cast<double>(k);
    if (k >= f.from && k <= f.to)
      n[f.fault] += f.signal.offset + f.signal.amplitude * std::sin(angle);
  }
  return n;
}

}  // namespace

TEST_CASE("additive faults push the state along F, and are told") {
  Model model = uncertain();
  model.linear.A_radius = model.linear.B_radius = model.linear.C_radius = Matrix();
  model.linear.F = Matrix{{1., 0.}, {-.5, 2.}};
  model.W = box(.1, 2);
  Study study = study_of(model);
  const auto healthy = all(study);
  spec_of(study).additive_faults = {additive(1, 3, 20, 0, .4), additive(0, 10, 12, .5),
                                    additive(1, 15, end, -.25)};
  const auto faulty = all(study);
  Vector e = Vector::Zero(2);  // the difference follows the undisturbed system
  for (std::size_t k = 0; k < faulty.size(); ++k) {
    const Vector n = fault_at(spec_of(study), static_cast<std::int64_t>(k));
    REQUIRE(faulty[k].fault);
    CHECK((*faulty[k].fault - n).norm() < 1e-15);
    CHECK((*faulty[k].truth - *healthy[k].truth - e).norm() < 1e-13);
    CHECK((faulty[k].sample.y - healthy[k].sample.y - model.linear.C * e).norm() < 1e-13);
    CHECK(faulty[k].mode == Index(n.isZero(0) ? 0 : -1));
    CHECK(healthy[k].mode == Index(0));
    CHECK(*healthy[k].fault == Vector::Zero(2));
    e = model.linear.A * e + model.linear.F * n;
  }
  CHECK(faulty[2].mode == Index(0));
  CHECK(faulty[3].mode == Index(-1));
  study.model.linear.F = Matrix();
  spec_of(study).additive_faults.clear();
  CHECK_FALSE(all(study)[0].fault);
  CHECK_FALSE(all(study)[0].mode);
}

TEST_CASE("additive faults act beside the modes") {
  Model model = uncertain();
  model.linear.F = Matrix{{1.}, {0.}};
  Model other = model;
  other.linear.A = Matrix{{.2, 0.}, {0., .3}};
  other.linear.A_radius = model.linear.A_radius = Matrix();
  Study study = study_of(model, Noise::zero);
  spec_of(study).faults = {fault(5, 9, 1, other)};
  spec_of(study).additive_faults = {additive(0, 7, 11, .5)};
  const auto records = all(study);
  for (std::size_t k = 0; k < 20; ++k) {
    const LinearModel& m = k >= 5 && k <= 9 ? other.linear : model.linear;
    const Vector n{{k >= 7 && k <= 11 ? .5 : 0.}};
    CHECK((*records[k + 1].truth - m.A * *records[k].truth - m.B * records[k].sample.u - m.F * n)
              .norm() < 1e-13);
    CHECK(records[k].mode == Index(n[0] != 0 ? -1 : k >= 5 && k <= 9 ? 1 : 0));
  }
}

TEST_CASE("descriptor systems: F n acts on the whole equation, static rows included") {
  const Study study = faulty_descriptor();
  const LinearModel& m = study.model.linear;
  const auto records = all(study);
  double least = 9, most = -9;
  for (std::size_t k = 0; k + 1 < records.size(); ++k) {
    const Vector n = fault_at(std::get<SimulateSpec>(study.data), static_cast<std::int64_t>(k));
    const Vector w =
        m.E * *records[k + 1].truth - m.A * *records[k].truth - m.B * records[k].sample.u - m.F * n;
    CHECK((w.cwiseAbs().array() <= Vector{{.1, 1.5, .6}}.array() + 1e-12).all());  // Bw is diagonal
    least = std::min(least, w[2]), most = std::max(most, w[2]);
  }
  CHECK((least < -.5 && most > .5));  // and not always near 0
  // without disturbances the static row holds exactly
  Study exact = study;
  exact.model.W = make_point(Vector::Zero(3));
  exact.model.X0 = make_point(Vector{{.5, .5, .25}});
  for (const Record& record : all(exact)) {
    const Vector n = fault_at(std::get<SimulateSpec>(study.data), record.sample.k);
    CHECK(std::abs((m.A * *record.truth + m.B * record.sample.u + m.F * n)[2]) < 1e-12);
  }
}

TEST_CASE("the start of a descriptor system is consistent with the fault of k = 0") {
  Study study = faulty_descriptor();
  const LinearModel& m = study.model.linear;
  spec_of(study).additive_faults = {additive(1, 0, end, .5)};
  const auto static_row = [&](const Record& record) {
    return (m.A * *record.truth + m.B * record.sample.u)[2] + m.F(2, 1) * .5;
  };
  const Record given = *open_data(study)->next();
  CHECK((*given.truth - *spec_of(study).x0).norm() < 1e-12);
  CHECK(std::abs(static_row(given)) <= .6 + 1e-12);  // some w_0 ∈ W explains it
  spec_of(study).additive_faults = {additive(1, 0, end, 5)};
  CHECK(message_of(study).find("/data/simulate/x0: is not consistent with the static rows") !=
        std::string::npos);
  spec_of(study).additive_faults = {additive(1, 0, end, .5)};
  spec_of(study).x0.reset();
  study.model.W = make_point(Vector::Zero(3));
  const Record free = *open_data(study)->next();
  CHECK(std::abs(static_row(free)) < 1e-12);
}

TEST_CASE("any linear system with additive faults: the truth meets an independent recursion") {
  CHECK(rc::check("x⁺ = A x + B u + F n", [](std::uint64_t seed) {
    detail::RandomStream random(seed, detail::Purpose::prbs);
    const auto size = [&](double most) { return 1 + static_cast<Index>(random.unit() * most); };
    const auto any = [&](Index rows, Index cols) {
      return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return random.symmetric(); }));
    };
    const Index n = size(4), p = size(3), q = size(3), y = size(3);
    Model model;
    model.linear = {.E = {},
                    .A = any(n, n),
                    .B = any(n, p),
                    .Bw = Matrix(n, 0),
                    .C = any(y, n),
                    .D = any(y, p),
                    .Dv = Matrix(y, 0)};
    model.linear.F = any(n, q);
    model.X0 = make_point(any(n, 1).col(0));
    model.W = model.V = make_point(Vector(0));
    Study study = study_of(model);
    spec_of(study).steps = 12;
    for (Index i = 0; i < q; ++i) {
      AdditiveFaultSpec one = additive(i, static_cast<std::int64_t>(random.unit() * 6), 9,
                                       random.symmetric(), random.symmetric());
      one.signal.type = static_cast<Signal::Type>(static_cast<int>(random.unit() * 3));
      spec_of(study).additive_faults.push_back(one);
    }
    Vector x = model.X0.c;
    for (const Record& record : all(study)) {
      RC_ASSERT((*record.truth - x).norm() < 1e-12 * (1 + x.norm()));
      RC_ASSERT((record.sample.y - model.linear.C * x - model.linear.D * record.sample.u).norm() <
                1e-12 * (1 + x.norm()));
      x = model.linear.A * x + model.linear.B * record.sample.u + model.linear.F * *record.fault;
    }
  }));
}

TEST_CASE("equal pseudo-random signals of two faults are unrelated") {
  Model model = uncertain();
  model.linear.F = Matrix::Identity(2, 2);
  Study study = study_of(model, Noise::zero);
  AdditiveFaultSpec one;
  one.signal.type = Signal::Type::prbs;
  one.signal.amplitude = 1;
  AdditiveFaultSpec two = one;
  two.fault = 1;
  two.from = 10;
  spec_of(study).additive_faults = {one, two};
  spec_of(study).input[0] = one.signal;
  int equal = 0, like_input = 0;
  const auto records = all(study);
  for (std::size_t k = 10; k < 60; ++k) {
    equal += (*records[k].fault)[0] == (*records[k].fault)[1];
    like_input += (*records[k].fault)[0] == records[k].sample.u[0];
  }
  CHECK((equal > 5 && equal < 45));
  CHECK((like_input > 5 && like_input < 45));
  spec_of(study).additive_faults[1].from = 0;  // the signal is that of absolute time
  CHECK((*all(study)[30].fault)[1] == (*records[30].fault)[1]);
}
