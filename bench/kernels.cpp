// SPDX-License-Identifier: GPL-3.0-or-later
// Operations on random constrained sets of (states, generators, constraints) = (3,30,5),
// (10,100,20), (20,200,50).
#include <map>
#include <random>

#include <benchmark/benchmark.h>

#include "cordon/sets/line_zonotope.hpp"
#include "cordon/sets/strip.hpp"
#include "cordon/sets/zonotope.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "random_sets.hpp"

namespace {

using namespace cordon;
using namespace cordon::bench;

void affine_map_of_set(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  std::mt19937_64 engine(2);
  const Matrix T = random_matrix(engine, X.dim(), X.dim());
  const Vector t = Vector::Zero(X.dim());
  for (auto _ : state) benchmark::DoNotOptimize(affine_map(X, T, t));
}
void minkowski_sum_of_sets(benchmark::State& state) {
  const LineForm X = random_set(size(state)), Y = random_set(size(state), 2);
  for (auto _ : state) benchmark::DoNotOptimize(minkowski_sum(X, Y));
}
void generalised_intersection(benchmark::State& state) {
  const LineForm X = random_set(size(state)),
                 Y = make_box({Vector::Constant(2, -1), Vector::Constant(2, 1)});
  std::mt19937_64 engine(2);
  const Matrix R = random_matrix(engine, 2, X.dim());
  for (auto _ : state) benchmark::DoNotOptimize(intersection(X, R, Y));
}
void line_elimination(benchmark::State& state) {
  const LineForm X =
      intersection(make_space(size(state).n), Matrix::Identity(size(state).n, size(state).n),
                   random_set(size(state)));
  for (auto _ : state) benchmark::DoNotOptimize(eliminate_lines(X));
}
void constraint_elimination_of_one(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  for (auto _ : state)
    benchmark::DoNotOptimize(sets::eliminate_constraints(X, X.constraints() - 1));
}
void constraint_elimination_to_5(benchmark::State& state) {
  Size s = size(state);
  if (s.m <= 5) s.m = 8;
  const LineForm X = random_set(s);
  for (auto _ : state) benchmark::DoNotOptimize(sets::eliminate_constraints(X, 5));
}
void generator_reduction_by_a_fifth(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  Matrix lifted(X.dim() + X.constraints(), X.generators());
  lifted << X.G, X.A;
  const Index target = X.generators() * 4 / 5;
  for (auto _ : state) benchmark::DoNotOptimize(sets::reduce_generators(lifted, target));
}
void interval_hull_certified(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  for (auto _ : state) benchmark::DoNotOptimize(interval_hull(X));
}
void emptiness_of_non_empty(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  if (is_empty(X) == Answer::yes) state.SkipWithError("the instance must not be empty");
  for (auto _ : state) benchmark::DoNotOptimize(is_empty(X));
}
void emptiness_of_empty(benchmark::State& state) {
  LineForm X = random_set(size(state));
  for (int tries = 0; tries < 20 && is_empty(X) != Answer::yes; ++tries) X.b *= 2;
  if (is_empty(X) != Answer::yes) state.SkipWithError("the instance must be proven empty");
  for (auto _ : state) benchmark::DoNotOptimize(is_empty(X));
}
void containment_of_inner_point(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  const Box hull = interval_hull(X);
  const Vector x = hull.center();
  for (auto _ : state) benchmark::DoNotOptimize(contains(X, x));
}
/// Within 2 % of the boundary, seen from the middle. Found once per size: on the boundary itself
/// exact arithmetic decides.
const Vector& point_near_boundary(Size s, const LineForm& X) {
  static std::map<Index, Vector> found;
  Vector& x = found[s.n];
  if (x.size() > 0) return x;
  const Vector middle = interval_hull(X).center();
  std::mt19937_64 engine(5);
  const Vector direction = random_matrix(engine, X.dim(), 1);
  double inside = 0, outside = 100;
  for (int k = 0; k < 40; ++k) {
    const double between = (inside + outside) / 2;
    (contains(X, middle + between * direction) == Answer::yes ? inside : outside) = between;
  }
  return x = middle + .98 * inside * direction;
}
void containment_near_boundary(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  const Vector& x = point_near_boundary(size(state), X);
  if (contains(X, x) != Answer::yes)
    state.SkipWithError("the point must be proven to lie in the set");
  for (auto _ : state) benchmark::DoNotOptimize(contains(X, x));
}
void strip_of_zonotope(benchmark::State& state) {
  const LineForm X = random_set(size(state));
  const sets::Zonotope Z{X.c, X.G};
  const Vector rho = Vector::Ones(X.dim());
  for (auto _ : state) benchmark::DoNotOptimize(sets::intersect_strip(Z, rho, rho.dot(Z.c), .1));
}

BENCHMARK(affine_map_of_set)->Apply(sizes);
BENCHMARK(minkowski_sum_of_sets)->Apply(sizes);
BENCHMARK(generalised_intersection)->Apply(sizes);
BENCHMARK(line_elimination)->Apply(sizes);
BENCHMARK(constraint_elimination_of_one)->Apply(sizes);
BENCHMARK(constraint_elimination_to_5)->Apply(sizes);
BENCHMARK(generator_reduction_by_a_fifth)->Apply(sizes);
BENCHMARK(interval_hull_certified)->Apply(sizes);
BENCHMARK(emptiness_of_non_empty)->Apply(sizes);
BENCHMARK(emptiness_of_empty)->Apply(sizes);
BENCHMARK(containment_of_inner_point)->Apply(sizes);
BENCHMARK(containment_near_boundary)->Apply(sizes);
BENCHMARK(strip_of_zonotope)->Apply(sizes);

}  // namespace
