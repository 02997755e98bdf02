// SPDX-License-Identifier: GPL-3.0-or-later
// Exact proofs of what an input sequence separates: examples by hand, and the published ones.
#include <atomic>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/study/design.hpp"
#include "input_design/systems.hpp"
#include "study/checks/common_runs.hpp"
#include "verify/designs.hpp"

using namespace cordon;
using namespace verify_test;

namespace {

Answer word(char letter) {
  return letter == 'y' ? Answer::yes : letter == 'n' ? Answer::no : Answer::unknown;
}

/// "ynnyyn": are the pairs 12, 13, 14, 23, 24, 34 disjoint?
void check_pairs(const ExactSeparation& found, const std::string& expected) {
  REQUIRE(found.pairs.size() == expected.size());
  for (std::size_t q = 0; q < expected.size(); ++q)
    CHECK(found.pairs[q].disjoint == word(expected[q]));
}

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

TEST_CASE("what is too large for the simplex method is decided by restored proofs") {
  const ModeBank bank = signs();
  const Matrix apart = Matrix::Constant(30, 1, 1.5), together = Matrix::Constant(30, 1, .5);
  const TimedModel first(bank[0].model), second(bank[1].model);
  const std::vector<const TimedModel*> both{&first, &second};
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
