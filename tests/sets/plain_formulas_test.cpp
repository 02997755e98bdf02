// SPDX-License-Identifier: GPL-3.0-or-later
// What is arranged for speed, beside the plain formula, over random sets.
#include <limits>
#include <numeric>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "cordon/sets/line_zonotope.hpp"
#include "elimination_scores.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::test;

namespace {

Matrix padded(const Matrix& A) {
  Matrix B = Matrix::Zero(vectors::padded(A.rows()), A.cols());
  B.topRows(A.rows()) = A;
  return B;
}

bool near(const Matrix& A, const Matrix& B, double tolerance) {
  if (A.rows() != B.rows() || A.cols() != B.cols()) return false;
  return A.size() == 0 ||
         (A - B).cwiseAbs().maxCoeff() <= tolerance * (1 + B.cwiseAbs().maxCoeff());
}

bool near(const LineForm& X, const LineForm& Y) {
  constexpr double tolerance = 1e-13;
  return near(X.M, Y.M, tolerance) && near(X.G, Y.G, tolerance) && near(X.c, Y.c, tolerance) &&
         near(X.S, Y.S, tolerance) && near(X.A, Y.A, tolerance) && near(X.b, Y.b, tolerance);
}

/// Wide in all coordinates and rows: a factor for each of them alone.
LineForm wide_set(Index n, Index constraints, Index lines) {
  const Index g = n + constraints + *rc::gen::inRange<Index>(0, 6);
  LineForm X{arbitrary_matrix(n, lines),
             arbitrary_matrix(n, g),
             arbitrary_vector(n),
             arbitrary_matrix(constraints, lines),
             arbitrary_matrix(constraints, g),
             arbitrary_vector(constraints)};
  X.G.leftCols(n) = 3 * Matrix::Identity(n, n);
  X.A.leftCols(n).setZero();
  X.G.middleCols(n, constraints).setZero();
  X.A.middleCols(n, constraints) = 2 * Matrix::Identity(constraints, constraints);
  return X;
}

/// r² (‖D G P e_j‖² / P_jj + w) / P_jj with H = (I - Σ e_k e_kᵀ + GᵀG)⁻¹ over the factors k that
/// were forgotten; +inf where P_jj is little more than rounding.
Vector plain_scores(const Matrix& G, const Matrix& A, const std::vector<Index>& forgotten,
                    double reach) {
  const Index g = G.cols();
  Matrix precision = Matrix::Identity(g, g) + G.transpose() * G;
  for (const Index k : forgotten) precision(k, k) -= 1;
  Matrix K = Matrix::Zero(
      g + A.rows(), g + A.rows());  // P is the upper left block of the inverse of [H⁻¹ Aᵀ; A 0]
  K.topLeftCorner(g, g) = precision;
  K.topRightCorner(g, A.rows()) = A.transpose();
  K.bottomLeftCorner(A.rows(), g) = A;
  const Matrix P = linalg::pseudo_inverse(K, 1e-14).topLeftCorner(g, g);
  Vector widths = G.cwiseAbs().rowwise().sum();
  for (double& width : widths) width = width > 0 ? width : 1;
  Vector scores(g);
  for (Index j = 0; j < g; ++j) {
    const double moved = (G * P.col(j)).cwiseQuotient(widths).squaredNorm();
    scores[j] = P(j, j) > 1e-6 ? reach * reach * (moved / P(j, j) + 1e-6) / P(j, j)
                               : std::numeric_limits<double>::infinity();
  }
  return scores;
}

/// Method 4 of [Yang2018] for a matrix of full row rank, by the inverse of the basis.
Matrix plain_yang_scott(const Matrix& G, Index most) {
  const Index n = G.rows();
  Matrix W = G;
  std::vector<Index> basis;
  std::vector<bool> row_used(static_cast<std::size_t>(n), false),
      column_used(static_cast<std::size_t>(G.cols()), false);
  for (Index step = 0; step < n; ++step) {
    Index row = -1, column = -1;
    for (Index j = 0; j < W.cols(); ++j) {
      for (Index i = 0; i < n; ++i) {
        if (row_used[static_cast<std::size_t>(i)] || column_used[static_cast<std::size_t>(j)])
          continue;
        if (row < 0 || std::abs(W(i, j)) > std::abs(W(row, column))) {
          row = i;
          column = j;
        }
      }
    }
    row_used[static_cast<std::size_t>(row)] = column_used[static_cast<std::size_t>(column)] = true;
    basis.push_back(column);
    for (Index i = 0; i < n; ++i) {
      if (i != row) W.row(i) -= W(i, column) / W(row, column) * W.row(row);
    }
  }
  Matrix T = G(Eigen::all, basis);
  std::vector<Index> rest;
  for (Index j = 0; j < G.cols(); ++j) {
    if (!column_used[static_cast<std::size_t>(j)]) rest.push_back(j);
  }
  while (n + static_cast<Index>(rest.size()) > most) {
    std::size_t cheapest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const Vector r = linalg::product(linalg::pseudo_inverse(T, 1e-15), G.col(rest[k])).cwiseAbs();
      const double cost = (1 + r.array()).prod() - 1 - r.sum();
      if (cost < least - 1e-9) {
        least = cost;
        cheapest = k;
      }
    }
    const Vector r =
        linalg::product(linalg::pseudo_inverse(T, 1e-15), G.col(rest[cheapest])).cwiseAbs();
    T = T * (1 + r.array()).matrix().asDiagonal();
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(cheapest));
  }
  Matrix H(n, most);
  H << T, G(Eigen::all, rest);
  return H;
}

}  // namespace

TEST_CASE("loops over padded numbers") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange<Index>(0, 19);
    const Matrix numbers = arbitrary_matrix(n, 2), full = padded(numbers);
    const double a = arbitrary_number();
    RC_ASSERT(std::abs(vectors::dot(n, full.col(0).data(), full.col(1).data()) -
                       numbers.col(0).dot(numbers.col(1))) < 1e-10);
    RC_ASSERT(vectors::largest_size(n, full.col(0).data()) ==
              (n ? numbers.col(0).cwiseAbs().maxCoeff() : 0));
    const Matrix sizes = full.cwiseAbs();
    RC_ASSERT(vectors::largest_product(n, sizes.col(0).data(), sizes.col(1).data()) ==
              (n ? sizes.col(0).cwiseProduct(sizes.col(1)).maxCoeff() : 0));
    Vector y = full.col(1);
    vectors::add_multiple(n, a, full.col(0).data(), y.data());
    RC_ASSERT(near(y, full.col(1) + a * full.col(0), 1e-15));
  }));
}

TEST_CASE("one number that is not finite is seen, wherever it is") {
  for (Index rows = 1; rows < 7; ++rows) {
    Matrix A = Matrix::Constant(rows + 1, 5, std::numeric_limits<double>::max());
    CHECK(vectors::all_finite(A));
    for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
      for (double& entry : A.reshaped()) {
        const double before = entry;
        entry = bad;
        CHECK(!vectors::all_finite(A));
        CHECK(vectors::all_finite(A.topRows(rows)) == A.topRows(rows).allFinite());
        entry = before;
      }
    }
  }
}

TEST_CASE("products of any size") {
  CHECK(rc::check([] {
    const auto size = [] { return *rc::gen::inRange<Index>(0, 15); };
    const Matrix A = arbitrary_matrix(size(), size()), B = arbitrary_matrix(A.cols(), size()),
                 C = arbitrary_matrix(A.rows(), size());
    RC_ASSERT(near(linalg::product(A, B), A.lazyProduct(B), 1e-14));
    RC_ASSERT(near(linalg::transposed_product(A, C), A.transpose().lazyProduct(C), 1e-14));
    RC_ASSERT(near(linalg::gram(A), A.lazyProduct(A.transpose()), 1e-14));
    const sets::Rows rows = sets::padded_rows(A);
    RC_ASSERT(near(rows.leftCols(A.cols()), A, 0));
    RC_ASSERT(rows.rightCols(rows.cols() - A.cols()).isZero(0));
    RC_ASSERT(near(sets::row_gram(rows), A.lazyProduct(A.transpose()), 1e-14));
  }));
  const Matrix large = Matrix::Random(80, 130);  // by the way of large ones
  CHECK(near(sets::row_gram(sets::padded_rows(large)), large * large.transpose(), 1e-13));
}

TEST_CASE("scores of eliminations, and after some") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(4), m = *rc::gen::inRange<Index>(0, 5);
    const LineForm X = wide_set(n, m, 0);
    const Index g = X.generators();
    std::vector<Index> live(static_cast<std::size_t>(m)), forgotten;
    std::iota(live.begin(), live.end(), Index{0});
    sets::EliminationScores scores;
    scores.take(sets::padded_rows(X.G), sets::padded_rows(X.A), live);
    for (int step = 0; step < 3; ++step) {
      const Vector plain = plain_scores(X.G, X.A, forgotten, 1.5);
      for (Index j = 0; j < g; ++j) {
        const bool gone = std::find(forgotten.begin(), forgotten.end(), j) != forgotten.end();
        RC_ASSERT(scores.score(j, 0) == 0);
        if (!gone && std::isfinite(plain[j]))
          RC_ASSERT(std::abs(scores.score(j, 1.5) - plain[j]) <= 1e-6 * plain[j]);
      }
      const Index next = *rc::gen::inRange<Index>(0, g);
      // 1 - P_jj of what is forgotten is left for the others
      if (std::find(forgotten.begin(), forgotten.end(), next) != forgotten.end() ||
          !std::isfinite(plain[next]))
        continue;
      scores.forget(next);
      forgotten.push_back(next);
    }
  }));
}

TEST_CASE("the basis of the reduction and what it absorbs") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange<Index>(2, 5);  // on a line nothing costs anything
    auto random = arbitrary_random();
    Matrix G(n, n + *rc::gen::inRange<Index>(1, 8));
    for (double& entry : G.reshaped())
      entry = random.between(.5, 1) * (random.unit() < .5 ? -1 : 1);  // rows of one scale, no ties
    const Index most = *rc::gen::inRange<Index>(n, G.cols());
    const Matrix reduced = sets::reduce_generators(G, most, sets::GeneratorReduction::yang_scott),
                 plain = plain_yang_scott(G, most);
    RC_ASSERT(reduced.cols() == plain.cols());
    for (Index j = 0; j < plain.cols(); ++j) {
      double nearest = std::numeric_limits<double>::infinity();
      for (Index k = 0; k < reduced.cols(); ++k)
        nearest = std::min(nearest, (reduced.col(k) - plain.col(j)).norm());
      RC_ASSERT(nearest <= 1e-9 * plain.col(j).norm());
    }
  }));
}

TEST_CASE("predictions and corrections assembled in place") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(5), m = arbitrary_dim(5), p = arbitrary_dim(3);
    const LineForm X = wide_set(n, *rc::gen::inRange<Index>(0, 4), *rc::gen::inRange<Index>(0, 3));
    const LineForm W = wide_set(p, *rc::gen::inRange<Index>(0, 2), *rc::gen::inRange<Index>(0, 2));
    const Matrix A = arbitrary_matrix(m, n), T = arbitrary_matrix(m, p);
    const Vector f = arbitrary_vector(m);
    const sets::Summand summand{T, W};
    const LineForm sum = sets::affine_sum(X, A, f, {&summand, 1}).set;
    const LineForm plain = minkowski_sum(affine_map(X, A, f), affine_map(W, T, Vector::Zero(m)));
    RC_ASSERT(near(sum.c, plain.c, 1e-13));
    RC_ASSERT(near(sum.G.leftCols(plain.generators()), plain.G, 1e-13));
    RC_ASSERT(sum.generators() == plain.generators() || linalg::rank(plain.G) < m);
    if (sum.lines() == plain.lines()) {
      if (sum.generators() == plain.generators()) RC_ASSERT(near(sum, plain));
    } else {  // what depends on other lines is left out
      RC_ASSERT(linalg::rank(sum.M) == linalg::rank(plain.M));
    }

    const Matrix C = arbitrary_matrix(p, n), N = Matrix::Identity(p, p);
    const LineForm cut = sets::strip_intersection(X, C, arbitrary_vector(p), N, W).set;
    RC_ASSERT(near(cut.G.leftCols(X.generators()), X.G, 0));
    RC_ASSERT(near(cut.A.topLeftCorner(X.constraints(), X.generators()), X.A, 0));
  }));
}

TEST_CASE("a measurement is an intersection") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(5), p = arbitrary_dim(3);
    const LineForm X = wide_set(n, *rc::gen::inRange<Index>(0, 4), *rc::gen::inRange<Index>(0, 3)),
                   V = wide_set(p, 0, 0);
    const Matrix C = arbitrary_matrix(p, n), T = 2 * Matrix::Identity(p, p);
    const Vector z = arbitrary_vector(p);
    RC_ASSERT(near(sets::strip_intersection(X, C, z, T, V).set,
                   intersection(X, C, affine_map(V, -T, z))));
  }));
}

TEST_CASE("lines are solved for alike with and without a trace") {
  CHECK(rc::check([] {
    const LineForm X =
        wide_set(arbitrary_dim(4), *rc::gen::inRange<Index>(0, 5), *rc::gen::inRange<Index>(0, 4));
    const LinesSolved solved = solve_for_lines(X);
    const LinesEliminated traced = eliminate_lines_traced(X, Vector(0));
    RC_ASSERT(near(solved.set.G, traced.set.G, 0));
    RC_ASSERT(near(solved.set.A, traced.set.A, 0));
    RC_ASSERT(near(solved.set.b, traced.set.b, 0));
    RC_ASSERT(near(solved.set.M, traced.set.M, 0));
    RC_ASSERT(near(solved.row_magnitude, traced.row_magnitude, 0));
  }));
}

TEST_CASE("products in place, in blocks of larger matrices") {
  CHECK(rc::check([] {
    const Index m = *rc::gen::inRange<Index>(0, 9), n = *rc::gen::inRange<Index>(0, 15),
                k = *rc::gen::inRange<Index>(0, 5);
    const Matrix A = arbitrary_matrix(m, n), B = arbitrary_matrix(n, k);
    Matrix whole = Matrix::Constant(m + 2, k + 2, 7), plain = whole;
    for (Index i = 0; i < m; ++i) {
      for (Index j = 0; j < k; ++j) {
        plain(i + 1, j + 1) = 0;
        for (Index l = 0; l < n; ++l) plain(i + 1, j + 1) += A(i, l) * B(l, j);
      }
    }
    linalg::product(A, B, whole.block(1, 1, m, k));
    RC_ASSERT(near(whole, plain, 1e-14));
    RC_ASSERT(linalg::product(A, B) == whole.block(1, 1, m, k));
    Matrix K = Matrix::Constant(2, 3, 7);
    linalg::gram(A, K);
    RC_ASSERT(near(K, linalg::product(A, A.transpose()), 1e-14));
  }));
}

TEST_CASE("products of matrices without rows or columns") {
  for (const Index n : {0, 1, 6, 7, 47, 48, 100}) {
    CAPTURE(n);
    CHECK(linalg::gram(Matrix(n, 0)) == Matrix::Zero(n, n));
    CHECK(linalg::product(Matrix(n, 0), Matrix(0, n)) == Matrix::Zero(n, n));
    CHECK(linalg::transposed_product(Matrix(0, n), Matrix(0, n)) == Matrix::Zero(n, n));
    CHECK(sets::row_gram(sets::padded_rows(Matrix(n, 0))) == Matrix::Zero(n, n));
  }
}

TEST_CASE("what cancels in a product is zero, and what overflows is refused") {
  for (const Index rows : {1, 6, 7}) {  // small maps have a way of their own
    CAPTURE(rows);
    const Matrix ones = Matrix::Ones(rows, 3);
    CHECK(linalg::denoised_product(ones, Vector{{.1, .2, -.3}}).isZero(0));
    CHECK(linalg::denoised_product(ones, Vector{{.1, .2, -.3 + 1e-12}}).minCoeff() > 9e-13);
    CHECK_THROWS_AS(linalg::denoised_product(1e308 * ones, Vector{{1, 1, 1}}), Error);
    CHECK_THROWS_AS(linalg::denoised_product(1e308 * ones, Vector{{10, 1, 1}}), Error);
  }
}

TEST_CASE("definite systems, few equations by loops of their own") {
  CHECK(rc::check([] {
    const Index m = *rc::gen::inRange<Index>(1, 8);
    const Matrix G = arbitrary_matrix(m, m + 3),
                 B = arbitrary_matrix(m, *rc::gen::inRange<Index>(0, 4));
    const Matrix A = linalg::gram(G) + Matrix::Identity(m, m);
    const auto X = linalg::solve_spd(A, B);
    RC_ASSERT(X.has_value());
    RC_ASSERT(near(linalg::product(A, *X), B, 1e-9));
  }));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Index m : {1, 2, 4, 5}) {
    CAPTURE(m);
    Matrix A = Matrix::Identity(m, m);
    A(m - 1, m - 1) = 0;
    CHECK_FALSE(linalg::solve_spd(A, Matrix::Ones(m, 1)));
    A(m - 1, m - 1) = -1;
    CHECK_FALSE(linalg::solve_spd(A, Matrix::Ones(m, 1)));
    A(m - 1, m - 1) = nan;
    CHECK_FALSE(linalg::solve_spd(A, Matrix::Ones(m, 1)));
    CHECK_FALSE(linalg::solve_spd(Matrix::Identity(m, m), Matrix::Constant(m, 1, nan)));
  }
}
