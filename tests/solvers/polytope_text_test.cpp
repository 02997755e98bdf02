// SPDX-License-Identifier: GPL-3.0-or-later
// Both descriptions of polytopes as texts, and back.
#include <random>

#include <doctest/doctest.h>

#include "cordon/sets/sampling.hpp"
#include "cordon/solvers/polytope.hpp"
#include "saved_state/damage.hpp"
#include "solvers/polytopes.hpp"

using namespace cordon;
using namespace solvers_test;

namespace {

Matrix drawn(sets::Random& random, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index j = 0; j < cols; ++j) A.col(j) = random.cube(rows);
  return A;
}

std::vector<Polytope> some() {
  std::vector<Polytope> all{
      Polytope::empty(0),
      Polytope::space(0),
      Polytope::empty(3),
      Polytope::space(2),
      Polytope::from_inequalities(Matrix{{1, 2}}, Vector{{3}}),
      Polytope::from_inequalities(Matrix{{1, 2}}, Vector{{3}}, Matrix{{0, 1}}, Vector{{1}}),
      Polytope::from_generators(Matrix{{1}, {2}}, Matrix{{0}, {1}}, Matrix{{1}, {0}})};
  sets::Random random(1);
  for (Index n = 1; n <= 3; ++n) {
    for (int i = 0; i < 10; ++i) {
      const Polytope P = Polytope::from_generators(drawn(random, n, n + 4));
      all.push_back(P.affine_map(drawn(random, n, n), random.cube(n)));
      all.push_back(
          P.intersection(Polytope::from_inequalities(drawn(random, 2, n), random.cube(2))));
    }
  }
  return all;
}

}  // namespace

TEST_CASE("polytopes are read as they were, and go on alike") {
  sets::Random random(2);
  for (const Polytope& P : some()) {
    const std::string text = P.descriptions();
    CAPTURE(text);
    const Polytope Q = Polytope::from_descriptions(text);
    CHECK(Q.descriptions() == text);
    CHECK(Q == P);
    const Index n = P.dim();
    const Matrix T = drawn(random, n, n);
    const Polytope box = Polytope::from(make_box({-Vector::Ones(n), Vector::Ones(n)}));
    const auto next = [&](const Polytope& X) {
      return X.affine_map(T, Vector::Ones(n)).minkowski_sum(box).intersection(box).descriptions();
    };
    CHECK(next(P) == next(Q));
  }
}

TEST_CASE("descriptions of two sets, and what is none, are refused") {
  const std::string square =
                        Polytope::from_inequalities(stacked(2), Vector::Ones(4)).descriptions(),
                    larger = Polytope::from_inequalities(stacked(2), Vector::Constant(4, 2))
                                 .descriptions();
  const auto half = [](const std::string& text, bool first) {
    const std::size_t second = text.find("2 4\n", 1);  // both have four rows
    return first ? text.substr(0, second) : text.substr(second);
  };
  const auto refused = [](const std::string& text) {
    return code_of([&] { Polytope::from_descriptions(text); }) == Errc::invalid;
  };
  CHECK(!refused(half(square, true) + half(square, false)));
  CHECK(refused(half(square, true) + half(larger, false)));
  CHECK(refused(half(larger, true) + half(square, false)));
  for (const char* text : {"", "2", "2 4", "-1 0\n-1 0\n", "0 1\n+ 1/0\n0 0\n", "0 1\n+ 1\n0 0\nx",
                           "1 1\n+ 1 g\n1 0\n", "1 1\n? 1 0\n1 0\n", "1 1\n+ 2 0\n1 0\n",
                           "1 1\n+ 0 1\n1 1\n+ 1 0\n", "9999999999 0\n9999999999 0\n",
                           "1 9999999999999999999\n", "1 1\n= 1 0\n1 0\n", "1 1\n+ 1 1/-2\n1 0\n"})
    CHECK_MESSAGE(refused(text), text);
}

TEST_CASE("damaged texts are refused, or are those of a polytope") {
  std::mt19937_64 random(1);
  int refused = 0, read = 0;
  for (const Polytope& P : some()) {
    const std::string text = P.descriptions();
    for (int i = 0; i < 200; ++i) {
      try {
        const Polytope Q = Polytope::from_descriptions(damage(text, random));
        Q.interval_hull();
        CHECK(Q.is_empty() == (Q.generators().vertices.cols() == 0));
        ++read;
      } catch (const Error& error) {
        REQUIRE(error.code() == Errc::invalid);
        ++refused;
      }
    }
  }
  CHECK(refused > 10 * read);
}
