// SPDX-License-Identifier: GPL-3.0-or-later
// What the filter refuses, in words and all at once.
#include <algorithm>
#include <cmath>

#include "fault_estimation/filters.hpp"

using namespace cordon;
using namespace faults;

namespace {

std::vector<Diagnostic> problems(const ModeBank& bank, const Params& params,
                                 const std::shared_ptr<const SetBackend>& backend = zonotopes()) {
  auto found =
      banks::registry().check<DiagnoserEntry>("fault_estimation_filter", {bank, backend}, params);
  if (!found.empty()) {
    CHECK_THROWS_AS(
        banks::registry().make<DiagnoserEntry>("fault_estimation_filter", {bank, backend}, params),
        InputError);
  }
  return found;
}

bool tells(const std::vector<Diagnostic>& all, const std::string& pointer,
           const std::string& text) {
  return std::any_of(all.begin(), all.end(), [&](const Diagnostic& p) {
    return p.pointer == pointer && p.message.find(text) != std::string::npos &&
           !p.suggestion.empty();
  });
}

}  // namespace

TEST_CASE("the published example has no problems") {
  CHECK(problems(alone(published()), {}).empty());
}

TEST_CASE("sizes") {
  const auto all = problems(alone(published()),
                            parameters("shared", 3).set("free_matrix", Matrix(Matrix::Zero(7, 4))));
  CHECK(all.size() == 2);
  CHECK(tells(all, "/max_columns", "is 3, fewer than the 4 states"));
  CHECK(tells(all, "/free_matrix", "is 7 × 4, must be 4 × 7"));
  CHECK(problems(alone(published()), parameters("shared", 4)).empty());
  CHECK(tells(problems(alone(published()), Params().set("admissible_set", make_space(3))),
              "/admissible_set", "has 3 coordinates, the system has 4 states"));
  CHECK(tells(problems(alone(published()), Params().set("admissible_set", make_space(4))),
              "/admissible_set", "admissible_set is unbounded"));
  CHECK(problems(alone(published()), parameters("shared", 0)).empty());
  CHECK(tells(problems(alone(published()), Params().set("free_matrix", Matrix(Matrix::Zero(4, 6)))),
              "/free_matrix", "is 4 × 6"));
  Matrix bad = Matrix::Zero(4, 7);
  bad(2, 3) = std::nan("");
  CHECK(problems(alone(published()), Params().set("free_matrix", bad)).size() == 1);
}

TEST_CASE("unbounded sets and ranges, all at once") {
  Model model = published();
  model.X0 = make_space(4);
  model.W = make_space(1);
  model.V = make_box({Vector{{0, 0, -std::numeric_limits<double>::infinity()}},
                      Vector{{1, 1, std::numeric_limits<double>::infinity()}}});
  model.linear.actuator = {Vector{{.5, 1}}, Vector{{1, 1}}};
  const auto all = problems(alone(model), {});
  CHECK(all.size() == 4);
  CHECK(tells(all, "", "X0 is unbounded"));
  CHECK(tells(all, "", "W is unbounded"));
  CHECK(tells(all, "", "V is unbounded"));
  CHECK(tells(all, "/type", "effectiveness is known by ranges"));
}

TEST_CASE("the nominal mode counts, not the others") {
  ModeBank bank = alone(published());
  bank.modes.push_back(bank.modes[0]);
  bank.modes[0].model.X0 = make_space(4);
  CHECK(problems(bank, {}).size() == 1);
  bank.nominal = 1;
  CHECK(problems(bank, {}).empty());
}

TEST_CASE("outward rounding") {
  Params outward;
  outward.set("rounding", std::string("outward"));
  const auto all =
      problems(alone(published()), {}, banks::registry().make<BackendEntry>("zonotope", outward));
  CHECK(all.size() == 1);
  CHECK(tells(all, "/type", "promises outward rounding"));
}

TEST_CASE("conditions of the design come with the others' absence") {
  Model model = published();
  model.linear.F.col(1) = -2 * model.linear.F.col(0);
  CHECK(tells(problems(alone(model), {}), "/type", "faults 1 and 2 act alike"));
  model = published();
  model.linear.C.row(2).setZero();
  CHECK(tells(problems(alone(model), {}), "/type", "rank [E; C] is 3"));
  model = published();
  model.linear.F.resize(4, 0);
  CHECK(tells(problems(alone(model), {}), "", "no faults to find"));
  model = published();
  model.linear.A_radius = .01 * Matrix::Identity(4, 4);
  CHECK(tells(problems(alone(model), {}), "/type", "interval matrices"));
}

TEST_CASE("bounds that outgrow the numbers end the run, until it begins anew") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, 0}, {0, 30}};
  m.F = Matrix{{1}, {0}};
  m.C = Matrix{{1, 2}};
  m.B = Matrix::Zero(2, 1);
  m.D = Matrix::Zero(1, 1);
  m.Bw = Matrix::Identity(2, 2);
  m.Dv = Matrix::Identity(1, 1);
  model.X0 = make_zonotope(Vector::Zero(2), Matrix::Identity(2, 2));
  model.W = model.X0;
  model.V = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  const auto diagnoser = filter(model, {});
  CHECK(std::isinf(diagnoser->guarantees()->faults[0].half_width));
  const auto samples = [&](Index from, Index to) {
    for (Index k = from; k < to; ++k) diagnoser->step({k, Vector::Zero(1), Vector::Zero(1)});
  };
  diagnoser->start();
  samples(0, 20);
  CHECK_THROWS_AS(samples(20, 2000), Error);
  Index k = 20;
  diagnoser->start();
  samples(0, 20);
  try {
    for (; k < 2000; ++k) diagnoser->step({k, Vector::Zero(1), Vector::Zero(1)});
  } catch (const Error& error) {
    CHECK(error.code() == Errc::not_finite);
  }
  CHECK_THROWS_WITH_AS(diagnoser->step({k, Vector::Zero(1), Vector::Zero(1)}),
                       doctest::Contains("start anew"), Error);
}

TEST_CASE("a response that is too weak to be one, and no rounding") {
  // C T f = 1e-12, and what the fault shows a step later is not much more: 22 % of a fault in the
  // step before would be taken for one
  Model model;
  model.linear = {{},
                  Matrix{{.5, 0}, {0, .5 - 4e-12}},
                  Matrix(2, 0),
                  Matrix(2, 0),
                  Matrix{{1, 1}},
                  Matrix(1, 0),
                  Matrix(1, 0)};
  model.linear.F = Vector{{1, -1 + 1e-12}};
  model.X0 = make_point(Vector::Zero(2));
  model.W = model.V = model.U = make_point(Vector(0));
  CHECK(tells(problems(alone(model), {}), "/type", "shows in the outputs before the response"));
  model.linear.F = Vector{{1, -1}};  // none before, exactly
  model.linear.A(1, 1) = .25;
  CHECK(problems(alone(model), {}).empty());
}
