// SPDX-License-Identifier: GPL-3.0-or-later
// Set operations with results published in the test suites of CORA and ZonoOpt (named case by case
// in the data file), checked there or independently by linear programs. Those of plain zonotopes
// are in tests/sets.
#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/vertices.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

constexpr double tolerance = 1e-6;

Matrix matrix(const json& rows) {
  Matrix A(static_cast<Index>(rows.size()), rows.empty() ? 0 : static_cast<Index>(rows[0].size()));
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j)
      A(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  return A;
}
Vector vector(const json& values) {
  Vector v(static_cast<Index>(values.size()));
  for (Index i = 0; i < v.size(); ++i) v[i] = values[static_cast<std::size_t>(i)];
  return v;
}
LineForm set(const json& s) {
  LineForm X = make_zonotope(vector(s["c"]), matrix(s["G"]));
  if (s.contains("A")) {
    X.A = matrix(s["A"]);
    X.b = vector(s["b"]);
    X.S.resize(X.b.size(), 0);
  }
  return X;
}

Matrix polygon_of(const LineForm& X) {
  const LineForm Y = eliminate_lines(X);
  BoxedProgram program(Y.A, Y.b);
  return sets::polygon([&](const Vector& d) -> sets::SupportPoint {
    const auto bound = program.maximum(linalg::product(Y.G.transpose(), d));
    REQUIRE(bound.xi);
    return {d.dot(Y.c) + bound.upper, Y.c + linalg::product(Y.G, *bound.xi)};
  });
}

/// Same points in any order.
void check_vertices(const Matrix& got, const Matrix& expected) {
  REQUIRE(got.cols() == expected.cols());
  for (Index j = 0; j < expected.cols(); ++j) {
    CHECK((got.colwise() - expected.col(j)).colwise().lpNorm<Eigen::Infinity>().minCoeff() <=
          tolerance);
  }
}

/// {x : H x ≤ f, Aeq x = beq} ∩ X, each half-space within a box around X.
LineForm cut(LineForm X, const Matrix& H, const Vector& f, const Matrix& Aeq, const Vector& beq) {
  for (Index i = 0; i < H.rows(); ++i) {
    const double lowest = -support(X, -H.row(i).transpose());
    X = intersection(X, H.row(i), make_box({Vector{{std::min(lowest, f[i])}}, Vector{{f[i]}}}));
  }
  for (Index i = 0; i < Aeq.rows(); ++i)
    X = intersection(X, Aeq.row(i), make_point(beq.segment(i, 1)));
  return X;
}

void check_support(const LineForm& X, const json& expected) {
  for (const json& e : expected) {
    const Vector d = vector(e["d"]);
    CHECK(std::abs(support(X, d) - e["h"].get<double>()) <= tolerance);
    CHECK(support(X, d) >= e["h"].get<double>() - 1e-12);
  }
}

void check_points(const LineForm& X, const json& expected) {
  const Matrix inside = matrix(expected["inside_cols"]), outside = matrix(expected["outside_cols"]);
  for (Index j = 0; j < inside.cols(); ++j) CHECK(contains(X, inside.col(j)) != Answer::no);
  for (Index j = 0; j < outside.cols(); ++j) CHECK(contains(X, outside.col(j)) == Answer::no);
}

}  // namespace

TEST_CASE("published cases of set operations") {
  std::ifstream file(CORDON_SOURCE_DIR "/tests/published/data/set_operations.json");
  const json cases = json::parse(file);
  REQUIRE(cases.size() == 12);
  for (const json& c : cases) {
    const std::string id = c["id"], op = c["op"];
    CAPTURE(id);
    const LineForm X = set(c["sets"][0]);
    const json& expected = c["expected"];
    if (op == "vertices") {
      check_vertices(polygon_of(X), matrix(expected["vertices_cols"]));
    } else if (op == "support") {
      check_support(X, expected);
    } else if (op == "is_empty") {
      CHECK(is_empty(X) == (expected["empty"].get<bool>() ? Answer::yes : Answer::no));
    } else if (op == "intersection") {
      check_vertices(polygon_of(intersection(X, Matrix::Identity(2, 2), set(c["sets"][1]))),
                     matrix(expected["vertices_cols"]));
    } else if (op == "contains_point") {
      check_points(X, expected);
    } else if (op == "contains_set") {
      const LineForm Y = set(c["sets"][1]);
      CHECK(is_subset(Y, X) == Answer::yes);
      CHECK(is_subset(X, Y) == Answer::no);
    } else {
      FAIL("no test for the operation " << op);
    }
  }
}

TEST_CASE("intersection with a polyhedron") {
  // X has the vertices (1,3), (1,-1), (3,2), (3,-2); the line x₁ - 2 x₂ = 1 meets it for 1 ≤ x₁ ≤
  // 3, and -2 x₁ + x₂ ≤ -4.25 leaves x₁ ≥ 2.5 of that.
  LineForm X = make_zonotope(Vector::Zero(2), Matrix{{3, 0, 1}, {0, 2, 1}});
  X.A = Matrix{{1, 0, 1}};
  X.b = Vector{{1}};
  X.S.resize(1, 0);
  const LineForm segment =
      cut(X, Matrix{{-2, 1}, {-.5, 0}}, Vector{{-4.25, 2.5}}, Matrix{{1, -2}}, Vector{{1}});
  check_vertices(polygon_of(segment), Matrix{{2.5, 3}, {.75, 1}});
  CHECK(contains(segment, Vector{{2, .5}}) == Answer::no);
}
