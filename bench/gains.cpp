// SPDX-License-Identifier: GPL-3.0-or-later
// The design of a gain by each linear matrix inequality, for the published plants with three and
// two states and for a random one with eight.
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "registry.hpp"

namespace {

using namespace cordon;

LineForm cube(Index n) { return make_zonotope(Vector::Zero(n), Matrix::Identity(n, n)); }

Model plant(const Matrix& A, const Matrix& C, double w, double v) {
  Model model;
  LinearModel& m = model.linear;
  m.A = A;
  m.B = Matrix(A.rows(), 0);
  m.Bw = w * Matrix::Identity(A.rows(), A.rows());
  m.C = C;
  m.D = Matrix(C.rows(), 0);
  m.Dv = v * Matrix::Identity(C.rows(), C.rows());
  model.X0 = model.W = cube(A.rows());
  model.V = cube(C.rows());
  return model;
}

/// Non-negative, with the largest row sum .9.
Model random_plant(Index n, Index outputs) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  Matrix A = Matrix::NullaryExpr(n, n, [&] { return uniform(engine); });
  A *= .9 / A.rowwise().sum().maxCoeff();
  return plant(A, Matrix::NullaryExpr(outputs, n, [&] { return uniform(engine); }), .1, .2);
}

const int registered = [] {
  static const Model three = plant(Matrix{{.8, .1, .3}, {0, .8, .2}, {.01, 0, .8}},
                                   Matrix{{0, 0, 1}}, .08, .2),
                     two = plant(Matrix{{.9886, 0}, {.0114, .9903}}, Matrix{{0, 1}}, .006, .5),
                     eight = random_plant(8, 3);
  for (const char* type : {"h_infinity", "h_infinity_monotone", "w_radius"}) {
    for (const auto& [name, model] : {std::pair{"2_states", &two}, std::pair{"3_states", &three},
                                      std::pair{"8_states", &eight}}) {
      benchmark::RegisterBenchmark(("gain/" + std::string(type) + "/" + name).c_str(),
                                   [type, model = model](benchmark::State& state) {
                                     Params params;
                                     if (std::string(type) == "w_radius") params.set("rho", .98);
                                     const auto designer = registry().make<GainEntry>(type, params);
                                     for (auto _ : state) {
                                       if (designer->design(*model).feasible != Answer::yes)
                                         state.SkipWithError("no gain");
                                     }
                                   })
          ->Unit(benchmark::kMicrosecond)
          ->Repetitions(7);
    }
  }
  return 0;
}();

}  // namespace
