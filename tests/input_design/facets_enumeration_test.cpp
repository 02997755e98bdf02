// SPDX-License-Identifier: GPL-3.0-or-later
// The search over facets against the enumeration of all choices of facets.
#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/lp.hpp"
#include "input_design/facets_answers.hpp"

using namespace cordon;
using namespace cordon::designers;
using namespace cordon::examples;

namespace {

/// min Σ ω (u - r)² over rows F u ≥ e, by Hildreth's method on the multipliers; infinity if that is
/// more than `enough`.
double least_squares_cost(const Cost& cost, const Matrix& F, const Vector& e, double enough) {
  Vector lambda = Vector::Zero(e.size()), u = cost.reference;
  const Vector inverse = (2 * cost.weights).cwiseInverse();
  for (int sweep = 0; sweep < 100000; ++sweep) {
    double change = 0;
    for (Index f = 0; f < e.size(); ++f) {
      const double curvature = F.row(f).cwiseAbs2().dot(inverse);
      if (curvature == 0) {
        if (e[f] > 0) return infinity;
        continue;
      }
      const double next = std::max(0.0, lambda[f] + (e[f] - F.row(f).dot(u)) / curvature),
                   step = next - lambda[f];
      lambda[f] = next;
      u += step * inverse.cwiseProduct(F.row(f).transpose());
      change = std::max(change, std::abs(step) * std::sqrt(curvature));
    }
    if (cost.at(u) + lambda.dot(e - F * u) > enough) return infinity;  // the dual value
    if (change < 1e-11) break;
  }
  REQUIRE((F * u - e).minCoeff() > -1e-8);
  return cost.at(u);
}

/// The least cost of u with rows F u ≥ e and |u_i| ≤ radius_i around `centre`, by a program in u
/// itself; infinity if that is more than `enough` and the cost is quadratic.
double least_cost(const Cost& cost, const Matrix& F, const Vector& e, const Vector& centre,
                  const Vector& radius, double enough) {
  const Index n = centre.size(), m = e.size();
  if (cost.kind == Cost::Kind::quadratic) {
    if (least_cost({Cost::Kind::norm_1, cost.weights, cost.reference}, F, e, centre, radius,
                   enough) == infinity)
      return infinity;
    Matrix rows(m + 2 * n, n);
    rows << F, Matrix::Identity(n, n), -Matrix::Identity(n, n);
    Vector levels(m + 2 * n);
    levels << e, centre - radius, -centre - radius;
    return least_squares_cost(cost, rows, levels, enough);
  }
  const bool one = cost.kind == Cost::Kind::norm_1;
  const Index costs = one ? n : 1, slacks = m + 2 * n;
  Matrix A = Matrix::Zero(slacks, n + costs + slacks);
  Vector b = Vector::Zero(slacks), lower = Vector::Zero(A.cols()),
         upper = Vector::Constant(A.cols(), infinity);
  lower.head(n) = centre - radius;
  upper.head(n) = centre + radius;
  A.topLeftCorner(m, n) = F;
  b.head(m) = e;
  for (Index i = 0; i < n; ++i) {
    for (int side = 0; side < 2; ++side) {
      const Index row = m + 2 * i + side;
      const double sign = side ? 1 : -1;
      A(row, n + (one ? i : 0)) = 1;
      A(row, i) = -sign * cost.weights[i];
      b[row] = -sign * cost.weights[i] * cost.reference[i];
    }
  }
  A.rightCols(slacks) = -Matrix::Identity(slacks, slacks);
  Vector objective = Vector::Zero(A.cols());
  objective.segment(n, costs).setConstant(-1);
  const LinearProgram::Solution solution = LinearProgram(A, b, lower, upper).maximize(objective);
  return solution.status == LinearProgram::Status::optimal ? -solution.objective : infinity;
}

/// Every choice of a facet for each pair. Box-shaped input sets only.
double enumerated(const SeparationProblem& problem) {
  const InputSequences& U = problem.U;
  const Index n = U.c.size();
  // ζ as a function of u: the columns of G have one entry each.
  Matrix inverse = Matrix::Zero(U.G.cols(), n);
  for (Index j = 0; j < U.G.cols(); ++j) {
    for (Index i = 0; i < n; ++i) {
      if (U.G(i, j) != 0) inverse(j, i) = 1 / U.G(i, j);
    }
  }
  std::vector<ForbiddenSet> sets;
  for (const PairProgram& pair : problem.pairs) {
    sets.push_back(forbidden(pair, U, problem.epsilon));
    if (sets.back().kind == ForbiddenSet::Kind::separated) sets.pop_back();
  }
  const auto m = static_cast<Index>(sets.size());
  Matrix F(m, n);
  Vector e(m);
  double best = infinity;
  std::vector<std::size_t> choice(sets.size(), 0);
  for (;;) {
    for (Index q = 0; q < m; ++q) {
      const SeparatingFacet& facet =
          sets[static_cast<std::size_t>(q)].facets[choice[static_cast<std::size_t>(q)]];
      F.row(q) = facet.a.transpose() * inverse;
      e[q] = facet.out + F.row(q).dot(U.c);
    }
    best =
        std::min(best, least_cost(problem.cost, F, e, U.c, U.G.cwiseAbs().rowwise().sum(), best));
    std::size_t q = 0;
    while (q < choice.size() && ++choice[q] == sets[q].facets.size()) choice[q++] = 0;
    if (q == choice.size()) return best;
  }
}

SeparationProblem random_problem(std::mt19937& random, Cost::Kind kind, int trial) {
  const Index inputs = 4;
  std::vector<PairProgram> pairs;
  for (Index q = 0; q < 3; ++q)
    pairs.push_back(random_pair(random, q, q + 1, 3, 5, 1 + (trial + q) % 3, inputs));
  if (trial % 5 == 4) pairs[1].N *= .1;  // hard to reach
  SeparationProblem problem =
      problem_of(std::move(pairs), boxed_inputs(inputs, 1.5, trial % 2), kind, trial % 3 ? .2 : 0);
  if (trial % 2) problem.U.c[0] = random_matrix(random, 1, 1)(0, 0);
  problem.cost.reference = random_matrix(random, inputs, 1);
  problem.cost.weights += .9 * random_matrix(random, inputs, 1);
  return problem;
}

}  // namespace

TEST_CASE("All choices of facets for the published example, quadratic and largest entry") {
  for (const auto kind : {Cost::Kind::quadratic, Cost::Kind::norm_inf}) {
    SeparationProblem problem = published_problem(3, 1e-4, kind);
    problem.pairs = {problem.pairs[0], problem.pairs[1], problem.pairs[2]};
    check_optimal(problem, searched(problem), enumerated(problem));
    SeparationProblem scalar = scalar_problem(.1);
    scalar.cost.kind = kind;
    check_optimal(scalar, searched(scalar), enumerated(scalar));
  }
}

TEST_CASE("Random problems agree with the enumeration of all choices") {
  std::mt19937 random(23);
  int found_some = 0, found_none = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const auto kind = static_cast<Cost::Kind>(trial % 3);
    const SeparationProblem problem = random_problem(random, kind, trial / 3);
    const double expected = enumerated(problem);
    const SearchResult found = searched(problem);
    CAPTURE(trial);
    if (expected == infinity) {
      CHECK(found.status == DesignStatus::infeasible);
      ++found_none;
      continue;
    }
    ++found_some;
    check_answer(problem, found);
    CHECK(found.cost == doctest::Approx(expected).epsilon(1e-7).scale(.01));
    CHECK(found.lower_bound >= found.cost * (1 - 1e-9) - 1e-10);
    CHECK((found.status == DesignStatus::optimal ||
           found.cost < .1));  // a share of little is below rounding
  }
  CHECK(found_some > 80);
  CHECK(found_none > 3);
}

TEST_CASE("More distance never costs less") {
  std::mt19937 random(29);
  for (int trial = 0; trial < 12; ++trial) {
    SeparationProblem problem = random_problem(random, static_cast<Cost::Kind>(trial % 3), trial);
    double before = 0;
    for (const double epsilon : {0.0, .05, .3, .8}) {
      problem.epsilon = epsilon;
      const SearchResult found = searched(problem);
      if (!found.u) break;
      CHECK(found.cost >= before - 1e-9);
      before = found.cost;
    }
  }
}
