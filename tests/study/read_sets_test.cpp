// SPDX-License-Identifier: GPL-3.0-or-later
// Every set type means the set that docs/study_format.md defines.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/fakes.hpp"

using namespace cordon;
using namespace study_test;

namespace {

/// The set of a JSON text in R², read as X0 of a study whose simulation does not start from a given
/// point.
LineForm set_of(const std::string& json) {
  const std::string text = exchanged(valid_study, "\"x0\": [0.5, 0.25],\n", "");
  return read_text(
             exchanged(
                 text,
                 "{\"type\": \"zonotope\", \"center\": [0, 1], \"generators\": [[1, 0.5], [0, 1]]}",
                 json))
      .model.X0;
}

Vector point(double x, double y) { return (Vector(2) << x, y).finished(); }

}  // namespace

TEST_CASE("box: bounded, flat and free coordinates") {
  const LineForm X = set_of(R"({"type": "box", "lower": [-1, "-inf"], "upper": [3, "inf"]})");
  const Box hull = interval_hull(X);
  CHECK(hull.lower[0] == doctest::Approx(-1));
  CHECK(hull.upper[0] == doctest::Approx(3));
  CHECK(hull.upper[1] == std::numeric_limits<double>::infinity());
  CHECK(hull.lower[1] == -std::numeric_limits<double>::infinity());
  CHECK(set_of(R"({"type": "box", "lower": [2, 2], "upper": [2, 2]})").generators() == 0);
}

TEST_CASE("zonotope: rows are states, columns are generators") {
  const LineForm X =
      set_of(R"({"type": "zonotope", "center": [1, 2], "generators": [[1, 2, 3], [0, 1, 0]]})");
  CHECK(X.generators() == 3);
  CHECK(support(X, point(1, 0)) == doctest::Approx(7));
  CHECK(support(X, point(0, 1)) == doctest::Approx(3));
  CHECK(set_of(R"({"type": "zonotope", "center": [1, 2]})").generators() == 0);
  CHECK(set_of(R"({"type": "zonotope", "center": [1, 2], "generators": []})").generators() == 0);
}

TEST_CASE("constrained zonotope and line zonotope") {
  const LineForm X = set_of(
      R"({"type": "constrained_zonotope", "center": [0, 0], "generators": [[1, 0], [0, 1]], "A": [[1, 1]], "b": [1]})");
  CHECK(support(X, point(1, 1)) == doctest::Approx(1));
  CHECK(support(X, point(-1, 0)) == doctest::Approx(0));
  const LineForm L = set_of(
      R"({"type": "line_zonotope", "center": [0, 0], "lines": [[1, 0], [0, 1]], "generators": [[0], [0]],
                                "S": [[1, 0]], "A": [[-1]], "b": [5]})");
  CHECK(support(L, point(1, 0)) == doctest::Approx(6));
  CHECK(support(L, point(-1, 0)) == doctest::Approx(-4));
  CHECK(support(L, point(0, 1)) == std::numeric_limits<double>::infinity());
  // blocks left out are zero
  const LineForm Z =
      set_of(R"({"type": "line_zonotope", "center": [0, 0], "lines": [[1], [1]], "b": [0]})");
  CHECK((Z.S.isZero(0) && Z.A.cols() == 0 && Z.constraints() == 1));
}

TEST_CASE("strip, space and point") {
  const LineForm X = set_of(R"({"type": "strip", "rho": [2, 0], "d": 3, "sigma": 1})");
  CHECK(support(X, point(1, 0)) == doctest::Approx(2));
  CHECK(support(X, point(-1, 0)) == doctest::Approx(-1));
  CHECK(set_of(R"({"type": "space", "dim": 2})").lines() == 2);
  CHECK(set_of(R"({"type": "point", "center": [4, 5]})").c == point(4, 5));
}

TEST_CASE("polytope: the triangle x, y ≥ 0, x + y ≤ 1") {
  const LineForm X =
      set_of(R"({"type": "polytope", "lower": [0, 0], "upper": [1, 1], "H": [[1, 1]], "h": [1]})");
  CHECK(contains(X, point(0.4, 0.4)) == Answer::yes);
  CHECK(contains(X, point(0.6, 0.6)) == Answer::no);
  CHECK(support(X, point(1, 1)) == doctest::Approx(1));
  CHECK(support(X, point(1, 2)) == doctest::Approx(2));
  CHECK(support(X, point(-1, -1)) == doctest::Approx(0));
}

TEST_CASE("polytope: the same triangle without bounds, and by its vertices") {
  for (const char* json :
       {R"({"type": "polytope", "H": [[1, 1], [-1, 0], [0, -1], [1, 0]], "h": [1, 0, 0, 7]})",
        R"({"type": "polytope", "vertices": [[0, 0], [1, 0], [0.25, 0.25], [0, 1]]})"}) {
    const LineForm X = set_of(json);
    CHECK(Polytope::from(X) == Polytope::from_generators(Matrix{{0, 1, 0}, {0, 0, 1}}));
    CHECK(X.constraints() == 1);
  }
  CHECK(set_of(R"({"type": "polytope", "vertices": [[4, 5]]})").c == point(4, 5));
  const LineForm strip = set_of(R"({"type": "polytope", "H": [[1, 0], [-1, 0]], "h": [1, 0]})");
  CHECK(Polytope::from(strip) == Polytope::from(make_strip(point(1, 0), 0.5, 0.5)));
}

TEST_CASE(
    "polytope: contains the points of its inequalities, and the supports of no others, over random "
    "ones") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const double scale = std::pow(10.0, 4 * unit(random));
    Matrix H(2, 2);
    for (double& x : H.reshaped()) x = unit(random);
    const Vector inside = scale * point(unit(random), unit(random)),
                 h = H * inside + scale * point(0.2, 0.3);
    const auto number = [](double x) {
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%.17g", x);
      return std::string(text.data());
    };
    const std::string bound = number(2 * scale);
    const LineForm X =
        set_of("{\"type\": \"polytope\", \"lower\": [-" + bound + ", -" + bound +
               "], \"upper\": [" + bound + ", " + bound + "], \"H\": [[" + number(H(0, 0)) + "," +
               number(H(0, 1)) + "],[" + number(H(1, 0)) + "," + number(H(1, 1)) + "]], \"h\": [" +
               number(h[0]) + "," + number(h[1]) + "]}");
    for (int i = 0; i < 2; ++i) CHECK(support(X, H.row(i).transpose()) <= h[i] + 1e-9 * scale);
    for (int sample = 0; sample < 30; ++sample) {
      const Vector x = 2 * scale * point(unit(random), unit(random));
      const bool member = ((H * x).array() <= h.array()).all();
      const Answer answer = contains(X, x);
      CAPTURE(x.transpose());
      if (member) CHECK(answer != Answer::no);
      if ((H * x - h).maxCoeff() > 1e-6 * scale) CHECK(answer == Answer::no);
    }
  }
}
