// SPDX-License-Identifier: GPL-3.0-or-later
// Gains and error sets of the fault estimation filter: the published example, to independently
// computed digits, and their laws.
#include "diagnosers/fault_estimation_filter/filter_recursion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "fault_estimation/systems.hpp"

using namespace cordon;
using namespace cordon::estimators;
using namespace faults;

namespace {

FilterDesign design(const LinearModel& m, const Matrix& S) {
  std::vector<Diagnostic> problems;
  auto made = design_filter(m, S, problems);
  REQUIRE(made.has_value());
  return *made;
}

FilterRecursion recursion(Index max_columns, NoiseCoupling coupling,
                          const Matrix& S = published_S()) {
  const Model model = published();
  const LinearModel& m = model.linear;
  FilterRecursion made(design(m, S), m, {m.Bw, m.Dv}, max_columns, coupling);
  made.start(model.X0.G);
  return made;
}

struct Expected {
  Index k;
  double first, second;
};

void check_half_widths(Index max_columns, NoiseCoupling coupling,
                       std::initializer_list<Expected> all, double tolerance = 1e-9) {
  FilterRecursion r = recursion(max_columns, coupling);
  Index k = 0;
  for (const Expected& e : all) {
    for (; k < e.k; ++k) r.advance();
    CAPTURE(k);
    CHECK(std::abs(r.half_widths()[0] - e.first) <= tolerance);
    CHECK(std::abs(r.half_widths()[1] - e.second) <= tolerance);
  }
}

void check_gains(Index max_columns, const std::array<Matrix, 4>& gains) {
  for (const NoiseCoupling coupling : {NoiseCoupling::independent, NoiseCoupling::shared}) {
    FilterRecursion r = recursion(max_columns, coupling);
    const std::array<Index, 4> times{0, 1, 10, 200};
    Index k = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      for (; k <= times[i]; ++k) r.advance();
      CAPTURE(times[i]);
      CHECK((r.gain() - gains[i]).cwiseAbs().maxCoeff() < 1e-8);
    }
  }
}

const Matrix G0{{0.026068360907752018, -0.11606836090775201, -0.07841240150073636},
                {0.4956347760183185, 0.051715223981681574, -0.001275873189924684},
                {-0.0463724519194591, 0.49152245191945926, -0.002837348555702418},
                {0.025822126186560074, 0.9741778738134399, 0.9142021694026079}};
const Matrix G1{{1.5647205313219095, -1.6547205313219095, 0.7678462922270507},
                {0.4866180700421392, 0.06073192995786092, -0.006235061476823331},
                {0.05117763950602894, 0.3939723604939712, 0.05081520172831601},
                {1.7521053958863728, -0.7521053958863729, 1.8636579677375054}};

/// ‖R_{k+1}‖_F before reduction, for any gain.
double size_with(const LinearModel& m, const FilterDesign& d, const Matrix& R, const Matrix& G) {
  return (((d.T * m.A - G * m.C) * R).squaredNorm() + (G * m.Dv).squaredNorm());
}

}  // namespace

TEST_CASE("half widths of the published example") {
  using enum NoiseCoupling;
  check_half_widths(20, independent,
                    {{0, 0.14809989142236696, 0.26299674267100964},
                     {1, 0.14322673285535642, 0.11588156838070991},
                     {2, 0.12213577171838257, 0.100370329729902},
                     {5, 0.13408602930164906, 0.11567225175427231},
                     {10, 0.14804391642146433, 0.12108948074317354},
                     {50, 0.1495310025707828, 0.12180169986502304},
                     {100, 0.14953100266361558, 0.12180169992001114},
                     {200, 0.14953100266361513, 0.12180169992001094}});
  check_half_widths(10, independent,
                    {{1, 0.14367532570984604, 0.11757460167531783},
                     {2, 0.1328873618994252, 0.10533235833454424},
                     {5, 0.19629147364854915, 0.14161581839136778},
                     {10, 0.24207967075926978, 0.16473360424719274},
                     {200, 0.2524588190715115, 0.1699470639277035}});
  check_half_widths(0, independent,
                    {{1, 0.14322673285535642, 0.11588156838070991},
                     {2, 0.12213577171838257, 0.100370329729902},
                     {5, 0.10957783356562613, 0.09959755984755356},
                     {10, 0.11410507046968305, 0.10182078716340724},
                     {50, 0.11545379830974205, 0.10248361290253317},
                     {200, 0.11545379963288298, 0.10248361355278492}});
  check_half_widths(0, shared,
                    {{1, 0.12107689572180592, 0.08806397880416267},
                     {2, 0.057749212216061954, 0.056916393838276},
                     {5, 0.059009316278939156, 0.05751619538189508},
                     {10, 0.06479237002111131, 0.060358695487537514},
                     {50, 0.06648645189563165, 0.061191244845448765},
                     {200, 0.06648645355483933, 0.06119124566085905}});
  check_half_widths(20, shared,
                    {{1, 0.12107689572180592, 0.08806397880416267},
                     {2, 0.057749212216061954, 0.056916393838276},
                     {10, .07197679, .06491670},
                     {200, .07590599, .06691382}},
                    1e-8);
}

TEST_CASE("gains of the published example") {
  check_gains(20, {G0, G1,
                   Matrix{{0.6566738160243236, -0.7466738160243236, 0.26842059881337815},
                          {0.4515602491240177, 0.09578975087598238, -0.02551686298179015},
                          {0.04326139289783609, 0.40188860710216406, 0.04646126609380995},
                          {0.7839718131277383, 0.21602818687226166, 1.331184497220256}},
                   Matrix{{0.6800056242544354, -0.7700056242544354, 0.28125309333993964},
                          {0.45212158744387987, 0.09522841255612019, -0.02520812690586595},
                          {0.04388222021009616, 0.401267779789904, 0.046802721115552975},
                          {0.8092732806775986, 0.19072671932240137, 1.3451003043726795}}});
  check_gains(0, {G0, G1,
                  Matrix{{0.40837044114565363, -0.49837044114565365, 0.13185374263010963},
                         {0.4056879761554934, 0.14166202384450668, -0.05074661311447853},
                         {0.08571687347576303, 0.35943312652423715, 0.06981178041166977},
                         {0.5647488215545509, 0.4352511784454492, 1.2106118518550029}},
                  Matrix{{0.4070246326914131, -0.49702463269141306, 0.1311135479802773},
                         {0.40555948211584264, 0.14179051788415745, -0.05081728483628644},
                         {0.08579925512976794, 0.3593507448702322, 0.06985709032137247},
                         {0.5634099521094498, 0.43659004789055017, 1.2098754736601973}}});
}

TEST_CASE("the size of the error set is the published one") {
  FilterRecursion r = recursion(20, NoiseCoupling::independent);
  CHECK(r.errors().squaredNorm() == doctest::Approx(0.04));
  r.advance();
  CHECK(r.errors().squaredNorm() == doctest::Approx(0.01881012787171628));
  for (int k = 1; k < 200; ++k) r.advance();
  CHECK(r.errors().cols() <= 20);
  FilterRecursion whole = recursion(0, NoiseCoupling::independent);
  for (int k = 0; k < 200; ++k) whole.advance();
  CHECK(whole.errors().cols() == 4 + 200 * 7);
  CHECK(whole.errors().squaredNorm() == doctest::Approx(0.001124203965636227));
}

TEST_CASE("no gain that leaves the faults apart makes a smaller error set") {
  Draw draw{std::mt19937_64(3)};
  LinearModel m = published().linear;
  m.Dv = Matrix{{.01, .02, 0}, {0, .05, 0}, {-.03, 0, .002}};
  const FilterDesign d = design(m, published_S());
  FilterRecursion r(d, m, {m.Bw, m.Dv}, 20, NoiseCoupling::shared);
  r.start(published().X0.G);
  for (int k = 0; k < 30; ++k) {
    const Matrix R = r.errors();
    r.advance();
    const double best = size_with(m, d, R, r.gain());
    for (const double step : {1.0, 1e-2, 1e-3}) {
      const Matrix other = r.gain() + step * draw.matrix(4, 1) * d.Omega;
      CHECK(size_with(m, d, R, other) > best);
    }
  }
}

TEST_CASE("half widths of a long run") {
  const Matrix H = published().X0.G;
  const auto settled = [&](Index l, NoiseCoupling c) {
    return lasting_half_widths(recursion(l, c), H);
  };
  const Vector reduced = settled(20, NoiseCoupling::independent),
               shared = settled(20, NoiseCoupling::shared);
  CHECK(std::abs(reduced[0] - 0.14953100266361513) < 1e-9);
  CHECK(std::abs(reduced[1] - 0.12180169992001094) < 1e-9);
  CHECK(std::abs(shared[0] - .07590599) < 1e-8);
  CHECK(std::abs(settled(0, NoiseCoupling::independent)[0] - 0.11545379963288298) < 1e-9);
  // a larger start does not matter, nor does what the recursion has done before
  FilterRecursion used = recursion(20, NoiseCoupling::shared);
  used.advance();
  CHECK(std::abs(lasting_half_widths(used, 10 * H)[0] - shared[0]) < 1e-8);
}

TEST_CASE("bounds that grow are infinite in advance, and end with an error") {
  // y = x₁ + 2 x₂ sees the fault of x₁ = 0.5 x₁ + n at once; x₂⁺ = 3 x₂ cannot be told from it
  LinearModel m;
  m.A = Matrix{{.5, 0}, {0, 3}};
  m.F = Matrix{{1}, {0}};
  m.C = Matrix{{1, 2}};
  const FilterDesign d = design(m, Matrix::Zero(2, 3));
  const Matrix unit = Matrix::Identity(1, 1);
  for (const Index columns : {0, 10}) {
    for (const NoiseCoupling coupling : {NoiseCoupling::independent, NoiseCoupling::shared}) {
      FilterRecursion r(d, m, {Matrix::Ones(2, 1), unit}, columns, coupling);
      CHECK(std::isinf(lasting_half_widths(r, Matrix::Identity(2, 2))[0]));
      r.start(Matrix::Identity(2, 2));
      CHECK_THROWS_AS(for (int k = 0; k < 2000; ++k) r.advance(), Error);
    }
  }
}

TEST_CASE("without noise and from a point there is nothing to bound") {
  const LinearModel m = published().linear;
  FilterRecursion r(design(m, published_S()), m, {Matrix(4, 0), Matrix(3, 0)}, 20,
                    NoiseCoupling::shared);
  r.start(Matrix(4, 0));
  for (int k = 0; k < 50; ++k) r.advance();
  CHECK(r.half_widths().cwiseAbs().maxCoeff() == 0);
  CHECK(r.gain().allFinite());
  CHECK(std::isinf(lasting_half_widths(r, Matrix(4, 0))
                       .maxCoeff()));  // the gain without noise lets errors grow: rounding would
  r.start(Matrix::Identity(4, 4));     // the errors die out, and the gain stays moderate
  for (int k = 0; k < 500; ++k) r.advance();
  CHECK(r.half_widths().maxCoeff() < 1e-6);
  CHECK(r.gain().cwiseAbs().maxCoeff() < 1e3);
}

TEST_CASE("noise of rank one on two free outputs: the gain stays moderate") {
  Draw draw{std::mt19937_64(2)};
  LinearModel m;
  m.A = draw.matrix(3, 3);
  m.F = draw.matrix(3, 1);
  m.C = draw.matrix(3, 3);
  const FilterDesign d = design(m, Matrix::Zero(3, 6));
  FilterRecursion r(d, m, {Matrix(3, 0), Matrix(3, 0)}, 20, NoiseCoupling::shared);
  r.start(Vector::Ones(3));
  for (int k = 0; k < 2000; ++k) {  // until squares underflow
    r.advance();
    CHECK(r.gain().cwiseAbs().maxCoeff() < 100);
  }
}

TEST_CASE("a start with many generators is reduced for both couplings") {
  Draw draw{std::mt19937_64(4)};
  for (const NoiseCoupling coupling : {NoiseCoupling::independent, NoiseCoupling::shared}) {
    FilterRecursion r = recursion(6, coupling);
    r.start(draw.matrix(4, 40));
    CHECK(r.errors().cols() == 6);
    FilterRecursion again = recursion(6, coupling);
    again.start(r.errors());
    CHECK(again.half_widths().isApprox(r.half_widths(), 1e-12));
  }
}

TEST_CASE("half widths that go round in circles are told by their largest") {
  Index circles = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Draw draw{std::mt19937_64(seed)};
    LinearModel m;
    m.A = draw.matrix(4, 4);
    m.A *= .95 / m.A.cwiseAbs().rowwise().sum().maxCoeff();
    m.F = draw.matrix(4, 1);
    m.C = draw.matrix(2, 4);
    const FilterDesign d = design(m, Matrix::Zero(4, 6));
    FilterRecursion r(d, m, {draw.matrix(4, 1), .1 * draw.matrix(2, 2)}, 7, NoiseCoupling::shared);
    const double told = lasting_half_widths(r, Matrix::Identity(4, 4))[0];
    if (std::isinf(told)) continue;
    r.start(Matrix::Identity(4, 4));
    for (int k = 0; k < 2000; ++k) r.advance();
    double least = told, largest = 0;
    for (int k = 0; k < 300; ++k) {
      r.advance();
      least = std::min(least, r.half_widths()[0]);
      largest = std::max(largest, r.half_widths()[0]);
    }
    CHECK(std::abs(largest - told) <= .02 * told);
    circles += least < .98 * largest;
  }
  CHECK(circles >= 3);
}

TEST_CASE("errors that do not die out leave no promise, whether the run stirs them up or not") {
  for (const double pole : {1.0, 3.0}) {  // x₁, x₂ as above, and x₃ apart from them
    LinearModel m;
    m.A = Matrix{{.5, 0, 0}, {0, pole, 0}, {0, 0, .5}};
    m.F = Matrix{{1, 0}, {0, 0}, {0, 1}};
    m.C = Matrix{{1, 2, 0}, {0, 0, 1}};
    const FilterDesign d = design(m, Matrix::Zero(3, 5));
    const FilterRecursion r(d, m, {Matrix::Identity(3, 3), Matrix::Identity(2, 2)}, 0,
                            NoiseCoupling::shared);
    CHECK(std::isinf(lasting_half_widths(r, Matrix::Identity(3, 3))[0]));
  }
  // A is stable, and the zero from the fault to y is 1.001: no noise and no start is along it, and
  // an entry of 10 hides it for long
  LinearModel m;
  m.A = Matrix{{.5, 1, 10}, {-.3, 1.001, 0}, {0, 0, .5}};
  m.F = Matrix{{1}, {0}, {0}};
  m.C = Matrix{{1, 0, 0}};
  const FilterDesign d = design(m, Matrix::Zero(3, 4));
  for (const Index columns : {0, 20}) {
    const FilterRecursion r(d, m, {Matrix{{.3}, {0}, {0}}, Matrix(1, 0)}, columns,
                            NoiseCoupling::shared);
    CHECK(std::isinf(lasting_half_widths(r, Matrix{{.1}, {0}, {.1}})[0]));
  }
}

TEST_CASE("a mode that is slower than any run is in the bound, or there is none") {
  for (const auto& [pole, drift, limit] :
       {std::tuple{.9999, 1.3e-5, .77}, {.999, 2.5e-5, .675}, {.999, 4e-5, .69}, {.9, 1e-3, .66}}) {
    CAPTURE(pole);
    CAPTURE(drift);
    LinearModel m;
    m.A = Matrix{{.5, 1}, {0, pole}};
    m.F = Matrix{{1}, {0}};
    m.C = Matrix{{1, 0}};
    const FilterDesign d = design(m, Matrix::Zero(2, 3));
    for (const Index columns : {0, 20}) {
      CAPTURE(columns);
      FilterRecursion r(d, m, {Matrix{{.5, 0}, {0, drift}}, Matrix{{.1}}}, columns,
                        NoiseCoupling::shared);
      const Matrix start{{.1}, {0}};
      const double told = lasting_half_widths(r, start)[0];
      CHECK(told >= limit * .98);
      if (columns == 0) CHECK(told <= limit * 1.03);
      if (pole < .99) CHECK(std::isfinite(told));
      r.start(start);
      for (int k = 0; k < (columns == 0 ? 3000 : 60'000); ++k) {
        r.advance();
        if (k > 400 && r.half_widths()[0] > told * (1 + 1e-9))
          FAIL("step ", k, ": ", r.half_widths()[0], " > ", told);
      }
    }
  }
}

TEST_CASE(
    "a bound told in advance holds from the start of the steady state on, for random systems") {
  Index told = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Draw draw{std::mt19937_64(seed)};
    const Index n = 2 + static_cast<Index>(seed % 5), p = 1 + static_cast<Index>(seed % 3);
    LinearModel m;
    m.A = draw.matrix(n, n);
    m.A *= (seed % 4 == 0 ? .999 : .9) / m.A.cwiseAbs().rowwise().sum().maxCoeff();
    m.F = draw.matrix(n, 1);
    m.C = draw.matrix(p, n);
    const FilterDesign d = design(m, Matrix::Zero(n, n + p));
    for (const Index columns : {Index{0}, 2 * n, Index{20}}) {
      CAPTURE(columns);
      const auto coupling = seed % 2 == 0 ? NoiseCoupling::shared : NoiseCoupling::independent;
      FilterRecursion r(d, m, {draw.matrix(n, 1), .1 * draw.matrix(p, p)}, columns, coupling);
      const double width = lasting_half_widths(r, Matrix::Identity(n, n))[0];
      ++all;
      if (std::isinf(width)) continue;
      ++told;
      r.start(Matrix::Identity(n, n));
      const int settled = columns == 0 ? 400 : 50'000, steps = columns == 0 ? 700 : 51'000;
      double largest = 0;
      for (int k = 0; k < steps; ++k) {
        r.advance();
        if (k >= settled) largest = std::max(largest, r.half_widths()[0]);
      }
      CHECK(largest <= width * (1 + 1e-12));
      if (columns > 0) CHECK(largest >= width * (1 - 1e-12));
    }
  }
  CHECK(told * 5 >= all * 4);
}
