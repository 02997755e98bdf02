// SPDX-License-Identifier: GPL-3.0-or-later
// The kit's own parts: names, patterns, seeds, shrinking, generators.
#include "cordon/conformance/conformance.hpp"

#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "generate.hpp"
#include "operations.hpp"
#include "reference.hpp"
#include "shrink.hpp"

using namespace cordon;
using namespace cordon::conformance;

TEST_CASE("laws have unique names of their group, and a statement") {
  std::set<std::string> names;
  for (const Law& law : laws()) {
    CAPTURE(law.name);
    CHECK(names.insert(law.name).second);
    CHECK_FALSE(law.statement.empty());
    CHECK(law.statement.find('|') == std::string::npos);  // stands in a table
  }
  for (const char* group :
       {"soundness.", "tightness.", "algebra.", "questions.", "contract.", "lifetime.", "observer.",
        "diagnoser.", "designer.", "gain.", "metric.", "plant."}) {
    CHECK(names.lower_bound(group)->starts_with(group));
  }
}

TEST_CASE("patterns") {
  CHECK(matches("*", ""));
  CHECK(matches("*", "soundness.sum"));
  CHECK(matches("soundness.*", "soundness.sum"));
  CHECK(matches("*sum", "soundness.sum"));
  CHECK(matches("soundness.s?m", "soundness.sum"));
  CHECK_FALSE(matches("soundness.s?m", "soundness.sm"));
  CHECK_FALSE(matches("soundness", "soundness.sum"));
  CHECK_FALSE(matches("", "x"));
}

TEST_CASE("an unknown law is an error with a suggestion") {
  try {
    describe_case("soundness.sums", {}, {}, 0);
    FAIL("nothing was thrown");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::invalid);
    CHECK(std::string(error.what()).find("soundness.sum") != std::string::npos);
  }
}

TEST_CASE("a case depends on law, seed and number only") {
  const Options one{"*", 7, 10}, many{"*", 7, 1000}, other{"*", 8, 10};
  for (Index k = 0; k < 20; ++k) {
    CHECK(describe_case("soundness.sum", one, {}, k) ==
          describe_case("soundness.sum", many, {}, k));
    CHECK(describe_case("soundness.sum", one, {}, k) !=
          describe_case("soundness.sum", other, {}, k));
    CHECK(describe_case("soundness.sum", one, {}, k) != describe_case("tightness.sum", one, {}, k));
  }
}

TEST_CASE("generated sets hold the point that they come with, and empty ones none") {
  Random random(5);
  int points = 0, lines = 0, constrained = 0;
  for (int k = 0; k < 300; ++k) {
    Generator make(random, Style::tame);
    const Index n = random.between(0, 3);
    const TestSet X = make.set("X", 'n', n, {true, 5, 2});
    check(X.form, "generated");
    CHECK(exact::contains(X.form, X.point()) == Answer::yes);
    for (const Vector& x : points_of(X.form, X.delta, X.xi, random, 3))
      CHECK(exact::contains(X.form, x) == Answer::yes);
    points += X.form.generators() == 0;
    lines += X.form.lines() > 0;
    constrained += X.form.constraints() > 0;
    CHECK(exact::is_empty(make.empty("E", 'n', n, {true, 5, 2}).form) == Answer::yes);
  }
  CHECK(points > 10);
  CHECK(lines > 30);
  CHECK(constrained > 30);
}

TEST_CASE("a reference bounds the exact support function from both sides") {
  Random random(6);
  int tight = 0, asked = 0;
  for (int k = 0; k < 200; ++k) {
    Generator make(random, Style::tame);
    const TestSet X = make.set("X", 'n', random.between(1, 3), {true, 5, 2});
    Reference reference(X.form, {X.point()});
    for (const Vector& d : directions({}, X.form.dim(), random, 3)) {
      const Interval exact = exact::support(X.form, d);
      const double tolerance = reference.tolerance(d);
      CHECK(reference.lower(d) <= exact.upper + tolerance);
      CHECK(reference.upper(d) >= exact.lower - tolerance);
      ++asked;
      tight += reference.lower(d) == exact.upper || reference.lower(d) >= exact.lower - tolerance;
    }
  }
  CHECK(tight > asked * 9 / 10);  // a reference that knows nothing would make every law hold
}

TEST_CASE("a case shrinks to what matters") {
  Random random(9);
  Generator make(random, Style::full);
  TestCase test;
  test.sets.push_back(make.set("X", 'n', 4, {false, 6, 2}));
  test.sets.push_back(make.set("Y", 'n', 4, {false, 6, 2}));
  test.matrices.push_back({"T", 'p', 'n', make.matrix(3, 4)});
  test.sets[1].form.G = make.matrix(4, test.sets[1].form.generators());
  test.sets[1].form.G(2, 0) = 3.7;
  const auto fails = [](const TestCase& t) {
    return t.sets[1].form.G.size() > 0 && t.sets[1].form.G.cwiseAbs().maxCoeff() > 0.5;
  };
  REQUIRE(fails(test));
  const TestCase small = shrink(test, fails, 5000);
  CHECK(fails(small));
  CHECK(describe(small.sets[0].form) == R"({"type": "point", "center": [0]})");
  CHECK(describe(small.sets[1].form) ==
        R"({"type": "zonotope", "center": [0], "generators": [[1]]})");
  CHECK(small.matrices[0].value.size() == 1);
  // known points stay members
  for (const TestSet& X : small.sets) CHECK(exact::contains(X.form, X.point()) == Answer::yes);
}

TEST_CASE("no bound across a line that is normal to the direction up to rounding only") {
  const LineForm X{Matrix::Ones(3, 1), Matrix(3, 0), Vector::Zero(3),
                   Matrix(0, 1),       Matrix(0, 0), Vector(0)};
  const Vector d{{1e-17, -1, 1}};
  REQUIRE(X.M.col(0).dot(d) == 0);
  CHECK(std::isinf(exact::support(X, d).upper));
  CHECK(std::isinf(Reference(X).upper(d)));
  CHECK(Reference(make_space(3)).upper(Vector::Zero(3)) == 0);
  const LineForm strip{Matrix{{1}, {1}}, Matrix{{1}, {0}}, Vector{{1, 2}},
                       Matrix(0, 1),     Matrix(0, 1),     Vector(0)};
  CHECK(Reference(strip).upper(Vector{{1, -1}}) == 0);
}

TEST_CASE("a set without factors is not empty by nothing or by rounding only") {
  LineForm X = make_point(Vector{{1, 2}});
  CHECK(Reference(X).robust());
  X.S = X.A = Matrix(1, 0);
  X.b = Vector{{0}};
  CHECK_FALSE(Reference(X).robust());
  X.b[0] = 1;
  CHECK_FALSE(Reference(X).robust());
}
