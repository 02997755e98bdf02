// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels keep their memory from call to call: what they computed before must not show in what they
// compute next.
#include <exception>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/line_elimination.hpp"
#include "cordon/sets/constraint_elimination.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "cordon/sets/line_zonotope.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::test;

namespace {

LineForm arbitrary_form() {
  const Index n = arbitrary_dim(), m = *rc::gen::inRange<Index>(0, 6),
              l = *rc::gen::inRange<Index>(0, 3);
  const Index g = *rc::gen::inRange<Index>(0, 16);
  return {arbitrary_matrix(n, l), arbitrary_matrix(n, g), arbitrary_vector(n),
          arbitrary_matrix(m, l), arbitrary_matrix(m, g), arbitrary_vector(m)};
}

LineForm without_lines(const LineForm& X) {
  return {Matrix(X.dim(), 0), X.G, X.c, Matrix(X.constraints(), 0), X.A, X.b};
}

/// All that the kernels with memory of their own make of X.
std::vector<Matrix> results(const LineForm& X) {
  const Index n = X.dim();
  std::vector<Matrix> made;
  const auto keep = [&](const LineForm& Y) {
    made.insert(made.end(), {Y.M, Y.G, Y.c, Y.S, Y.A, Y.b});
  };
  const LinesSolved solved = solve_for_lines(X);
  keep(solved.set);
  made.insert(made.end(), {solved.row_magnitude, solved.state_magnitude});
  keep(eliminate_lines_traced(X, Vector(0)).set);
  const LineForm Z = without_lines(X);
  for (const bool gauss_jordan : {false, true}) {
    keep(sets::eliminate_constraints(Z, 1, {.rescale = gauss_jordan, .gauss_jordan = gauss_jordan})
             .set);
  }
  keep(sets::reduce(X, n + 2, 2, {}).set);
  made.push_back(sets::reduce_generators(X.G, n + 1, sets::GeneratorReduction::yang_scott));
  return made;
}

/// In a thread of its own, where nothing was computed before.
std::vector<Matrix> fresh_results(const LineForm& X) {
  std::vector<Matrix> made;
  std::exception_ptr failure;
  std::thread([&] {
    try {
      made = results(X);
    } catch (...) {
      failure = std::current_exception();
    }
  }).join();
  if (failure) std::rethrow_exception(failure);
  return made;
}

bool same(const Matrix& A, const Matrix& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && (A.array() == B.array()).all();
}

}  // namespace

TEST_CASE("kernels compute the same after whatever they computed before") {
  REQUIRE(rc::check([] {
    const LineForm X = arbitrary_form();
    results(arbitrary_form());
    const std::vector<Matrix> here = results(X), fresh = fresh_results(X);
    RC_ASSERT(here.size() == fresh.size());
    for (std::size_t k = 0; k < here.size(); ++k) RC_ASSERT(same(here[k], fresh[k]));
  }));
}
