// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/simulate.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "data/published.hpp"
#include "data/records.hpp"

using namespace cordon;
using namespace data_test;
using detail::Disturbance;
using detail::LinearPlant;
using detail::Purpose;
using detail::RandomStream;
using detail::SimulatedSource;

namespace {

Study study_of(Model model, SimulateSpec spec) {
  Study study;
  study.file = "study.json";
  study.model = std::move(model);
  study.data = std::move(spec);
  return study;
}

Study published_study(std::int64_t steps = 100) {
  SimulateSpec spec;
  spec.steps = steps;
  spec.x0 = Vector{{.5, .5, .25}};
  spec.input = published::descriptor_input();
  return study_of(published::descriptor_model(), spec);
}

LineForm unit_box(Index n) { return make_box({-Vector::Ones(n), Vector::Ones(n)}); }

Model two_states() {
  Model model;
  model.linear.A = Matrix{{.9, .1}, {0, .8}};
  model.linear.B = Matrix{{0.}, {1.}};
  model.linear.Bw = Matrix::Identity(2, 2);
  model.linear.C = Matrix{{1., 0.}};
  model.linear.D = Matrix::Zero(1, 1);
  model.linear.Dv = Matrix{{.5}};
  model.X0 = unit_box(2);
  model.W = unit_box(2);
  model.V = unit_box(1);
  return model;
}

SimulateSpec two_state_spec(Noise noise) {
  SimulateSpec spec;
  spec.steps = 50;
  spec.noise = noise;
  spec.input.resize(1);
  spec.input[0].offset = 1;
  return spec;
}

}  // namespace

TEST_CASE("the published run comes out when its noise is given") {
  LinearPlant plant(published::descriptor_model().linear, "study.json");
  plant.start(Vector{{.5, .5, .25}});
  detail::SignalSource u1(published::descriptor_input()[0], 0),
      u2(published::descriptor_input()[1], 1);
  for (int k = 0; k < 13; ++k) {
    const Vector w{{std::sin(k), std::cos(2 * k), k == 0 ? 0.0 : std::sin(3 * k + 1)}},
        v{{std::cos(k), std::sin(2 * k + .5)}};
    const auto [x, y] = plant.step(Vector{{u1.at(k), u2.at(k)}}, w, v);
    for (Index i = 0; i < 3; ++i)
      CHECK(x[i] == doctest::Approx(published::states[k][i]).epsilon(1e-12));
    for (Index i = 0; i < 2; ++i)
      CHECK(y[i] == doctest::Approx(published::outputs[k][i]).epsilon(1e-12));
  }
}

TEST_CASE("a descriptor run keeps its start, its static rows and its bounds") {
  const Study study = published_study();
  const std::vector<Record> records = all(study);
  REQUIRE(records.size() == 101);
  CHECK((*records[0].truth - Vector{{.5, .5, .25}}).norm() < 1e-14);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Vector& x = *records[k].truth;
    CHECK(records[k].sample.k == static_cast<Index>(k));
    const double w3 = (x[0] - .5 * x[1] - x[2]) / .6;  // static row: 0 = -x1 + .5 x2 + x3 + .6 w3
    CHECK(std::abs(w3) <= 1 + 1e-9);
    if (k == 0) CHECK(std::abs(w3) < 1e-12);
    const Vector v =
        (records[k].sample.y - study.model.linear.C * x).cwiseQuotient(Vector{{.5, 1.5}});
    CHECK(v.cwiseAbs().maxCoeff() <= 1 + 1e-9);
    if (k + 1 == records.size()) break;
    const Vector rest = (*records[k + 1].truth - study.model.linear.A * x -
                         study.model.linear.B * records[k].sample.u)
                            .head(2);
    CHECK(std::abs(rest[0]) <= .1 + 1e-9);
    CHECK(std::abs(rest[1]) <= 1.5 + 1e-9);
  }
}

TEST_CASE("simulations repeat bit by bit") {
  CHECK(digest(all(published_study())) == digest(all(published_study())));
  Study other = published_study();
  std::get<SimulateSpec>(other.data).seed = 2;
  CHECK(digest(all(other)) != digest(all(published_study())));
  Study longer = published_study(150);
  std::vector<Record> head = all(longer);
  head.resize(101);
  CHECK(digest(head) == digest(all(published_study())));
}

TEST_CASE("the first values are pinned") {
  std::uint64_t expected[] = {14594713322818265554u, 10002092720016404607u, 9586776123028993042u,
                              3299691419449143060u};
  int i = 0;
  for (const Noise noise : {Noise::uniform, Noise::vertex, Noise::zero, Noise::sine}) {
    CHECK(digest(all(study_of(two_states(), two_state_spec(noise)))) == expected[i++]);
  }
}

TEST_CASE("kinds of noise without constraints") {
  const auto draws = [](Noise noise) {
    Disturbance d(make_zonotope(Vector{{1., 2.}}, Matrix{{1., 0., .5}, {0., 1., .5}}), noise,
                  RandomStream(1, Purpose::disturbance), 0, "f", "/p");
    std::vector<Vector> points;
    for (int k = 0; k < 2000; ++k) points.push_back(d.at(k));
    return points;
  };
  for (const Vector& p : draws(Noise::zero)) CHECK(p == Vector{{1., 2.}});
  double largest = 0;
  for (const Vector& p : draws(Noise::vertex)) {
    for (const double x : {p[0] - 1, p[1] - 2}) CHECK((std::abs(x) == .5 || std::abs(x) == 1.5));
  }
  for (const Vector& p : draws(Noise::uniform)) largest = std::max(largest, std::abs(p[0] - 1));
  CHECK(largest < 1.5);
  CHECK(largest > 1.3);
  const std::vector<Vector> sines = draws(Noise::sine);
  CHECK(sines[0] == Vector{{1., 2.}});
  CHECK(sines[7][0] ==
        doctest::Approx(1 + std::sin(7 * std::sqrt(2)) + .5 * std::sin(7 * std::sqrt(5)))
            .epsilon(1e-12));
}

TEST_CASE("draws from constrained sets stay inside and are not all alike") {
  // {ξ : ξ1 + ξ2 + ξ3 = 1.5, ‖ξ‖ ≤ 1}, mapped to the plane
  LineForm X = make_zonotope(Vector{{0., 0.}}, Matrix{{1., 0., .25}, {0., 1., .5}});
  X.S = Matrix(1, 0);
  X.A = Matrix{{1., 1., 1.}};
  X.b = Vector{{1.5}};
  const Box hull = interval_hull(X);
  for (const Noise noise : {Noise::uniform, Noise::vertex, Noise::sine, Noise::zero}) {
    Disturbance d(X, noise, RandomStream(1, Purpose::disturbance), 0, "f", "/p");
    Box seen = Box::empty(2);
    seen.lower.setConstant(9);
    seen.upper.setConstant(-9);
    for (int k = 0; k < 300; ++k) {
      const Vector p = d.at(k);
      seen.lower = seen.lower.cwiseMin(p);
      seen.upper = seen.upper.cwiseMax(p);
      // inside up to rounding: no direction separates
      for (const Vector& h : {Vector{{1., 0.}}, Vector{{-1., 0.}}, Vector{{1., 1.}},
                              Vector{{-1., -2.}}, Vector{{.3, -1.}}}) {
        CHECK(h.dot(p) <= support(X, h) + 1e-9);
      }
    }
    const double spread =
        (seen.upper - seen.lower).cwiseQuotient(hull.upper - hull.lower).minCoeff();
    if (noise == Noise::zero) {
      CHECK(spread == 0);
    } else {
      CHECK(spread > (noise == Noise::vertex ? 0.7 : 0.5));
    }
  }
}

TEST_CASE("any constrained set: the factors meet rows and bounds") {
  CHECK(rc::check("drawn points lie in the set", [](std::uint64_t seed) {
    RandomStream random(seed, Purpose::prbs);
    const Index g = 2 + static_cast<Index>(random.unit() * 5),
                m = 1 + static_cast<Index>(random.unit() * (static_cast<double>(g) - 1));
    LineForm X =
        make_zonotope(Vector::Zero(g), Matrix::Identity(g, g));  // the set of factors itself
    X.S = Matrix(m, 0);
    X.A = Matrix::NullaryExpr(m, g, [&] { return random.symmetric(); });
    X.b = X.A * Vector::NullaryExpr(
                    g, [&] { return random.sign() > 0 ? random.sign() : random.symmetric(); });
    const Noise noise = static_cast<Noise>(static_cast<int>(random.unit() * 4));
    Disturbance d(X, noise, RandomStream(seed, Purpose::disturbance), 0, "f", "/p");
    for (int k = 0; k < 20; ++k) {
      const Vector xi = d.at(k);
      RC_ASSERT(xi.cwiseAbs().maxCoeff() <= 1.0);
      RC_ASSERT((X.A * xi - X.b).cwiseAbs().maxCoeff() < 1e-7);
    }
  }));
}

TEST_CASE("sets that cannot be simulated") {
  Model model = two_states();
  model.W = make_space(2);
  CHECK(message_of(study_of(model, two_state_spec(Noise::uniform)))
            .find("/system/W: cannot be simulated: unbounded") != std::string::npos);
  model = two_states();
  model.V = make_empty(1);
  CHECK(message_of(study_of(model, two_state_spec(Noise::uniform)))
            .find("/system/V: cannot be simulated: the set is empty") != std::string::npos);
  // lines that the constraints bound are fine: {δ : δ + ξ = 0}
  model = two_states();
  model.V = LineForm{Matrix{{1.}}, Matrix::Zero(1, 1), Vector::Zero(1),
                     Matrix{{1.}}, Matrix{{1.}},       Vector::Zero(1)};
  for (const Record& r : all(study_of(model, two_state_spec(Noise::uniform))))
    CHECK(std::abs(r.sample.y[0] - (*r.truth)[0]) <= .5 + 1e-9);
}

TEST_CASE("an ordinary system starts in the centre of X0, or where x0 says") {
  Model model = two_states();
  model.X0 = make_zonotope(Vector{{3., 4.}}, Matrix::Identity(2, 2));
  SimulateSpec spec = two_state_spec(Noise::zero);
  const std::vector<Record> records = all(study_of(model, spec));
  CHECK(*records[0].truth == Vector{{3., 4.}});
  CHECK((*records[1].truth - Vector{{.9 * 3 + .1 * 4, .8 * 4 + 1}}).norm() < 1e-14);
  CHECK(records[1].sample.y[0] == (*records[1].truth)[0]);
  model.X0 = make_space(2);
  CHECK(*all(study_of(model, spec))[0].truth == Vector::Zero(2));
  spec.x0 = Vector{{1., 2.}};
  CHECK(*all(study_of(model, spec))[0].truth == Vector{{1., 2.}});
}

TEST_CASE("a descriptor system without x0 starts in X0 on its static rows") {
  Study study = published_study();
  std::get<SimulateSpec>(study.data).x0.reset();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::get<SimulateSpec>(study.data).seed = seed;
    const Vector x = *open_data(study)->next()->truth;
    CHECK((x.head(2) - Vector{{.5, .5}}).norm() < 1e-12);
    CHECK(contains(study.model.X0, x) != Answer::no);
  }
  // the centre leads out of X0, another start does not: x3 = x1 - .5 x2 - .6 w3 must lie in
  // [10.2, 10.4]
  study.model.X0 = make_box({Vector{{-20., -20., 10.2}}, Vector{{20., 20., 10.4}}});
  const Vector x = *open_data(study)->next()->truth;
  CHECK((x[2] > 10.2 - 1e-9 && x[2] < 10.4 + 1e-9));
  CHECK(std::abs(x[0] - .5 * x[1] - x[2]) <= .6 + 1e-9);
  // no start at all
  study.model.X0 = make_box({Vector{{-1., -1., 10.2}}, Vector{{1., 1., 10.4}}});
  CHECK(message_of(study).find("/system/X0: no state of X0") != std::string::npos);
}

TEST_CASE("an inconsistent x0 is refused with its residual") {
  Study study = published_study();
  std::get<SimulateSpec>(study.data).x0 = Vector{{.5, .5, 1.25}};  // would need w3 = -1/.6
  const std::string message = message_of(study);
  CHECK(message.find("/data/simulate/x0") != std::string::npos);
  CHECK(message.find("residual") != std::string::npos);
  std::get<SimulateSpec>(study.data).x0 = Vector{{.5, .5, .75}};
  const Record start = *open_data(study)->next();
  CHECK((*start.truth - Vector{{.5, .5, .75}}).norm() < 1e-12);
}

TEST_CASE("a correction that leaves W is replaced by another point of W") {
  // static row 0 = x1 + w1 + w2 with w1 + w2 = 1.5 needed: the drawn (w1,w2), corrected, may leave
  // the box
  Model model = two_states();
  model.linear.E = Matrix{{0., 0.}, {0., 1.}};
  model.linear.A = Matrix{{1., 0.}, {.1, .5}};
  model.linear.Bw = Matrix{{1., 1.}, {0., 1.}};
  SimulateSpec spec = two_state_spec(Noise::uniform);
  spec.x0 = Vector{{-1.9, 0.}};
  for (spec.seed = 1; spec.seed <= 30; ++spec.seed) {
    LinearPlant plant(model.linear, "f");
    const auto data = open_data(study_of(model, spec));
    const Vector x0 = *data->next()->truth, x1 = *data->next()->truth;
    CHECK((x0 - *spec.x0).norm() < 1e-9);
    const double w2 = x1[1] - .1 * x0[0] - 1, w1 = -x0[0] - w2;  // from the dynamic row with u = 1
    CHECK(std::abs(w1) <= 1 + 1e-9);
    CHECK(std::abs(w2) <= 1 + 1e-9);
  }
}

TEST_CASE("index above 1 is refused; a regular E is inverted") {
  Model model = two_states();
  model.linear.E = Matrix{{1., 0.}, {0., 0.}};
  model.linear.A = Matrix{{0., 1.}, {1., 0.}};
  CHECK(message_of(study_of(model, two_state_spec(Noise::zero))).find("index above 1") !=
        std::string::npos);
  model = two_states();
  const std::vector<Record> plain = all(study_of(model, two_state_spec(Noise::uniform)));
  const Matrix E{{2., 1.}, {1., 3.}};
  model.linear.E = E;
  model.linear.A = E * model.linear.A;
  model.linear.B = E * model.linear.B;
  model.linear.Bw = E * model.linear.Bw;
  const std::vector<Record> scaled = all(study_of(model, two_state_spec(Noise::uniform)));
  for (std::size_t k = 0; k < plain.size(); ++k)
    CHECK((*plain[k].truth - *scaled[k].truth).norm() < 1e-12);
}

TEST_CASE("rotating a descriptor system changes nothing but coordinates") {
  const Model model = published::descriptor_model();
  const double a = .7, b = 1.1;
  const Matrix P =
      Matrix{{std::cos(a), -std::sin(a), 0.}, {std::sin(a), std::cos(a), 0.}, {0., 0., 1.}} *
      Matrix{{1., 0., 0.}, {0., std::cos(b), -std::sin(b)}, {0., std::sin(b), std::cos(b)}};
  LinearModel rotated = model.linear;
  rotated.E = P * model.linear.E * P.transpose();
  rotated.A = P * model.linear.A * P.transpose();
  rotated.B = P * model.linear.B;
  rotated.Bw = P * model.linear.Bw;
  rotated.C = model.linear.C * P.transpose();
  LinearPlant plain(model.linear, "f"), turned(rotated, "f");
  plain.start(Vector{{.5, .5, .25}});
  turned.start(P * Vector{{.5, .5, .25}});
  for (int k = 0; k < 10; ++k) {
    const Vector w{{std::sin(k), std::cos(k), k == 0 ? 0. : std::sin(2 * k)}}, v{{.1, .2}},
        u{{1., -1.}};
    const auto p = plain.step(u, w, v), t = turned.step(u, w, v);
    CHECK((P * p.x - t.x).norm() < 1e-10);
    CHECK((p.y - t.y).norm() < 1e-10);
  }
}

TEST_CASE("states of unlike sizes lose no digits to each other") {
  LinearModel model;
  model.E = Matrix{{.0625, .5, 0}, {0, 0, 0}, {-.03125, -.25, 0}};
  model.A = Matrix{{.125, -.186, 1.4e-7}, {0, 262144, .061}, {0, 0, 1.2e-7}};
  model.B = model.Bw = Matrix(3, 0);
  model.C = Matrix{{1, 0, 0}};
  model.D = model.Dv = Matrix(1, 0);
  LinearPlant plant(model, "study.json");
  plant.start(Vector{{80422.0, 5572.0, -2.4e10}});
  const Vector none(0);
  Vector before = plant.step(none, none, none).x;
  for (int k = 0; k < 3; ++k) {
    const Vector now = plant.step(none, none, none).x;
    const Vector left = model.E * now, right = model.A * before;
    const Vector terms =
        model.E.cwiseAbs() * now.cwiseAbs() + model.A.cwiseAbs() * before.cwiseAbs();
    CAPTURE(Vector(left - right).transpose());
    CHECK(((left - right).cwiseAbs().array() <= 4e-16 * terms.array()).all());
    before = now;
  }
}

TEST_CASE("wrong sizes are reported together, an overflow with its time") {
  SimulateSpec spec = two_state_spec(Noise::uniform);
  spec.input.clear();
  spec.x0 = Vector{{1., 2., 3.}};
  Model model = two_states();
  model.W = unit_box(1);
  const std::string message = message_of(study_of(model, spec));
  for (const char* pointer : {"3 errors", "/data/simulate/input", "/data/simulate/x0", "/system/W"})
    CHECK(message.find(pointer) != std::string::npos);
  model = two_states();
  model.linear.A *= 1e100;
  CHECK_THROWS_AS(all(study_of(model, two_state_spec(Noise::uniform))), InputError);
}

TEST_CASE("systems without inputs, disturbances or noise") {
  Model model = two_states();
  model.linear.B = Matrix(2, 0);
  model.linear.Bw = Matrix(2, 0);
  model.linear.D = Matrix(1, 0);
  model.linear.Dv = Matrix(1, 0);
  model.W = make_point(Vector(0));
  model.V = make_point(Vector(0));
  SimulateSpec spec;
  spec.steps = 3;
  spec.x0 = Vector{{1., 1.}};
  const std::vector<Record> records = all(study_of(model, spec));
  REQUIRE(records.size() == 4);
  CHECK(records[1].sample.u.size() == 0);
  CHECK(((*records[1].truth) - Vector{{1., .8}}).norm() < 1e-15);
}
