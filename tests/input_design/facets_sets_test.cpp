// SPDX-License-Identifier: GPL-3.0-or-later
// Hulls, forbidden sets and lower bounds: what the search over facets rests on.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/solvers/lp.hpp"
#include "cordon/solvers/polytope.hpp"
#include "designers/facets/facet_dual.hpp"
#include "designers/facets/growing_hull.hpp"
#include "designers/facets/node_program.hpp"
#include "input_design/facets_problems.hpp"

using namespace cordon;
using namespace cordon::designers;
using namespace cordon::examples;

namespace {

/// Rows (h, k) with |h| = 1, sorted, for comparison.
std::vector<Vector> sorted_rows(const Matrix& H, const Vector& h) {
  std::vector<Vector> rows;
  for (Index i = 0; i < h.size(); ++i) {
    Vector row(H.cols() + 1);
    row << H.row(i).transpose(), h[i];
    rows.push_back(row / H.row(i).norm());
  }
  std::sort(rows.begin(), rows.end(), [](const Vector& a, const Vector& b) {
    for (Index i = 0; i < a.size(); ++i) {
      if (std::abs(a[i] - b[i]) > 1e-9) return a[i] < b[i];
    }
    return false;
  });
  return rows;
}

/// Most by which ζ is beyond a facet.
double most_beyond(const ForbiddenSet& set, const Vector& zeta, bool inner = false) {
  double most = -INFINITY;
  for (const SeparatingFacet& facet : set.facets)
    most = std::max(most, facet.a.dot(zeta) - (inner ? facet.in : facet.out));
  return most;
}

}  // namespace

TEST_CASE("A hull that grows by points has the facets that rational arithmetic finds") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> small(-3, 3);
  for (int trial = 0; trial < 60; ++trial) {
    const Index r = 1 + trial % 4;
    // Small integers: many points on a facet, and twice the same.
    Matrix points = Matrix::NullaryExpr(r, 16, [&] { return small(random); });
    points.leftCols(r).setIdentity();
    points.col(r).setConstant(-1);
    GrowingHull hull(points.leftCols(r + 1), 0);
    for (Index p = r + 1; p < points.cols(); ++p)
      REQUIRE(hull.add(points.col(p), [] { return false; }));
    Matrix H(static_cast<Index>(hull.facets().size()), r);
    Vector h(H.rows());
    for (Index f = 0; f < h.size(); ++f) {
      const auto& facet = hull.facets()[static_cast<std::size_t>(f)];
      H.row(f) = facet.h.transpose();
      h[f] = hull.level(facet) * facet.h.norm();
      for (Index p = 0; p < points.cols(); ++p) CHECK(hull.beyond(facet, points.col(p)) < 1e-11);
    }
    const Polytope::Inequalities exact = Polytope::from_generators(points).inequalities();
    const std::vector<Vector> ours = sorted_rows(H, h), theirs = sorted_rows(exact.H, exact.h);
    REQUIRE(ours.size() == theirs.size());
    for (std::size_t f = 0; f < ours.size(); ++f)
      CHECK((ours[f] - theirs[f]).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("A simplex without volume has no facets; one that grows can be stopped") {
  Matrix points(2, 3);
  points << 0, 1, 2, 0, 1, 2;
  CHECK(GrowingHull(points, 0).facets().empty());
  points(0, 2) = 1;
  GrowingHull hull(points, 0);
  CHECK(hull.facets().size() == 3);
  CHECK_FALSE(hull.add(numbers({5, 5}), [] { return true; }));

  // A pyramid over a polygon of 40 points: the point below it is beyond all but one facet, each
  // with a ridge on the rim.
  const auto pyramid = [] {
    Matrix start(3, 4);
    start << 1, -1, -1, 0, 0, 1, -1, 0, 0, 0, 0, 1;
    GrowingHull whole(start, 0);
    for (int k = 0; k < 40; ++k) {
      whole.add(numbers({3 * std::cos(.157 * k), 3 * std::sin(.157 * k), 0}), [] { return false; });
    }
    return whole;
  };
  int asked = 0;
  GrowingHull whole = pyramid();
  const auto facets = static_cast<int>(whole.facets().size());
  REQUIRE(whole.add(numbers({0, 0, 9}), [&] { return ++asked < 0; }));
  CHECK(asked > facets);  // not once for each facet alone
  for (int most = 0; most < asked; ++most) {
    int calls = 0;
    CHECK_FALSE(pyramid().add(numbers({0, 0, 9}), [&] { return ++calls > most; }));
    CHECK(calls == most + 1);
  }
}

TEST_CASE("Beyond a facet: κ ≥ ε; beyond none: κ < ε") {
  std::mt19937 random(7);
  int beyond = 0, within = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Index r = 1 + trial % 4, m = r + trial % 3, inputs = 5, g = 7;
    const PairProgram pair = random_pair(random, 0, 1, m, g, r, inputs);
    InputSequences U = boxed_inputs(inputs, 1.5, 1);
    U.c = random_matrix(random, inputs, 1);
    const double epsilon = trial % 2 ? 0 : .3;
    const ForbiddenSet set = forbidden(pair, U, epsilon);
    if (set.kind == ForbiddenSet::Kind::separated) {
      const PairSeparation found =
          separation(pair, U.c + U.G * random_matrix(random, inputs - 1, 1));
      CHECK(found.kappa > epsilon);
      continue;
    }
    REQUIRE(set.kind == ForbiddenSet::Kind::facets);
    CHECK_FALSE(set.flat);
    for (const SeparatingFacet& facet : set.facets) {
      CHECK(facet.in < facet.out);
      CHECK(facet.out - facet.in < 1e-9 * std::max(1.0, std::abs(facet.out)));
    }
    for (int sample = 0; sample < 20; ++sample) {
      const Vector zeta = random_matrix(random, inputs - 1, 1);
      const PairSeparation found = separation(pair, U.c + U.G * zeta);
      const double most = most_beyond(set, zeta);
      if (most >= 0) CHECK(found.kappa > epsilon - 1e-9);
      if (most < 0) CHECK(found.kappa < epsilon + 1e-9);
      ++(most >= 0 ? beyond : within);
    }
    // At the boundary: from inside to each facet in turn.
    const SeparatingFacet& facet = set.facets[static_cast<std::size_t>(trial) % set.facets.size()];
    if (facet.a.lpNorm<1>() < facet.out) continue;
    const Vector edge = facet.a * (facet.out / facet.a.squaredNorm());
    CHECK(separation(pair, U.c + U.G * edge).kappa > epsilon - 1e-9);
  }
  CHECK(beyond > 100);
  CHECK(within > 100);
}

TEST_CASE("The facets of the published pairs") {
  const auto count = [](Index horizon, double epsilon) {
    const SeparationProblem problem = published_problem(horizon, epsilon);
    std::vector<std::size_t> facets;
    for (const PairProgram& pair : problem.pairs)
      facets.push_back(forbidden(pair, problem.U, epsilon).facets.size());
    return facets;
  };
  CHECK(count(3, 1e-4) == std::vector<std::size_t>{2, 11, 12, 31, 31, 13});
  const SeparationProblem problem = published_problem(3, 1e-4);
  const ForbiddenSet first = forbidden(problem.pairs[0], problem.U, 1e-4);
  // One combination of the inputs, .3888 u_1(1) - .1944 u_1(2), tells 1 and 2 apart beyond 1.03459
  // and -.43497.
  REQUIRE(first.facets.size() == 2);
  for (const SeparatingFacet& facet : first.facets) {
    CHECK(std::abs(facet.a[0]) == doctest::Approx(1).epsilon(1e-12));
    CHECK(facet.a[1] == doctest::Approx(-facet.a[0] / 2).epsilon(1e-9));
    const double expected = facet.a[0] > 0 ? 1.0345900140934057 : .4349705924090004;
    CHECK(facet.out * 8 * .38878359333236145 == doctest::Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("Forbidden sets that are no polytope with an interior") {
  const InputSequences U = boxed_inputs(2, 1);
  SUBCASE("without rows nothing separates") {
    CHECK(forbidden(pair_of(0, 1, Matrix(0, 3), Vector(0), Matrix(0, 2)), U, 0).kind ==
          ForbiddenSet::Kind::never);
  }
  SUBCASE("inputs without effect: it depends on the rows alone") {
    const Matrix G = Matrix::Ones(1, 2), N = Matrix::Zero(1, 2);
    CHECK(forbidden(pair_of(0, 1, G, numbers({1}), N), U, 0).kind == ForbiddenSet::Kind::never);
    CHECK(forbidden(pair_of(0, 1, G, numbers({3}), N), U, 0).kind == ForbiddenSet::Kind::separated);
    CHECK(forbidden(pair_of(0, 1, G, numbers({3}), N), U, .6).kind == ForbiddenSet::Kind::never);
  }
  SUBCASE("fixed inputs enter through the constant") {
    InputSequences fixed = boxed_inputs(2, 1, 1);
    fixed.c[0] = 4;
    const Matrix G = Matrix::Ones(1, 2), N = numbers({1, 0}).transpose();
    CHECK(forbidden(pair_of(0, 1, G, numbers({1}), N), fixed, 0).kind ==
          ForbiddenSet::Kind::separated);
    CHECK(forbidden(pair_of(0, 1, G, numbers({1}), N), fixed, .6).kind ==
          ForbiddenSet::Kind::never);
  }
  SUBCASE("a row that inputs do not enter and noise cannot meet") {
    const Matrix G = Matrix::Identity(2, 2), N = (Matrix(2, 2) << 1, 1, 0, 0).finished();
    CHECK(forbidden(pair_of(0, 1, G, numbers({0, 1.5}), N), U, 0).kind ==
          ForbiddenSet::Kind::separated);
    CHECK(forbidden(pair_of(0, 1, G, numbers({0, 1.5}), N), U, .6).kind ==
          ForbiddenSet::Kind::facets);
  }
}

TEST_CASE(
    "Forbidden sets without noise in some direction, of simple shapes, and beyond the limits") {
  const InputSequences U = boxed_inputs(2, 1);
  SUBCASE("no noise in one of two directions") {
    const Matrix G = (Matrix(2, 1) << 0, .5).finished();
    const ForbiddenSet set =
        forbidden(pair_of(0, 1, G, numbers({.25, 0}), Matrix::Identity(2, 2)), U, 0);
    REQUIRE(set.kind == ForbiddenSet::Kind::facets);
    CHECK(set.flat);
    CHECK(set.facets.size() == 4);
    CHECK(most_beyond(set, numbers({.25, .499})) < 0);
    CHECK(most_beyond(set, numbers({.25, .501})) > 0);
    for (const double side : {-1.0, 1.0}) {
      CHECK(most_beyond(set, numbers({.25 + side * 1e-5, 0})) > 0);
      CHECK(most_beyond(set, numbers({.25 + side * 1e-7, 0})) < 0);
      CHECK(most_beyond(set, numbers({.25 + side * 1e-7, 0}), true) >
            0);  // not denied that it separates
    }
  }
  SUBCASE("no noise at all") {
    const ForbiddenSet set =
        forbidden(pair_of(0, 1, Matrix(2, 0), numbers({.25, .5}), Matrix::Identity(2, 2)), U, .1);
    REQUIRE(set.kind == ForbiddenSet::Kind::facets);
    CHECK(set.flat);
    CHECK(set.facets.size() == 4);
    CHECK(most_beyond(set, numbers({.25, .5})) < 0);
    CHECK(most_beyond(set, numbers({.25, .501})) > 0);
    CHECK(most_beyond(set, numbers({.249, .5})) > 0);
  }
  SUBCASE("a triangle, whichever way it points") {
    for (const double first : {1.0, -1.0}) {
      for (const double second : {1.0, -1.0}) {
        const Matrix G = (Matrix(3, 3) << first, 0, 0, 0, second, 0, 1, 1, 1).finished(),
                     N = Matrix::Identity(3, 2);
        const ForbiddenSet set = forbidden(pair_of(0, 1, G / 4, numbers({0, 0, .25}), N), U, 0);
        REQUIRE(set.kind == ForbiddenSet::Kind::facets);
        CHECK(set.facets.size() == 3);
        CHECK(most_beyond(set, numbers({-.2 * first, -.2 * second})) < 0);
        CHECK(most_beyond(set, numbers({.05 * first, .05 * second})) > 0);
        CHECK(most_beyond(set, numbers({-.26 * first, 0})) > 0);
      }
    }
  }
  SUBCASE("too many facets, and no time") {
    std::mt19937 random(1);
    const PairProgram pair = random_pair(random, 0, 1, 3, 12, 3, 2 + 3);
    const InputSequences wide = boxed_inputs(5, 1);
    DesignControl control;
    const ForbiddenSet many = forbidden_set(pair, wide, 0, 8, Watch(control, 0, 60));
    CHECK(many.kind == ForbiddenSet::Kind::unknown);
    CHECK(many.reason.find("more than 8 facets") != std::string::npos);
    const ForbiddenSet late = forbidden_set(pair, wide, 0, 1000, Watch(control, 0, 0));
    CHECK(late.kind == ForbiddenSet::Kind::unknown);
    CHECK(late.reason == "the search was stopped");
  }
}

TEST_CASE("Equations of the input set narrow what can be told apart") {
  // u_1 = u_2 leaves one combination of the two rows, and u_1 = -u_2 + .2 another.
  std::mt19937 random(11);
  for (const double sign : {1.0, -1.0}) {
    InputSequences U{Vector::Zero(2), 2 * Matrix::Identity(2, 2),
                     (Matrix(1, 2) << 1, -sign).finished(), numbers({sign < 0 ? .1 : 0.0})};
    const PairProgram pair = random_pair(random, 0, 1, 2, 5, 2, 2);
    const ForbiddenSet set = forbidden(pair, U, .1);
    REQUIRE(set.kind == ForbiddenSet::Kind::facets);
    CHECK(set.facets.size() == 2);
    for (double t = -.9; t <= .9; t += .05) {
      const Vector zeta = numbers({t, sign > 0 ? t : .1 - t});
      CHECK((most_beyond(set, zeta) >= 0) == (separation(pair, U.G * zeta).kappa >= .1));
    }
  }
}

TEST_CASE(
    "Whatever the multipliers, the bound is below the minimum; with the right ones it is the "
    "minimum") {
  std::mt19937 random(13);
  for (int trial = 0; trial < 50; ++trial) {
    BoundedProgram program;
    const Index n = 5;
    for (Index j = 0; j < n; ++j)
      program.add_column(-1 - j % 2, 1 + j, random_matrix(random, 1, 1)(0, 0));
    const Vector inside = .5 * random_matrix(random, n, 1);
    for (int i = 0; i < 2; ++i) {
      const Vector row = random_matrix(random, n, 1);
      program.add_row(row, row.dot(inside), 0);
    }
    const Vector above = random_matrix(random, n, 1);
    program.add_row_above(above, above.dot(inside) - .01, 0, 20);
    const auto solution =
        LinearProgram(program.A, program.b, program.lower, program.upper).maximize(-program.cost);
    REQUIRE(solution.status == LinearProgram::Status::optimal);
    const double minimum = program.cost.dot(solution.x);
    CHECK(proven_minimum(program, -solution.y) <= minimum + 1e-15);
    CHECK(proven_minimum(program, -solution.y) > minimum - 1e-12);
    CHECK(proven_minimum(program, solution.y) < minimum);
    CHECK(proven_minimum(program, Vector::Zero(3)) <= minimum);
    CHECK(proven_minimum(program, random_matrix(random, 3, 1)) <= minimum);
    program.error.setConstant(.1);
    CHECK(proven_minimum(program, -solution.y) ==
          doctest::Approx(minimum - .1 * solution.y.lpNorm<1>()).epsilon(1e-9));
    CHECK(proven_minimum(program, Vector::Constant(3, NAN)) == -INFINITY);
  }
}

TEST_CASE(
    "The bound of a child is below its minimum, and is it where the parent has no facets and the "
    "cost is one sum") {
  std::mt19937 random(17);
  for (int trial = 0; trial < 120; ++trial) {
    const auto kind = trial % 2 ? Cost::Kind::norm_1 : Cost::Kind::quadratic;
    const Index n = 4;
    SeparationProblem problem = problem_of({}, boxed_inputs(n, 2, 1), kind, 0);
    problem.cost.reference = 1.5 * random_matrix(random, n, 1);
    problem.cost.weights = random_matrix(random, n, 1).cwiseAbs();
    if (trial % 5 == 0) problem.cost.weights[1] = 0;
    NodeProgram program(problem);
    const FacetDual dual(problem);
    REQUIRE(dual.usable());
    const auto facet = [&] {
      SeparatingFacet made{random_matrix(random, n - 1, 1), 0, 0};
      made.a /= made.a.cwiseAbs().maxCoeff();
      made.out = .6 * random_matrix(random, 1, 1)(0, 0);
      made.in = made.out;
      return made;
    };
    const SeparatingFacet first = facet(), second = facet();
    const NodeProgram::Answer root = program.solve({}), one = program.solve({&first}),
                              both = program.solve({&first, &second});
    if (both.impossible || one.impossible) continue;
    REQUIRE(both.zeta);
    const Vector u = problem.U.c + problem.U.G * *both.zeta;
    CHECK(both.bound <= problem.cost.at(u) * (1 + 1e-15));
    CHECK(both.bound > problem.cost.at(u) * (1 - 1e-9) - 1e-12);
    CHECK(dual.bound(dual.parent({}, {}), first) <= one.bound + 1e-12);
    CHECK(dual.bound(dual.parent({}, {}), first) == doctest::Approx(one.bound).epsilon(1e-4));
    CHECK(dual.bound(dual.parent({&first}, one.multipliers), second) <= both.bound + 1e-12);
    CHECK(dual.bound(dual.parent({&first}, one.multipliers), second) >=
          one.bound * (1 - 1e-6) - 1e-9);
    CHECK(root.bound <= one.bound + 1e-12);
  }
  SeparationProblem largest = problem_of({}, boxed_inputs(2, 1), Cost::Kind::norm_inf, 0);
  CHECK_FALSE(FacetDual(largest).usable());
  SeparationProblem mixed = problem_of({}, boxed_inputs(2, 1), Cost::Kind::norm_1, 0);
  mixed.U.G(0, 1) = 1;
  CHECK_FALSE(FacetDual(mixed).usable());
}

TEST_CASE("An input that only `out` denies is not proven impossible") {
  SeparationProblem problem = problem_of({}, boxed_inputs(2, 1), Cost::Kind::norm_1, 0);
  NodeProgram program(problem);
  const SeparatingFacet thick{numbers({1, 0}), 1.5, .5}, thin{numbers({1, 0}), 1.5, 1.4};
  const NodeProgram::Answer open = program.solve({&thick});
  CHECK_FALSE(open.impossible);
  CHECK_FALSE(open.zeta);
  CHECK(program.solve({&thin}).impossible);
  const SeparatingFacet left{numbers({1, .5}), .8, .7},
      right{numbers({-1, .5}), .8, .7};  // together u_1 ≥ 1.6 and 1.4
  CHECK(program.solve({&left, &right}).impossible);
}

TEST_CASE("A quadratic cost under equations is proven without further tangents") {
  SeparationProblem problem = problem_of({}, boxed_inputs(2, 1), Cost::Kind::quadratic, 0);
  problem.U.A = Matrix::Ones(1, 2);
  problem.U.b = numbers({.5});
  problem.cost.weights = numbers({1, 3});
  problem.cost.reference = numbers({0, .1});
  // Apart by .4, shared 3 to 1.
  const NodeProgram::Answer answer = NodeProgram(problem).solve({});
  REQUIRE(answer.zeta);
  CHECK((*answer.zeta - numbers({.3, .2})).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(answer.bound == doctest::Approx(.12).epsilon(1e-10));
}

TEST_CASE("A hull without one of its facets is not closed") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const Index r : {Index(3), Index(4)}) {
    Matrix simplex = Matrix::Zero(r, r + 1);
    simplex.rightCols(r).setIdentity();
    designers::GrowingHull hull(simplex, 1e-13);
    CHECK(hull.is_closed());
    for (int k = 0; k < 12; ++k) {
      const Vector x = Vector::NullaryExpr(r, [&] { return 2 * uniform(random); });
      REQUIRE(hull.add(x, [] { return false; }));
      CHECK(hull.is_closed());
      const designers::GrowingHull::Facet last = hull.facets().back();
      hull.facets().pop_back();
      CHECK_FALSE(hull.is_closed());
      hull.facets().push_back(last);
    }
  }
}
