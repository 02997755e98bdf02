// SPDX-License-Identifier: GPL-3.0-or-later
// The design of the fault estimation filter: the published matrices, what makes it one, and systems
// that have none.
#include "diagnosers/fault_estimation_filter/filter_design.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "fault_estimation/systems.hpp"

using namespace cordon;
using namespace cordon::estimators;
using namespace faults;

namespace {

bool near(const Matrix& A, const Matrix& B, double tolerance) {
  return A.rows() == B.rows() && A.cols() == B.cols() &&
         (A.size() == 0 || (A - B).cwiseAbs().maxCoeff() <= tolerance);
}

FilterDesign design(const LinearModel& m, const Matrix& S) {
  std::vector<Diagnostic> problems;
  auto made = design_filter(m, S, problems);
  for (const Diagnostic& p : problems) FAIL(p.message);
  REQUIRE(made.has_value());
  return *made;
}

FilterDesign design(const LinearModel& m) {
  return design(m, Matrix::Zero(m.states(), m.states() + m.outputs()));
}

Diagnostic problem(const LinearModel& m) {
  std::vector<Diagnostic> problems;
  CHECK_FALSE(
      design_filter(m, Matrix::Zero(m.states(), m.states() + m.outputs()), problems).has_value());
  REQUIRE(problems.size() == 1);
  return problems[0];
}

bool says(const Diagnostic& p, const std::string& text) {
  return p.message.find(text) != std::string::npos;
}

/// x⁺ = A x + F n, y = C x.
LinearModel lti(Matrix A, Matrix F, Matrix C) {
  LinearModel m;
  m.A = std::move(A);
  m.F = std::move(F);
  m.C = std::move(C);
  m.B = Matrix::Zero(m.states(), 1);
  m.D = Matrix::Zero(m.outputs(), 1);
  m.Bw = Matrix::Identity(m.states(), m.states());
  m.Dv = Matrix::Identity(m.outputs(), m.outputs());
  return m;
}

/// Every equation that the bounds rest on, for a gain with any Ḡ.
void check_equations(const LinearModel& m, const FilterDesign& d, Draw& draw) {
  const Index n = m.states(), q = m.faults(), p = m.outputs();
  const Matrix E = m.is_descriptor() ? m.E : Matrix(Matrix::Identity(n, n)), TA = d.T * m.A;
  CHECK(near(d.T * E + d.N * m.C, Matrix::Identity(n, n), 1e-10));
  CHECK(near(d.M * m.C * d.Psi, Matrix::Identity(q, q), 1e-9));
  REQUIRE(d.Omega.rows() == p - q);
  CHECK(near(d.Omega * d.Omega.transpose(), Matrix::Identity(p - q, p - q), 1e-12));
  const Matrix G = d.Phi * d.M + draw.matrix(n, p - q) * d.Omega;
  CHECK(near((TA - G * m.C) * d.Psi, Matrix::Zero(n, q), 1e-9));
  for (Index i = 0; i < q; ++i) {
    Vector state = d.T * m.F.col(i);
    for (Index j = 1; j < d.delays[static_cast<std::size_t>(i)]; ++j) {
      CHECK(near(m.C * state, Vector::Zero(p), 1e-10));
      state = TA * state;
    }
    CHECK(near(state, d.Psi.col(i), 1e-12));
    CHECK((m.C * state).norm() > 1e-9);
  }
}

}  // namespace

TEST_CASE("the published matrices") {
  const FilterDesign d = design(published().linear, published_S());
  CHECK(near(d.T, Vector{{1, .5, .5, 1}}.asDiagonal().toDenseMatrix(),
             1e-14));  // printed without its third row
  CHECK(near(d.N, Matrix{{0, 0, 0}, {.5, 0, 0}, {0, .5, 0}, {0, 0, 1}}, 1e-14));
  CHECK(d.delays == std::vector<Index>{1, 1});
  CHECK(near(d.Psi, Matrix{{.1, 0}, {.5, .5}, {-.05, .5}, {-1, 0}}, 1e-14));
  CHECK(near(d.Upsilon, Matrix{{.5, .5}, {-.05, .5}, {-1, 0}}, 1e-14));
  CHECK(near(d.M,
             Matrix{{0.2388707926167209, -0.23887079261672098, -0.868621064060803},
                    {0.8925081433224746, 1.1074918566775243, 0.3908794788273616}},
             1e-13));
  CHECK(near(d.Phi, Matrix{{.09725, -.045}, {.2465075, .273675}, {-.044925, .222575}, {-.95, .5}},
             1e-14));
  const Matrix Omega{{0.6590224063189366, -0.6590224063189366, 0.3624623234754153}};
  CHECK(near(d.Omega * (d.Omega(0, 0) < 0 ? -1 : 1), Omega, 1e-13));
}

TEST_CASE("the free matrix enters in the null space of [E; C] only") {
  const LinearModel m = published().linear;
  Draw draw{std::mt19937_64(5)};
  for (int i = 0; i < 20; ++i) {
    const FilterDesign d = design(m, draw.matrix(4, 7));
    check_equations(m, d, draw);
    CHECK_FALSE(near(d.T, design(m).T, 1e-3));
  }
}

TEST_CASE("delays of any length") {
  Draw draw{std::mt19937_64(6)};
  Matrix shift = Matrix::Zero(4, 4);  // each state is the former one a step later
  for (Index i = 0; i + 1 < 4; ++i) shift(i + 1, i) = 1;
  Matrix C = Matrix::Zero(1, 4);
  C(0, 3) = 1;
  for (Index first = 0; first < 4; ++first) {
    const LinearModel m = lti(shift, Matrix::Identity(4, 4).col(first), C);
    const FilterDesign d = design(m);
    CHECK(d.delays == std::vector<Index>{4 - first});
    CHECK(d.Omega.rows() == 0);
    check_equations(m, d, draw);
  }
  Matrix two = Matrix::Zero(2, 4);
  two(0, 1) = two(1, 3) = 1;
  const LinearModel mixed = lti(shift, Matrix{{0, 0}, {1, 0}, {0, 1}, {0, 0}}, two);
  CHECK(design(mixed).delays == std::vector<Index>{1, 2});
  check_equations(mixed, design(mixed), draw);
}

TEST_CASE("designs of random systems satisfy their equations") {
  CHECK(rc::check([](std::uint64_t seed) {
    Draw draw{std::mt19937_64(seed)};
    const Index n = 1 + draw.below(5), p = 1 + draw.below(n), q = 1 + draw.below(p);
    LinearModel m = lti(draw.matrix(n, n), draw.matrix(n, q), draw.matrix(p, n));
    if (draw.below(2) == 0) {
      m.E = draw.matrix(n, n);
      m.E.row(0).setZero();
    }
    std::vector<Diagnostic> problems;
    const auto d = design_filter(m, draw.matrix(n, n + p), problems);
    RC_PRE(d.has_value());
    RC_PRE(d->T.cwiseAbs().maxCoeff() < 1e2 && d->M.cwiseAbs().maxCoeff() < 1e3);
    check_equations(m, *d, draw);
  }));
}

TEST_CASE("a weak response is one, if no larger numbers cancel in it") {
  Matrix shift = Matrix::Zero(4, 4);
  for (Index i = 0; i + 1 < 4; ++i) shift(i + 1, i) = 1e-6;
  Matrix C = Matrix::Zero(1, 4);
  C(0, 3) = 1;
  CHECK(design(lti(shift, Matrix::Identity(4, 4).col(0), C)).delays == std::vector<Index>{4});
}

TEST_CASE("units of outputs and faults do not matter") {
  Draw draw{std::mt19937_64(7)};
  LinearModel m = lti(draw.matrix(4, 4), draw.matrix(4, 2), draw.matrix(3, 4));
  const FilterDesign before = design(m);
  m.F.col(0) *= 1e-8;
  m.F.col(1) *= 1e7;
  const FilterDesign after = design(m);
  CHECK(after.delays == before.delays);
  CHECK(near(after.M.row(0) * 1e-8, before.M.row(0), 1e-9));
  CHECK(near(after.M.row(1) * 1e7, before.M.row(1), 1e-9));
}

TEST_CASE("systems without a filter, in words") {
  const Matrix A = Matrix::Identity(3, 3) * .5, one = Matrix::Identity(3, 3);
  SUBCASE("a direction that neither E nor C sees") {
    LinearModel m = lti(A, one.col(0), one.topRows(1));
    m.E = Matrix(Vector{{1, 1, 0}}.asDiagonal());
    const Diagnostic p = problem(m);
    CHECK(says(p, "rank [E; C] is 2, the state has 3"));
    CHECK((says(p, "direction (0, 0, 1)") || says(p, "direction (0, 0, -1)")));
    CHECK(p.pointer == "/type");
  }
  SUBCASE("[E; C] near to a smaller rank") {
    Draw draw{std::mt19937_64(1)};
    LinearModel m = lti(A, one.col(0), one.topRows(1));
    m.E = draw.matrix(3, 3) * Vector{{1, 1, 3e-9}}.asDiagonal() * draw.matrix(3, 3);
    m.C = m.E.topRows(1);
    CHECK(says(problem(m), "cannot be solved in doubles"));
  }
  SUBCASE("faults that do not show") {
    CHECK(says(problem(lti(A, one, one.topRows(1))), "faults 2 and 3 do not show in the outputs"));
    CHECK(says(problem(lti(A, one.leftCols(2), one.topRows(1))),
               "fault 2 does not show in the outputs"));
    CHECK(problem(lti(A, one, one.topRows(1))).pointer == "/free_matrix");
    CHECK(says(problem(lti(A, Matrix::Zero(3, 1), one)), "fault 1 does not show"));
    const Matrix nearly{{.5, 0}, {0, .5 + 1e-12}};  // shows by 1e-12: no claim that it never does
    CHECK(says(problem(lti(nearly, Matrix{{1}, {-1}}, Matrix{{1, 1}})), "as far as doubles tell"));
  }
  SUBCASE("more faults than outputs") {
    Matrix F(3, 3);
    F << one.col(0), 2 * one.col(0), -one.col(0);
    CHECK(says(problem(lti(A, F, one.topRows(2))),
               "the system has 3 faults, which 2 outputs cannot tell apart"));
    CHECK(says(problem(lti(A, F, one.topRows(1))), "which 1 output cannot"));
  }
  SUBCASE("faults that act alike") {
    Matrix F(3, 3);
    F << one.col(0), one.col(1), -1e6 * one.col(0);
    CHECK(says(problem(lti(A, F, one)), "faults 1 and 3 act alike on the outputs"));
  }
  SUBCASE("as many faults as outputs are none of these") {
    CHECK(design(lti(A, one, one)).Omega.rows() == 0);
  }
}

TEST_CASE("a fault in static rows needs a free matrix") {
  LinearModel m = published().linear;
  m.F = Matrix::Identity(4, 4).col(3);
  CHECK(says(problem(m), "fault 1 does not show"));
  CHECK(design(m, published_S()).delays == std::vector<Index>{1});
}
