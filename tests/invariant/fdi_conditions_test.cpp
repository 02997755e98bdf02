// SPDX-License-Identifier: GPL-3.0-or-later
// Offline conditions of banks whose sets are known by hand, and what is refused.
#include "diagnosers/observer_bank/fdi_conditions.hpp"

#include <doctest/doctest.h>

#include "banks.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace fdi_test;
using Invariant = OfflineOptions::Invariant;

TEST_CASE("inputs shared by plant and observer give smaller sets than independent ones") {
  OfflineOptions options;
  const Guarantees joint = fdi_guarantees(reactor(), reactor_gains(), options);
  options.separate_inputs = true;
  const Guarantees separate = fdi_guarantees(reactor(), reactor_gains(), options);
  for (std::size_t k = 0; k < 9; ++k) {
    const double inner = joint.pairs[k].residual.radius()[0],
                 outer = separate.pairs[k].residual.radius()[0];
    CHECK(inner < outer);
    CHECK(joint.pairs[k].holds == Answer::yes);
  }
}

TEST_CASE("two outputs: a separation that no axis shows, and its failure") {
  // e⁺ = d with d on the segment (1,-1) ξ: apart from 0 by its centre in the direction (1, 1) only
  ModeBank bank;
  for (const double offset : {0.0, .2, .02}) {
    Model model = model_of(Matrix::Zero(2, 2), Matrix(2, 0), Matrix::Identity(2, 2));
    model.U = make_point(Vector(0));
    model.W = make_zonotope(Vector::Constant(2, offset), Matrix{{1, .02, 0}, {-1, 0, .02}});
    bank.modes.push_back({mode_name(bank.size()), model});
  }
  const std::vector<Matrix> gains(3, Matrix::Zero(2, 2));
  for (const Invariant invariant : {Invariant::mrpi, Invariant::rpi}) {
    OfflineOptions options;
    options.invariant = invariant;
    if (invariant == Invariant::rpi) options.iterations = {1};  // the closed form is a box here
    const Guarantees all = fdi_guarantees(bank, gains, options);
    const Box& R = pair(all, 1, 0).residual;
    CHECK(R.contains(Vector::Zero(2)));
    CHECK(R.upper[0] == doctest::Approx(2.24));
    CHECK(pair(all, 1, 0).holds == Answer::yes);
    CHECK(pair(all, 0, 1).holds == Answer::yes);
    CHECK(pair(all, 2, 0).holds == Answer::no);
    CHECK(pair(all, 1, 1).holds == Answer::yes);
    CHECK(all.all == Answer::no);
  }
}

TEST_CASE("iterations that do not contain the limit promise nothing by themselves") {
  // no step at all: the residual is that of e = 1 and misses 0, the limit does not
  ModeBank bank;
  for (int i = 0; i < 2; ++i) {
    Model model = model_of(Matrix{{.5}}, Matrix{{1}}, Matrix{{1}});
    model.W = box_around(Vector{{0}}, Vector{{.1}});
    bank.modes.push_back({mode_name(i), model});
  }
  OfflineOptions options;
  options.invariant = Invariant::iterate;
  options.iterations = {0};
  options.start_set = make_point(Vector{{1}});
  const Guarantees all = fdi_guarantees(bank, {Matrix{{0}}, Matrix{{0}}}, options);
  CHECK(pair(all, 1, 0, 2).iterated.lower[0] == doctest::Approx(1));
  CHECK(pair(all, 1, 0, 2).residual.lower[0] <= -.4 * (1 - 1e-9));  // the limit: 2 · .1 / (1 - .5)
  CHECK(pair(all, 1, 0, 2).holds == Answer::no);
  CHECK(pair(all, 0, 0, 2).holds == Answer::yes);
}

TEST_CASE("one iteration from 0 is no promise: the box holds residuals for long") {
  // A = .9, L = .1: errors shrink by .8 a step only
  ModeBank bank;
  for (const double effectiveness : {1.0, .5}) {
    Model model = model_of(Matrix{{.9}}, Matrix{{effectiveness}}, Matrix{{1}});
    model.W = model.V = box_around(Vector{{0}}, Vector{{.1}});
    model.U = box_around(Vector{{0}}, Vector{{1}});
    bank.modes.push_back({effectiveness == 1 ? "healthy" : "weak", model});
  }
  OfflineOptions options;
  options.invariant = Invariant::iterate;
  options.iterations = {1};
  const std::vector<Matrix> gains{Matrix{{.1}}, Matrix{{.1}}};
  const Guarantees one = fdi_guarantees(bank, gains, options),
                   limit = fdi_guarantees(bank, gains, {});
  for (Index i = 0; i < 2; ++i) {
    for (Index j = 0; j < 2; ++j) {
      CHECK(pair(one, i, j, 2).iterated.upper[0] < .9 * pair(limit, i, j, 2).residual.upper[0]);
      CHECK(pair(one, i, j, 2).residual.upper[0] == pair(limit, i, j, 2).residual.upper[0]);
      CHECK(pair(one, i, j, 2).residual.lower[0] == pair(limit, i, j, 2).residual.lower[0]);
    }
  }
}

namespace {

Diagnostic problem(const ModeBank& bank, const std::vector<Matrix>& gains,
                   const OfflineOptions& options) {
  const std::vector<Diagnostic> found = check_offline(bank, gains, options);
  REQUIRE(found.size() >= 1);
  return found[0];
}

void says(const Diagnostic& found, const char* pointer, const char* text) {
  CHECK(found.pointer == pointer);
  CHECK(found.message.find(text) != std::string::npos);
  if (found.message.find(text) == std::string::npos) MESSAGE(found.message);
}

}  // namespace

TEST_CASE("problems of models and options") {
  OfflineOptions options;
  CHECK(check_offline(reactor(), reactor_gains(), options).empty());
  options.invariant = Invariant::rpi;
  CHECK(check_offline(reactor(), reactor_gains(), options).empty());
  options.iterations = {1, 2};
  says(problem(reactor(), reactor_gains(), options), "/iterations", "2 entries for 3 observers");
  options.iterations = {-1};
  says(problem(reactor(), reactor_gains(), options), "/iterations", "negative");
  options = {};
  options.max_columns = 1;
  says(problem(reactor(), reactor_gains(), options), "/max_columns", "at least 2");
  options = {};
  options.accuracy = 0;
  says(problem(reactor(), reactor_gains(), options), "/accuracy", "between 0 and 1");
  options = {};
  options.error_set = make_point(Vector{{1}});
  says(problem(reactor(), reactor_gains(), options), "/error_set",
       "1 dimensions, the models have 2 states");
  options.error_set = make_strip(Vector{{1, 0}}, 0, 1);
  says(problem(reactor(), reactor_gains(), options), "/error_set", "zonotope");
  options = {};
  ModeBank bank = reactor();
  bank.modes[1].model.U = make_space(1);
  const Diagnostic unbounded = problem(bank, reactor_gains(), options);
  says(unbounded, "", "bounded inputs");
  CHECK(unbounded.suggestion.find("/system/U") != std::string::npos);
  CHECK_FALSE(input_bounds(reactor()).contains(Vector{{20.1}}));
  CHECK(input_bounds(reactor()).contains(Vector{{20}}));
  bank = reactor();
  bank.modes[1].model.W = make_space(2);
  says(problem(bank, reactor_gains(), options), "", "W of mode \"fault_1\" is unbounded");
  std::vector<Matrix> gains = reactor_gains();
  gains[2] = Matrix{{-1}, {0}};
  says(problem(reactor(), gains, options), "",
       "A - L C of mode \"fault_2\" is not Schur: it has the eigenvalue 1.8");
  CHECK_THROWS_AS(fdi_guarantees(reactor(), gains, options), Error);
  gains.pop_back();
  says(problem(reactor(), gains, options), "", "one gain per mode");
  // an unstable plant is no obstacle as long as its state does not act on the errors
  bank = reactor();
  for (Mode& mode : bank.modes) mode.model.linear.A(0, 0) = 1.02;
  gains = std::vector<Matrix>(3, Matrix{{.28}, {11.6106}});
  CHECK(check_offline(bank, gains, options).empty());
  bank.modes[1].model.linear.C *= .5;
  says(problem(bank, gains, options), "/state_set", "nothing bounds it");
  options.state_set = box_around(Vector::Zero(2), Vector::Constant(2, 1));
  CHECK_THROWS_AS(fdi_guarantees(bank, gains, options), Error);
  says(problem(bank, gains, options), "",
       "A of mode \"fault_1\", whose state acts on the error of the observer of mode \"healthy\", "
       "is not Schur");
}

TEST_CASE("every actuator with a range varies on its own") {
  Model model = model_of(Matrix::Zero(2, 2), Matrix::Identity(2, 2), Matrix{{1, -1}});
  model.linear.actuator = {Vector{{.5, .5}}, Vector{{1, 1}}};
  model.U = make_point(Vector{{4, 4}});
  const Guarantees all = fdi_guarantees({{{"mode", model}}, 0}, {Matrix::Zero(2, 1)}, {});
  const Box& R = pair(all, 0, 0, 1)
                     .residual;  // both of plant and observer: f_1 - f_2 in ±.5, four times, twice
  CHECK(R.upper[0] == doctest::Approx(4));
  CHECK(R.lower[0] == doctest::Approx(-4));
}

TEST_CASE("observers that start elsewhere than the plant start with an error") {
  ModeBank bank;
  for (const double start : {0.0, 5.0}) {
    Model model = model_of(Matrix::Zero(1, 1), Matrix(1, 0), Matrix{{1}});
    model.U = make_point(Vector(0));
    model.X0 = make_point(Vector::Constant(1, start));
    bank.modes.push_back({mode_name(bank.size()), model});
  }
  const Box box =
      interval_hull(check_error_set(bank, {Matrix::Zero(1, 1), Matrix::Zero(1, 1)}, {}).set);
  CHECK(box.lower[0] == doctest::Approx(-5));
  CHECK(box.upper[0] == doctest::Approx(5));
}

TEST_CASE("two outputs: noise counts in a separation, and a coarse sum proves no overlap") {
  const auto holds = [](double decay, double offset, double noise, double accuracy) {
    ModeBank bank;
    for (const double center : {0.0, offset}) {
      Model model = model_of(decay * Matrix::Identity(2, 2), Matrix(2, 0), Matrix::Identity(2, 2));
      model.U = make_point(Vector(0));
      model.W = make_zonotope(Vector::Constant(2, center), Matrix{{1, .02, 0}, {-1, 0, .02}});
      model.V = box_around(Vector::Zero(2), Vector::Constant(2, noise));
      bank.modes.push_back({mode_name(bank.size()), model});
    }
    OfflineOptions options;
    options.accuracy = accuracy;
    return pair(fdi_guarantees(bank, {Matrix::Zero(2, 2), Matrix::Zero(2, 2)}, options), 1, 0, 2)
        .holds;
  };
  // along (1, 1): the centre at 2 · offset / (1 - decay), half widths .08 / (1 - decay) + 4 · noise
  CHECK(holds(0, .2, .07, 1e-9) == Answer::yes);
  CHECK(holds(0, .2, .09, 1e-9) == Answer::no);
  CHECK(holds(.5, .05, .005, 1e-9) == Answer::yes);
  CHECK(holds(.5, .05, .015, 1e-9) == Answer::no);
  CHECK(holds(.5, .05, .005, .5) == Answer::unknown);
}

TEST_CASE("the state acts on the error by both matrices") {
  // x = 1 / (1 - a), e = .25 e + (a - .5 - .5 (1 - .5)) x, r = .5 e + (1 - .5) x
  for (const double a : {.5, .6}) {
    ModeBank bank{{{"plant", model_of(Matrix{{a}}, Matrix{{1}}, Matrix{{1}})},
                   {"observer", model_of(Matrix{{.5}}, Matrix{{1}}, Matrix{{.5}})}},
                  0};
    for (Mode& mode : bank.modes) mode.model.U = make_point(Vector{{1}});
    OfflineOptions options;
    options.state_set = box_around(Vector{{0}}, Vector{{3}});
    const Guarantees all = fdi_guarantees(bank, {Matrix{{.5}}, Matrix{{.5}}}, options);
    const double x = 1 / (1 - a), e = (a - .75) * x / .75;
    CHECK(pair(all, 0, 1, 2).residual.lower[0] == doctest::Approx(.5 * e + .5 * x));
    CHECK(pair(all, 0, 1, 2).residual.upper[0] == doctest::Approx(.5 * e + .5 * x));
  }
}
