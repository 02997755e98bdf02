// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/detectability.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"

using namespace cordon;
using estimators::undetectable_mode;
using estimators::unobservable_mode;

TEST_CASE("a hidden mode is named with its direction") {
  const Matrix C{{1, 0}};
  CHECK(undetectable_mode(Matrix{{.5, 0}, {0, 1.2}}, C).value() ==
        "the mode 1.2 of A, along (0, 1), does not show in the outputs");
  CHECK(undetectable_mode(Matrix{{.5, 0}, {.3, -1}}, C).value() ==
        "the mode -1 of A, along (0, 1), does not show in the outputs");
  CHECK(undetectable_mode(Matrix{{.5, 0, 0}, {1, 1, -1}, {0, 1, 1}}, Matrix{{1, 0, 0}})
            .value()
            .starts_with("the mode 1 + 1i of A"));
  CHECK(undetectable_mode(Matrix{{1.5, 1}, {0, 1.5}}, Matrix(0, 2)).has_value());
  CHECK(undetectable_mode(Matrix{{2, 0}, {0, 2}}, Matrix{{1, -1}}).value() ==
        "the mode 2 of A, along (1, 1), does not show in the outputs");
}

TEST_CASE("modes that decay need not show, unless observability is asked for") {
  const Matrix A{{.5, 0}, {0, .9}}, C{{1, 0}};
  CHECK_FALSE(undetectable_mode(A, C).has_value());
  CHECK(unobservable_mode(A, C).value() == "the mode 0.9 of A, along (0, 1), does not show in the outputs");
  CHECK(unobservable_mode(Matrix::Zero(2, 2), Matrix{{1, 1}}).has_value());
  CHECK_FALSE(unobservable_mode(Matrix{{0, 0}, {1, 0}}, Matrix{{0, 1e-9}}).has_value());  // the outputs' unit does not matter
  CHECK_FALSE(undetectable_mode(Matrix(0, 0), Matrix(1, 0)).has_value());
}

TEST_CASE("a mode is hidden exactly where it was hidden on purpose") {
  CHECK(rc::check("block systems in random coordinates", [] {
    const auto number = [] { return (*rc::gen::inRange(-100, 101)) * 1e-2; };
    const double seen = number(), hidden = 1.1 + std::abs(number());
    const bool connected = *rc::gen::arbitrary<bool>();
    const Matrix T{{1, number()}, {number(), 3}};
    const Matrix back = linalg::solve(T, Matrix::Identity(2, 2)).value();
    const Matrix A = T * Matrix{{seen, 0}, {number(), hidden}} * back;
    const Matrix C = Matrix{{1, connected ? .5 : 0}} * back;
    RC_ASSERT(undetectable_mode(A, C).has_value() == !connected);
  }));
}

TEST_CASE("a mode that shows by a small entry is no hidden one") {
  // the second state is seen by 1e-8 beside 1e8: badly scaled, and detectable
  CHECK_FALSE(undetectable_mode(Matrix{{.5, 0}, {0, 2}}, Matrix{{1e8, 1e-8}}).has_value());
  CHECK(undetectable_mode(Matrix{{.5, 0}, {0, 2}}, Matrix{{1e8, 0}}).has_value());
}
