// SPDX-License-Identifier: GPL-3.0-or-later
// The search over cones: closed forms, the other search on random problems, and designs with more
// inputs than facets can be enumerated for.
#include <algorithm>
#include <limits>
#include <tuple>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "designers/cones/search.hpp"
#include "designers/exact_search.hpp"
#include "designers/facets/first_input.hpp"
#include "input_design/facets_answers.hpp"
#include "input_design/motor.hpp"

using namespace cordon;
using namespace cordon::designers;
using namespace cordon::examples;

namespace {

const Cost::Kind kinds[] = {Cost::Kind::norm_1, Cost::Kind::norm_inf, Cost::Kind::quadratic};

/// What cones alone know after so many nodes.
struct Known {
  KnownAnswer answer;
  bool ended, impossible;
};
Known known_by_cones(const SeparationProblem& problem, double gap, std::int64_t nodes = 1000000) {
  DesignControl control;
  NodeProgram inputs(problem);
  Known known{{}, false, false};
  Watch watch(control, problem.horizon, 60);
  ConeSearch cones(problem, inputs, known.answer, gap, watch);
  cones.run(nodes);
  known.ended = cones.ended();
  known.impossible = cones.impossible();
  return known;
}

SearchResult exactly(const SeparationProblem& problem, double gap = 1e-8) {
  DesignControl control;
  return search_exactly(problem, {.gap = gap}, control);
}

SeparationProblem motor_problem(const ModeBank& bank, Index horizon) {
  std::vector<OutputTube> tubes;
  for (const Mode& mode : bank.modes)
    tubes.push_back(output_tube(mode.model, *backend("zonotope"), {horizon}));
  SeparationProblem problem =
      problem_of(pair_programs(tubes), boxed_inputs(horizon + 1, 24), Cost::Kind::norm_1, .001);
  problem.horizon = horizon;
  problem.inputs = 1;
  return problem;
}

}  // namespace

TEST_CASE("How far inputs go before they separate") {
  // |u_0 + 2 u_1 - .5| ≤ 1 + ε does not separate.
  const PairProgram pair =
      pair_of(0, 1, Matrix::Ones(1, 1), numbers({.5}), (Matrix(1, 2) << 1, 2).finished());
  for (const double epsilon : {0.0, .5}) {
    const SeparationProblem problem =
        problem_of({pair}, boxed_inputs(2, 10), Cost::Kind::norm_1, epsilon);
    const Star star(problem);
    const auto reach = ForbiddenReach::of(problem, pair, star);
    REQUIRE(reach);
    const double up = 1.5 + epsilon, down = .5 + epsilon;
    for (const auto& [v, theta] : {std::pair(numbers({1, 0}), up),
                                   {numbers({0, 1}), up / 2},
                                   {numbers({-1, 0}), down},
                                   {numbers({-1, -1}), down / 3}}) {
      const ForbiddenReach::Answer along = reach->along(v);
      CHECK(1 / along.inverse <= theta);
      CHECK(1 / along.inverse >= theta * (1 - 1e-9));
      REQUIRE(along.facet);  // of the factors: u = 10 ζ
      CHECK(along.facet->a.dot(theta * v) / 10 == doctest::Approx(along.facet->out));
    }
    const ForbiddenReach::Answer beside = reach->along(numbers({2, -1}));
    CHECK(beside.inverse < .0011);  // for ever, as far as it is followed
    CHECK_FALSE(beside.facet);
  }
  SeparationProblem apart = problem_of({pair}, boxed_inputs(2, 10), Cost::Kind::norm_1, 0);
  for (const double reference : {1.5, 1.6}) {  // at the edge, and beyond
    apart.cost.reference = numbers({reference, 0});
    CHECK_FALSE(ForbiddenReach::of(apart, pair, Star(apart)));
  }
}

TEST_CASE("The box around inputs, from the point that is nearest to the reference") {
  SeparationProblem problem = problem_of({}, boxed_inputs(3, 2, 1), Cost::Kind::norm_1, 0);
  problem.U.c = numbers({5, 1, -1});
  problem.cost.reference = numbers({3, 0, 4});
  problem.cost.weights = numbers({1, 2, 3});
  const Star star(problem);
  CHECK(star.free == std::vector<Index>{1, 2});
  CHECK(star.centre.isApprox(numbers({5, 0, 1})));
  CHECK(star.up.isApprox(numbers({3, 0})));
  CHECK(star.down.isApprox(numbers({1, 4})));
  CHECK(star.apart.isApprox(numbers({0, 3})));
  CHECK(star.fixed == 2);
  CHECK(star.most == doctest::Approx(2 + 2 * 3 + 3 * 7));
  CHECK(star.stretched(numbers({.5, -1})).isApprox(numbers({2, -4})));
}

TEST_CASE("Closed forms by cones alone") {
  // Two pairs: |u_0 + u_1| > 1 and |u_1 - u_2| > 1.
  const PairProgram sum = pair_of(0, 1, Matrix::Ones(1, 1), numbers({0}),
                                  (Matrix(1, 3) << 1, 1, 0).finished()),
                    difference = pair_of(0, 2, Matrix::Ones(1, 1), numbers({0}),
                                         (Matrix(1, 3) << 0, 1, -1).finished());
  for (const auto& [kind, cost] : {std::pair(Cost::Kind::norm_1, 1.0),
                                   {Cost::Kind::norm_inf, .5},
                                   {Cost::Kind::quadratic, 2.0 / 3}}) {
    SeparationProblem problem = problem_of({sum, difference}, boxed_inputs(3, 2), kind, 0);
    const Known found = known_by_cones(problem, 1e-7);
    REQUIRE(found.answer.u);
    CHECK(found.answer.cost == doctest::Approx(cost).epsilon(1e-6));
    CHECK(found.answer.bound >= cost * (1 - 1e-6));
    CHECK(found.answer.bound <= cost * (1 + 1e-12));
  }
  SeparationProblem narrow =
      problem_of({sum, difference}, boxed_inputs(3, .4), Cost::Kind::norm_1, 0);
  CHECK(known_by_cones(narrow, 1e-7).impossible);
  const SearchResult none = exactly(narrow);
  CHECK(none.status == DesignStatus::infeasible);
  CHECK(none.reason == "no input of the input set separates modes 1 and 2");
}

TEST_CASE(
    "Random problems: the bound of cones never passes the optimum of facets, and reaches it") {
  std::mt19937 random(1);
  int reached = 0, left_out = 0, open = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Index inputs = 2 + trial % 3, rank = std::min<Index>(inputs, 2 + trial % 2);
    std::vector<PairProgram> pairs;
    for (Index j = 1; j <= 1 + trial % 3; ++j)
      pairs.push_back(random_pair(random, 0, j, rank + 1, 6, rank, inputs));
    for (const Cost::Kind kind : kinds) {
      CAPTURE(trial);
      SeparationProblem problem =
          problem_of(pairs, boxed_inputs(inputs, 3), kind, trial % 4 == 0 ? 0 : .05);
      problem.cost.reference = .3 * random_matrix(random, inputs, 1).col(0);
      problem.cost.weights = Vector::Ones(inputs) + .5 * random_matrix(random, inputs, 1).col(0);
      const SearchResult exact = searched(problem, {.gap = 1e-7});
      CAPTURE(static_cast<int>(kind));
      const Known cones = known_by_cones(problem, 1e-6, 3000);
      if (exact.status == DesignStatus::infeasible) {
        CHECK_FALSE(cones.answer.u);
        continue;
      }
      CHECK_FALSE(cones.impossible);
      if (exact.cost < 1e-9) continue;  // the reference separates
      REQUIRE(exact.u);
      CHECK(cones.answer.bound <= exact.cost * (1 + 1e-9) + 1e-12);
      if (cones.answer.u) {
        CHECK(cones.answer.cost >= exact.lower_bound * (1 - 1e-9) - 1e-12);
        reached += cones.answer.bound >= exact.cost * (1 - 2e-6);
      } else {
        ++left_out;
      }
      const SearchResult both = exactly(problem);
      check_answer(problem, both);
      CHECK(both.lower_bound <= exact.cost * (1 + 1e-9));
      CHECK(both.cost <= exact.cost * (1 + 1e-7));
      open += both.status != DesignStatus::optimal;
    }
  }
  CHECK(reached >= 60);
  CHECK(left_out <= 2);
  CHECK(open <= 4);  // quadratic costs
}

TEST_CASE("Inputs that cannot vary, and entries that cost nothing") {
  const PairProgram pair = pair_of(0, 1, Matrix::Ones(1, 1), numbers({0}), Matrix::Ones(1, 2));
  for (const Cost::Kind kind : kinds) {
    SeparationProblem point = problem_of({pair}, boxed_inputs(2, 0), kind, .1);
    point.U.c = numbers({.5, .25});
    CHECK(exactly(point).status == DesignStatus::infeasible);
    point.U.c = numbers({.5, 1.25});
    const SearchResult found = exactly(point);
    CHECK(found.status == DesignStatus::optimal);
    check_answer(point, found);
    SeparationProblem free = problem_of({pair}, boxed_inputs(2, 1), kind, .1);
    free.cost.weights.setZero();
    check_optimal(free, exactly(free), 0);
    free.cost.weights[0] = 1;
    check_optimal(free, exactly(free), kind == Cost::Kind::quadratic ? .01 : .1);
  }
}

TEST_CASE("The program of a cone, with room in its sums") {
  const SeparationProblem problem = problem_of({}, boxed_inputs(1, 1), Cost::Kind::norm_1, 0);
  const Star star(problem);
  const Ray ray{numbers({1}), numbers({4, 5})};
  const ConeProgram::Answer exact =
      ConeProgram(star, Cost::Kind::norm_1, numbers({0, 0}), 0).solve({&ray}, infinity);
  CHECK(exact.bound == doctest::Approx(.25));
  const ConeProgram::Answer roomy =
      ConeProgram(star, Cost::Kind::norm_1, numbers({6, 0}), 0).solve({&ray}, infinity);
  CHECK_FALSE(roomy.impossible);
  CHECK(roomy.bound == doctest::Approx(.2));
  const Ray far{numbers({1}), numbers({.5, 5})};
  CHECK(
      ConeProgram(star, Cost::Kind::norm_1, numbers({0, 0}), 0).solve({&far}, infinity).impossible);
}

TEST_CASE("What a solver cannot answer proves nothing") {
  // Numbers that no linear program is solved with: no bound but 0, and nothing is impossible.
  const SeparationProblem problem = problem_of({}, boxed_inputs(1, 1), Cost::Kind::norm_1, 0);
  const Star star(problem);
  for (const double inverse : {infinity, std::numeric_limits<double>::quiet_NaN(), 1e308}) {
    CAPTURE(inverse);
    const Ray ray{numbers({1}), numbers({inverse})};
    ConeProgram::Answer answer;
    try {
      answer = ConeProgram(star, Cost::Kind::norm_1, numbers({0}), 0).solve({&ray}, infinity);
    } catch (const Error&) {
      continue;
    }
    CHECK_FALSE(answer.impossible);
    CHECK(answer.bound < 1e-300);
  }
  // A point that is not known to satisfy its rows: no ray, no end.
  const PairProgram flat = pair_of(0, 1, Matrix::Zero(1, 1), numbers({0}), Matrix::Ones(1, 1));
  const SeparationProblem thin = problem_of({flat}, boxed_inputs(1, 1), Cost::Kind::norm_1, .1);
  CHECK_FALSE(ForbiddenReach::of(thin, flat, Star(thin)));
  const Known known = known_by_cones(thin, 1e-9);
  CHECK(known.answer.bound == 0);
  CHECK_FALSE(known.impossible);
  PairProgram vanished = pair_of(0, 1, Matrix::Ones(1, 1), numbers({0}), Matrix::Ones(1, 1));
  vanished.vanished = 1;  // rows that rounding took away might tell them apart
  CHECK_FALSE(ForbiddenReach::of(thin, vanished, Star(thin)));
}

TEST_CASE("Inputs that begin at the reference, up to the rounding of their ends") {
  std::mt19937 random(5);
  for (const auto& [middle, radius, reference] :
       {std::tuple(2.5, 2.5, 0.0), {.7, .3, .4}, {-.7, .6, -.1}, {1e3, .1, 999.9}}) {
    std::vector<PairProgram> pairs;
    for (Index j = 1; j <= 2; ++j) {
      pairs.push_back(random_pair(random, 0, j, 5, 12, 4, 5));
      pairs.back().G *= radius;
      pairs.back().c = pairs.back().N * Vector::Constant(5, reference);
    }
    SeparationProblem problem = problem_of(pairs, boxed_inputs(5, radius), Cost::Kind::norm_1, .01);
    problem.U.c.setConstant(middle);
    problem.cost.reference.setConstant(reference);
    const Star star(problem);
    CHECK(std::min(star.up.maxCoeff(), star.down.maxCoeff()) == 0);
    CHECK(star.neglected.maxCoeff() > 0);
    CHECK(star.neglected.maxCoeff() < 1e-12 * (std::abs(middle) + radius));
    const Known cones = known_by_cones(problem, 1e-7, 20000);
    REQUIRE(cones.answer.u);
    CHECK(cones.answer.bound >= cones.answer.cost * (1 - 1e-6));
    CHECK(searched(problem).cost >= cones.answer.bound * (1 - 1e-9));
    SeparationProblem narrow = problem;  // the cheapest input is at least as far as this
    const double most = (*cones.answer.u - problem.cost.reference).cwiseAbs().sum() / 5 * .9;
    narrow.U.G *= most / (2 * radius);
    narrow.U.c.setConstant(reference + (middle > reference ? 1 : -1) * most / 2);
    CHECK(known_by_cones(narrow, 1e-7, 20000).impossible);
  }
}

TEST_CASE("Many inputs: no input that separates costs less than the bound") {
  std::mt19937 random(3);
  int separating = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const Index inputs = 8;
    std::vector<PairProgram> pairs;
    for (Index j = 1; j <= 3; ++j) pairs.push_back(random_pair(random, 0, j, 8, 20, 8, inputs));
    const SeparationProblem problem =
        problem_of(pairs, boxed_inputs(inputs, 2), Cost::Kind::norm_1, .01);
    const Known cones = known_by_cones(problem, 1e-8, 300);
    REQUIRE(cones.answer.u);
    CHECK(cones.answer.bound > .5 * cones.answer.cost);
    for (int draw = 0; draw < 200; ++draw) {
      Vector u = random_matrix(random, inputs, 1).col(0);
      for (Index i = 0; i < inputs; ++i) u[i] = random() % 3 == 0 ? u[i] : 0;
      if (u.isZero()) continue;
      u *= cones.answer.bound * (1 - 1e-9) / problem.cost.at(u);
      const bool apart = std::all_of(pairs.begin(), pairs.end(), [&](const PairProgram& pair) {
        const PairSeparation found = separation(pair, u);
        separating += found.kappa_lower >= .01;
        return found.kappa_lower >= .01;
      });
      CHECK_FALSE(apart);
    }
  }
  CHECK(separating > 0);
}

TEST_CASE("The motor with 5, 6 and 8 steps") {
  for (const auto& [horizon, cost] :
       {std::pair(Index{5}, 18.846133), {Index{6}, 17.336914}, {Index{8}, 16.45209}}) {
    const SeparationProblem problem = motor_problem(motor_models(), horizon);
    const SearchResult found = exactly(problem);
    CHECK(found.status == DesignStatus::optimal);
    check_answer(problem, found);
    CHECK(found.cost == doctest::Approx(cost).epsilon(1e-6));
    CHECK(found.lower_bound >= found.cost * (1 - 1e-8));
  }
  const SeparationProblem shaft = motor_problem(motor_with_shaft_models(), 5);
  const SearchResult found = exactly(shaft);
  CHECK(found.status == DesignStatus::optimal);
  check_answer(shaft, found);
  CHECK(found.cost == doctest::Approx(14.648372).epsilon(1e-6));
}

TEST_CASE("The published example with 5 and 6 steps") {
  const SeparationProblem five = published_problem(5, 1e-4);
  const SearchResult of_five = exactly(five);
  CHECK(of_five.status == DesignStatus::optimal);
  check_answer(five, of_five);
  CHECK(of_five.cost == doctest::Approx(8.37528275).epsilon(1e-7));
  const SeparationProblem six = published_problem(6, 1e-4);
  const SearchResult of_six = exactly(six, .01);
  CHECK(of_six.status == DesignStatus::optimal);
  check_answer(six, of_six);
  CHECK(of_six.cost < 8.2101 * 1.01);
  CHECK(of_six.lower_bound > 8.12);
  CHECK(of_six.lower_bound < 8.21008);
}

TEST_CASE("What cones leave open is found all the same") {
  // The reference separates modes 1 and 2, and the cheapest input that separates 1 and 3 does not.
  const Matrix one = Matrix::Ones(1, 1);
  const PairProgram left = pair_of(0, 1, one, numbers({2.5}), one),
                    near = pair_of(0, 2, one, numbers({0}), one);
  const SeparationProblem problem =
      problem_of({left, near}, boxed_inputs(1, 5), Cost::Kind::norm_1, .6);
  const Known cones = known_by_cones(problem, 1e-9);
  CHECK(cones.answer.bound == doctest::Approx(1.6));
  check_optimal(problem, exactly(problem, 1e-9), 1.6);  // on the other side
  SeparationProblem onesided = problem;
  onesided.U.c[0] = 2.5;
  onesided.U.G(0, 0) = 2.5;
  check_optimal(onesided, exactly(onesided, 1e-9), 4.1);
  // A polytope of inputs, u_0 + u_1 ≤ .5, of which cones see the box only.
  InputSequences U{Vector::Zero(2), Matrix::Zero(2, 3), (Matrix(1, 3) << 1, 1, 1.25).finished(),
                   numbers({-.75})};
  U.G.leftCols(2).setIdentity();
  const PairProgram sum = pair_of(0, 1, one, numbers({0}), (Matrix(1, 2) << 1, 1).finished());
  SeparationProblem polytope = problem_of({sum}, U, Cost::Kind::norm_1, .2);
  polytope.cost.reference = numbers({.2, .2});
  CHECK(known_by_cones(polytope, 1e-9).answer.bound <= 1.6);
  check_optimal(polytope, exactly(polytope, 1e-9), 1.6);
}
