// SPDX-License-Identifier: GPL-3.0-or-later
// Half widths of errors through steps by other matrices: never less than errors of matrices within
// their bounds, and of what they are told to be off by.
#include "observers/error_widths.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"

using namespace cordon;
using estimators::ErrorWidths;
using estimators::Rounded;

namespace {

std::mt19937_64 engine(8);

const auto number = [] { return std::uniform_real_distribution<double>(-1, 1)(engine); };
const auto sign = [] { return number() < 0 ? -1. : 1.; };
Matrix random(Index rows, Index cols) { return Matrix::NullaryExpr(rows, cols, number); }
Vector signs(Index n) { return Vector::NullaryExpr(n, sign); }

/// A matrix at a corner of the errors.
Matrix one_of(const Rounded& Z) {
  return Z.value + Z.error.cwiseProduct(Matrix::NullaryExpr(Z.value.rows(), Z.value.cols(), sign));
}

Rounded within(const Matrix& value, double error) {
  return {value, error * random(value.rows(), value.cols()).cwiseAbs()};
}

Matrix decaying(Index n) {
  const Matrix M = random(n, n);
  return M * (.9 / linalg::eigenvalues(M).cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("errors of matrices within their bounds stay within the half widths") {
  for (int system = 0; system < 40; ++system) {
    CAPTURE(system);
    const Index n = 1 + system % 6, m = system % 5;
    const double error = system % 4 == 3 ? 0 : 1e-3;
    const Rounded M = within(decaying(n), error), D = within(random(n, m), error),
                  R = within(random(n, n + 1), error);
    ErrorWidths widths(M, D);
    for (int run = 0; run < 20; ++run) {
      widths.start(R);
      Vector e = one_of(R) * signs(n + 1);
      for (int k = 0; k < 150; ++k) {
        if (std::abs(number()) < (run % 2 == 0 ? .4 : .05)) {
          const Rounded other = within(decaying(n), error), noise = within(random(n, m + 1), error);
          const Vector off = error * random(n, 1).cwiseAbs();
          e += off.cwiseProduct(signs(n));
          e = one_of(other) * e + one_of(noise) * signs(m + 1);
          widths.step_by(other, noise, off);
        } else {
          e = one_of(M) * e + one_of(D) * signs(m);
          widths.step();
        }
        REQUIRE((e.cwiseAbs().array() <= widths.half_widths().array() * (1 + 1e-14)).all());
      }
    }
  }
}

TEST_CASE("one state, whose errors all add up: half widths leave none of them out") {
  const auto only = [](double value, double error) {
    return Rounded{Matrix{{value}}, Matrix{{error}}};
  };
  for (int source = 0; source < 7; ++source) {
    CAPTURE(source);
    const auto error = [&](int of) { return of == source ? .01 : 0; };
    const Rounded M = only(.8, error(0)), D = only(1, error(1)), R = only(3, error(2)),
                  other = only(.9, error(3)), noise = only(2, error(4));
    const double off = source == 6 ? 1e-10 : error(5);  // so small that it is not made a column
    for (const int period : {2, 3, 10, 40, 90}) {
      CAPTURE(period);
      ErrorWidths widths(M, D);
      widths.start(R);
      double e = 3 + error(2);
      for (int k = 1; k < 400; ++k) {
        CAPTURE(k);
        if (k % period == 0) {
          e = (.9 + error(3)) * (e + off) + 2 + error(4);
          widths.step_by(other, noise, Vector{{off}});
        } else {
          e = (.8 + error(0)) * e + 1 + error(1);
          widths.step();
        }
        const double half = widths.half_widths()[0];
        REQUIRE(e <= half * (1 + 1e-14));
        REQUIRE(half < 2 * e);
      }
    }
  }
}

TEST_CASE("a bound of the errors alone, where there are no columns") {
  const Matrix none(2, 0), M{{.5, -.4}, {.4, .5}};
  ErrorWidths widths({M, Matrix::Zero(2, 2)}, {none, none});
  widths.start({none, none});
  widths.step_by({M, Matrix::Zero(2, 2)}, {none, none}, Vector{{1, 0}});
  const Vector half = widths.half_widths();
  CHECK(half[0] >= .5);
  CHECK(half[0] < .51);
  CHECK(half[1] >= .4);
  CHECK(half[1] < .41);
}

TEST_CASE("steps after a state that was kept are those that followed it") {
  const Matrix M = decaying(4), D = random(4, 2), zero4 = Matrix::Zero(4, 4),
               zero2 = Matrix::Zero(4, 2);
  ErrorWidths widths({M, zero4}, {D, zero2});
  widths.start({random(4, 9), Matrix::Zero(4, 9)});
  ErrorWidths::State kept;
  const Rounded other{decaying(4), zero4}, noise{D, zero2};
  const auto follow = [&] {
    std::vector<Vector> found;
    for (int k = 0; k < 90; ++k) {
      if (k == 60 || (k > 70 && k % 5 == 0)) {
        widths.step_by(other, noise, Vector::Constant(4, 1e-12));
      } else {
        widths.step();
      }
      found.push_back(widths.half_widths());
    }
    return found;
  };
  for (int time = 0; time < 2; ++time) {
    widths.keep(kept);
    const std::vector<Vector> first = follow();
    widths.go_back(kept);
    CHECK(first == follow());
  }
}
