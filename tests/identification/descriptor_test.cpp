// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <optional>
#include <random>

#include <Eigen/LU>
#include <Eigen/QR>
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/study/identify.hpp"
#include "study/identification/scaling_proof.hpp"

using namespace cordon;
using identification::RationalVector;
using rational::exact;
using rational::Rational;

namespace {

LineForm cube(Index n, double radius) {
  return make_zonotope(Vector::Zero(n), radius * Matrix::Identity(n, n));
}

Model descriptor_of(const Matrix& E, const Matrix& A, const Matrix& C) {
  const Index n = A.rows(), p = C.rows();
  Model model;
  LinearModel& linear = model.linear;
  linear.E = E, linear.A = A, linear.C = C;
  linear.B = Matrix(n, 0), linear.D = Matrix(p, 0);
  linear.Bw = Matrix::Identity(n, n), linear.Dv = Matrix::Identity(p, p);
  model.X0 = make_space(n);
  model.W = cube(n, 1), model.V = cube(p, 1);
  return model;
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Matrix matrix(Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& entry : A.reshaped()) entry = (*this)();
    return A;
  }
  Matrix integers(Index rows, Index cols) {
    Matrix A = 2.5 * matrix(rows, cols);
    return A.array().round();
  }
  Vector point(const LineForm& set) {
    Vector xi = matrix(set.generators(), 1);
    if ((*this)() > 0) xi = xi.cwiseSign();
    return set.c + set.G * xi;
  }

 private:
  std::mt19937_64 engine_;
};

/// The trajectory of a descriptor system of index 1: R x_k is kept, E = L R, and the static rows
/// give the rest.
class Trajectory {
 public:
  Trajectory(const LinearModel& linear, const Matrix& L, const Matrix& R)
      : linear_(linear), L_(L), R_(R) {
    kernel_ =
        L.rows() == L.cols() ? Matrix(L.rows(), 0) : Matrix(L.transpose().fullPivLu().kernel());
    Matrix whole(linear.states(), linear.states());
    whole << R, kernel_.transpose() * linear.A;
    lu_.compute(whole);
  }
  bool is_well_conditioned() const { return lu_.isInvertible() && lu_.rcond() > 1e-2; }
  Vector state(const Vector& kept, const Vector& u, const Vector& w) const {
    Vector right(linear_.states());
    right << kept, -kernel_.transpose() * (linear_.B * u + linear_.Bw * w);
    return lu_.solve(right);
  }
  Vector next(const Vector& x, const Vector& u, const Vector& w) const {
    return L_.colPivHouseholderQr().solve(linear_.A * x + linear_.B * u + linear_.Bw * w);
  }

 private:
  const LinearModel& linear_;
  Matrix L_, R_, kernel_;
  Eigen::FullPivLU<Matrix> lu_;
};

struct DescriptorPlant {
  Model model;
  std::vector<Sample> samples;
};

std::optional<DescriptorPlant> simulated(Model model, const Matrix& L, const Matrix& R, Index steps,
                                         std::uint64_t seed) {
  Draw random(seed + 1'000'000);
  const Trajectory plant(model.linear, L, R);
  if (!plant.is_well_conditioned()) return std::nullopt;
  DescriptorPlant made{model, {}};
  Vector kept = random.matrix(R.rows(), 1);
  for (Index k = 0; k < steps; ++k) {
    const Vector u = random.matrix(model.linear.inputs(), 1), w = random.point(model.W);
    const Vector x = plant.state(kept, u, w);
    if (k == 0 && seed % 3 != 0) {
      made.model.X0 = cube(x.size(), 0.5);
      made.model.X0.c = x + 0.4 * random.matrix(x.size(), 1);
    }
    if (k == 0 && seed % 3 != 0 && seed % 5 == 0) {
      made.model.X0.M = Matrix::Identity(x.size(), 1);
      made.model.X0.S = Matrix(0, 1);
    }
    Sample sample{
        k, u, model.linear.C * x + model.linear.D * u + model.linear.Dv * random.point(model.V)};
    if (seed % 4 == 1 && random() > 0.4) sample = missing_outputs(sample, {0});
    made.samples.push_back(sample);
    kept = plant.next(x, u, w);
    if (kept.cwiseAbs().maxCoeff() > 100) return std::nullopt;
  }
  return made;
}

/// Of random matrices, E of any rank; nothing where they are no plant that can be simulated.
std::optional<DescriptorPlant> descriptor_plant(std::uint64_t seed, Index steps) {
  Draw random(seed);
  const Index n = 2 + static_cast<Index>(seed % 2), p = 1 + static_cast<Index>(seed % 2);
  const Index rank = seed % 11 == 0 ? n : 1 + static_cast<Index>(seed % 7 == 0 ? 0 : n - 2);
  const Matrix L = random.integers(n, rank), R = random.integers(rank, n);
  if (L.colPivHouseholderQr().rank() < rank || R.colPivHouseholderQr().rank() < rank)
    return std::nullopt;
  Model model = descriptor_of(L * R, random.matrix(n, n), random.matrix(p, n));
  model.linear.B = random.matrix(n, 1), model.linear.D = random.matrix(p, 1);
  model.W = cube(n, 0.1), model.V = cube(p, 0.05);
  model.W.c = 0.3 * random.matrix(n, 1);
  if (seed % 2 == 0) model.W.G = 0.1 * random.matrix(n, n + 1);
  return simulated(std::move(model), L, R, steps, seed);
}

/// The one of examples/studies/descriptor_four_representations.json.
DescriptorPlant known_plant(std::uint64_t seed, Index steps) {
  Model model = descriptor_of(Matrix{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
                              Matrix{{0.5, 0, 0.5}, {0.8, 0.95, 0}, {-1, 0.5, 1}},
                              Matrix{{1, 0, 1}, {1, -1, 0}});
  model.linear.B = Matrix{{1, 0}, {0, 1}, {0, 0}}, model.linear.D = Matrix::Zero(2, 2);
  model.linear.Bw = Matrix{{0.1, 0, 0}, {0, 1.5, 0}, {0, 0, 0.6}};
  model.linear.Dv = Matrix{{0.5, 0}, {0, 1.5}};
  const Matrix L = Matrix::Identity(3, 2), R = Matrix::Identity(2, 3);
  return *simulated(model, L, R, steps, seed);
}

constexpr Scaled all_scales[] = {Scaled::both, Scaled::disturbances, Scaled::noises, Scaled::each};

void check_truth(const DescriptorPlant& plant) {
  const auto generators =
      static_cast<double>(plant.model.W.generators() + plant.model.V.generators());
  for (const Scaled scaled : all_scales) {
    CAPTURE(static_cast<int>(scaled));
    const BoundFactors found = identify_bounds(plant.model, plant.samples, {scaled});
    REQUIRE(found.status == BoundFactors::Status::found);
    const double of_truth = scaled == Scaled::each ? generators : 1;
    CHECK(found.cost <= of_truth * (1 + 1e-7));
    CHECK(found.proven <= of_truth * (1 + 1e-10));  // data are rounded
    CHECK(found.proven <= found.cost * (1 + 1e-6) + 1e-9);
    CHECK(found.proven >= found.cost * (1 - 1e-5) - 1e-9);
  }
}

std::vector<Sample> outputs(const std::vector<Vector>& ys) {
  std::vector<Sample> samples;
  for (const Vector& y : ys) samples.push_back({std::ssize(samples), Vector(0), y});
  return samples;
}

double factor_of(const Model& model, const std::vector<Sample>& samples, Scaled scaled) {
  const BoundFactors found = identify_bounds(model, samples, {scaled});
  REQUIRE(found.status == BoundFactors::Status::found);
  CHECK(found.proven == doctest::Approx(found.cost).epsilon(1e-9));
  return found.cost;
}

Rational magnitude(const Rational& q) { return abs(q); }

RationalVector applied(const Matrix& T, const RationalVector& x) {  // Tᵀ x
  RationalVector y(static_cast<std::size_t>(T.cols()));
  for (Index j = 0; j < T.cols() && !x.empty(); ++j)
    for (Index i = 0; i < T.rows(); ++i)
      y[static_cast<std::size_t>(j)] += exact(T(i, j)) * x[static_cast<std::size_t>(i)];
  return y;
}

RationalVector plus(RationalVector a, const RationalVector& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

/// Of one factor for W and V, by the definitions, with E and all else as they are written.
Rational bound_by_definition(const DescriptorPlant& plant,
                             const identification::Certificate& given) {
  const LinearModel& m = plant.model.linear;
  Rational left = 0, reach = 0;
  const auto over = [&](const RationalVector& d, const LineForm& set, Rational& spread) {
    left -= rational::dot(d, exact(set.c));
    for (const Rational& entry : applied(set.G, d)) spread += magnitude(entry);
  };
  RationalVector r;
  for (std::size_t k = 0; k < plant.samples.size(); ++k) {
    const Sample& sample = plant.samples[k];
    const RationalVector &mu = given.outputs[k], &p = given.steps[k];
    r = plus(applied(m.C, mu), applied(m.A, p));
    const RationalVector ended =
        k > 0 ? applied(m.E, given.steps[k - 1]) : RationalVector(r.size());
    if (k > 0) CHECK(r == ended);
    Rational fixed = 0;
    if (k == 0) {
      over(r, plant.model.X0, fixed);
      for (const Rational& entry : applied(plant.model.X0.M, r)) CHECK(entry == 0);
    }
    left -= fixed;
    for (std::size_t i = 0; i < mu.size(); ++i)
      if (mu[i] != 0) left += mu[i] * exact(sample.y[static_cast<Index>(i)]);
    left -= rational::dot(applied(m.D, mu), exact(sample.u));
    left -= rational::dot(applied(m.B, p), exact(sample.u));
    over(applied(m.Dv, mu), plant.model.V, reach);
    over(applied(m.Bw, p), plant.model.W, reach);
  }
  for (const Rational& entry : applied(m.E, given.steps.back())) CHECK(entry == 0);
  return left / reach;
}

}  // namespace

TEST_CASE("the residual of a static row gives its bound: by hand") {
  // x1⁺ = x1 + w1, 0 = x1 - x2 + w2; y = x + v, the first one without noise.
  Model model =
      descriptor_of(Matrix{{1, 0}, {0, 0}}, Matrix{{1, 0}, {1, -1}}, Matrix::Identity(2, 2));
  model.linear.Dv = Matrix{{0}, {1}};
  model.V = cube(1, 1);
  const auto one = outputs({Vector{{0, 1}}});
  CHECK(factor_of(model, one, Scaled::both) == doctest::Approx(0.5));  // 1 ≤ |w2| + |v|
  model.V = cube(1, 0.2);
  CHECK(factor_of(model, one, Scaled::disturbances) == doctest::Approx(0.8));
  model.V = make_point(Vector::Zero(1));
  const auto two = outputs({Vector{{0, 0.25}}, Vector{{0.5, 0}}});
  CHECK(factor_of(model, two, Scaled::disturbances) == doctest::Approx(0.5));
  const BoundFactors each = identify_bounds(model, two, {Scaled::each});
  CHECK(each.disturbances[0] == doctest::Approx(0.5));  // x1 moves by 0.5
  CHECK(each.disturbances[1] == doctest::Approx(0.5));  // x1 - x2
  CHECK(each.proven == doctest::Approx(1));
}

TEST_CASE("X0 that the static rows contradict requires a factor without any output") {
  Model model =
      descriptor_of(Matrix{{1, 0}, {0, 0}}, Matrix{{1, 0}, {1, -1}}, Matrix::Identity(2, 2));
  model.X0 = make_point(Vector{{3, 1}});
  auto samples = outputs({Vector{{3, 1}}});
  samples[0] = missing_outputs(samples[0], {0, 1});
  const BoundFactors found = identify_bounds(model, samples);
  CHECK(found.cost == doctest::Approx(2));
  CHECK(found.proven == doctest::Approx(2));
  CHECK(found.required_by.empty());
}

TEST_CASE("of index 2, and with a state that nothing determines: by hand") {
  // x2⁺ = x1 + w1, 0 = x2 + w2: x1 at k is -w2 at k + 1 less w1 at k.
  Model model = descriptor_of(Matrix{{0, 1}, {0, 0}}, Matrix::Identity(2, 2), Matrix{{1, 0}});
  const auto samples = outputs({Vector{{1}}, Vector{{0}}, Vector{{0}}});
  CHECK(factor_of(model, samples, Scaled::both) == doctest::Approx(1.0 / 3));
  CHECK(std::abs(identify_bounds(model, outputs({Vector{{1}}})).cost) < 1e-9);
  // x1⁺ = x1 + x2, x2 anything: outputs of both.
  model = descriptor_of(Matrix{{1, 0}, {0, 0}}, Matrix{{1, 1}, {0, 0}}, Matrix::Identity(2, 2));
  model.linear.Bw = Matrix{{1}, {0}};
  model.W = cube(1, 1);
  const auto free = outputs({Vector{{0, 5}}, Vector{{6, -6}}, Vector{{0, 0}}});
  // 6 - 0 - 5 = 1 ≤ s (2 for the noise of y1, 1 for that of y2, 1 for w)
  CHECK(factor_of(model, free, Scaled::both) == doctest::Approx(0.25));
}

TEST_CASE("descriptor data of known bounds: no factor is above them, a smaller one is refuted") {
  const char* const wanted = std::getenv("CORDON_IDENTIFIED_DESCRIPTORS");
  const std::uint64_t plants = wanted ? std::strtoull(wanted, nullptr, 10) : 60;
  std::uint64_t simulated_ones = 0;
  for (std::uint64_t seed = 1; seed <= plants; ++seed) {
    CAPTURE(seed);
    check_truth(known_plant(seed, 20));
    const auto plant = descriptor_plant(seed, 25);
    if (!plant) continue;
    ++simulated_ones;
    check_truth(*plant);
  }
  CHECK(simulated_ones >= plants / 4);
}

TEST_CASE("certificates of descriptor data hold in rational arithmetic, and broken ones do not") {
  int checked = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const auto random_one = descriptor_plant(seed, 8);
    const DescriptorPlant plant = random_one ? *random_one : known_plant(seed, 8);
    const auto factors = identification::factors_of(plant.model, Scaled::both);
    const BoundFactors found = identify_bounds(plant.model, plant.samples);
    // whatever is proposed
    Draw random(seed);
    identification::Multipliers proposal{random.matrix(plant.model.linear.outputs(), 8),
                                         random.matrix(plant.model.linear.states(), 8)};
    for (const Sample& sample : plant.samples)
      for (const Index i : sample.missing) proposal.outputs(i, sample.k) = 0;
    const auto proof = identification::scaling_proof(plant.model, plant.samples, factors, proposal);
    if (!proof) continue;
    ++checked;
    CHECK(proof->least <= found.cost * (1 + 1e-7));
    const Rational bound = bound_by_definition(plant, proof->certificate);
    CHECK(exact(proof->least) <= (bound > 0 ? bound : Rational(0)));
    auto broken = proof->certificate;
    RationalVector& mu = broken.outputs[proof->samples.back()];
    for (Rational& entry : mu) entry += Rational(1, 1'000'000'000);
    CHECK(!identification::bound_of(plant.model, plant.samples, factors, broken));
  }
  CHECK(checked >= 30);
}

TEST_CASE("the identity for E and none are the same, and equations may be combined") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    DescriptorPlant plant = known_plant(seed, 15);
    LinearModel& linear = plant.model.linear;
    const double before = identify_bounds(plant.model, plant.samples).cost;
    Draw random(seed);
    const Matrix P = random.integers(3, 3) + 4 * Matrix::Identity(3, 3);
    if (std::abs(P.determinant()) > 0.5) {
      Model combined = plant.model;
      for (Matrix* matrix :
           {&combined.linear.E, &combined.linear.A, &combined.linear.B, &combined.linear.Bw})
        *matrix = P * *matrix;
      const BoundFactors found = identify_bounds(combined, plant.samples);
      CHECK(found.cost == doctest::Approx(before).epsilon(1e-6));
      CHECK(found.proven == doctest::Approx(before).epsilon(1e-5));
    }
    linear.E = Matrix();
    linear.A *= 0.5;
    const BoundFactors without = identify_bounds(plant.model, plant.samples);
    linear.E = Matrix::Identity(3, 3);
    const BoundFactors with = identify_bounds(plant.model, plant.samples);
    CHECK(with.cost == without.cost);
    CHECK(with.proven == without.proven);
    CHECK(with.required_by == without.required_by);
  }
}

TEST_CASE("an E that is singular up to rounding is taken as it is elsewhere") {
  // Rows (0.1, 0.3) and (0.3, 0.9): 3 times the first equation less the second one is static.
  Model model =
      descriptor_of(Matrix{{0.1, 0.3}, {0.3, 0.9}}, Matrix{{1, 0}, {2, 1}}, Matrix::Identity(2, 2));
  model.V = make_point(Vector::Zero(2));
  // 0 = x1 - x2 + 3 w1 - w2
  const auto samples = outputs({Vector{{1, 0}}});
  CHECK(factor_of(model, samples, Scaled::disturbances) == doctest::Approx(0.25));
}

TEST_CASE("samples are left out of descriptor data") {
  DescriptorPlant plant = known_plant(3, 20);
  plant.samples[9].y.array() += 40;
  const LeftOutSamples found = leave_out(plant.model, plant.samples, 1.001, 3, {});
  CHECK(found.is_enough);
  REQUIRE(found.steps.size() == 1);
  CHECK(found.steps[0].k == 9);
  CHECK(found.at_least == 1);
}
