// SPDX-License-Identifier: GPL-3.0-or-later
// What errors add up to in a stable recursion: never less than they do, and forgotten as it decays.
#include "observers/error_memory.hpp"

#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"

using namespace cordon;
using estimators::ErrorMemory;

TEST_CASE("errors stay within the bound, whatever came before, and old ones are forgotten") {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int system = 0; system < 60; ++system) {
    CAPTURE(system);
    const Index n = 1 + system % 5;
    const auto draw = [&] { return number(engine); };
    Matrix F = Matrix::NullaryExpr(n, n, draw);
    F *= .95 / linalg::eigenvalues(F).cwiseAbs().maxCoeff();  // |F| may be unstable
    if (system % 4 == 0) F.row(0) *= 1e6, F.col(0) /= 1e6;
    ErrorMemory memory(F);
    Vector e = Vector::Zero(n);
    double largest = 0;
    for (int k = 0; k < 2000; ++k) {
      const double scale = k < 100 ? std::pow(10., number(engine) * 4) : 0;
      const Vector size = scale * Vector::NullaryExpr(n, [&] { return std::abs(draw()); });
      const Vector error = size.cwiseProduct(Vector::NullaryExpr(n, draw).cwiseSign());
      e = F * e + error;
      memory.step(size);
      REQUIRE((e.cwiseAbs().array() <= memory.bound().array() * (1 + 1e-9) + 1e-300).all());
      largest = std::max(largest, memory.bound().maxCoeff());
    }
    CHECK(memory.bound().maxCoeff() < 1e-6 * largest);
  }
}
