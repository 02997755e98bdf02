// SPDX-License-Identifier: GPL-3.0-or-later
// Simulations with interval matrices, and studies that cannot be simulated.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "data/published.hpp"
#include "data/records.hpp"
#include "data/uncertain_studies.hpp"
#include "study/data/linear_plant.hpp"

using namespace cordon;
using namespace data_test;

TEST_CASE("constant parameters: one matrix of the intervals makes a whole run") {
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    Study study = study_of(uncertain(), noise);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      spec_of(study).seed = seed;
      const auto records = all(study);
      const LinearModel& m = study.model.linear;
      // one [A B] explains all steps
      Matrix known(60, 3), next(60, 2);
      for (Index k = 0; k < 60; ++k) {
        const auto i = static_cast<std::size_t>(k);
        known.row(k) << records[i].truth->transpose(), records[i].sample.u.transpose();
        next.row(k) = records[i + 1].truth->transpose();
      }
      const Matrix AB = (linalg::pseudo_inverse(known) * next).transpose();
      const double c = records[0].sample.y[0] / (*records[0].truth)[0];
      for (std::size_t k = 0; k + 1 < records.size(); ++k) {
        Vector xu(3);
        xu << *records[k].truth, records[k].sample.u;
        CHECK((AB * xu - *records[k + 1].truth).norm() < 1e-9);
        CHECK(std::abs(records[k].sample.y[0] - c * xu[0]) < 1e-12);
        CHECK(records[k].sample.y[1] == doctest::Approx(xu[1] + .5 * xu[2]).epsilon(1e-14));
      }
      const double slack = 1e-9;
      CHECK(((AB.leftCols(2) - m.A).cwiseAbs().array() <= m.A_radius.array() + slack).all());
      CHECK(((AB.rightCols(1) - m.B).cwiseAbs().array() <= m.B_radius.array() + slack).all());
      CHECK(std::abs(c - 1) <= .1 + slack);
      if (noise == Noise::vertex) {
        CHECK(std::abs(AB(1, 0)) == doctest::Approx(.02).epsilon(1e-6));
        CHECK(std::abs(c - 1) == doctest::Approx(.1));
      }
    }
  }
}

TEST_CASE("varying parameters: every step has matrices of its own, all inside the intervals") {
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    const Study study = study_of(uncertain(), noise, ParameterDraw::varying);
    const auto records = all(study);
    double least = 9, most = -9, last = 0;
    int changes = 0;
    for (std::size_t k = 0; k + 1 < records.size(); ++k) {
      const Vector &x = *records[k].truth, &u = records[k].sample.u;
      const LinearModel& m = study.model.linear;
      const Vector off = *records[k + 1].truth - m.A * x - m.B * u;
      const Vector bound = m.A_radius * x.cwiseAbs() + m.B_radius * u.cwiseAbs();
      CHECK((off.cwiseAbs().array() <= bound.array() + 1e-12).all());
      const double share = off[0] / (.05 * x[0]);  // one interval acts on the first state
      least = std::min(least, share), most = std::max(most, share);
      changes += std::abs(share - last) > 1e-6;
      last = share;
      if (noise == Noise::vertex) CHECK(std::abs(share) == doctest::Approx(1));
    }
    CHECK((least < -.8 && most > .8));
    CHECK(changes > 15);
  }
}

TEST_CASE("without chance the matrices are the centres") {
  for (const Noise noise : {Noise::zero, Noise::sine}) {
    for (const ParameterDraw parameters : {ParameterDraw::constant, ParameterDraw::varying}) {
      const auto records = all(study_of(uncertain(), noise, parameters));
      const LinearModel m = uncertain().linear;
      for (std::size_t k = 0; k + 1 < records.size(); ++k)
        CHECK((*records[k + 1].truth - m.A * *records[k].truth - m.B * records[k].sample.u).norm() <
              1e-13);
    }
  }
}

TEST_CASE("parameters do not change what else is drawn") {
  Model model = uncertain();
  model.W = box(.1, 2);
  model.V = box(.2, 2);
  const auto noise_of = [&](ParameterDraw parameters, bool radius) {
    Model one = model;
    // no gain from states and inputs to states: the states are the disturbances
    one.linear.A.setZero();
    one.linear.B.setZero();
    one.linear.A_radius.setZero();
    if (!radius) one.linear.A_radius = Matrix();
    one.linear.B_radius = one.linear.C_radius = Matrix();
    if (radius) one.linear.A_radius(1, 1) = 1e-300;
    return all(study_of(one, Noise::uniform, parameters));
  };
  const auto plain = noise_of(ParameterDraw::constant, false);
  for (const ParameterDraw parameters : {ParameterDraw::constant, ParameterDraw::varying}) {
    const auto drawn = noise_of(parameters, true);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      CHECK((*plain[k].truth - *drawn[k].truth).norm() < 1e-15);
      CHECK((plain[k].sample.y - drawn[k].sample.y).norm() < 1e-15);
    }
  }
}

TEST_CASE(
    "a fault draws matrices of its own, and changes those of the nominal mode neither before nor "
    "after") {
  for (const ParameterDraw parameters : {ParameterDraw::constant, ParameterDraw::varying}) {
    const Study plain = study_of(uncertain(), Noise::uniform, parameters);
    Study study = plain;
    spec_of(study).faults = {fault(0, 3, 1, uncertain()), fault(7, 11, 1, uncertain()),
                             fault(20, 24, 1, uncertain())};
    const auto first_row = [](const std::vector<Record>& records,
                              std::size_t k) {  // A(0,0) that acted at k
      const Vector& x = *records[k].truth;
      return ((*records[k + 1].truth)[0] - .1 * x[1] - records[k].sample.u[0]) / x[0];
    };
    const auto with = all(study), without = all(plain);
    for (std::size_t k = 0; k < 60; ++k) {
      const double difference = std::abs(first_row(with, k) - first_row(without, k));
      if (k <= 3 || (k >= 7 && k <= 11) || (k >= 20 && k <= 24)) {
        CHECK(difference > 1e-6);
        CHECK(std::abs(first_row(with, k) - .9) <= .05 + 1e-9);
      } else {
        CHECK(difference < 1e-11);
      }
    }
    if (parameters == ParameterDraw::constant)
      CHECK(std::abs(first_row(with, 7) - first_row(with, 11)) < 1e-9);
    CHECK(std::abs(first_row(with, 7) - first_row(with, 20)) > 1e-6);
  }
}

TEST_CASE("the first uncertain values are pinned") {
  CHECK(digest(all(study_of(uncertain(), Noise::uniform, ParameterDraw::constant))) ==
        14232558760594489440u);
  CHECK(digest(all(study_of(uncertain(), Noise::vertex, ParameterDraw::varying))) ==
        391912007558744188u);
  Model model = uncertain();
  model.linear.F = Matrix{{1., 0.}, {-.5, 2.}};
  Study study = study_of(model);
  spec_of(study).additive_faults = {additive(0, 3, 20, 0, .4), additive(1, 10, end, .5)};
  spec_of(study).additive_faults[1].signal.type = Signal::Type::prbs;
  CHECK(digest(all(study)) == 2044666257460684526u);
  CHECK(digest(all(faulty_descriptor())) == digest(all(faulty_descriptor())));
}

TEST_CASE("descriptor systems: drawn matrices keep the state that is carried over") {
  Model model = published::descriptor_model();
  model.linear.A_radius = model.linear.A.cwiseAbs() * .1;
  model.linear.C_radius = model.linear.C.cwiseAbs() * .1;
  for (const ParameterDraw parameters : {ParameterDraw::constant, ParameterDraw::varying}) {
    Study study = study_of(model, Noise::uniform, parameters);
    spec_of(study).input = published::descriptor_input();
    spec_of(study).faults = {fault(10, 19, 1, model)};
    const auto records = all(study);
    double largest = 0;
    for (std::size_t k = 0; k + 1 < records.size(); ++k) {
      const Vector& x = *records[k].truth;
      const LinearModel& m = model.linear;
      const Vector open = m.E * *records[k + 1].truth - m.A * x - m.B * records[k].sample.u;
      const Vector disturbed{{.1, 1.5, .6}}, drawn = m.A_radius * x.cwiseAbs();
      CHECK((open.cwiseAbs().array() <= (disturbed + drawn).array() + 1e-9).all());
      largest = std::max(largest, (open.cwiseAbs() - disturbed).maxCoeff());
    }
    CHECK(largest > 1e-3);  // the disturbances alone do not explain it
  }
}

TEST_CASE("matrices exchanged and exchanged back make the same steps") {
  LinearModel m = published::descriptor_model().linear;
  m.F = Matrix{{1.}, {0.}, {2.}};
  detail::LinearPlant plain(m, "f"), exchanged(m, "f");
  plain.start(Vector{{.5, .5, .25}});
  exchanged.start(Vector{{.5, .5, .25}});
  LinearModel other = m;
  other.A *= .5;
  other.B *= 2;
  other.C *= 3;
  const Vector un{{1., -1., .5}}, w = Vector::Constant(3, .1), v = Vector::Zero(2);
  for (int k = 0; k < 5; ++k) {
    exchanged.exchange(other.A, other.B, other.C);
    detail::LinearPlant fresh(other, "f");
    fresh.resume(exchanged);
    const auto a = fresh.step(un, w, v);
    detail::LinearPlant copy = exchanged;
    const auto b = copy.step(un, w, v);
    CHECK((a.x - b.x).norm() < 1e-13);
    CHECK((a.y - b.y).norm() < 1e-13);
    exchanged.exchange(m.A, m.B, m.C);
    const auto p = plain.step(un, w, v), q = exchanged.step(un, w, v);
    CHECK(p.x == q.x);
    CHECK(p.y == q.y);
  }
}

TEST_CASE("what cannot be simulated is told, all at once") {
  Study study = study_of(uncertain());
  study.model.linear.A_radius(0, 0) = -1;
  study.model.linear.B_radius = Matrix::Zero(2, 2);
  study.model.linear.C_radius(0, 0) = std::numeric_limits<double>::infinity();
  spec_of(study).additive_faults = {additive(0, 5, 4, std::numeric_limits<double>::quiet_NaN())};
  const std::string message = message_of(study);
  for (const char* part :
       {"6 errors", "/system/A: has a radius that is negative",
        "/system/B: has a radius of another size",
        "/system/C: has a radius that is negative or not finite",
        "additive_faults/0/fault: is no column", "additive_faults/0: ends before it begins",
        "additive_faults/0/signal/offset: is not a finite number"}) {
    CAPTURE(message);
    CHECK(message.find(part) != std::string::npos);
  }
  study = study_of(uncertain());
  study.model.linear.F = Matrix::Ones(3, 1);
  CHECK(message_of(study).find("/system/F: has size 3, must be 2") != std::string::npos);
  study.model.linear.F = Matrix::Ones(2, 1);
  Model other = uncertain();
  other.linear.A_radius = Matrix::Ones(1, 2);
  spec_of(study).faults = {fault(1, 2, 1, other)};
  CHECK(message_of(study).find("faults/0: has size 0, must be 1, the columns of /system/F") !=
        std::string::npos);
  CHECK(message_of(study).find("faults/0: has a radius of another size") != std::string::npos);
  spec_of(study).faults.clear();
  study.model.linear.F *= 1e-300;
  spec_of(study).additive_faults = {additive(0, 0, end, 1e308), additive(0, 3, end, 1e308)};
  CHECK(message_of(study).find("/data/simulate/additive_faults: overflow at k = 3") !=
        std::string::npos);
  spec_of(study).additive_faults = {additive(-1, 0, end, 1)};
  CHECK(message_of(study).find("additive_faults/0/fault: is no column") != std::string::npos);
}
