// SPDX-License-Identifier: GPL-3.0-or-later
// With outward rounding the coordinates of a descriptor observer, which no doubles hold, are
// enclosed: sets hold every state of a sequence that satisfies the model to the last digit, at
// vertices of all sets, as decided in rational arithmetic.
#include <cmath>
#include <cstdint>
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/exact_questions.hpp"
#include "diagnosis/banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

/// Numbers of few digits, so that sums of products of three of them are doubles.
double dyadic(std::mt19937& random, int sixteenths) {
  return std::uniform_int_distribution<int>(-sixteenths, sixteenths)(random) / 16.0;
}
Matrix dyadics(std::mt19937& random, Index rows, Index cols, int sixteenths = 40) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = dyadic(random, sixteenths);
  return A;
}
Vector vertex(std::mt19937& random, const Vector& radius) {
  Vector v = radius;
  for (double& entry : v) entry *= random() % 2 == 0 ? 1 : -1;
  return v;
}
LineForm box(const Vector& center, const Vector& radius) {
  return make_box({center - radius, center + radius});
}

/// E of rank 1 or 2 whose rows are multiples of few; x_{k+1} is drawn, and u makes the equations
/// hold.
struct Sequence {
  Model model;
  std::vector<Vector> x;
  std::vector<Sample> samples;
};

/// Outputs of many digits, with large entries for a state that is 0 at all times: C x is a double,
/// and C T is none.
Matrix fine_outputs(std::mt19937& random, Index rows, Index n, Index zero) {
  std::uniform_int_distribution<std::int64_t> entry(-(std::int64_t{1} << 38),
                                                    std::int64_t{1} << 38);
  Matrix C(rows, n);
  for (double& c : C.reshaped()) c = std::ldexp(static_cast<double>(entry(random)), -36);
  C.col(zero) *= std::ldexp(1.0, static_cast<int>(random() % 30));
  return C;
}

Sequence drawn(std::mt19937& random, Index n, Index rank, bool noisy, bool fine = false) {
  Sequence made;
  LinearModel& m = made.model.linear;
  const Index zero = fine ? static_cast<Index>(random()) % n : -1;
  m.E = dyadics(random, n, rank, 5) * dyadics(random, rank, n, 5);
  if (fine) {  // coordinates that are doubles
    std::uniform_int_distribution<int> small(-1, 1);
    Matrix rows(rank, n);
    for (double& entry : rows.reshaped()) entry = small(random);
    m.E = dyadics(random, n, rank, 5) * rows;
  }
  m.A = dyadics(random, n, n);
  m.B = Matrix::Identity(n, n);
  m.Bw = dyadics(random, n, 2, 12);
  m.C = dyadics(random, 1 + static_cast<Index>(random() % 2), n);
  if (fine) m.C = fine_outputs(random, m.C.rows(), n, zero);
  m.D = Matrix(m.C.rows(), n);
  m.D.setZero();
  m.Dv = Matrix::Identity(m.C.rows(), m.C.rows());
  const Vector w = noisy ? Vector{{.25, .125}} : Vector{{0, 0}},
               v = Vector::Constant(m.C.rows(), noisy ? .125 : 0);
  made.model.W = box(Vector::Zero(2), w);
  made.model.V = box(Vector::Zero(v.size()), v);
  made.model.U = make_space(n);
  Vector center = dyadics(random, n, 1), radius = dyadics(random, n, 1).cwiseAbs();
  if (fine) center[zero] = radius[zero] = 0;
  made.model.X0 = box(center, radius);
  made.x.push_back(center + vertex(random, radius));
  for (Index k = 0; k < 8; ++k) {
    made.x.push_back(dyadics(random, n, 1, 60));
    if (fine) made.x.back()[zero] = 0;
    const Vector& now = made.x[static_cast<std::size_t>(k)];
    const Vector u = m.E * made.x.back() - m.A * now - m.Bw * vertex(random, w);
    made.samples.push_back({k, u, m.C * now + vertex(random, v)});
  }
  return made;
}

/// Steps whose set does not hold the state; and that were checked.
struct Count {
  int lost = 0, checked = 0;
};

Count followed(const Sequence& sequence, const std::string& representation, bool bounded,
               Index constraints) {
  const Index n = sequence.model.linear.states();
  const auto outward = registry().make<BackendEntry>(
      representation, Params().set("rounding", std::string("outward")));
  Params params;
  params.set("max_constraints", static_cast<std::int64_t>(constraints))
      .set("max_generators", std::int64_t{20});
  if (bounded) params.set("admissible_set", box(Vector::Zero(n), Vector::Constant(n, 8)));
  if (!registry().check<ObserverEntry>("descriptor", {sequence.model, outward}, params).empty())
    return {};
  const auto observer =
      registry().make<ObserverEntry>("descriptor", {sequence.model, outward}, params);
  Count count;
  for (std::size_t k = 0; k < sequence.samples.size(); ++k) {
    const LineForm X = observer->step(sequence.samples[k]).set->line_form();
    count.lost += exact::contains(X, sequence.x[k]) != Answer::yes;
    ++count.checked;
  }
  return count;
}

}  // namespace

TEST_CASE("no state is lost by the rounding of coordinates") {
  std::mt19937 random(3);
  int pseudo_inverses = 0;  // [E; C] of full column rank
  for (int sample = 0; sample < 60; ++sample) {
    const Index n = 2 + sample % 2, rank = 1 + sample % (n - 1);
    const Sequence sequence = drawn(random, n, rank, sample % 3 != 0);
    for (const Index constraints : {0, 2, 6}) {
      CAPTURE(sample);
      CAPTURE(constraints);
      CHECK(followed(sequence, "line_zonotope", false, constraints).lost == 0);
      CHECK(followed(sequence, "line_zonotope", true, constraints).lost == 0);
      CHECK(followed(sequence, "constrained_zonotope", true, constraints).lost == 0);
    }
    for (const char* representation : {"zonotope", "interval"}) {
      const Count count = followed(sequence, representation, false, 0);
      INFO(sample, ", ", representation);
      CHECK(count.lost == 0);
      pseudo_inverses += count.checked > 0;
    }
  }
  CHECK(pseudo_inverses > 50);
}

TEST_CASE("no state is lost by the rounding of what the outputs are in other coordinates") {
  std::mt19937 random(5);
  int checked = 0;
  for (int sample = 0; sample < 100; ++sample) {
    const Index n = 2 + sample % 2, rank = 1 + sample % (n - 1);
    const Sequence sequence = drawn(random, n, rank, sample % 3 == 0, true);
    CAPTURE(sample);
    for (const Index constraints : {0, 2, 6}) {
      CAPTURE(constraints);
      for (const bool bounded : {false, true}) {
        const Count count = followed(sequence, "line_zonotope", bounded, constraints);
        CHECK(count.lost == 0);
        checked += count.checked;
      }
      CHECK(followed(sequence, "constrained_zonotope", true, constraints).lost == 0);
    }
    for (const char* representation : {"zonotope", "interval"})
      CHECK(followed(sequence, representation, false, 0).lost == 0);
  }
  CHECK(checked > 3000);
}
