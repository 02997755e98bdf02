// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/monotone.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"

using namespace cordon;
using estimators::no_monotone_gain;
using estimators::raised_to_monotone;

namespace {

double number(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 100'001)) * 1e-5;
}

Matrix random_matrix(Index rows, Index cols, double low, double high) {
  Matrix A(rows, cols);
  for (Index i = 0; i < A.size(); ++i) A(i) = number(low, high);
  return A;
}

}  // namespace

TEST_CASE("three reasons why there is no monotone gain") {
  CHECK(no_monotone_gain(Matrix{{.8, -.1, .3}, {0, .8, .2}, {.01, 0, .8}}, Matrix{{0, 0, 1}})
            .value()
            .reason == "no monotone gain exists: column 2 of C is zero and A(1,2) < 0");
  CHECK(no_monotone_gain(Matrix{{.5, 0}, {-.3, .2}}, Matrix{{1, -1}}).value().reason ==
        "no monotone gain exists: the outputs do not show the direction (1, 1), to four digits, "
        "and row 2 of A makes a negative "
        "number of it");
  CHECK(no_monotone_gain(Matrix{{1.2, 0}, {0, .5}}, Matrix{{0, 1}}).value().reason ==
        "no monotone gain exists: every monotone A - L C leaves the states (1, 0), to four digits, "
        "as large as they are, and is "
        "not stable");
  // detectable, yet whoever takes the first state's growth away makes an entry negative
  CHECK(no_monotone_gain(Matrix{{1.2, .1}, {.3, .5}}, Matrix{{1, 1}}).has_value());
}

TEST_CASE("a reason that holds but for rounding is no proof") {
  const auto answer = [](const Matrix& A, const Matrix& C) {
    return no_monotone_gain(A, C).value().gain_exists;
  };
  const Matrix row{{.5, 0}, {-.3, .2}}, grows{{1.2, 0}, {0, .5}};
  CHECK(answer(row, Matrix{{1, -1}}) == Answer::no);
  CHECK(answer(row, Matrix{{1, -1}, {1, -1 - 1e-12}}) == Answer::unknown);  // C is regular
  CHECK(answer(grows, Matrix{{0, 1}}) == Answer::no);
  CHECK(answer(grows, Matrix{{1e-3, 1}}) == Answer::no);
  CHECK(answer(Matrix{{.9999999999999}}, Matrix{{0}}) == Answer::unknown);
  CHECK(answer(Matrix{{1.2, .1}, {.3, .5}}, Matrix{{1, 1}}) == Answer::no);
}

TEST_CASE("proofs in rational arithmetic reach as far as 10 states") {
  CHECK(rc::check("unstable plants, one output", [] {
    const Index n = 10;
    const Matrix A = 2 * Matrix::Identity(n, n) + random_matrix(n, n, 0, .1),
                 C = random_matrix(2, n, .5, 1);
    const auto why = no_monotone_gain(A, C);
    RC_ASSERT(why.has_value());
    RC_ASSERT(why->gain_exists == Answer::no);
  }));
}

TEST_CASE("nothing is said where there is one") {
  CHECK_FALSE(no_monotone_gain(Matrix{{.8, .1, .3}, {0, .8, .2}, {.01, 0, .8}}, Matrix{{0, 0, 1}})
                  .has_value());
  CHECK_FALSE(no_monotone_gain(Matrix{{.5, -.1}, {.3, .2}}, Matrix{{0, 1}}).has_value());
  CHECK_FALSE(no_monotone_gain(Matrix{{.8, 0}, {0, .8}}, Matrix(0, 2)).has_value());
  CHECK_FALSE(no_monotone_gain(Matrix{{1.2, 0}, {.3, .5}}, Matrix{{1, 0}}).has_value());
}

TEST_CASE("a system that was made from a monotone stable loop is never refused") {
  CHECK(rc::check("A = M + L C", [] {
    const Index n = *rc::gen::inRange(1, 5), p = *rc::gen::inRange(1, 4);
    Matrix M = random_matrix(n, n, -.3, 1).cwiseMax(0);
    M *= .9 / std::max(.9, invariant::spectral_radius(M));
    const Matrix C = random_matrix(p, n, -1, 1), L = random_matrix(n, p, -2, 2);
    RC_ASSERT_FALSE(no_monotone_gain(M + L * C, C).has_value());
  }));
}

TEST_CASE("what is refused is not found by search either") {
  CHECK(rc::check("random gains", [] {
    const Index n = 2;
    const Matrix A = random_matrix(n, n, -.5, 1.5), C = random_matrix(1, n, -1, 1);
    if (!no_monotone_gain(A, C)) return;
    for (int i = 0; i < 200; ++i) {
      const Matrix closed = A - random_matrix(n, 1, -3, 3) * C;
      RC_ASSERT_FALSE((closed.array() >= 0).all() && invariant::spectral_radius(closed) < 1);
    }
  }));
}

TEST_CASE("in the plane the answer is that of the intervals of L") {
  int refused = 0, all = 0;
  CHECK(rc::check("one output, two states", [&] {
    const Matrix A = random_matrix(2, 2, -.5, 1.5), C = random_matrix(1, 2, -1, 1);
    // each L_i in an interval; the spectral radius of a monotone matrix falls with its entries, c
    // c' ≥ 0: ends decide, else a grid
    double low[2], high[2];
    for (Index i = 0; i < 2; ++i) {
      low[i] = -1e3;
      high[i] = 1e3;
      for (Index j = 0; j < 2; ++j) {
        if (C(j) > 0) high[i] = std::min(high[i], A(i, j) / C(j));
        if (C(j) < 0) low[i] = std::max(low[i], A(i, j) / C(j));
      }
    }
    double best = 1e9;
    for (int a = 0; a <= 60; ++a) {
      for (int b = 0; b <= 60; ++b) {
        if (low[0] > high[0] || low[1] > high[1]) continue;
        const Matrix L{{low[0] + (high[0] - low[0]) * a / 60},
                       {low[1] + (high[1] - low[1]) * b / 60}};
        best = std::min(best, invariant::spectral_radius(A - L * C));
      }
    }
    const bool no = no_monotone_gain(A, C).has_value();
    refused += no;
    ++all;
    if (best < .999) RC_ASSERT_FALSE(no);
    if (low[0] > high[0] + 1e-6 || low[1] > high[1] + 1e-6) RC_ASSERT(no);
    if (C(0) * C(1) > 0 && best > 1.001) RC_ASSERT(no);  // an end decides
  }));
  CHECK(refused * 20 > all);
}

TEST_CASE("rounding below zero is raised, what is really negative stays") {
  const Matrix A{{.8, .1, .3}, {0, .8, .2}, {.01, 0, .8}}, C{{0, 0, 1}};
  const Matrix L = raised_to_monotone(A, C, Matrix{{.3 + 1e-13}, {.2 + 1e-15}, {.8 + 1e-12}});
  CHECK(((A - L * C).array() >= 0).all());
  CHECK((L - Matrix{{.3}, {.2}, {.8}}).norm() < 1e-11);
  const Matrix far{{.3 + 1e-4}, {.2}, {.8}};
  CHECK(raised_to_monotone(A, C, far)(0) == far(0));
  const Matrix square{{.31, .7}, {.2, .11}}, both{{1, .3}, {.7, -.9}};  // A - L C = 0: L = A C⁻¹
  const Matrix exact = linalg::solve(both.transpose(), square.transpose()).value().transpose();
  const Matrix raised = raised_to_monotone(square, both, exact + Matrix::Constant(2, 2, 1e-15));
  CHECK(((square - linalg::product(raised, both)).array() >= 0).all());
  CHECK((raised - exact).norm() < 1e-12);
}

TEST_CASE("raising never makes the least entry smaller, also where one L alone serves") {
  CHECK(rc::check("rows between two outputs' limits", [] {
    const Index n = *rc::gen::inRange(2, 5), p = *rc::gen::inRange(1, 3);
    Matrix M = random_matrix(n, n, -1, 1).cwiseMax(0);
    M.row(0).setZero();
    const Matrix C = random_matrix(p, n, -1, 1), A = M + random_matrix(n, p, -1, 1) * C;
    const Matrix L = linalg::product(A - M, linalg::pseudo_inverse(C));
    const Matrix raised = raised_to_monotone(A, C, L);
    for (Index i = 0; i < n; ++i) {
      const Matrix before = A.row(i) - linalg::product(L.row(i), C),
                   after = A.row(i) - linalg::product(raised.row(i), C);
      RC_ASSERT(after.minCoeff() >= before.minCoeff());
    }
  }));
}
