// SPDX-License-Identifier: GPL-3.0-or-later
// The search over facets against published optima and closed forms, and where it has none to find.
#include <doctest/doctest.h>

#include "designers/facets/first_input.hpp"
#include "input_design/facets_answers.hpp"

using namespace cordon;
using namespace cordon::designers;
using namespace cordon::examples;

TEST_CASE("The published example: the optimum of the unreduced problem") {
  for (const auto& [epsilon, cost] :
       {std::pair(0.0, 9.19954), {1e-4, 9.2005343602499}, {.01, 9.298976025}, {.1, 10.19390025}}) {
    const SeparationProblem problem = published_problem(3, epsilon);
    const SearchResult found = searched(problem);
    check_optimal(problem, found, cost, 1e-9);
    CHECK(found.facets >= 99);
    CHECK(found.nodes > 6);
  }
  const SeparationProblem problem = published_problem(3, 1e-4);
  const SearchResult found = searched(problem);
  const Vector expected = numbers({.5, -1, -2.798921735, -1, 1.25099762525, -6.150615, .5, -1});
  CHECK((*found.u - expected).cwiseAbs().maxCoeff() < 1e-7);
}

TEST_CASE("Horizons of the published example: 2 is too short, 4 is cheaper than 3") {
  const SearchResult two = searched(published_problem(2, 1e-4));
  CHECK(two.status == DesignStatus::infeasible);
  CHECK(two.reason ==
        "modes 1 and 2: the inputs that may be chosen have no effect on what tells one from the "
        "other");
  CHECK_FALSE(two.u);
  const SeparationProblem four = published_problem(4, 1e-4);
  const SearchResult found = searched(four);
  check_optimal(four, found, 8.7056961, 1e-7);
  const SeparationProblem five =
      published_problem(5, 1e-4);  // hulls in five dimensions, all found to be closed
  check_optimal(five, searched(five), 8.37528, 1e-6);
}

TEST_CASE("Scalar models from anywhere: the cheapest input costs .9 (1 + ε)") {
  for (const double epsilon : {0.0, 1e-4, .1, 1.0}) {
    const SeparationProblem problem = scalar_problem(epsilon);
    check_optimal(problem, searched(problem), .9 * (1 + epsilon), 1e-9);
  }
  const SearchResult beyond = searched(scalar_problem(10));  // |u| ≤ 2
  CHECK(beyond.status == DesignStatus::infeasible);
  CHECK(beyond.reason.find("no input of the input set separates modes") == 0);
  CHECK_FALSE(beyond.suggestion.empty());
}

TEST_CASE("Nothing to separate: the reference, or the nearest admitted input") {
  for (const auto kind : {Cost::Kind::norm_1, Cost::Kind::norm_inf, Cost::Kind::quadratic}) {
    SeparationProblem problem = problem_of({}, boxed_inputs(3, 2), kind, 0);
    problem.cost.reference = numbers({.5, -1, .25});
    SearchResult found = searched(problem);
    CHECK(found.status == DesignStatus::optimal);
    REQUIRE(found.u);
    CHECK((*found.u - problem.cost.reference).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(found.lower_bound >= 0);

    problem.cost.reference[1] = -5;
    problem.cost.weights[1] = 2;
    check_optimal(problem, searched(problem), kind == Cost::Kind::quadratic ? 18 : 6);
  }
  SeparationProblem given =
      problem_of({}, boxed_inputs(2, 1, 2), Cost::Kind::norm_inf, 0);  // no input may vary
  given.U.c = numbers({3, -4});
  given.cost.weights = numbers({1, .5});
  for (const auto& [kind, cost] : {std::pair(Cost::Kind::norm_inf, 3.0),
                                   {Cost::Kind::norm_1, 5.0},
                                   {Cost::Kind::quadratic, 17.0}}) {
    given.cost.kind = kind;
    check_optimal(given, searched(given), cost, 1e-12);
  }
}

TEST_CASE("Inputs that cost nothing are used first") {
  // One pair, |u_0 + u_1| > 1.
  const PairProgram pair = pair_of(0, 1, Matrix::Ones(1, 1), numbers({0}), Matrix::Ones(1, 2));
  for (const auto kind : {Cost::Kind::norm_1, Cost::Kind::norm_inf, Cost::Kind::quadratic}) {
    SeparationProblem problem = problem_of({pair}, boxed_inputs(2, .75), kind, 0);
    problem.cost.weights = numbers({0, 1});
    check_optimal(problem, searched(problem), kind == Cost::Kind::quadratic ? .0625 : .25);
    problem.cost.weights.setZero();
    const SearchResult free = searched(problem);
    CHECK(free.status == DesignStatus::optimal);
    CHECK(free.cost == 0);
    check_answer(problem, free);
  }
}

TEST_CASE("A polytope of inputs") {
  // u_0 + u_1 ≤ 1, as u_0 + u_1 + 1.5 ζ = -.5 with |u| ≤ 1: then only the negative side, or both
  // positive at a price.
  InputSequences U{Vector::Zero(2), Matrix::Zero(2, 3), (Matrix(1, 3) << 1, 1, 1.5).finished(),
                   numbers({-.5})};
  U.G.leftCols(2).setIdentity();
  const PairProgram sum =
      pair_of(0, 1, Matrix::Ones(1, 1), numbers({0}), (Matrix(1, 2) << 1, 1).finished());
  for (const auto kind : {Cost::Kind::norm_1, Cost::Kind::norm_inf, Cost::Kind::quadratic}) {
    SeparationProblem problem = problem_of({sum}, U, kind, .2);
    problem.cost.reference = numbers({.4, .4});
    // Beyond +1.2 is not admitted; -1.2 costs 2 in sum, 1 in the largest entry, 2 in squares.
    check_optimal(problem, searched(problem), kind == Cost::Kind::norm_inf ? 1 : 2);
    problem.epsilon = 1.5;  // |u| ≤ 1 and -2.5
    CHECK(searched(problem).status == DesignStatus::infeasible);
  }
}

TEST_CASE("Tubes that must not be empty") {
  // The tube has a row ξ = u_0 + .5: |u_0 + .5| ≤ 1 is needed, and |u_0| > .75 separates.
  const PairProgram pair =
      pair_of(0, 1, Matrix::Constant(1, 1, .75), numbers({0}), Matrix::Ones(1, 1));
  TubeConditions needed{Matrix::Ones(1, 1), Matrix::Ones(1, 1), numbers({.5}), numbers({1})};
  for (const auto kind : {Cost::Kind::norm_1, Cost::Kind::norm_inf, Cost::Kind::quadratic}) {
    SeparationProblem problem = problem_of({pair}, boxed_inputs(1, 2), kind, 0);
    problem.cost.reference = numbers({.5});
    check_optimal(problem, searched(problem), kind == Cost::Kind::quadratic ? .0625 : .25);
    problem.conditions = {needed};
    check_optimal(problem, searched(problem), kind == Cost::Kind::quadratic ? 1.5625 : 1.25);
    SeparationProblem shifted = problem;  // |u_0 - .5| ≤ 1.5
    shifted.U.c[0] = .5;
    shifted.U.G(0, 0) = 1.5;
    check_optimal(shifted, searched(shifted), kind == Cost::Kind::quadratic ? 1.5625 : 1.25);
    problem.conditions[0].b[0] = 4;  // |u_0 + 4| ≤ 1 never
    const SearchResult none = searched(problem);
    CHECK(none.status == DesignStatus::infeasible);
    CHECK(none.reason == "every input of the input set leaves the output tube of a mode empty");
  }
}

TEST_CASE("Pairs that contradict each other") {
  // |u_0| > 1 and |u_0| must be separated by a row that is met for |u_0 - 1.5| ≤ 2.6, and |u_0|
  // ≤ 1.5.
  const Matrix one = Matrix::Ones(1, 1);
  const PairProgram far = pair_of(0, 1, one, numbers({0}), one),
                    left = pair_of(0, 2, 2.4 * one, numbers({1.5}), one),
                    right = pair_of(1, 2, 2.4 * one, numbers({-1.5}), one);
  const SearchResult each =
      searched(problem_of({far, left, right}, boxed_inputs(1, 1.5), Cost::Kind::norm_1, 0));
  CHECK(each.status == DesignStatus::infeasible);
  CHECK(each.reason == "every pair alone can be separated, but not all of them at once");
  const SearchResult one_side =
      searched(problem_of({far, left}, boxed_inputs(1, 1.5), Cost::Kind::norm_1, 0));
  CHECK(one_side.status == DesignStatus::optimal);
  CHECK((*one_side.u)[0] == doctest::Approx(-1));
  const SearchResult hopeless =
      searched(problem_of({far, left}, boxed_inputs(1, .95), Cost::Kind::norm_1, 0));
  CHECK(hopeless.reason == "no input of the input set separates modes 1 and 2");
  InputSequences corner = boxed_inputs(2, 1);  // each reaches 1, the sum does not reach 1.9
  corner.A = (Matrix(1, 2) << 1, -1).finished();
  corner.b = numbers({.5});
  const PairProgram sum =
      pair_of(0, 1, Matrix::Constant(1, 1, 1.9), numbers({0}), Matrix::Ones(1, 2));
  const SearchResult together = searched(problem_of({sum}, corner, Cost::Kind::norm_1, 0));
  CHECK(together.status == DesignStatus::infeasible);
  CHECK(together.reason == "no input of the input set separates modes 1 and 2");
}

TEST_CASE("Without noise there is no cheapest input, and none is claimed") {
  const PairProgram exact = pair_of(0, 1, Matrix(2, 0), numbers({.25, .5}), Matrix::Identity(2, 2));
  SeparationProblem problem = problem_of({exact}, boxed_inputs(2, 1), Cost::Kind::norm_1, .1);
  SearchResult found = searched(problem);
  check_optimal(problem, found, 0);  // the reference separates
  problem.cost.reference = numbers({.25, .5});
  found = searched(problem);
  CHECK(found.status == DesignStatus::feasible);
  check_answer(problem, found);
  CHECK(separation(exact, *found.u).disjoint == Answer::yes);
  CHECK(found.cost > 1e-7);
  CHECK(found.cost < 1e-5);
  CHECK(found.lower_bound == 0);
  CHECK(found.reason.find("without width") != std::string::npos);
}

TEST_CASE("Inputs too near to a set without width: found at corners, or not denied") {
  const PairProgram exact = pair_of(0, 1, Matrix(1, 0), numbers({1}), Matrix::Ones(1, 1));
  SeparationProblem problem = problem_of({exact}, boxed_inputs(1, 1e-7), Cost::Kind::norm_1, 0);
  problem.U.c[0] = 1;
  const SearchResult corner = searched(problem);  // the cheapest of U separates
  check_optimal(problem, corner, 1 - 1e-7);
  CHECK(separation(exact, *corner.u).disjoint == Answer::yes);
  problem.U.G *= 1e-5;
  const SearchResult nearer = searched(problem);  // by less than rounding allows to prove
  CHECK(nearer.status == DesignStatus::unknown);
  CHECK(nearer.reason == "a linear program could not be decided");
}

TEST_CASE("A search that is stopped says so, and proves what it can") {
  class Stop final : public DesignControl {
   public:
    explicit Stop(int after) : left_(after) {}
    bool stop() const noexcept override { return left_-- <= 0; }
    void progress(Index horizon, double best, double bound) override {
      CHECK(horizon == 3);
      CHECK(best >= bound);
      ++reports;
    }
    int reports = 0;

   private:
    mutable int left_;
  };
  const SeparationProblem problem = published_problem(3, 1e-4);
  const double optimum = 9.2005343602499;
  int with_input = 0, before_the_search = 0;
  for (int after = 0; after < 1500; after += 25) {
    Stop control(after);
    const SearchResult found = searched(problem, {}, control);
    CHECK(found.lower_bound <= optimum + 1e-9);
    if (found.status == DesignStatus::optimal) {
      CHECK(found.cost == doctest::Approx(optimum).epsilon(1e-9));
      continue;
    }
    CHECK(found.stopped);
    CHECK_FALSE(found.reason.empty());
    CHECK(found.status == (found.u ? DesignStatus::feasible : DesignStatus::unknown));
    if (!found.u) continue;
    ++with_input;
    before_the_search += found.nodes == 0;
    check_answer(problem, found);
    CHECK(found.cost > optimum - 1e-9);
  }
  CHECK(with_input > before_the_search);
  CHECK(before_the_search > 0);
  Stop watched(1000000);
  searched(problem, {}, watched);
  CHECK(watched.reports > 0);

  FacetLimits none;
  none.time_limit = 0;
  const SearchResult late = searched(problem, none);
  CHECK(late.status == DesignStatus::unknown);
  CHECK(late.stopped);
  CHECK(late.lower_bound == 0);
  FacetLimits few;
  few.max_facets = 20;
  const SearchResult many = searched(problem, few);
  CHECK(many.status == DesignStatus::feasible);
  check_answer(problem, many);
  CHECK(many.cost > optimum - 1e-9);
  CHECK(many.lower_bound <= optimum + 1e-9);
  CHECK(many.lower_bound > 0);  // by the pairs with fewer facets
  CHECK_FALSE(many.stopped);
  CHECK(many.reason.find("modes 2 and 3: ") == 0);
  CHECK(many.suggestion.find("time_limit") == std::string::npos);
}

TEST_CASE("A pair with too many facets is left out of the search, and judged by its own κ") {
  // |u_1| ≥ 1 by two facets; a cube in three dimensions has six.
  const auto line = [](Index i, Index j) {
    return pair_of(i, j, Matrix::Ones(1, 1), Vector::Zero(1),
                   Matrix(Vector::Unit(3, 0).transpose()));
  };
  const auto cube = [](double radius) {
    return pair_of(0, 2, radius * Matrix::Identity(3, 3), Vector::Zero(3), Matrix::Identity(3, 3));
  };
  FacetLimits few;
  few.max_facets = 5;
  SUBCASE("what solves the rest separates it too: optimal") {
    const SeparationProblem problem =
        problem_of({cube(.5), line(0, 1)}, boxed_inputs(3, 2), Cost::Kind::norm_1, .1);
    check_optimal(problem, searched(problem, few), 1.1);
  }
  SUBCASE("what solves the rest does not: a bound, and another input") {
    const SeparationProblem problem =
        problem_of({cube(1.5), line(0, 1)}, boxed_inputs(3, 2), Cost::Kind::norm_1, .1);
    const SearchResult found = searched(problem, few);
    CHECK(found.status == DesignStatus::feasible);
    check_answer(problem, found);
    CHECK(found.lower_bound == doctest::Approx(1.1));
    CHECK(found.cost >= 1.65 * (1 - 1e-9));
    CHECK(found.reason.find("modes 1 and 3: ") == 0);
    CHECK_FALSE(found.stopped);
    CHECK(searched(problem).status == DesignStatus::optimal);
  }
  SUBCASE("nothing separates it: no answer, but a bound") {
    const SeparationProblem problem =
        problem_of({cube(3), line(0, 1)}, boxed_inputs(3, 2), Cost::Kind::norm_1, .1);
    const SearchResult found = searched(problem, few);
    CHECK(found.status == DesignStatus::unknown);
    CHECK(found.lower_bound == doctest::Approx(1.1));
    CHECK(found.reason.find("modes 1 and 3: ") == 0);
    CHECK_FALSE(found.stopped);
  }
  SUBCASE("the rest has no solution") {
    const SeparationProblem problem =
        problem_of({cube(.5), line(0, 1)}, boxed_inputs(3, 1), Cost::Kind::norm_1, .1);
    CHECK(searched(problem, few).status == DesignStatus::infeasible);
  }
}

TEST_CASE("The first input separates, within the input set and not much beyond what is needed") {
  for (const double epsilon : {0.0, 1e-4, .3}) {
    const SeparationProblem problem = published_problem(3, epsilon);
    NodeProgram program(problem);
    const KnownAnswer found = first_input(problem, program, [] { return false; });
    REQUIRE(found.u);
    CHECK(found.cost == problem.cost.at(*found.u));
    CHECK(found.bound <= found.cost);
    for (const PairProgram& pair : problem.pairs) {
      const PairSeparation apart = separation(pair, *found.u);
      CHECK(apart.disjoint == Answer::yes);
      CHECK(apart.kappa_lower >= epsilon);
    }
    CHECK((*found.u - problem.U.c).cwiseAbs().maxCoeff() <= 8);
    CHECK(found.u->head(2) == problem.U.c.head(2));
    CHECK(found.cost < 5 * 9.2);
  }
  // One input at one time suffices: found to the last halving.
  const SeparationProblem single = problem_of(
      {pair_of(0, 1, Matrix::Ones(1, 1), Vector::Zero(1), Matrix(Vector::Unit(6, 4).transpose()))},
      boxed_inputs(6, 4), Cost::Kind::norm_1, 0);
  NodeProgram program(single);
  const KnownAnswer found = first_input(single, program, [] { return false; });
  REQUIRE(found.u);
  CHECK(found.cost < 1.1);
  CHECK(found.cost > 1);

  int calls = 0;
  CHECK_FALSE(first_input(single, program, [&] { return ++calls > 1; }).u);
  CHECK(calls > 1);
}

TEST_CASE("A wide gap ends the search early, within that gap") {
  const SeparationProblem problem = published_problem(3, 1e-4);
  FacetLimits limits;
  limits.gap = .3;
  const SearchResult found = searched(problem, limits);
  CHECK(found.status == DesignStatus::optimal);
  CHECK(found.cost >= 9.2005343);
  CHECK(found.cost - found.lower_bound <= .3 * found.cost);
  CHECK(found.lower_bound <= 9.2005344);
  CHECK(found.nodes <= searched(problem).nodes);
}
