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
  CHECK(undetectable_mode(Matrix{{.5, 0}, {0, 1.2}}, C).value().reason ==
        "the mode 1.2 of A, along (0, 1), does not show in the outputs");
  CHECK(undetectable_mode(Matrix{{.5, 0}, {.3, -1}}, C).value().reason ==
        "the mode -1 of A, along (0, 1), does not show in the outputs");
  CHECK(undetectable_mode(Matrix{{.5, 0, 0}, {1, 1, -1}, {0, 1, 1}}, Matrix{{1, 0, 0}})
            .value()
            .reason.starts_with("the mode 1 + 1i of A"));
  CHECK(undetectable_mode(Matrix{{1.5, 1}, {0, 1.5}}, Matrix(0, 2)).has_value());
  CHECK(undetectable_mode(Matrix{{2, 0}, {0, 2}}, Matrix{{1, -1}}).value().reason ==
        "the mode 2 of A, along (1, 1), does not show in the outputs");
}

TEST_CASE("modes that decay need not show, unless observability is asked for") {
  const Matrix A{{.5, 0}, {0, .9}}, C{{1, 0}};
  CHECK_FALSE(undetectable_mode(A, C).has_value());
  CHECK(unobservable_mode(A, C).value().reason ==
        "the mode 0.9 of A, along (0, 1), does not show in the outputs");
  CHECK(unobservable_mode(Matrix::Zero(2, 2), Matrix{{1, 1}}).has_value());
  CHECK_FALSE(unobservable_mode(Matrix{{0, 0}, {1, 0}}, Matrix{{0, 1e-9}})
                  .has_value());  // the outputs' unit does not matter
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

TEST_CASE(
    "what is said to have no gain has none in exact arithmetic; what rounding may hide is "
    "unknown") {
  const auto answer = [](const Matrix& A, const Matrix& C, double rate = 1) {
    const auto found = undetectable_mode(A, C, rate);
    return found ? found->gain_exists : Answer::yes;
  };
  const Matrix none(0, 1), both{{1, 1}};
  CHECK(answer(Matrix{{.9999999999995}}, none) == Answer::yes);  // decays, with the gain 0
  CHECK(answer(Matrix{{1 - 1e-16}}, none) == Answer::yes);
  CHECK(answer(Matrix{{1}}, none) == Answer::no);
  CHECK(answer(Matrix{{-1}}, none) == Answer::no);
  CHECK(answer(Matrix{{1 + 3e-16}}, none) == Answer::no);
  CHECK(answer(Matrix{{2, 0}, {0, 2}}, both) == Answer::no);
  CHECK(answer(Matrix{{2, 0}, {0, 2 + 1e-10}}, both) ==
        Answer::unknown);  // L = (-22499998138.34, 22499998141.34) serves
  CHECK(answer(Matrix{{2, 0}, {0, 2 + 1e-9}}, both) == Answer::yes);
  CHECK(answer(Matrix{{.8}}, none, .6399999999) == Answer::no);
  CHECK(answer(Matrix{{.5}}, none, .25) ==
        Answer::yes);  // as slowly as asked for: for the designer to find out
  CHECK(answer(Matrix{{.5}}, none, .2501) == Answer::yes);
  CHECK(answer(Matrix{{.6, -.8}, {.8, .6}}, Matrix(0, 2)) ==
        Answer::no);  // .6² + .8² > 1, for the doubles
  CHECK(answer(Matrix{{0, 1}, {-1, 0}}, Matrix(0, 2)) == Answer::no);
  CHECK(estimators::not_detectable({Answer::unknown, "m"}).starts_with("no gain was sought"));
  CHECK(unobservable_mode(Matrix{{.5, 0}, {0, .5}}, both)->gain_exists == Answer::no);
  CHECK(unobservable_mode(Matrix{{.5, 0}, {0, .5 + 1e-12}}, both)->gain_exists == Answer::unknown);
}

TEST_CASE("the mode that is named is the one that is hidden, not one that nearly is") {
  // 2 along (1, 1, 0, 0) shows by 1e-10; what never shows is 1.5, along the fourth axis
  const Matrix A{{1, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, .5, 0}, {0, 0, 0, 1.5}},
      C{{.01, -.0100000001, 1, 0}};
  const std::string told = "the mode 1.5 of A, along (0, 0, 0, 1), does not show in the outputs";
  CHECK(undetectable_mode(A, C).value().reason == told);
  CHECK(unobservable_mode(A, C).value().reason == told);
  CHECK(undetectable_mode(A.topLeftCorner(3, 3), C.leftCols(3)).value().gain_exists ==
        Answer::unknown);
}
