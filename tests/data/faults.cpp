// SPDX-License-Identifier: GPL-3.0-or-later
// Simulations with faults, and with plants that are not the model.
#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "data/published.hpp"
#include "data/records.hpp"
#include "study/data/plant_source.hpp"
#include "study/data/simulate.hpp"

using namespace cordon;
using namespace data_test;

namespace {

LineForm box(double radius, Index n) {
  return make_box({Vector::Constant(n, -radius), Vector::Constant(n, radius)});
}

Model healthy() {
  Model model;
  model.linear.A = Matrix{{.9, .1}, {0., .8}};
  model.linear.B = Matrix{{1., 0.}, {0., 2.}};
  model.linear.Bw = Matrix::Identity(2, 2);
  model.linear.C = Matrix{{1., 0.}, {1., 1.}};
  model.linear.D = Matrix{{.5, 0.}, {0., 0.}};
  model.linear.Dv = Matrix::Identity(2, 2);
  model.X0 = box(1, 2);
  model.W = box(.1, 2);
  model.V = box(.01, 2);
  return model;
}

FaultSpec fault(std::int64_t from, std::int64_t to, Index mode, Model model, Box actuator = {},
                Box sensor = {}) {
  FaultSpec spec;
  spec.from = from;
  spec.to = to;
  spec.mode = mode;
  spec.actuator = model.linear.actuator = std::move(actuator);
  spec.sensor = model.linear.sensor = std::move(sensor);
  model.linear = with_exact_effectiveness_applied(std::move(model.linear));
  spec.model = std::move(model);
  return spec;
}

Study study_of(std::vector<FaultSpec> faults, Noise noise = Noise::uniform,
               Model model = healthy()) {
  SimulateSpec spec;
  spec.steps = 30;
  spec.noise = noise;
  spec.input.resize(2);
  spec.input[0].type = Signal::Type::sine;
  spec.input[0].amplitude = 1;
  spec.input[0].omega = .7;
  spec.input[0].phase = .4;
  spec.input[1].offset = 1.5;
  spec.faults = std::move(faults);
  Study study;
  study.file = "study.json";
  study.model = std::move(model);
  study.data = std::move(spec);
  return study;
}

/// x_{k+1} - A x_k of the healthy model: B diag(f) u + w.
Vector pushed(const std::vector<Record>& records, std::size_t k) {
  return *records[k + 1].truth - healthy().linear.A * *records[k].truth;
}

constexpr std::int64_t end = std::numeric_limits<std::int64_t>::max();
const Box half{Vector{{.5, 1.}}, Vector{{.5, 1.}}}, weak{Vector{{.2, 1.}}, Vector{{.6, 1.}}};

class Tank final : public Plant {
 public:
  Index throws_at = -1, wrong_at = -1, overflows_at = -1;

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 2; }
  Index do_outputs() const override { return 2; }
  Vector do_next(Index k, VectorIn x, VectorIn u) const override {
    if (k == throws_at) throw std::runtime_error("the tank is empty");
    if (k == wrong_at) return Vector(3);
    if (k == overflows_at) return Vector{{1., std::numeric_limits<double>::infinity()}};
    return Vector{{.5 * x[0] + u[0], x[1] * x[1] / 16 + u[1]}};
  }
  Vector do_output(Index, VectorIn x, VectorIn u) const override {
    return Vector{{x[0] + u[0], x[1]}};
  }
};

Study tank_study(std::vector<FaultSpec> faults, Noise noise, Tank tank = {}) {
  Study study = study_of(std::move(faults), noise);
  std::get<SimulateSpec>(study.data).made_plant = std::make_shared<Tank>(tank);
  return study;
}

}  // namespace

TEST_CASE("a fault makes y_k and x_{k+1} from its first step to its last") {
  const auto plain = all(study_of({}, Noise::zero)),
             faulty = all(study_of({fault(4, 6, 1, healthy(), half)}, Noise::zero));
  for (std::size_t k = 0; k <= 4; ++k) CHECK(*faulty[k].truth == *plain[k].truth);
  for (std::size_t k = 0; k < 4; ++k) CHECK(faulty[k].sample.y == plain[k].sample.y);
  for (std::size_t k = 0; k < 30; ++k) {
    const bool acts = k >= 4 && k <= 6;
    const Vector& u = faulty[k].sample.u;
    CHECK(u == plain[k].sample.u);
    CHECK((pushed(faulty, k) - Vector{{(acts ? .5 : 1) * u[0], 2 * u[1]}}).norm() < 1e-14);
    CHECK(faulty[k].sample.y[0] ==
          doctest::Approx((*faulty[k].truth)[0] + (acts ? .25 : .5) * u[0]).epsilon(1e-14));
    CHECK(faulty[k].mode == Index(acts ? 1 : 0));
  }
}

TEST_CASE("the true mode is told where there are several") {
  CHECK_FALSE(all(study_of({}))[0].mode);
  CHECK(all(study_of({fault(40, 50, 1, healthy())}))[0].mode == Index(0));
  Study study = study_of({});
  study.modes = {{"leak", healthy()}};
  CHECK(all(study)[0].mode == Index(0));
}

TEST_CASE("faults do not change what is drawn for the healthy plant") {
  const auto plain = all(study_of({}));
  const auto faulty =
      all(study_of({fault(5, 9, 1, healthy(), half), fault(12, 12, -1, healthy(), weak)}));
  CHECK(faulty[12].mode == Index(-1));
  for (std::size_t k = 0; k < 30; ++k) {
    const bool acts = (k >= 5 && k <= 9) || k == 12;
    const double difference = (pushed(plain, k) - pushed(faulty, k)).norm();
    if (acts) {
      CHECK(difference > 1e-3);
    } else {
      CHECK(difference < 1e-13);
    }
  }
}

TEST_CASE("a mode that comes back is drawn anew") {
  Model noisy = healthy();
  noisy.linear.A.setZero();
  noisy.W = box(1, 2);
  const auto records = all(study_of({fault(0, 4, 1, noisy), fault(10, 14, 1, noisy)}));
  const auto w = [&](std::size_t k) {
    return Vector(*records[k + 1].truth - noisy.linear.B * records[k].sample.u);
  };
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(w(k).cwiseAbs().maxCoeff() <= 1 + 1e-12);
    CHECK((w(k) - w(k + 10)).norm() > 1e-3);
  }
}

TEST_CASE("magnitudes within ranges are drawn at every step") {
  for (const Noise noise : {Noise::uniform, Noise::vertex, Noise::zero, Noise::sine}) {
    Model exact = healthy();
    exact.W = make_point(Vector::Zero(2));
    exact.V = make_point(Vector::Zero(2));
    const Box dim{Vector{{1., .3}}, Vector{{1., .4}}};
    const auto records = all(study_of({fault(0, end, 2, exact, weak, dim)}, noise));
    double least = 1, most = 0, changes = 0, before = 0;
    for (std::size_t k = 0; k < 30; ++k) {
      const Vector &u = records[k].sample.u, &x = *records[k].truth;
      const double f = pushed(records, k)[0] / u[0], y = records[k].sample.y[1], sum = x[0] + x[1];
      CHECK(pushed(records, k)[1] == doctest::Approx(2 * u[1]));
      CHECK((f > .2 - 1e-9 && f < .6 + 1e-9));
      CHECK(std::abs(y - .35 * sum) <= .05 * std::abs(sum) + 1e-9);  // y = g sum with g in [.3, .4]
      CHECK(records[k].sample.y[0] ==
            doctest::Approx(x[0] + .5 * f * u[0]));  // the same f in x and y
      if (noise == Noise::vertex) CHECK(std::min(std::abs(f - .2), std::abs(f - .6)) < 1e-9);
      if (noise == Noise::zero) CHECK(f == doctest::Approx(.4));
      least = std::min(least, f), most = std::max(most, f);
      changes += std::abs(f - before) > 1e-6;
      before = f;
    }
    if (noise != Noise::zero) CHECK((most - least > .3 && changes > 8));
  }
}

TEST_CASE("a fault brings its own W, V and matrices") {
  Model leak = healthy();
  leak.linear.Bw = Matrix{{1., 0., 1.}, {0., 1., 0.}};
  leak.W = cartesian_product(box(.1, 2), make_box({Vector{{3.}}, Vector{{4.}}}));
  leak.V = box(5, 2);
  const auto records = all(study_of({fault(10, 19, 1, leak)}, Noise::vertex));
  for (std::size_t k = 0; k < 30; ++k) {
    const bool acts = k >= 10 && k <= 19;
    const Vector w = pushed(records, k) - healthy().linear.B * records[k].sample.u;
    const Vector v = records[k].sample.y - healthy().linear.C * *records[k].truth -
                     healthy().linear.D * records[k].sample.u;
    CHECK(std::abs(w[1]) == doctest::Approx(.1));
    CHECK(((w[0] > 2.8) == acts));
    CHECK(v.cwiseAbs().minCoeff() == doctest::Approx(acts ? 5 : .01));
  }
}

TEST_CASE("the state starts in the X0 of a fault that acts from the beginning") {
  Model away = healthy();
  away.X0 = make_point(Vector{{7., 8.}});
  CHECK(*all(study_of({fault(0, 3, 1, away)}))[0].truth == Vector{{7., 8.}});
  CHECK(*all(study_of({fault(1, 3, 1, away)}))[0].truth == Vector{{0., 0.}});
}

TEST_CASE("descriptor systems: models of one E follow each other") {
  const auto study = [](std::vector<FaultSpec> faults) {
    Study one = study_of(std::move(faults), Noise::uniform, published::descriptor_model());
    auto& spec = std::get<SimulateSpec>(one.data);
    spec.x0 = Vector{{.5, .5, .25}};
    spec.input = published::descriptor_input();
    return one;
  };
  Model changed = published::descriptor_model();
  changed.linear.A(0, 0) *= .5;
  changed.linear.A(2, 1) *= 2;  // a static row
  const auto records = all(study({fault(5, 9, 1, changed)}));
  const auto plain = all(study({}));
  for (std::size_t k = 0; k < 5; ++k) CHECK(*records[k].truth == *plain[k].truth);
  for (std::size_t k = 0; k < 30; ++k) {
    const LinearModel& model =
        k >= 5 && k <= 9 ? changed.linear : published::descriptor_model().linear;
    const Vector open = model.E * *records[k + 1].truth - model.A * *records[k].truth -
                        model.B * records[k].sample.u;
    // some w_k ∈ W explains the step, static row included
    CHECK((open.cwiseAbs().array() <= Vector{{.1, 1.5, .6}}.array() + 1e-9).all());
  }
  Model other = published::descriptor_model();
  other.linear.E *= 2;
  CHECK(message_of(study({fault(5, 9, 1, other)}))
            .find("/data/simulate/faults/0: cannot be simulated: two models of different E") !=
        std::string::npos);
  CHECK(message_of(study({fault(0, 9, 1, other)})).find("different E") != std::string::npos);
  CHECK(message_of(study({fault(0, 9, 1, changed), fault(10, end, 1, other)})).find("faults/1") !=
        std::string::npos);
  CHECK(message_of(study({fault(0, 29, 1, other)})).find("different E") != std::string::npos);
  for (const auto& faults :
       {std::vector{fault(0, end, 1, other)}, std::vector{fault(0, 30, 1, other)},
        std::vector{fault(0, 9, 1, other), fault(10, 30, 1, other)},
        std::vector{fault(31, 40, 1, other)}}) {
    CHECK(message_of(study(faults)) == "");
    CHECK(all(study(faults)).size() == 31);
  }
  other.linear.A.row(2).setZero();  // index above 1: told at the fault
  CHECK(message_of(study({fault(0, end, 1, other)}))
            .find("/data/simulate/faults/0: the descriptor system has an index above 1") !=
        std::string::npos);
}

TEST_CASE("faults that cannot be simulated") {
  Model open = healthy();
  open.V = make_space(2);
  CHECK(message_of(study_of({fault(1, 2, 1, open)}))
            .find("/data/simulate/faults/0: cannot be simulated: unbounded") != std::string::npos);
  CHECK(message_of(study_of({fault(3, 2, 1, healthy())})).find("ends before it begins") !=
        std::string::npos);
  CHECK(message_of(study_of({fault(3, 5, 1, healthy()), fault(5, 6, 1, healthy())}))
            .find("faults/1: begins before") != std::string::npos);
  Model small = healthy();
  small.linear.A = Matrix{{1.}};
  CHECK(message_of(study_of({fault(3, 5, 1, small)})).find("faults/0: has size 1, must be 2") !=
        std::string::npos);
}

TEST_CASE("a plant takes the place of the model") {
  const Box deaf{Vector{{1., .3}}, Vector{{1., .3}}};
  Model loud = healthy();
  loud.V = box(2, 2);
  const auto records = all(tank_study(
      {fault(3, 5, 1, healthy(), half), fault(8, 9, -1, loud, {}, deaf)}, Noise::vertex));
  REQUIRE(records.size() == 31);
  CHECK(*records[0].truth == Vector{{0., 0.}});
  const Tank tank;
  for (std::size_t k = 0; k < 31; ++k) {
    Vector u = records[k].sample.u;
    const Vector& x = *records[k].truth;
    if (k >= 3 && k <= 5) u[0] *= .5;
    if (k < 30) CHECK(*records[k + 1].truth == tank.next(0, x, u));  // no disturbance is drawn
    const bool quiet = k < 8 || k > 9;
    const Vector v = records[k].sample.y - Vector{{x[0] + u[0], (quiet ? 1. : .3) * x[1]}};
    CHECK(v.cwiseAbs().minCoeff() == doctest::Approx(quiet ? .01 : 2));
    CHECK(records[k].mode == Index(k >= 3 && k <= 5 ? 1 : quiet ? 0 : -1));
  }
  Study from = tank_study({}, Noise::zero);
  std::get<SimulateSpec>(from.data).x0 = Vector{{.5, -.5}};
  from.model.W = make_space(2);  // not drawn
  CHECK(*all(from)[0].truth == Vector{{.5, -.5}});
}

TEST_CASE("a plant that misbehaves") {
  const auto end_of = [](const Tank& tank) {
    try {
      all(tank_study({}, Noise::zero, tank));
    } catch (const Error& error) {
      return std::string(to_string(error.code())) + ": " + error.what();
    }
    return std::string();
  };
  Tank tank;
  tank.throws_at = 7;
  CHECK(end_of(tank).find("next state at k = 7 threw the tank is empty") != std::string::npos);
  tank = {};
  tank.wrong_at = 3;
  CHECK(end_of(tank).find("has size 3, must be 2") != std::string::npos);
  tank = {};
  tank.overflows_at = 3;
  CHECK(end_of(tank).find("/data/simulate/plant: its next state is not finite at k = 3") !=
        std::string::npos);
  Study study = tank_study({}, Noise::zero);
  study.model.linear.C = Matrix{{1., 0.}};
  study.model.linear.D = Matrix(1, 2);
  study.model.linear.Dv = Matrix::Identity(1, 1);
  study.model.V = box(1, 1);
  CHECK(message_of(study).find("/data/simulate/plant: has other numbers") != std::string::npos);
}
