// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs without noise leave sets without width in some directions, where the numbers hold
// rounding errors alone. Data of plants that integers simulate exactly are consistent; rounding
// must not make them a proof of the contrary, whatever the budget.
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

using Integers = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic>;

/// The doubles numerators/2^shift, if they are exact.
std::optional<Matrix> dyadic(const Integers& numerators, int shift) {
  Matrix A(numerators.rows(), numerators.cols());
  for (Index i = 0; i < A.size(); ++i) {
    if (std::abs(numerators(i)) >= std::int64_t{1} << 53) return std::nullopt;
    A(i) = std::ldexp(static_cast<double>(numerators(i)), -shift);
  }
  return A;
}

struct Run {
  Model model;
  std::vector<Vector> states;
  std::vector<Sample> samples;
};

/// Random plants with up to four states, A and C in 1/4, x_0 in 1/64. Of a descriptor system, the
/// last states are static.
class Plants {
 public:
  explicit Plants(unsigned seed) : engine_(seed) {}

  struct Shape {
    bool descriptor = false, noise = false, unknown_start = false;
    int length = 9;
  };

  /// Nothing if the numbers do not fit.
  std::optional<Run> draw(const Shape& shape) {
    const Index n = integer(2, 4), p = integer(1, n), g = n + integer(0, 2),
                nw = shape.noise ? integer(0, 1) : 0;
    const Index dynamic = shape.descriptor ? integer(1, n - 1) : n,
                rows = std::min<Index>(integer(0, 2), g - 1);
    Integers A = integers(n, n, 3), E = Integers::Zero(n, n);
    for (Index i = 0; i < n; ++i) E(i, i) = i < dynamic ? 1 : 0;
    A.bottomRightCorner(n - dynamic, n - dynamic) =
        4 * Integers::Identity(n - dynamic, n - dynamic);
    A.topRightCorner(dynamic, n - dynamic).setZero();
    A.bottomLeftCorner(n - dynamic, dynamic) *=
        4;  // so that static states are as fine as the others
    const Integers C = integers(p, n, 6), Bw = integers(n, nw, 4);
    const Integers c = 16 * integers(n, 1, 8), G = integers(n, g, 8), A0 = integers(rows, g, 8),
                   xi = integers(g, 1, 7);
    Integers x = c + G * xi;  // G and ξ in 1/8
    settle(x, A, dynamic);

    Run run;
    LinearModel& m = run.model.linear;
    m.A = *dyadic(A, 2);
    if (shape.descriptor) m.E = *dyadic(E, 0);
    m.B = Matrix(n, 0);
    m.D = Matrix(p, 0);
    m.C = *dyadic(C, 2);
    m.Bw = *dyadic(Bw, 2);
    if (shape.descriptor) m.Bw.bottomRows(n - dynamic).setZero();
    m.Dv = Matrix(p, 0);
    LineForm X0 = make_zonotope(dyadic(c, 6)->col(0), *dyadic(G, 3));
    X0.S = Matrix(rows, 0);
    X0.A = *dyadic(A0, 3);
    X0.b = dyadic(A0 * xi, 6)->col(0);
    run.model.X0 = shape.unknown_start ? make_space(n) : X0;
    run.model.W = nw > 0 ? make_zonotope(Vector::Zero(nw), Matrix::Identity(nw, nw) / 8)
                         : make_point(Vector(0));
    run.model.V = make_point(Vector(0));
    run.model.U = make_space(0);

    int shift = 6;  // x_k in 1/64 · 4^-k
    for (Index k = 0; k < shape.length; ++k, shift += 2) {
      const auto state = dyadic(x, shift), output = dyadic(C * x, shift + 2);
      if (!state || !output) return std::nullopt;
      run.states.push_back(state->col(0));
      run.samples.push_back({k, Vector(0), output->col(0)});
      Integers w = integers(nw, 1, 8) * (std::int64_t{1} << (shift - 6));  // in 1/64, |w| ≤ 1/8
      x = A * x;
      if (nw > 0) x.topRows(dynamic) += (Bw * w).topRows(dynamic);
      settle(x, A, dynamic);
    }
    if (shape.descriptor)
      run.model.X0 = make_box({Vector::Constant(n, -4096), Vector::Constant(n, 4096)});
    return run;
  }

 private:
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(engine_);
  }
  Integers integers(Index rows, Index cols, std::int64_t most) {
    Integers A(rows, cols);
    for (Index i = 0; i < A.size(); ++i) A(i) = integer(-most, most);
    return A;
  }
  /// The static rows, x_j = -Σ A_ji x_i / 4.
  static void settle(Integers& x, const Integers& A, Index dynamic) {
    for (Index j = dynamic; j < x.rows(); ++j) {
      std::int64_t sum = 0;
      for (Index i = 0; i < dynamic; ++i) sum += A(j, i) * x(i);
      x(j) = -sum / 4;
    }
  }

  std::mt19937 engine_;
};

struct Tally {
  int runs = 0, empty = 0, outside = 0;
};

void follow(const Run& run, const std::string& observer,
            const std::shared_ptr<const SetBackend>& backend, int constraints, Tally& tally) {
  const auto made = registry().make<ObserverEntry>(
      observer, {run.model, backend}, Params().set("max_constraints", std::int64_t{constraints}));
  ++tally.runs;
  for (std::size_t k = 0; k < run.samples.size(); ++k) {
    const Estimate estimate = made->step(run.samples[k]);
    if (estimate.consistent == Answer::no) {
      ++tally.empty;
      return;
    }
    if (estimate.set->contains(run.states[k]) == Answer::no) {
      ++tally.outside;
      return;
    }
  }
}

std::shared_ptr<const SetBackend> backend(const std::string& name, const std::string& rounding) {
  return registry().make<BackendEntry>(name, Params().set("rounding", rounding));
}

/// The observer keeps to the truth of `count` plants.
void expect_truth_inside(const std::string& observer, const std::string& name,
                         const std::string& rounding, const Plants::Shape& shape, int count,
                         std::vector<int> budgets = {0, 1, 2, 3, 5, 50}) {
  const auto sets = backend(name, rounding);
  for (const int constraints : budgets) {
    CAPTURE(name);
    CAPTURE(constraints);
    Tally tally;
    for (int seed = 0; seed < count; ++seed) {
      if (const auto run = Plants(static_cast<unsigned>(seed)).draw(shape))
        follow(*run, observer, sets, constraints, tally);
    }
    CHECK(tally.runs > count / 2);
    CHECK(tally.empty == 0);
    CHECK(tally.outside == 0);
  }
}

}  // namespace

TEST_CASE("exact data of a plant with two outputs are consistent") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{-.75, -.25}, {.25, .75}};
  m.B = Matrix(2, 0);
  m.C = Matrix{{-1.5, -.75}, {1, -.25}};
  m.D = Matrix(2, 0);
  m.Bw = Matrix{{0}, {0}};
  m.Dv = Matrix{{0}, {0}};
  model.W = model.V = make_point(Vector{{0}});
  model.X0 = make_zonotope(Vector{{2, 1}}, Matrix{{.25, .5, 1}, {-.375, .5, -1}});
  model.X0.S = Matrix(1, 0);
  model.X0.A = Matrix{{-.75, -.125, .375}};
  model.X0.b = Vector{{.515625}};
  model.U = make_space(0);
  const Matrix outputs{{-4.1015625, 1.6328125},    {1.599609375, -2.267578125},
                       {-2.05078125, .81640625},   {.7998046875, -1.1337890625},
                       {-1.025390625, .408203125}, {.39990234375, -.56689453125}};
  for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
    for (const char* rounding : {"nominal", "outward"}) {
      for (const int constraints : {0, 1, 2, 3, 5, 50}) {
        CAPTURE(name);
        CAPTURE(rounding);
        CAPTURE(constraints);
        const auto observer = registry().make<ObserverEntry>(
            "prediction_correction", {model, backend(name, rounding)},
            Params().set("max_constraints", std::int64_t{constraints}));
        for (Index k = 0; k < outputs.rows(); ++k) {
          CAPTURE(k);
          CHECK(observer->step({k, Vector(0), outputs.row(k).transpose()}).consistent !=
                Answer::no);
        }
      }
    }
  }
}

TEST_CASE("exact data are consistent with prediction and correction") {
  expect_truth_inside("prediction_correction", "constrained_zonotope", "nominal", {}, 60);
  expect_truth_inside("prediction_correction", "constrained_zonotope", "nominal", {.noise = true},
                      30, {1, 2, 5});
  expect_truth_inside("prediction_correction", "line_zonotope", "nominal", {.noise = true}, 30,
                      {0, 2, 5});
}

TEST_CASE("exact data are consistent where the observer lets errors grow") {
  const auto expect_consistent = [](const std::string& observer, const std::string& name,
                                    unsigned seed, bool descriptor) {
    CAPTURE(observer);
    CAPTURE(seed);
    Tally tally;
    const auto run = Plants(seed).draw({.descriptor = descriptor, .noise = true, .length = 14});
    REQUIRE(run);
    for (const int constraints : {0, 1, 2, 3, 5})
      follow(*run, observer, backend(name, "nominal"), constraints, tally);
    CHECK(tally.empty + tally.outside == 0);
  };
  for (const unsigned seed : {45u, 51u, 59u, 175u, 761u, 1112u}) {
    expect_consistent("prediction_correction", "constrained_zonotope", seed, false);
  }
  for (const unsigned seed : {92u, 432u})
    expect_consistent("descriptor", "line_zonotope", seed, true);
}

TEST_CASE("exact data are consistent when nothing is known of the start") {
  expect_truth_inside("prediction_correction", "line_zonotope", "nominal",
                      {.noise = true, .unknown_start = true}, 30);
}

TEST_CASE("exact data are consistent with the observer of descriptor systems") {
  expect_truth_inside("descriptor", "line_zonotope", "nominal", {.descriptor = true, .noise = true},
                      30);
}

TEST_CASE("exact data are consistent with outward rounding") {
  expect_truth_inside("prediction_correction", "constrained_zonotope", "outward", {.noise = true},
                      20, {1, 5});
  expect_truth_inside("prediction_correction", "line_zonotope", "outward", {.noise = true}, 20,
                      {1, 5});
  expect_truth_inside("descriptor", "line_zonotope", "outward", {.descriptor = true, .noise = true},
                      20, {1, 5});
}
