// SPDX-License-Identifier: GPL-3.0-or-later
// Random small sets and questions against rational arithmetic: never a wrong answer, and few
// unknown ones. CORDON_ORACLE_SETS sets how many (2000 by default; the nightly test takes 100,000).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;

namespace {

constexpr double near = 1e-9;  ///< sets this near to the boundary may be left undecided

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  Index upto(Index most) {
    return static_cast<Index>(engine_() % static_cast<std::uint64_t>(most + 1));
  }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// One set draws all its numbers in one manner.
  enum class Manner { quarters, continuous, scaled, sparse };
  double number(Manner manner) {
    switch (manner) {
      case Manner::quarters:  // degenerate on purpose: dependent rows, touching sets
        return static_cast<double>(upto(16)) / 4 - 2;
      case Manner::continuous:
        return 2 * unit() - 1;
      case Manner::scaled:
        return (2 * unit() - 1) * std::pow(10.0, static_cast<double>(upto(16)) - 8);
      case Manner::sparse:
        return upto(2) > 0 ? 0.0 : upto(30) == 0 ? 1e-80 : static_cast<double>(upto(8)) / 4 - 1;
    }
    return 0;
  }

  Matrix matrix(Index rows, Index cols, Manner manner) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) a = number(manner);
    return A;
  }
  Vector vector(Index n, Manner manner) { return matrix(n, 1, manner); }

  LineForm set(Index n, Manner manner) {
    const Index l = upto(3) == 0 ? 1 + upto(1) : 0, g = upto(8), m = upto(3);
    LineForm X{matrix(n, l, manner), matrix(n, g, manner), vector(n, manner),
               matrix(m, l, manner), matrix(m, g, manner), vector(m, manner)};
    if (upto(1) == 0)
      X.b = X.A * Vector(.9 * matrix(g, 1, Manner::continuous));  // mostly not empty
    if (m > 1 && upto(3) == 0) {                                  // a dependent row
      const double factor = static_cast<double>(upto(8)) / 4 - 1;
      X.S.row(m - 1) = factor * X.S.row(0);
      X.A.row(m - 1) = factor * X.A.row(0);
      if (upto(1) == 0) X.b[m - 1] = factor * X.b[0];
    }
    return X;
  }

 private:
  std::mt19937_64 engine_;
};

/// The rows of "x ∈ X" or "X meets Y" as a set of no dimension.
LineForm rows_only(LineForm X) {
  X.M.resize(0, X.lines());
  X.G.resize(0, X.generators());
  X.c.resize(0);
  return X;
}

/// Would the answer change if all factors or all rows moved by 1e-9 of their size? `terms`: what
/// the last rows' right-hand sides are differences of, x - c or c_Y - c_X, whose size counts.
bool is_near_boundary(const LineForm& X, bool empty, const Vector& terms = Vector(0)) {
  LineForm moved = X;
  if (!empty) {
    moved.A *= 1 - near;
    moved.G *= 1 - near;
    return exact::is_empty(rows_only(moved)) == Answer::yes;
  }
  const Index m = X.constraints(), g = X.generators();
  moved.A = Matrix::Zero(m, g + m);
  moved.A.leftCols(g) = X.A;
  Vector right = X.b.cwiseAbs();
  right.tail(terms.size()) = right.tail(terms.size()).cwiseMax(terms);
  for (Index i = 0; i < m; ++i)
    moved.A(i, g + i) = near * (X.A.row(i).lpNorm<1>() + X.S.row(i).lpNorm<1>() + right[i]);
  moved.G = Matrix::Zero(X.dim(), g + m);
  return exact::is_empty(rows_only(moved)) == Answer::no;
}

LineForm point_rows(const LineForm& X, const Vector& x) {
  return intersection(X, Matrix::Identity(X.dim(), X.dim()), make_point(x));
}

struct Tally {
  std::int64_t asked = 0, unknown_inside = 0, unknown_near = 0, wrong = 0;
  std::string first;  ///< where the first wrong or needless unknown answer was

  void count(Answer given, Answer truth, bool near_boundary, std::uint64_t set,
             const char* question) {
    ++asked;
    const bool is_wrong = given != Answer::unknown && given != truth,
               needless = given == Answer::unknown && !near_boundary;
    wrong += is_wrong ? 1 : 0;
    unknown_inside += needless ? 1 : 0;
    unknown_near += given == Answer::unknown && near_boundary ? 1 : 0;
    if ((is_wrong || needless) && first.empty())
      first = std::string(question) + ", set " + std::to_string(set);
  }
};

void report(const char* question, const Tally& t) {
  std::printf(
      "%-12s %8lld asked, %lld wrong, %lld unknown (%lld of them within 1e-9 of the "
      "boundary)%s%s\n",
      question, static_cast<long long>(t.asked), static_cast<long long>(t.wrong),
      static_cast<long long>(t.unknown_inside + t.unknown_near),
      static_cast<long long>(t.unknown_near), t.first.empty() ? "" : "; first: ", t.first.c_str());
}

std::uint64_t sets_to_try() {
  const char* text = std::getenv("CORDON_ORACLE_SETS");
  return text ? std::strtoull(text, nullptr, 10) : 2000;
}

/// On the boundary as often as inside, where X has no constraints.
Vector point_for(const LineForm& X, Draw& draw, Draw::Manner manner) {
  Vector x = draw.vector(X.dim(), manner);
  if (draw.upto(1) == 0 && X.constraints() == 0) {
    x = X.c + X.M * draw.vector(X.lines(), manner) +
        X.G * (draw.upto(1) == 0
                   ? Vector(draw.vector(X.generators(), Draw::Manner::continuous).array().sign())
                   : draw.vector(X.generators(), Draw::Manner::continuous));
  }
  return x;
}

}  // namespace

TEST_CASE("answers agree with rational arithmetic") {
  Tally empty, member, disjoint, bounded;
  std::int64_t supports = 0, below = 0, loose = 0;
  for (std::uint64_t i = 0; i < sets_to_try(); ++i) {
    Draw draw(i);
    const auto manner = static_cast<Draw::Manner>(draw.upto(3));
    const Index n = draw.upto(4);
    const LineForm X = draw.set(n, manner), Y = draw.set(n, manner);

    const Answer truth = exact::is_empty(X);
    empty.count(is_empty(X), truth, is_near_boundary(X, truth == Answer::yes), i, "is_empty");

    const Vector x = point_for(X, draw, manner);
    const Answer inside = exact::contains(X, x);
    member.count(
        contains(X, x), inside,
        is_near_boundary(point_rows(X, x), inside == Answer::no, x.cwiseAbs() + X.c.cwiseAbs()), i,
        "contains");

    const LineForm both = intersection(X, Matrix::Identity(n, n), Y);
    const Answer apart = exact::is_empty(both);
    disjoint.count(is_disjoint(X, Y), apart,
                   is_near_boundary(both, apart == Answer::yes, X.c.cwiseAbs() + Y.c.cwiseAbs()), i,
                   "is_disjoint");

    if (truth == Answer::no) {
      Answer bound = Answer::yes;
      for (Index k = 0; k < n; ++k) {
        if (exact::support(X, Vector::Unit(n, k)).upper == std::numeric_limits<double>::infinity())
          bound = Answer::no;
      }
      bounded.count(is_bounded(X), bound, is_near_boundary(X, false), i, "is_bounded");
    }
    const Vector d = draw.vector(n, manner);
    const Interval h = exact::support(X, d);
    const double ours = support(X, d);
    ++supports;
    below += ours < h.lower ? 1 : 0;
    const double size = d.cwiseAbs().dot(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
    if (std::isfinite(h.upper) && !(ours <= h.upper + 1e-9 * size + 1e-300) &&
        !is_near_boundary(X, false))
      ++loose;
  }
  report("is_empty", empty);
  report("contains", member);
  report("is_disjoint", disjoint);
  report("is_bounded", bounded);
  std::printf("%-12s %8lld asked, %lld below the exact value, %lld above it by more than 1e-9\n",
              "support", static_cast<long long>(supports), static_cast<long long>(below),
              static_cast<long long>(loose));
  for (const Tally* t : {&empty, &member, &disjoint, &bounded}) {
    CHECK(t->wrong == 0);
    CHECK(static_cast<double>(t->unknown_inside) <= 1e-3 * static_cast<double>(t->asked));
  }
  CHECK(below == 0);
}
