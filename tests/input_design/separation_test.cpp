// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/tubes/separation.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using namespace cordon::designers;
using examples::backend;
using examples::numbers;

namespace {

std::vector<OutputTube> tubes_of(const ModeBank& bank, Index horizon) {
  std::vector<OutputTube> tubes;
  for (const Mode& mode : bank.modes)
    tubes.push_back(output_tube(mode.model, *backend("line_zonotope"), {horizon}));
  return tubes;
}

}  // namespace

TEST_CASE("κ of the published inputs") {
  const std::vector<PairProgram> pairs =
      pair_programs(tubes_of(examples::four_descriptor_models(), 3));
  REQUIRE(pairs.size() == 6);
  const auto check = [&](const Vector& u, std::initializer_list<double> expected) {
    auto pair = pairs.begin();
    for (const double kappa : expected) {
      const PairSeparation found = separation(*pair++, u);
      CAPTURE(found.i);
      CAPTURE(found.j);
      CHECK(std::abs(found.kappa - kappa) < 1e-6);
      CHECK(found.kappa_lower <= found.kappa + 1e-12);
      CHECK(found.kappa_lower > found.kappa - 1e-9);
      CHECK(found.disjoint == (kappa > 0 ? Answer::yes : Answer::no));  // Table 1
      CHECK(found.why.kind == (kappa > 0 ? Certificate::Kind::farkas : Certificate::Kind::point));
    }
  };
  check(examples::published_line_input(),
        {.9184357542, .1484878049, .1309372064, .2307897451, 1.6599838402, 1.2369816787});
  check(examples::published_constrained_input(),
        {.3940156025, -.8085889571, -.5956685499, .4966639294, .2753818400, -.4508039983});
  check(examples::reference_input(),
        {-.6202396234, -.8085889571, -.9243257114, -.4833119384, -.6766805827, -.7421013700});
}

TEST_CASE(
    "Scalar models from anywhere: κ = |u_1| / 0.9 - 1 at u = (0, u_1, 0, 0) for the closest pair") {
  const std::vector<PairProgram> pairs =
      pair_programs(tubes_of(examples::three_scalar_models(), 3));
  for (const double u1 : {.99, -.99, .9000899999, 1.8, .5}) {
    double smallest = INFINITY;
    for (const PairProgram& pair : pairs)
      smallest = std::min(smallest, separation(pair, numbers({0, u1, 0, 0})).kappa);
    CHECK(smallest == doctest::Approx(std::abs(u1) / .9 - 1).epsilon(1e-9));
  }
}

TEST_CASE("κ agrees with the rational emptiness of the intersection, with boxes widened") {
  const ModeBank bank = examples::four_descriptor_models();
  const std::vector<OutputTube> tubes = tubes_of(bank, 2);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-8, 8);
  int disjoint = 0, meeting = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const Vector u = Vector::NullaryExpr(6, [&] { return uniform(random); });
    const Index i = trial % 3, j = 3;
    const PairSeparation found =
        separation(pair_program(i, tubes[static_cast<std::size_t>(i)], j, tubes[3]), u);
    const LineForm Yi = tubes[static_cast<std::size_t>(i)].at(u), Yj = tubes[3].at(u);
    const auto answer = [&](double factor) {  // ‖ξ‖∞ ≤ factor
      LineForm both = intersection(Yi, Matrix::Identity(3, 3), Yj);
      both.G *= factor;
      both.A *= factor;
      return exact::is_empty(both);
    };
    CHECK(answer(1) == found.disjoint);
    if (found.kappa > -.999) {
      CHECK(answer((1 + found.kappa) * (1 - 1e-7)) == Answer::yes);
      CHECK(answer((1 + found.kappa) * (1 + 1e-7)) == Answer::no);
    }
    (found.disjoint == Answer::yes ? disjoint : meeting) += 1;
  }
  CHECK(disjoint > 0);
  CHECK(meeting > 0);
}

TEST_CASE("κ of random models agrees with the rational emptiness of the intersection") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 12; ++trial) {
    ModeBank bank;
    for (const char* name : {"a", "b"})
      bank.modes.push_back({name, examples::random_model(random)});
    const std::vector<OutputTube> tubes = tubes_of(bank, 1);
    const Vector u = Vector::NullaryExpr(
        4, [&] { return std::uniform_real_distribution<double>(-20, 20)(random); });
    const PairSeparation found = separation(pair_program(0, tubes[0], 1, tubes[1]), u);
    for (const double share : {1 - 1e-6, 1 + 1e-6}) {
      LineForm both = intersection(tubes[0].at(u), Matrix::Identity(4, 4), tubes[1].at(u));
      both.G *= share * (1 + found.kappa);
      both.A *= share * (1 + found.kappa);
      CHECK(exact::is_empty(both) == (share < 1 ? Answer::yes : Answer::no));
    }
  }
}

TEST_CASE("a pair of which no equation is left has no κ, and whether its tubes meet is open") {
  Model model;
  LinearModel& m = model.linear;
  m.A = (Matrix(2, 2) << -1.5, -1.375, .75, 0).finished();
  m.B = numbers({-.25, 0});
  m.Bw = numbers({-.375, -.25});
  m.C = (Matrix(1, 2) << -.625, .5).finished();
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix::Zero(1, 0);
  model.X0 = make_space(2);
  model.W = examples::cube(1, .125);
  model.V = make_space(0);
  model.U = examples::cube(1, 1);
  ModeBank bank;
  for (const char* name : {"healthy", "weak"}) bank.modes.push_back({name, model});
  bank.modes[1].model.linear.B *= .5;
  const std::vector<OutputTube> tubes = tubes_of(bank, 3);
  const PairProgram pair = pair_program(0, tubes[0], 1, tubes[1]);
  REQUIRE(pair.rows() == 0);
  REQUIRE(pair.vanished > 0);
  const PairSeparation found = separation(pair, numbers({0, 1, 0, -1}));
  CHECK(std::isnan(found.kappa));  // in rationals it is -0.51375
  CHECK(found.kappa_lower == -1);
  CHECK(found.disjoint == Answer::unknown);
}

TEST_CASE("κ is convex in the inputs") {
  const std::vector<PairProgram> pairs =
      pair_programs(tubes_of(examples::four_descriptor_models(), 3));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-8, 8);
  for (int trial = 0; trial < 50; ++trial) {
    const PairProgram& pair = pairs[static_cast<std::size_t>(trial) % pairs.size()];
    const Vector u = Vector::NullaryExpr(8, [&] { return uniform(random); }),
                 v = Vector::NullaryExpr(8, [&] { return uniform(random); });
    const double middle = separation(pair, (u + v) / 2).kappa;
    CHECK(middle <= (separation(pair, u).kappa + separation(pair, v).kappa) / 2 + 1e-9);
  }
}

TEST_CASE("Equal models meet under every input") {
  ModeBank bank = examples::four_descriptor_models();
  bank.modes[1].model = bank.modes[0].model;
  const std::vector<OutputTube> tubes = tubes_of(bank, 3);
  const PairProgram pair = pair_program(0, tubes[0], 1, tubes[1]);
  for (const Vector& u : {examples::published_line_input(), examples::reference_input()}) {
    const PairSeparation found = separation(pair, u);
    CHECK(found.disjoint == Answer::no);
    CHECK(found.kappa <= 0);
  }
}

TEST_CASE("Too short a horizon leaves no row to tell models apart") {
  const std::vector<OutputTube> tubes = tubes_of(examples::three_scalar_models(), 0);
  const PairProgram pair =
      pair_program(0, tubes[0], 1, tubes[1]);  // y_0 = x_0 + v_0 with any x_0, in both
  CHECK(pair.rows() == 0);
  const PairSeparation found = separation(pair, numbers({2}));
  CHECK(found.disjoint == Answer::no);
  CHECK(found.kappa == -1);
}

TEST_CASE("Without disturbances every difference separates") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes)
    mode.model.X0 = mode.model.W = mode.model.V = make_point(numbers({0}));
  const std::vector<OutputTube> tubes = tubes_of(bank, 2);
  const PairProgram pair = pair_program(0, tubes[0], 1, tubes[1]);
  const PairSeparation apart = separation(pair, numbers({0.1, 0, 0}));
  CHECK(apart.disjoint == Answer::yes);
  CHECK(apart.kappa == INFINITY);
  CHECK(apart.kappa_lower == INFINITY);
  CHECK(separation(pair, numbers({0, 0.1, 0})).disjoint !=
        Answer::yes);  // felt at k = 2 alike by both
}

namespace {

/// Two modes of two states, all numbers short decimals: E = (1, 3)ᵀ(.1, .3) up to rounding or of
/// rank 1 in decimals, states from anywhere.
ModeBank singular_in_decimals(std::mt19937& random) {
  std::uniform_int_distribution<int> tenth(-30, 30), small(1, 9);
  const auto decimal = [&] { return tenth(random) / 10.0; };
  const double a = small(random), b = small(random), c = small(random), d = small(random);
  Model model;
  LinearModel& m = model.linear;
  m.E = (Matrix(2, 2) << a * b / 10, a * c / 10, d * b / 10, d * c / 10).finished();
  // in half of them the static equation holds x_1 by what rounding leaves of it
  m.A = (Matrix(2, 2) << a / d, decimal(), 1, decimal()).finished();
  if (random() % 2) m.A.col(0) << decimal(), decimal();
  m.B = (Matrix(2, 1) << decimal(), decimal()).finished();
  m.Bw = Matrix::Identity(2, 2);
  m.C = (Matrix(1, 2) << 0, 1).finished();
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix::Identity(1, 1);
  model.X0 = make_space(2);
  model.W = make_box({numbers({0, -.3}), numbers({0, .3})});
  model.V = examples::cube(1, .1);
  model.U = examples::cube(1, 3);
  ModeBank bank;
  bank.modes = {{"healthy", model}, {"weak", model}};
  bank.modes[1].model.linear.B(1, 0) = decimal();
  return bank;
}

}  // namespace

TEST_CASE("tubes of states from anywhere are disjoint on the rows as they were, lines and all") {
  std::mt19937 random(7);
  int disjoint = 0, open = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::vector<OutputTube> tubes = tubes_of(singular_in_decimals(random), 1);
    const PairProgram pair = pair_program(0, tubes[0], 1, tubes[1]);
    for (const double u : {.7, 3.}) {
      const PairSeparation found = separation(pair, numbers({u, u}));
      const Vector at = numbers({u, u});
      const Answer exact =
          exact::is_empty(intersection(tubes[0].at(at), Matrix::Identity(2, 2), tubes[1].at(at)));
      CAPTURE(trial);
      CAPTURE(u);
      if (found.disjoint == Answer::yes) CHECK(exact == Answer::yes);
      if (found.kappa_lower > 0) CHECK(exact == Answer::yes);
      if (found.disjoint == Answer::no) CHECK(exact == Answer::no);
      disjoint += found.disjoint == Answer::yes;
      open += found.disjoint == Answer::unknown;
    }
  }
  CHECK(disjoint > 20);
  CHECK(open < 300);
  MESSAGE(disjoint, " of 600 pairs disjoint, ", open, " open");
}
