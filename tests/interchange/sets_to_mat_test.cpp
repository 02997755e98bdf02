// SPDX-License-Identifier: GPL-3.0-or-later
// Sets that go to MATLAB come back as they were.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/experiments/interchange.hpp"
#include "experiments/interchange/json_to_mat.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/model_to_mat.hpp"
#include "interchange/mat_variables.hpp"
#include "run/scratch.hpp"
#include "study/reading/read_sets.hpp"

using namespace cordon;
using namespace interchange_test;

TEST_CASE("boxes are recognised, and only boxes") {
  CHECK(rc::check("make_box of the bounds is the set", [] {
    const auto n = *rc::gen::inRange<Index>(1, 5);
    Box box{Vector(n), Vector(n)};
    for (Index i = 0; i < n; ++i) {
      const double x = *rc::gen::inRange(-1000, 1000) / 64.0,
                   y = *rc::gen::inRange(-1000, 1000) / 256.0;
      box.lower[i] = std::min(x, y), box.upper[i] = std::max(x, y);
      if (*rc::gen::inRange(0, 5) == 0) box.lower[i] = -infinity, box.upper[i] = infinity;
      if (*rc::gen::inRange(0, 5) == 0) box.lower[i] = box.upper[i] = x;
    }
    const LineForm X = make_box(box);
    const auto found = mat::as_box(X);
    RC_ASSERT(found.has_value());
    RC_ASSERT(found->lower == box.lower);
    RC_ASSERT(found->upper == box.upper);
    const LineForm Y = make_box(*found);
    RC_ASSERT(X.c == Y.c);
    RC_ASSERT(X.G == Y.G);
    RC_ASSERT(X.M == Y.M);
  }));
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{0, 0}}, Matrix{{1, 0.5}, {0, 1}})));
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{0, 0}}, Matrix{{0, 1}, {1, 0}})));
  CHECK_FALSE(mat::as_box(make_strip(Vector{{1, 0}}, 0, 1)));
  LineForm cut = make_box({Vector{{0}}, Vector{{1}}});
  cut.A = Matrix{{1}}, cut.b = Vector{{0}}, cut.S = Matrix(1, 0);
  CHECK_FALSE(mat::as_box(cut));
}

TEST_CASE("bounds that are no doubles are not written") {
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{0.1}}, Matrix{{0.7}})));  // 0.1 + 0.7 is rounded
  CHECK_FALSE(
      mat::as_box(make_zonotope(Vector{{1e308}}, Matrix{{1.7e308}})));  // there is no such double
  CHECK_FALSE(mat::as_box(make_zonotope(Vector{{1}}, Matrix{{1e-300}})));
  const Value X = mat::to_mat(make_zonotope(Vector{{0.1}}, Matrix{{0.7}}));
  CHECK(X.field("type")->text == "zonotope");
  CHECK_FALSE(X.field("lower"));
  CHECK(X.field("c")->numbers(0, 0) == 0.1);
  CHECK(X.field("G")->numbers(0, 0) == 0.7);
}

TEST_CASE("sets come back bit by bit, and as they were written") {
  const Scratch scratch;
  CHECK(rc::check("random zonotopes", [&] {
    const auto n = *rc::gen::inRange<Index>(1, 4), m = *rc::gen::inRange<Index>(1, 4);
    const bool diagonal = *rc::gen::arbitrary<bool>();
    const auto any = [] {
      return std::ldexp(*rc::gen::inRange(-100000, 100000) / 977.0, *rc::gen::inRange(-60, 60));
    };
    Vector c(n);
    Matrix G = Matrix::Zero(n, diagonal ? n : m);
    for (Index i = 0; i < n; ++i) c[i] = any();
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < G.cols(); ++j) {
        if (!diagonal || i == j) G(i, j) = diagonal ? std::abs(any()) + 1e-9 : any();
      }
    }
    const auto back = mat_to_json(mat_of(scratch, {{"X", mat::to_mat(make_zonotope(c, G))}}),
                                  {scratch / "set.json", true});
    RC_ASSERT(back.sets_only);
    json::Problems problems;
    std::vector<std::string> warnings;
    const json::Value root = json::parse(bytes_of(scratch / "set.json"), problems);
    const auto X = json::read_set(json::Cursor(root, "", problems), warnings);
    RC_ASSERT(X.has_value());
    RC_ASSERT(X->c == c);
    RC_ASSERT(X->G.rows() == n);
    if (G.cwiseAbs().minCoeff() > 0 || diagonal) RC_ASSERT((X->G.cols() == G.cols() && X->G == G));
    const Value written = mat::to_mat(make_zonotope(c, G));
    for (Index i = 0; written.field("lower") && i < n; ++i) {  // in more digits
      const long double center = c[i], radius = G.row(i).cwiseAbs().maxCoeff();
      RC_ASSERT(center - radius == static_cast<long double>(written.field("lower")->numbers(i, 0)));
      RC_ASSERT(center + radius == static_cast<long double>(written.field("upper")->numbers(i, 0)));
    }
  }));
}

TEST_CASE("the fields of a set") {
  const Value X = mat::to_mat(make_box({Vector{{-1, -infinity}}, Vector{{3, infinity}}}));
  CHECK(X.field("type")->text == "box");
  CHECK(X.field("lower")->numbers == Matrix{{-1}, {-infinity}});
  CHECK(X.field("upper")->numbers == Matrix{{3}, {infinity}});
  CHECK(X.field("c")->numbers == Matrix{{1}, {0}});
  CHECK(X.field("G")->numbers == Matrix{{2}, {0}});
  CHECK(X.field("M")->numbers == Matrix{{0}, {1}});
  CHECK(mat::to_mat(make_space(2)).field("type")->text == "space");
  CHECK(mat::to_mat(make_point(Vector{{1}})).field("type")->text == "point");
  CHECK(mat::to_mat(make_strip(Vector{{1, 1}}, 0, 1)).field("type")->text == "line_zonotope");
  CHECK(mat::to_mat(make_zonotope(Vector{{0, 0}}, Matrix{{1, 1}, {0, 1}})).field("type")->text ==
        "zonotope");
}

TEST_CASE("sets of every type come back") {
  const Scratch scratch;
  const std::string sets = R"([
    {"type": "box", "lower": [-1, "-inf"], "upper": [1, "inf"]},
    {"type": "zonotope", "center": [1, 2], "generators": [[1, 0.5], [0, 1]]},
    {"type": "constrained_zonotope", "center": [0, 0], "generators": [[1, 0], [0, 1]], "A": [[1, 1]], "b": [0.5]},
    {"type": "line_zonotope", "center": [0, 0], "lines": [[1], [1]], "generators": [[0], [1]], "S": [[1]], "A": [[-1]], "b": [2]},
    {"type": "space", "dim": 3},
    {"type": "point", "center": [4, 5, 6]}])";
  put(scratch / "sets.json", sets);
  CHECK(json_file(scratch / "sets.json") == JsonFile::sets);
  sets_to_mat(scratch / "sets.json", {scratch / "sets.mat"});
  const ImportedStudy back = mat_to_json(scratch / "sets.mat", {scratch / "back.json"});
  CHECK(back.sets_only);
  rewrite_matrices(scratch / "sets.json", {scratch / "same.json"}, MatrixForm::dense);
  CHECK(bytes_of(scratch / "back.json") == bytes_of(scratch / "same.json"));
}

TEST_CASE("one set, and the types that are not exchange forms") {
  const Scratch scratch;
  mat::Struct strip, polytope, hull;
  strip.set("rho", mat::matrix(Matrix{{1, 2}}))
      .set("d", mat::number(0.5))
      .set("sigma", mat::number(1));
  polytope.set("H", mat::matrix(Matrix{{1, 1}}))
      .set("h", mat::number(1))
      .set("lower", mat::matrix(Matrix{{-1}, {-1}}));
  polytope.set("upper", mat::matrix(Matrix{{1}, {1}}));
  hull.set("type", mat::text("polytope"))
      .set("vertices", mat::matrix(Matrix{{0, 0}, {1, 0}, {0, 1}}));
  const std::pair<Value, std::string> cases[] = {
      {std::move(strip).value(), R"({"type": "strip", "rho": [1, 2], "d": 0.5, "sigma": 1})"},
      {std::move(polytope).value(),
       R"({"type": "polytope", "lower": [-1, -1], "upper": [1, 1], "H": [[1, 1]], "h": [1]})"},
      {std::move(hull).value(), R"({"type": "polytope", "vertices": [[0, 0], [1, 0], [0, 1]]})"}};
  for (const auto& [value, text] : cases) {
    put(scratch / "want.json", text);
    rewrite_matrices(scratch / "want.json", {scratch / "same.json", true}, MatrixForm::dense);
    mat_to_json(mat_of(scratch, {{"S", value}}), {scratch / "back.json", true});
    CHECK(bytes_of(scratch / "back.json") == bytes_of(scratch / "same.json"));
  }
}
