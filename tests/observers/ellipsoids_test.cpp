// SPDX-License-Identifier: GPL-3.0-or-later
// Ellipsoids in an observer: hulls that were found independently, states of simulated runs that
// stay inside, and recursions of the literature that lose them.
#include <cmath>

#include <doctest/doctest.h>

#include "observers/noisy_runs.hpp"
#include "published/gain_plants.hpp"

using namespace cordon;
using namespace gain_plants;

namespace {

Params ellipsoids(const std::string& criterion, const std::string& rounding = "nominal") {
  return Params().set("criterion", criterion).set("rounding", rounding);
}

std::vector<Box> hulls_of(const Example& plant, const std::string& criterion) {
  return hulls(plant, "prediction_correction", {}, "ellipsoid", ellipsoids(criterion));
}

Vector widths(const Box& hull) { return hull.upper - hull.lower; }

/// What the steps of a run do to the truth: how often it is outside.
int lost(const Model& model, const SetBackend& backend, std::uint64_t seed, bool vertices,
         const Vector& units) {
  const auto observer =
      plugins().observer("prediction_correction", model, backend.shared_from_this(), {});
  observer->start();
  noisy_runs::Run run(model, seed, vertices);
  int violations = 0;
  for (Index k = 0; k < 25; ++k, run.move_on()) {
    const Estimate found = observer->step(run.sample(k));
    const Box hull = found.set->interval_hull();
    const Vector slack = 1e-12 * units;
    const bool inside = ((run.x + slack).array() >= hull.lower.array()).all() &&
                        ((run.x - slack).array() <= hull.upper.array()).all();
    violations += !inside || found.set->contains(run.x) == Answer::no ? 1 : 0;
  }
  return violations;
}

/// {x : |x - c| ≤ half}.
struct Segment {
  double c, half;
  bool holds(double x) const { return std::abs(x - c) <= half; }
};

/// Scalar outputs y = x + v, |v| ≤ phi, on {x : (x - c)² / P ≤ σ²}, as toolboxes have them: the
/// shape after the measurement is told without σ², or divided by it.
struct Fusion {
  double P, c, sigma;

  /// The weight λ of the measurement [Gollamudi1996; Liu2016].
  Segment fused(double y, double phi, double weight) const {
    const double innovation = y - c, G = P / (phi * phi);
    const double shape = 1 / ((1 - weight) / P + weight / (phi * phi));
    const double e = innovation / phi;
    const double next =
        (1 - weight) * sigma + weight - weight * (1 - weight) * e * e / (1 - weight + weight * G);
    return {c + weight * shape * innovation / (phi * phi), std::sqrt(shape * next)};
  }
  /// ESO-B: (I - K C) P is multiplied by 1 - λ, where it must be divided by it.
  Segment as_coded_b(double y, double phi, double weight) const {
    const double K = weight * P / ((1 - weight) * phi * phi + weight * P);
    return {c + K * (y - c), std::sqrt((1 - K) * P * (1 - weight))};
  }
  /// ESO-A: the shape is divided by the new σ², which forgets the old one.
  Segment as_coded_a(double y, double phi, double weight) const {
    const double shape = 1 / ((1 - weight) / P + weight), innovation = y - c;
    const double next = 1 - weight + weight * phi * phi -
                        weight * (1 - weight) * innovation * innovation / (1 - weight + weight * P);
    return {c + weight * shape * innovation, std::sqrt(shape / next)};
  }
};

/// {|x| ≤ 1} corrected by y = x + v in the backend.
Box corrected_unit(double y, double phi, const std::string& criterion) {
  const auto backend = plugins().backend("ellipsoid", ellipsoids(criterion));
  const Matrix one{{1.0}};
  const Enclosure V = backend->box({Vector{{-phi}}, Vector{{phi}}});
  return backend
      ->correct(backend->box({Vector{{-1.0}}, Vector{{1.0}}}), {one, Vector{{y}}, {one, V}})
      ->interval_hull();
}

}  // namespace

TEST_CASE("least traces are those of an independent implementation") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const json expected = plant.reference["designs"]["ellipsoid_trace"]["hulls"];
    CHECK(distance(hulls_of(plant, "trace"), expected) <= 1e-7);
  }
  const Box vehicle = hulls_of(plants()[1], "trace").back();
  CHECK((widths(vehicle) - Vector{{.4439, .0680}}).cwiseAbs().maxCoeff() <= 1e-4);
  const Box last = hulls_of(plants()[2], "trace").at(50);
  CHECK((widths(last) - Vector{{.4417, .5304, .3991}}).cwiseAbs().maxCoeff() <= 1e-4);
}

TEST_CASE("least volumes are those of an independent implementation") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const json expected = plant.reference["designs"]["ellipsoid_volume"]["hulls"];
    CHECK(distance(hulls_of(plant, "volume"), expected) <= 1e-6);
  }
}

TEST_CASE("a factor keeps the digits that a shape matrix loses") {
  // in extended precision; the shape matrix in doubles gave 1.204798 for the first
  const Box hull = hulls_of(plants()[1], "volume").at(50);
  CHECK((widths(hull) - Vector{{1.551012, .018856}}).cwiseAbs().maxCoeff() <= 1e-5);
}

TEST_CASE("disturbances are enclosed after their map, noise keeps its own width") {
  // the same plant with W and V behind ellipsoids: a rotation that is no placement of coordinates
  Example blurred = plants()[2];
  const double wide = std::sqrt(2.0);
  blurred.model.W = make_box(cube(2, wide));
  blurred.model.V = make_box(cube(2, wide));
  const Vector tight = widths(hulls_of(plants()[2], "trace").at(50)),
               loose = widths(hulls_of(blurred, "trace").at(50));
  CHECK((tight.array() < .75 * loose.array()).all());
  // every generator of Bw W by itself: the order of maps and sums does not matter
  Example mapped = plants()[2];
  LinearModel& m = mapped.model.linear;
  mapped.model.W = make_zonotope(Vector::Zero(3), m.Bw);
  m.Bw = Matrix::Identity(3, 3);
  mapped.model.V = make_zonotope(Vector::Zero(2), m.Dv);
  m.Dv = Matrix::Identity(2, 2);
  CHECK(distance(hulls_of(mapped, "trace"), hulls_of(plants()[2], "trace")) <= 1e-12);
}

TEST_CASE("exact hulls lie inside") {
  for (const Example& plant : plants()) {
    const json exact = plant.reference["designs"]["exact"]["hulls"];
    for (const char* criterion : {"trace", "volume"}) {
      const std::vector<Box> found = hulls_of(plant, criterion);
      for (const auto& [k, bounds] : exact.items()) {
        const Matrix told = matrix(bounds);
        const Box& hull = found.at(static_cast<std::size_t>(std::stoi(k)));
        CHECK((hull.lower - told.row(0).transpose()).maxCoeff() <= 1e-8);
        CHECK((told.row(1).transpose() - hull.upper).maxCoeff() <= 1e-8);
      }
    }
  }
}

TEST_CASE("mean widths as multiples of the exact ones") {
  // docs/ellipsoids.md
  const double told[][2] = {{1.42, 1.89}, {3.47, 3.49}, {3.13, 3.95}};
  for (std::size_t p = 0; p < plants().size(); ++p) {
    const Example& plant = plants()[p];
    CAPTURE(plant.name);
    const json exact = plant.reference["designs"]["exact"]["hulls"];
    const std::vector<Box> found[] = {hulls_of(plant, "trace"), hulls_of(plant, "volume")};
    for (std::size_t criterion = 0; criterion < 2; ++criterion) {
      double sum = 0;
      int count = 0;
      for (const auto& [k, bounds] : exact.items()) {
        if (std::stoi(k) < 5) continue;
        const Matrix two = matrix(bounds);
        const Box& hull = found[criterion].at(static_cast<std::size_t>(std::stoi(k)));
        for (Index i = 0; i < hull.dim(); ++i, ++count)
          sum += (hull.upper[i] - hull.lower[i]) / (two(1, i) - two(0, i));
      }
      CHECK(sum / count == doctest::Approx(told[p][criterion]).epsilon(.004));
    }
  }
}

TEST_CASE("the true state stays inside, in a thousand runs of three plants") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    int violations = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      const std::string criterion = seed % 2 ? "trace" : "volume",
                        rounding = seed % 4 < 2 ? "nominal" : "outward";
      const auto backend = plugins().backend("ellipsoid", ellipsoids(criterion, rounding));
      for (const bool vertices : {false, true})
        violations +=
            lost(plant.model, *backend, seed, vertices, Vector::Ones(plant.model.states()));
    }
    CHECK(violations == 0);
  }
}

TEST_CASE("states in units far apart are not lost") {
  for (const double scale : {1e-6, 1e3}) {
    for (const double noise : {1.0, 1e-12}) {
      Model model = plants()[2].model;
      LinearModel& m = model.linear;
      const Vector d{{scale, 1, 1 / scale}}, back = d.cwiseInverse();
      m.A = d.asDiagonal() * m.A * back.asDiagonal();
      m.B = d.asDiagonal() * m.B;
      m.Bw = noise * d.asDiagonal() * m.Bw;
      m.C *= back.asDiagonal();
      m.Dv *= noise;
      model.X0 = make_zonotope(Vector::Zero(3), Matrix(d.asDiagonal()));
      int violations = 0;
      for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const auto backend =
            plugins().backend("ellipsoid", ellipsoids(seed % 4 < 2 ? "trace" : "volume"));
        violations += lost(model, *backend, seed, seed % 2 == 0, d);
      }
      CHECK(violations == 0);
    }
  }
}

TEST_CASE("plants without noise: the state is found, and not lost in rounding") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    Model quiet = plant.model;
    const LinearModel& m = quiet.linear;
    quiet.W = make_point(Vector::Zero(m.Bw.cols()));
    quiet.V = make_point(Vector::Zero(m.Dv.cols()));
    for (const char* criterion : {"trace", "volume"}) {
      const auto backend = plugins().backend("ellipsoid", ellipsoids(criterion));
      const auto observer = plugins().observer("prediction_correction", quiet, backend, {});
      observer->start();
      noisy_runs::Run run(quiet, 7, false);
      double width = 0;
      for (Index k = 0; k < 60; ++k, run.move_on()) {
        const Estimate found = observer->step(run.sample(k));
        REQUIRE(found.set->is_empty() == Answer::no);
        CHECK(found.set->contains(run.x) != Answer::no);
        width = widths(found.set->interval_hull()).maxCoeff();
      }
      CHECK(width <= 1e-6);
    }
  }
}

TEST_CASE("a shape multiplied where it must be divided loses states") {
  // |x| ≤ 1, |v| ≤ 1, y = .2: x = 1 and x = -.8 are possible
  const Fusion prior{1, 0, 1};
  const Segment coded = prior.as_coded_b(.2, 1, .5), right = prior.fused(.2, 1, .5);
  CHECK(coded.c - coded.half == doctest::Approx(-.4));
  CHECK(coded.c + coded.half == doctest::Approx(.6));
  CHECK_FALSE(coded.holds(1));
  CHECK_FALSE(coded.holds(-.8));
  CHECK(right.c + right.half == doctest::Approx(1.09498743710662).epsilon(1e-12));
  CHECK(right.holds(1));
  CHECK(right.holds(-.8));
  const Box own = corrected_unit(.2, 1, "trace");
  CHECK(own.lower[0] <= -.8);
  CHECK(own.upper[0] >= 1);
  CHECK((own.lower - Vector{{-.8}}).norm() <= 1e-12);
}

TEST_CASE("a shape divided by its level loses states") {
  // |x| ≤ 1, |v| ≤ 10, y = 3.3 says nothing about x
  const Fusion prior{1, 0, .3};
  const Segment coded = prior.as_coded_a(3.3, 10, 1e-4);
  CHECK(coded.c - coded.half == doctest::Approx(-.9952933467826164).epsilon(1e-12));
  CHECK(coded.c + coded.half == doctest::Approx(.9959533467826165).epsilon(1e-12));
  CHECK_FALSE(coded.holds(1));
  CHECK_FALSE(coded.holds(-1));
  const Segment right = Fusion{1, 0, 1}.fused(3.3, 10, 1e-4);
  CHECK(right.holds(1));
  CHECK(right.holds(-1));
  const Box own = corrected_unit(3.3, 10, "volume");
  CHECK(own.lower[0] <= -1);
  CHECK(own.upper[0] >= 1);
}

TEST_CASE("a start inscribed into its box loses vertices") {
  // the largest circle inside of X0 against corners of X0
  const Example& plant = plants()[0];
  const auto backend = plugins().backend("ellipsoid", ellipsoids("trace"));
  int outside = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const noisy_runs::Run run(plant.model, seed, true);
    outside += run.x.norm() > 3 ? 1 : 0;
    CHECK(backend->import(plant.model.X0)->contains(run.x) != Answer::no);
  }
  CHECK(outside == 20);
}
