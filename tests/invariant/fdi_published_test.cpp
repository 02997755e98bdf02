// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of both papers, and the references computed from their recipes.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "banks.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "diagnosers/observer_bank/fdi_conditions.hpp"

using namespace fdi_test;
using Invariant = OfflineOptions::Invariant;

namespace {

/// Expected R̊_ij, by mode and observer.
struct Published {
  Index mode, observer;
  double lower, upper;
};

void check_table(const Guarantees& all, const std::vector<Published>& table, double tolerance) {
  for (const Published& row : table) {
    const PairGuarantee& told = pair(all, row.mode, row.observer);
    const Box& R = told.iterated.dim() > 0 ? told.iterated : told.residual;
    CAPTURE(row.mode);
    CAPTURE(row.observer);
    CHECK(std::abs(R.lower[0] - row.lower) < tolerance);
    CHECK(std::abs(R.upper[0] - row.upper) < tolerance);
  }
}

const std::vector<Published> reactor_rpi30{{0, 0, -0.00831117797623306, 0.00831117797623306},
                                           {0, 1, -0.07202686571867548, -0.04763767335606547},
                                           {0, 2, -0.1359186639677938, -0.10341041418168809},
                                           {1, 0, 0.04763767335606547, 0.07202686571867548},
                                           {1, 1, -0.016078014386376953, 0.016078014386376953},
                                           {1, 2, -0.07996981263549528, -0.03969472643924567},
                                           {2, 0, 0.10341041418168809, 0.1359186639677938},
                                           {2, 1, 0.03969472643924567, 0.07996981263549528},
                                           {2, 2, -0.02419707180987266, 0.02419707180987266}};
const std::vector<Published> reactor_mrpi{{0, 0, -0.008311149146439637, 0.008311149146439637},
                                          {0, 1, -0.0720268464792011, -0.047637692595539856},
                                          {0, 2, -0.1359186387858518, -0.1034104393636301},
                                          {1, 2, -0.0799697970438723, -0.03969474203086864},
                                          {2, 1, 0.03969474203086864, 0.0799697970438723},
                                          {2, 2, -0.024197050275782048, 0.024197050275782048}};
const std::vector<Published> reactor_literal{{0, 0, -0.0003201726797986379, 0.0003201726797986379},
                                             {1, 0, -0.05615161777251857, 0.06412925371083464},
                                             {1, 1, -0.11996069880355459, 0.11996069880355459},
                                             {1, 2, -0.18394587480848, 0.1759682388701639},
                                             {2, 0, -0.1121591578391279, 0.12811442971576004}};
const std::vector<Published> reactor_zero30{{0, 0, -0.008304898577797865, 0.008304898577797865},
                                            {1, 0, 0.04760842569324328, 0.07198083893973926},
                                            {2, 1, 0.03967036526834675, 0.0799188993646358}};
// those of i = j are ours: they depend on whether zero columns are dropped before the reduction,
// and were not published
const std::vector<Published> blade_iterated{{0, 0, -0.2092085858205697, 0.18879454381801827},
                                            {0, 1, 0.2888820436357938, 0.8014755010113823},
                                            {0, 2, 0.0729582233940762, 0.525482283092939},
                                            {1, 0, -0.8325188701385826, -0.2936985590833288},
                                            {1, 2, -0.4731866053643608, -0.035186224008985356},
                                            {2, 0, -0.5569645722947858, -0.07778468482963216},
                                            {2, 1, 0.018730432795799834, 0.4567308141511753}};
const std::vector<Published> blade_unreduced{{0, 0, -0.1837102906682785, 0.16725449945509285},
                                             {1, 0, -0.7924576253914773, -0.33081150168206974},
                                             {2, 1, 0.03765237650379383, 0.4378088704431813}};
const std::vector<Published> blade_mrpi{{0, 0, -0.11943354221799996, 0.11943354221799996},
                                        {0, 1, 0.380466462782, 0.7304224372180002},
                                        {0, 2, 0.15828868278200015, 0.45887181721799997},
                                        {1, 0, -0.7304224372180002, -0.380466462782},
                                        {1, 2, -0.390984162218, -0.10274423778200018},
                                        {2, 0, -0.45887181721799997, -0.15828868278200015},
                                        {2, 1, 0.10274423778200018, 0.390984162218}};

OfflineOptions reactor_options(Invariant invariant) {
  OfflineOptions options;
  options.invariant = invariant;
  options.separate_inputs = true;
  if (invariant != Invariant::mrpi) options.iterations = {30};
  return options;
}

OfflineOptions blade_options(Index columns) {
  OfflineOptions options;
  options.invariant = Invariant::iterate;
  options.iterations = {29, 30, 30};
  options.max_columns = columns;
  options.start_set = box_around(Vector::Constant(2, .1), Vector::Constant(2, .5));
  return options;
}

}  // namespace

TEST_CASE("the reactor: published residual sets and the FDI condition") {
  const Guarantees all =
      fdi_guarantees(reactor(), reactor_gains(), reactor_options(Invariant::rpi));
  check_table(all, reactor_rpi30, 1e-9);
  CHECK(all.all == Answer::yes);
  for (const PairGuarantee& one : all.pairs) CHECK(one.holds == Answer::yes);
  const Guarantees limit =
      fdi_guarantees(reactor(), reactor_gains(), reactor_options(Invariant::mrpi));
  check_table(limit, reactor_mrpi, 1e-9);
  CHECK(limit.all == Answer::yes);
  const Guarantees zero =
      fdi_guarantees(reactor(), reactor_gains(), reactor_options(Invariant::iterate));
  check_table(zero, reactor_zero30, 1e-9);
  CHECK(zero.all == Answer::yes);
  for (const PairGuarantee& one :
       zero.pairs) {  // 30 steps from 0 are not the limit: what is promised holds it
    const Box& last = pair(limit, one.mode, one.observer).residual;
    CHECK(one.residual.lower[0] == std::min(one.iterated.lower[0], last.lower[0]));
    CHECK(one.residual.upper[0] == std::max(one.iterated.upper[0], last.upper[0]));
    CHECK(one.iterated.radius()[0] < last.radius()[0]);
    CHECK(limit.pairs[0].iterated.dim() == 0);
  }
}

TEST_CASE("the reactor: centre and radius of the disturbance as printed fail the condition") {
  const Guarantees all =
      fdi_guarantees(reactor(true), reactor_gains(), reactor_options(Invariant::mrpi));
  check_table(all, reactor_literal, 1e-9);
  CHECK(all.all == Answer::no);
  CHECK(pair(all, 1, 0).holds == Answer::no);
  CHECK(pair(all, 1, 1).holds == Answer::yes);
  CHECK(fdi_guarantees(reactor(true), reactor_gains(), reactor_options(Invariant::rpi)).all ==
        Answer::no);
}

TEST_CASE("the blade: published residual sets, with and without reduction, and their limits") {
  const Guarantees all = fdi_guarantees(blade(), blade_gains(), blade_options(8));
  check_table(all, blade_iterated, 1e-9);
  CHECK(all.all == Answer::yes);
  OfflineOptions unreduced = blade_options(0);
  unreduced.iterations = {30};
  check_table(fdi_guarantees(blade(), blade_gains(), unreduced), blade_unreduced, 1e-9);
  const Guarantees limit = fdi_guarantees(blade(), blade_gains(), {});
  check_table(limit, blade_mrpi, 1e-6);
  CHECK(limit.all == Answer::yes);
}

TEST_CASE("the published error set of the reactor is too small, an enlarged one is not") {
  OfflineOptions options = reactor_options(Invariant::rpi);
  options.error_set = make_zonotope(Vector::Zero(2), Matrix{{.15, 0, .15}, {0, 5, 5}});
  const ErrorSetCheck published = check_error_set(reactor(), reactor_gains(), options);
  CHECK(published.steady_factor == doctest::Approx(1.163).epsilon(5e-4));
  CHECK(published.mode + published.observer == 2);
  CHECK(published.mode != published.observer);
  CHECK(published.factor >= published.steady_factor);
  const std::vector<Diagnostic> problems = check_offline(reactor(), reactor_gains(), options);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/error_set");
  CHECK(problems[0].message.find("1.163") != std::string::npos);
  options.error_set = box_around(Vector::Zero(2), Vector{{.15, 8}});
  const ErrorSetCheck enlarged = check_error_set(reactor(), reactor_gains(), options);
  CHECK(enlarged.factor <= 1);
  CHECK(enlarged.factor == doctest::Approx(.9061).epsilon(1e-3));
  CHECK(check_offline(reactor(), reactor_gains(), options).empty());
  // a start that reaches further than all that comes later
  options.initial_set = box_around(Vector::Zero(2), Vector{{.3, 0}});
  const ErrorSetCheck start = check_error_set(reactor(), reactor_gains(), options);
  CHECK(start.factor == doctest::Approx(2));
  CHECK(start.steady_factor == doctest::Approx(enlarged.steady_factor));
}
