// SPDX-License-Identifier: GPL-3.0-or-later
// Exact proofs of what an input sequence separates: examples by hand, and the published ones.
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/design.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"
#include "study/checks/common_runs.hpp"

using namespace cordon;

namespace {

/// x⁺ = a x + u + w, y = x + v with |w|, |v| ≤ bound and any x_0.
Mode scalar(double a, double bound) {
  Mode mode;
  mode.name = "a = " + std::to_string(a);
  LinearModel& m = mode.model.linear;
  m.A = Matrix{{a}};
  m.B = m.Bw = m.C = m.Dv = Matrix::Identity(1, 1);
  m.D = Matrix::Zero(1, 1);
  mode.model.X0 = make_space(1);
  mode.model.W = mode.model.V = make_box({Vector{{-bound}}, Vector{{bound}}});
  return mode;
}

/// y = ± u + v, |v| ≤ 1: κ = |u| - 1.
ModeBank signs() {
  ModeBank bank{{scalar(0, 1), scalar(0, 1)}, 0};
  for (Mode& mode : bank.modes) mode.model.linear.C.setZero();
  bank.modes[0].model.linear.D(0, 0) = 1;
  bank.modes[1].model.linear.D(0, 0) = -1;
  return bank;
}

DesignOutcome given(Matrix u) {
  DesignOutcome outcome;
  outcome.status = DesignStatus::given;
  outcome.horizon = u.rows() - 1;
  outcome.best.emplace().u = std::move(u);
  return outcome;
}

Answer word(char letter) {
  return letter == 'y' ? Answer::yes : letter == 'n' ? Answer::no : Answer::unknown;
}

/// "ynnyyn": are the pairs 12, 13, 14, 23, 24, 34 disjoint?
void check_pairs(const ExactSeparation& found, const std::string& expected) {
  REQUIRE(found.pairs.size() == expected.size());
  for (std::size_t q = 0; q < expected.size(); ++q)
    CHECK(found.pairs[q].disjoint == word(expected[q]));
}
void check_tubes(const ExactSeparation& found, Answer empty) {
  for (const Answer answer : found.empty) CHECK(answer == empty);
}

/// Inputs by time, stacked, as rows.
Matrix rows_of(const Vector& u, Index inputs) {
  return u.reshaped(inputs, u.size() / inputs).transpose();
}

const Matrix by_lines = rows_of(examples::published_line_input(), 2);
const Matrix by_constrained = rows_of(examples::published_constrained_input(), 2);
const Matrix reference = rows_of(examples::reference_input(), 2);

}  // namespace

TEST_CASE("the published inputs: every pair, with its distance") {
  const ModeBank bank = examples::four_descriptor_models();
  const ExactSeparation lines = verify_design(bank, given(by_lines));
  check_pairs(lines, "yyyyyy");
  check_tubes(lines, Answer::no);
  CHECK(lines.separates() == Answer::yes);
  const double kappa[]{.9184, .1485, .1309, .2308, 1.6600, 1.2370};
  for (std::size_t q = 0; q < 6; ++q)
    CHECK(lines.pairs[q].kappa_lower == doctest::Approx(kappa[q]).epsilon(1e-4));
  CHECK(lines.pairs[4].i == 1);
  CHECK(lines.pairs[4].j == 3);
  CHECK(lines.wall_s > 0);

  const ExactSeparation constrained = verify_design(bank, given(by_constrained));  // Table 1
  check_pairs(constrained, "ynnyyn");
  CHECK(constrained.separates() == Answer::no);
  CHECK(constrained.pairs[0].kappa_lower == doctest::Approx(.3940).epsilon(1e-4));
  CHECK(constrained.pairs[3].kappa_lower == doctest::Approx(.4967).epsilon(1e-4));
  CHECK(constrained.pairs[4].kappa_lower == doctest::Approx(.2754).epsilon(1e-4));

  const ExactSeparation none = verify_design(bank, given(reference));
  check_pairs(none, "nnnnnn");
  check_tubes(none, Answer::no);
}

TEST_CASE("the published bounded states leave no output at all") {
  for (const Matrix& u : {by_lines, by_constrained}) {
    DesignOutcome outcome = given(u);
    outcome.admissible_set = make_box({-Vector::Ones(3), Vector::Ones(3)});
    const ExactSeparation found = verify_design(examples::four_descriptor_models(), outcome);
    check_tubes(found, Answer::yes);
    check_pairs(found, "yyyyyy");
    CHECK(found.separates() == Answer::unknown);
  }
}

TEST_CASE("a scalar system with any initial state: separated by .99, not by 0") {
  const ModeBank bank = examples::three_scalar_models();
  Matrix u = Matrix::Zero(4, 1);
  check_pairs(verify_design(bank, given(u)), "nnn");
  u(1, 0) = .99;
  const ExactSeparation found = verify_design(bank, given(u));
  check_pairs(found, "yyy");
  double smallest = 1;
  for (const ExactPair& pair : found.pairs) smallest = std::min(smallest, pair.kappa_lower);
  CHECK(smallest == doctest::Approx(.1));
  u(1, 0) = .9 + 1e-9;
  CHECK(verify_design(bank, given(u)).separates() == Answer::yes);
  u(1, 0) = .9 - 1e-9;
  CHECK(verify_design(bank, given(u)).separates() == Answer::no);
}

TEST_CASE("nothing is rounded: tubes that touch meet, and one unit in the last place parts them") {
  const ModeBank bank = signs();
  CHECK(verify_design(bank, given(Matrix{{1.}})).pairs[0].disjoint == Answer::no);
  CHECK(verify_design(bank, given(Matrix{{-1.}})).pairs[0].disjoint == Answer::no);
  const ExactPair apart = verify_design(bank, given(Matrix{{std::nextafter(1., 2)}})).pairs[0];
  CHECK(apart.disjoint == Answer::yes);
  CHECK(apart.kappa_lower >= 0);
  CHECK(apart.kappa_lower <= std::nextafter(1., 2) - 1);
  CHECK(verify_design(bank, given(Matrix{{1.5}})).pairs[0].kappa_lower == .5);
  CHECK(verify_design(bank, given(Matrix{{0.}, {-4.}})).pairs[0].kappa_lower == 3);
}

TEST_CASE("whatever the numbers: touching tubes meet, and bounds of κ are rounded down") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(.1, 1);
  for (int i = 0; i < 200; ++i) {
    ModeBank bank = signs();
    const double d = uniform(random), u = d * (1 + uniform(random) / 2);
    for (Mode& mode : bank.modes) mode.model.linear.Dv(0, 0) = d;
    CHECK(verify_design(bank, given(Matrix{{d}})).pairs[0].disjoint == Answer::no);
    const ExactPair pair =
        verify_design(bank, given(Matrix{{u}})).pairs[0];  // κ = u / d - 1, and u - d is a double
    CHECK(pair.disjoint == Answer::yes);
    CHECK(std::fma(pair.kappa_lower, d, -(u - d)) <= 0);
    CHECK(std::fma(std::nextafter(pair.kappa_lower, 2), d, -(u - d)) >= 0);
  }
}

TEST_CASE("two modes without disturbances are apart however far a box is widened") {
  ModeBank bank = signs();
  for (Mode& mode : bank.modes) mode.model.V = make_point(Vector{{0.}});
  const ExactSeparation found = verify_design(bank, given(Matrix{{1e-300}}));
  CHECK(found.separates() == Answer::yes);
  CHECK(found.pairs[0].kappa_lower > 1e9);
}

TEST_CASE("one input for all: D has to be the same number in both rows") {
  ModeBank bank = signs();
  bank.modes[0].model.linear.D(0, 0) = 1;
  bank.modes[1].model.linear.D(0, 0) = -0x1p-60;  // D_i - D_j is no double
  for (Mode& mode : bank.modes) mode.model.V = make_zonotope(Vector{{0.}}, Matrix{{.5}});
  CHECK(verify_design(bank, given(Matrix{{1.}})).pairs[0].disjoint == Answer::yes);
  bank.modes[1].model.linear.D(0, 0) = 0;
  CHECK(verify_design(bank, given(Matrix{{1.}})).pairs[0].disjoint == Answer::no);
}

TEST_CASE("only the last output") {
  ModeBank bank{{scalar(0, .125), scalar(0, .125)}, 0};
  bank.modes[1].model.linear.B(0, 0) = -1;
  for (Mode& mode : bank.modes) mode.model.X0 = make_point(Vector{{0.}});
  for (const bool last : {false, true}) {
    DesignOutcome early = given(Matrix{{2.}, {0.}, {0.}}), late = given(Matrix{{0.}, {2.}, {0.}}),
                  after = given(Matrix{{0.}, {2.}});
    early.last_output_only = late.last_output_only = after.last_output_only = last;
    CHECK(verify_design(bank, early).pairs[0].disjoint == (last ? Answer::no : Answer::yes));
    CHECK(verify_design(bank, late).pairs[0].disjoint == Answer::yes);
    CHECK(verify_design(bank, after).pairs[0].disjoint == Answer::no);  // u_N shows in no output
  }
}

TEST_CASE("the static row of the last input counts") {
  // 0 = x_2 ± u_k: of y_k = x_2 + v
  ModeBank bank;
  for (const double sign : {1., -1.}) {
    Mode mode{"static", {}};
    LinearModel& m = mode.model.linear;
    m.E = Matrix{{1., 0}, {0, 0}};
    m.A = Matrix{{.5, 0}, {0, 1}};
    m.B = Matrix{{0.}, {sign}};
    m.Bw = Matrix(2, 0);
    m.C = Matrix{{0., 1}};
    m.D = Matrix::Zero(1, 1);
    m.Dv = Matrix{{1.}};
    mode.model.X0 = make_space(2);
    mode.model.W = make_point(Vector(0));
    mode.model.V = make_box({Vector{{-1.}}, Vector{{1.}}});
    bank.modes.push_back(mode);
  }
  CHECK(verify_design(bank, given(Matrix{{0.}, {2.}})).pairs[0].kappa_lower == 1);
  SUBCASE("an admissible set speaks of k = 1 … N and of what E leaves open") {
    const auto tubes = [&](Matrix u) {
      DesignOutcome outcome = given(std::move(u));
      outcome.admissible_set = make_box({Vector{{1000., -1}}, Vector{{1000.5, 1}}});
      return verify_design(bank, outcome).empty[0];
    };
    CHECK(tubes(Matrix{{2.}, {0.}, {0.}}) == Answer::no);
    CHECK(tubes(Matrix{{0.}, {2.}, {0.}}) == Answer::yes);
    CHECK(tubes(Matrix{{0.}, {0.}, {2.}}) == Answer::yes);
    CHECK(tubes(Matrix{{1.}, {1.}, {-1.}}) == Answer::no);
  }
  SUBCASE("x_0 keeps to X0 and its constraints") {
    for (Mode& mode : bank.modes)
      mode.model.X0 =
          intersection(make_space(2), Matrix{{0., 1}}, make_box({Vector{{-1.}}, Vector{{1.}}}));
    check_tubes(verify_design(bank, given(Matrix{{2.}, {0.}})), Answer::yes);
    check_tubes(verify_design(bank, given(Matrix{{1.}, {0.}})), Answer::no);
  }
}

TEST_CASE("an admissible set speaks of what E leaves open, whatever its rows are") {
  // x_1 + x_2 follows an equation, x_1 - x_2 = u; of X_A, x_1 - x_2 counts only
  Mode mode{"static", {}};
  LinearModel& m = mode.model.linear;
  m.E = Matrix{{1., 1}, {0, 0}};
  m.A = Matrix{{.5, .5}, {1, -1}};
  m.B = Matrix{{0.}, {-1}};
  m.Bw = Matrix(2, 0);
  m.C = Matrix{{0., 1}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix{{1.}};
  mode.model.X0 = make_space(2);
  mode.model.W = make_point(Vector(0));
  mode.model.V = make_box({Vector{{-1.}}, Vector{{1.}}});
  DesignOutcome outcome = given(Matrix{{3.}, {.5}});
  outcome.admissible_set = make_box({Vector{{1000., 999.}}, Vector{{1000., 1001.}}});
  check_tubes(verify_design({{mode, mode}, 0}, outcome), Answer::no);
  outcome.best->u(1, 0) = 2;
  check_tubes(verify_design({{mode, mode}, 0}, outcome), Answer::yes);
}

TEST_CASE("a regular E is the same as its inverse on the other side") {
  ModeBank plain = examples::four_descriptor_models();
  for (Mode& mode : plain.modes) {
    LinearModel& m = mode.model.linear;
    m.E = Matrix();
    m.A = Matrix{{.5, .25, 0}, {-.25, .5, 0}, {0, 0, .5}};
    m.B(2, 1) = 1;
  }
  plain.modes[1].model.linear.A(0, 0) = -.5;
  plain.modes[2].model.linear.B(1, 1) = -1;
  ModeBank scaled = plain;
  const Matrix E{{2., 0, 4}, {0, .5, 0}, {0, 1, 1}};  // powers of two: the products below are exact
  for (Mode& mode : scaled.modes) {
    LinearModel& m = mode.model.linear;
    m.E = E;
    m.A = E * m.A;
    m.B = E * m.B;
    m.Bw = E;  // and W scaled instead
    mode.model.W = make_box({-Vector{{.125, .25, .5}}, Vector{{.125, .25, .5}}});
  }
  for (Mode& mode : plain.modes) {
    mode.model.linear.Bw = Matrix::Identity(3, 3);
    mode.model.W = scaled.modes[0].model.W;
  }
  const Matrix u{{1., 2}, {-3, 5}, {4, 0}, {0, 1}};
  const ExactSeparation left = verify_design(plain, given(u));
  DesignOutcome outcome = given(u);
  outcome.admissible_set = make_point(Vector::Zero(3));  // E determines every state: without effect
  const ExactSeparation right = verify_design(scaled, outcome);
  bool any = false;
  for (std::size_t q = 0; q < 6; ++q) {
    CHECK(left.pairs[q].disjoint == right.pairs[q].disjoint);
    CHECK(left.pairs[q].kappa_lower == doctest::Approx(right.pairs[q].kappa_lower));
    any = any || left.pairs[q].kappa_lower > .01;
  }
  CHECK(any);
  check_tubes(right, Answer::no);
}

TEST_CASE("what does not fit is refused") {
  const ModeBank bank = signs();
  const auto code = [&](const ModeBank& b, const DesignOutcome& outcome) {
    try {
      verify_design(b, outcome);
    } catch (const Error& error) {
      return std::optional(error.code());
    }
    return std::optional<Errc>();
  };
  CHECK(code(bank, {}) == Errc::dimension);
  CHECK(code(bank, given(Matrix{{1., 2.}})) == Errc::dimension);
  CHECK(code(bank, given(Matrix(0, 1))) == Errc::dimension);
  CHECK(code(bank, given(Matrix{{std::nan("")}})) == Errc::not_finite);
  DesignOutcome wrong = given(Matrix{{1.}});
  wrong.admissible_set = make_space(2);
  CHECK(code(bank, wrong) == Errc::dimension);
  ModeBank range = bank;
  range.modes[1].model.linear.actuator = {Vector{{.5}}, Vector{{1.}}};
  CHECK(code(range, given(Matrix{{1.}})) == Errc::unsupported);
  CHECK_FALSE(code(bank, given(Matrix{{1.}})));
}

TEST_CASE("products with effectiveness are those of the numbers, not of their rounding") {
  // y = 3 f u + v₁ + v₂ with f = 0 and f = .1: .1 · 3 is rounded up by 3e-17
  const auto bank = [](double noise, Index through) {
    ModeBank modes{{scalar(0, 0), scalar(0, 0)}, 0};
    for (Index i = 0; i < 2; ++i) {
      Model& model = modes.modes[static_cast<std::size_t>(i)].model;
      LinearModel& m = model.linear;
      m.C.setZero();
      m.Dv = Matrix{{1, 1}};
      model.V = make_box({Vector{{-noise, -2e-17}}, Vector{{noise, 2e-17}}});
      const Box f{Vector{{i * .1}}, Vector{{i * .1}}};
      if (through == 0) m.D(0, 0) = 3, m.actuator = f;
      if (through == 1) m.D(0, 0) = 3, m.sensor = f;
      if (through == 2) m.B(0, 0) = 3, m.C(0, 0) = 1, m.actuator = f;
      if (through == 3) m.B(0, 0) = 1, m.C(0, 0) = 3, m.sensor = f;
      if (through >= 2) model.W = make_point(Vector::Zero(1));
      m = with_exact_effectiveness_applied(m);
    }
    return modes;
  };
  for (Index through = 0; through < 4; ++through) {
    CAPTURE(through);
    const Matrix u = Matrix::Ones(through < 2 ? 1 : 2, 1);
    CHECK(verify_design(bank(.15, through), given(u)).separates() == Answer::no);
    CHECK(verify_design(bank(.1499999999999999, through), given(u)).separates() == Answer::yes);
    const ModeBank plain = bank(.15, through);
    CHECK(plain[0].model.linear.unscaled == nullptr);  // a product with 0 is exact
    CHECK(plain[1].model.linear.unscaled != nullptr);
  }
}

TEST_CASE("what is too large for the simplex method is decided by restored proofs") {
  const ModeBank bank = signs();
  const Matrix apart = Matrix::Constant(30, 1, 1.5), together = Matrix::Constant(30, 1, .5);
  const std::vector<const Model*> both{&bank[0].model, &bank[1].model};
  const std::optional<LineForm> none;
  const LineForm rows = verification::common_runs(both, {apart, false, none});
  const auto m = static_cast<double>(rows.constraints());
  const double work = m * m * static_cast<double>(rows.lines() + rows.generators());
  CHECK(work > 1e7);
  CHECK(work < 1e8);
  const ExactSeparation found = verify_design(bank, given(apart));
  CHECK(found.separates() == Answer::yes);
  CHECK(found.pairs[0].kappa_lower == doctest::Approx(.5));
  CHECK(verify_design(bank, given(together)).separates() == Answer::no);
}

TEST_CASE("beyond the size limits nothing is said, with a reason") {
  const ExactSeparation found = verify_design(signs(), given(Matrix::Constant(120, 1, 4.)));
  CHECK(found.pairs[0].disjoint == Answer::unknown);
  CHECK(found.pairs[0].reason.find("too many") != std::string::npos);
  CHECK(found.separates() == Answer::unknown);
}

TEST_CASE("a stop leaves open what is not proven yet") {
  const std::atomic<bool> stop = true;
  const ExactSeparation found = verify_design(signs(), given(Matrix{{4.}}), &stop);
  CHECK(found.pairs.size() == 1);
  CHECK(found.pairs[0].disjoint == Answer::unknown);
  CHECK(found.pairs[0].reason == "interrupted");
  check_tubes(found, Answer::unknown);
  CHECK(found.separates() == Answer::unknown);
}

TEST_CASE("separation needs tubes that are proven to have outputs") {
  ExactSeparation found{{{0, 1, Answer::yes, 1, {}}}, {Answer::no, Answer::no}, 0};
  CHECK(found.separates() == Answer::yes);
  found.empty[1] = Answer::unknown;
  CHECK(found.separates() == Answer::unknown);
  found.empty[1] = Answer::yes;
  CHECK(found.separates() == Answer::unknown);
  found.pairs[0].disjoint = Answer::no;
  CHECK(found.separates() == Answer::no);
  found = {{{0, 1, Answer::unknown, 0, {}}}, {Answer::no, Answer::no}, 0};
  CHECK(found.separates() == Answer::unknown);
}

namespace {

double number() { return *rc::gen::inRange(-16, 17) / 8.; }
Matrix numbers(Index rows, Index cols) {
  Matrix M(rows, cols);
  for (double& x : M.reshaped()) x = number();
  return M;
}

Mode random_mode(Index n, Index inputs, Index outputs) {
  Mode mode{"random", {}};
  LinearModel& m = mode.model.linear;
  m.A = .5 * numbers(n, n);
  m.B = numbers(n, inputs);
  m.Bw = .125 * numbers(n, 1);
  m.C = numbers(outputs, n);
  m.D = numbers(outputs, inputs);
  m.Dv = .125 * numbers(outputs, 2);
  mode.model.X0 = make_zonotope(.25 * numbers(n, 1).col(0), .125 * numbers(n, 2));
  mode.model.W = make_zonotope(Vector{{number() / 16}}, Matrix{{.5}});
  mode.model.V = make_zonotope(.125 * numbers(2, 1).col(0), .5 * numbers(2, 2));
  return mode;
}

/// The output tube of a model without E by its recursion, all generators scaled.
LineForm tube(const Model& model, const Matrix& u, double scale) {
  const LinearModel& m = model.linear;
  const auto scaled = [&](LineForm X) {
    X.G *= scale;
    return X;
  };
  LineForm runs = scaled(model.X0);  // (x_k, y_0, …, y_{k-1})
  for (Index k = 0; k < u.rows(); ++k) {
    const Index n = m.states(), before = runs.dim() - n, p = m.outputs();
    Matrix T = Matrix::Zero(n + before + p, n + before);
    T.topLeftCorner(n, n) = m.A;
    T.block(n, n, before, before).setIdentity();
    T.bottomLeftCorner(p, n) = m.C;
    Vector t = Vector::Zero(T.rows());
    t.head(n) = m.B * u.row(k).transpose();
    t.tail(p) = m.D * u.row(k).transpose();
    const LineForm noise =
        cartesian_product(cartesian_product(affine_map(scaled(model.W), m.Bw, Vector::Zero(n)),
                                            make_point(Vector::Zero(before))),
                          affine_map(scaled(model.V), m.Dv, Vector::Zero(p)));
    runs = minkowski_sum(affine_map(runs, T, t), noise);
  }
  Matrix last = Matrix::Zero(runs.dim() - m.states(), runs.dim());
  last.rightCols(last.rows()).setIdentity();
  return affine_map(runs, last, Vector::Zero(last.rows()));
}

}  // namespace

TEST_CASE("random modes: the same answers and distances as by the tubes themselves") {
  int apart = 0, together = 0;
  CHECK(rc::check([&] {
    const Index n = *rc::gen::inRange<Index>(1, 4), inputs = *rc::gen::inRange<Index>(1, 3),
                outputs = *rc::gen::inRange<Index>(1, 3);
    const ModeBank bank{{random_mode(n, inputs, outputs), random_mode(n, inputs, outputs)}, 0};
    const Matrix u = numbers(*rc::gen::inRange<Index>(1, 5), inputs);
    const ExactSeparation found = verify_design(bank, given(u));
    const ExactPair& pair = found.pairs[0];
    RC_ASSERT(pair.disjoint != Answer::unknown);
    RC_ASSERT(found.empty == std::vector<Answer>(2, Answer::no));
    const auto disjoint = [&](double scale) {
      return is_disjoint(tube(bank[0].model, u, scale), tube(bank[1].model, u, scale));
    };
    if (pair.disjoint == Answer::no) {
      ++together;
      RC_ASSERT(disjoint(1) != Answer::yes);
    } else {
      ++apart;
      RC_ASSERT(disjoint(1) != Answer::no);
      if (pair.kappa_lower < 1e6) {
        RC_ASSERT(disjoint((1 + pair.kappa_lower) * (1 - 1e-7)) != Answer::no);
        RC_ASSERT(disjoint((1 + pair.kappa_lower) * (1 + 1e-7)) != Answer::yes);
      }
    }
    const std::vector<const Model*> both{&bank[0].model, &bank[1].model};
    const std::optional<LineForm> none;
    const LineForm rows = verification::common_runs(both, {u, false, none});
    if (rows.lines() + rows.generators() <= exact::max_columns &&
        rows.constraints() <= exact::max_rows) {
      RC_ASSERT(exact::is_empty(rows) == pair.disjoint);
    }
  }));
  CHECK(apart > 30);
  CHECK(together > 30);
}

TEST_CASE("the same answers as those of a designer") {
  const auto judged = [](const ModeBank& bank, const Matrix& u) {
    Params params;
    params.set("input", u);
    DesignControl control;
    return examples::registry()
        .make_designer("given", bank, examples::backend("line_zonotope"), params)
        ->design(control);
  };
  std::vector<std::pair<ModeBank, Matrix>> cases{
      {examples::four_descriptor_models(), by_lines},
      {examples::four_descriptor_models(), by_constrained}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int i = 0; i < 40; ++i) {
    const ModeBank bank{
        {{"a", examples::random_model(random)}, {"b", examples::random_model(random)}}, 0};
    cases.emplace_back(bank, Matrix::NullaryExpr(3, 2, [&] { return uniform(random); }));
  }
  int apart = 0, together = 0;
  for (const auto& [bank, u] : cases) {
    const DesignOutcome outcome = judged(bank, u);
    const ExactSeparation exact = verify_design(bank, outcome);
    REQUIRE(outcome.best->pairs.size() == exact.pairs.size());
    for (std::size_t q = 0; q < exact.pairs.size(); ++q) {
      CHECK(outcome.best->pairs[q].disjoint == exact.pairs[q].disjoint);
      (exact.pairs[q].disjoint == Answer::yes ? apart : together) += 1;
      if (exact.pairs[q].disjoint != Answer::yes) continue;
      CHECK(exact.pairs[q].kappa_lower ==
            doctest::Approx(outcome.best->pairs[q].kappa).epsilon(1e-6));
    }
    CHECK(exact.empty == outcome.best->empty);
  }
  CHECK(apart > 12);
  CHECK(together > 12);
}
