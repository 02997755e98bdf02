// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs found by the mixed-integer program, and what it says where there is none.
#include <cmath>

#include <doctest/doctest.h>

#include "designers/milp/search.hpp"
#include "input_design/milp_problems.hpp"

using namespace cordon;
using namespace cordon::designers;
using examples::descriptor_problem;
using examples::numbers;
using examples::scalar_problem;

namespace {

MilpLimits generators(Index count) { return {count, 2, 1e-6, 60}; }

SearchResult search(const SeparationProblem& problem, const MilpLimits& limits) {
  DesignControl control;
  return search_milp(problem, limits, control);
}

/// Feasible, closed, and proven to separate.
void check_found(const SeparationProblem& problem, const SearchResult& found, double cost) {
  CHECK(found.status == DesignStatus::feasible);
  CHECK_FALSE(found.stopped);
  REQUIRE(found.u);
  CHECK(found.cost == doctest::Approx(cost).epsilon(1e-5));
  CHECK(found.cost == doctest::Approx(problem.cost.at(*found.u)));
  CHECK(found.lower_bound == -infinity);  // of the problem itself nothing is known
  REQUIRE(found.restriction);
  CHECK(found.restriction->lower_bound <= found.cost);
  CHECK(found.restriction->lower_bound >= found.cost - 2e-6 * (1 + found.cost));
  CHECK(found.restriction->name.find("generators per pair, as GLPK bounds it") !=
        std::string::npos);
  CHECK(found.reason.find("may separate the modes too") != std::string::npos);
  for (const PairProgram& pair : problem.pairs)
    CHECK(separation(pair, *found.u).kappa >= problem.epsilon - 1e-6);
  const Vector ones = problem.U.G.cwiseAbs().rowwise().sum();
  CHECK(((*found.u - problem.U.c).cwiseAbs() - ones).maxCoeff() <= 1e-9);
}

/// Remembers what it was told, and ends the search after some calls.
class Watch : public DesignControl {
 public:
  explicit Watch(int most) : most_(most) {}
  bool stop() const noexcept override { return calls >= most_; }
  void progress(Index horizon, double best, double bound) override {
    ++calls;
    CHECK(horizon == 3);
    CHECK(best <= best_);
    CHECK(bound >= bound_);
    CHECK(bound <= best * (1 + 1e-9));
    best_ = best;
    bound_ = bound;
  }
  int calls = 0;

 private:
  int most_;
  double best_ = infinity, bound_ = -infinity;
};

}  // namespace

TEST_CASE("Scalar models from anywhere: |u_1| = 0.9 (1 + ε), and nothing else") {
  SeparationProblem problem = scalar_problem();
  for (const double epsilon : {.1, 1e-4}) {
    problem.epsilon = epsilon;
    const SearchResult found = search(problem, generators(3));
    check_found(problem, found, .9 * (1 + epsilon));
    CHECK(std::abs((*found.u)[1]) == doctest::Approx(.9 * (1 + epsilon)));
    CHECK(found.nodes > 0);
    CHECK(found.programs > 0);
  }
}

TEST_CASE("Other costs of the scalar models") {
  SeparationProblem problem = scalar_problem();
  const double least = .9 * (1 + 1e-4);
  SUBCASE("weights") {
    problem.cost.weights = numbers({5, 2, 5, 5});
    check_found(problem, search(problem, generators(3)), 2 * least);
  }
  SUBCASE("an input that costs nothing") {
    problem.cost.weights = numbers({5, 0, 5, 5});
    const SearchResult found = search(problem, generators(3));
    CHECK(found.status == DesignStatus::feasible);
    CHECK(found.cost == doctest::Approx(0));
    CHECK(found.restriction->lower_bound <= found.cost);
  }
  SUBCASE("a reference on one side") {
    problem.cost.reference = numbers({0, .5, 0, 0});
    const SearchResult found = search(problem, generators(3));
    check_found(problem, found, least - .5);
    CHECK((*found.u)[1] == doctest::Approx(least));
  }
  SUBCASE("a reference that separates") {
    problem.cost.reference = numbers({0, -1.2, 0, 0});
    const SearchResult found = search(problem, generators(3));
    CHECK(found.cost == doctest::Approx(0));
    CHECK((*found.u)[1] == doctest::Approx(-1.2));
  }
  SUBCASE("quadratic") {
    problem.cost.kind = Cost::Kind::quadratic;
    problem.cost.weights = numbers({1, 3, 1, 1});
    for (const Index k : {0, 2, 3}) problem.U.G.row(k).setZero();  // others would help a little
    problem.cost.reference = numbers({0, -.2, 0, 0});
    check_found(problem, search(problem, generators(3)), 3 * (least - .2) * (least - .2));
  }
  SUBCASE("maximum") {
    problem.cost.kind = Cost::Kind::norm_inf;
    const SearchResult found = search(problem, generators(3));
    CHECK(found.cost <= least + 1e-9);  // others help
    check_found(problem, found, found.cost);
  }
}

TEST_CASE("Input sets with constraints") {
  SeparationProblem problem = scalar_problem();
  problem.U.A = (Matrix(1, 4) << 0, 1, 0, 0).finished();
  problem.U.b = numbers({-.75});  // u_1 = -1.5
  const SearchResult found = search(problem, generators(3));
  check_found(problem, found, 1.5);
  CHECK((*found.u)[1] == doctest::Approx(-1.5));
  // u = (2ξ₁ + ξ₂, …) with generators that are no axes: u_1 ∈ [-3, 3] still
  problem = scalar_problem();
  problem.U.G(1, 0) = 1;
  check_found(problem, search(problem, generators(3)), .9 * (1 + 1e-4));
  problem.U.A = (Matrix(1, 4) << 1, -1, 0, 0).finished();
  problem.U.b = numbers({0});  // u_0 = 2ξ, u_1 = 3ξ: u_0 must follow
  const SearchResult tied = search(problem, generators(3));
  check_found(problem, tied, tied.cost);
  CHECK((*tied.u)[0] * 3 == doctest::Approx((*tied.u)[1] * 2));
  CHECK(tied.cost > .9 * (1 + 1e-4));
}

TEST_CASE("Tubes must not be empty") {
  SeparationProblem problem = scalar_problem();
  const auto row = [](double at) {  // ζ = u_1 - at for some |ζ| ≤ 1
    TubeConditions rows{Matrix::Ones(1, 1), Matrix::Zero(1, 4), Vector::Constant(1, -at),
                        Vector::Ones(1)};
    rows.Omega(0, 1) = 1;
    return rows;
  };
  problem.conditions[1] = row(2.5);
  const SearchResult found = search(problem, generators(3));
  check_found(problem, found, 1.5);
  CHECK((*found.u)[1] == doctest::Approx(1.5));
  problem.conditions[0] = row(0);  // both leave none
  const SearchResult none = search(problem, generators(3));
  CHECK(none.status == DesignStatus::unknown);
  CHECK_FALSE(none.u);
}

TEST_CASE("Descriptor models: no cheaper than the proven optimum, little dearer") {
  const SeparationProblem problem = descriptor_problem();
  const SearchResult found = search(problem, generators(2));
  check_found(problem, found, found.cost);
  CHECK(found.cost >= 9.2005343);
  CHECK(found.cost < 9.25);
  CHECK((*found.u)[0] == .5);
  CHECK((*found.u)[1] == -1);
  for (const PairProgram& pair : problem.pairs)
    CHECK(separation(pair, *found.u).disjoint == Answer::yes);
}

TEST_CASE("Descriptor models with a quadratic cost and with a maximum") {
  SeparationProblem problem = descriptor_problem();
  const Vector by_sum = *search(problem, generators(2)).u;
  for (const auto kind : {Cost::Kind::quadratic, Cost::Kind::norm_inf}) {
    problem.cost.kind = kind;
    const SearchResult found = search(problem, generators(2));
    check_found(problem, found, found.cost);
    CHECK(found.cost <= problem.cost.at(by_sum) * (1 + 1e-9));
  }
}

TEST_CASE("Without a solution nothing is claimed but what is proven") {
  SUBCASE("inputs too small") {
    SeparationProblem problem = scalar_problem();
    problem.U.G *= .2;
    const SearchResult none = search(problem, generators(3));
    CHECK(none.status == DesignStatus::unknown);
    CHECK_FALSE(none.u);
    CHECK_FALSE(none.stopped);
    CHECK(none.restriction->lower_bound == -infinity);
    CHECK(none.reason.find("as GLPK says") != std::string::npos);
    CHECK(none.suggestion.find("facets") != std::string::npos);
  }
  SUBCASE("pairs that exclude each other") {
    SeparationProblem problem = scalar_problem();
    const auto away_from = [](double centre, double radius) {  // |u_1 - centre| > radius
      PairProgram pair{
          0,           1, Matrix::Constant(1, 1, radius), numbers({centre}), Matrix::Zero(1, 4),
          numbers({0})};
      pair.N(0, 1) = 1;
      return pair;
    };
    problem.pairs = {away_from(0, 1.5), away_from(2, .6), away_from(-2, .6)};
    const SearchResult none = search(problem, generators(3));
    CHECK(none.status == DesignStatus::unknown);
    CHECK_FALSE(none.u);
    CHECK(none.restriction->lower_bound == -infinity);  // 1.5 is the first pair's, but GLPK's word
    CHECK(none.reason.find("as GLPK says") != std::string::npos);
    problem.pairs.pop_back();
    check_found(problem, search(problem, generators(3)), 1.5 * (1 + 1e-4));
  }
  SUBCASE("no row") {
    const SeparationProblem problem = examples::separation_problem(
        examples::three_scalar_models(), 0, 2, Vector::Zero(1), Vector(0));
    const SearchResult none = search(problem, generators(3));
    CHECK(none.status == DesignStatus::infeasible);
    CHECK(none.reason.find("modes 1 and 2") != std::string::npos);
    CHECK(none.suggestion == "a longer horizon");
  }
  SUBCASE("too few generators") {
    const SearchResult none = search(descriptor_problem(), generators(1));
    CHECK(none.status == DesignStatus::unknown);
    CHECK(none.suggestion.find("max_generators") != std::string::npos);
  }
}

TEST_CASE("Pairs that no input changes") {
  SeparationProblem problem = scalar_problem();
  PairProgram fixed{0, 2, Matrix::Ones(1, 1), numbers({3}), Matrix::Zero(1, 4), numbers({3})};
  problem.pairs.push_back(fixed);  // apart by κ = 2
  check_found(problem, search(problem, generators(3)), .9 * (1 + 1e-4));
  problem.pairs.back().c[0] = .5;
  SearchResult none = search(problem, generators(3));
  CHECK(none.status == DesignStatus::infeasible);
  CHECK(none.reason.find("no input changes") != std::string::npos);
  problem.pairs.back().c[0] = 1.5;  // apart, but not enough
  problem.epsilon = 1;
  none = search(problem, generators(3));
  CHECK(none.status == DesignStatus::unknown);
  // What u changes is held by U: they meet, but whether N is 0 up to rounding only is not known.
  problem = scalar_problem();
  problem.pairs.back().N.setZero();
  problem.pairs.back().N(0, 0) = 1;
  problem.pairs.back().c.setZero();
  problem.U.G.row(0).setZero();
  none = search(problem, generators(3));
  CHECK(none.status == DesignStatus::unknown);
  CHECK_FALSE(none.u);
}

TEST_CASE("A pair that is apart by however little is not proven to be") {
  SeparationProblem problem = scalar_problem();
  problem.epsilon = 0;
  const SearchResult touching = search(problem, generators(3));
  REQUIRE(touching.u);
  CHECK(touching.cost == doctest::Approx(.9));
  problem.epsilon = 1e-13;
  const SearchResult found = search(problem, generators(3));
  if (found.u) {
    for (const PairProgram& pair : problem.pairs)
      CHECK(separation(pair, *found.u).disjoint == Answer::yes);
  } else {
    CHECK(found.status == DesignStatus::unknown);
    CHECK(found.reason.find("not proven") != std::string::npos);
  }
}

TEST_CASE("The search is watched, and ends when told to") {
  const SeparationProblem problem = descriptor_problem();
  Watch all(1'000'000);
  CHECK(search_milp(problem, generators(4), all).status == DesignStatus::feasible);
  CHECK(all.calls > 3);
  Watch at_once(0);
  SearchResult ended = search_milp(problem, generators(8), at_once);
  CHECK(ended.status == DesignStatus::unknown);
  CHECK(ended.stopped);
  CHECK(ended.reason.find("from outside") != std::string::npos);
  Watch soon(30);
  ended = search_milp(problem, generators(8), soon);
  CHECK(ended.stopped);
  CHECK(ended.status == DesignStatus::feasible);
  REQUIRE(ended.u);
  CHECK(ended.restriction->lower_bound < ended.cost);
  CHECK(soon.calls < 100);
}

TEST_CASE("A time limit leaves what was found") {
  const SeparationProblem problem = descriptor_problem();
  SearchResult ended = search(problem, {20, 4, 1e-6, 1});
  CHECK(ended.stopped);
  CHECK(ended.status == (ended.u ? DesignStatus::feasible
                                 : DesignStatus::unknown));  // on a slow machine there may be none
  CHECK(ended.reason.find("the time limit is over") != std::string::npos);
  if (ended.u) CHECK(ended.restriction->lower_bound < ended.cost);
  ended = search(problem, {8, 2, 1e-6, 1e-9});
  CHECK(ended.stopped);
  CHECK(ended.status == DesignStatus::unknown);
  CHECK(ended.reason.find("no input was found") != std::string::npos);
}
