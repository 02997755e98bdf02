// SPDX-License-Identifier: GPL-3.0-or-later
// Random banks on random plants: whatever the modes are and whenever they change, the mode that the
// plant has been in throughout is not excluded, on any backend.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

Matrix draw_matrix(Draw& draw, Index rows, Index cols, double size) {
  Matrix M(rows, cols);
  for (Index j = 0; j < cols; ++j) {
    for (Index i = 0; i < rows; ++i) M(i, j) = size * draw();
  }
  return M;
}

Index below(Draw& draw, Index end) {
  return static_cast<Index>(draw.engine() % static_cast<std::uint64_t>(end));
}

/// Effectiveness: none, exact values, or ranges, entry by entry.
Box effectiveness(Draw& draw, Index size, double width) {
  if (below(draw, 3) == 0) return {};
  Box box{Vector(size), Vector(size)};
  for (Index i = 0; i < size; ++i) {
    box.lower[i] = .7 + .2 * draw();
    box.upper[i] = box.lower[i] + (below(draw, 2) == 0 ? 0.0 : width * (1 + draw()));
    box.upper[i] = std::min(1.0, box.upper[i]);
  }
  return box;
}

/// Any number of generators, none among them; or two more, whose factors add up to a number.
LineForm any_set(Draw& draw, Index n, double center, double size) {
  LineForm X = make_zonotope(draw_matrix(draw, n, 1, center),
                             draw_matrix(draw, n, below(draw, n + 2), size));
  if (below(draw, 4) != 0) return X;
  X.G.conservativeResize(Eigen::NoChange, X.generators() + 2);
  X.G.rightCols(2) = draw_matrix(draw, n, 2, size);
  X.S = Matrix(1, 0);
  X.A = Matrix::Zero(1, X.generators());
  X.A.rightCols(2).setOnes();
  X.b = Vector::Constant(1, draw());
  return X;
}

/// A point of such a set.
Vector point_of(Draw& draw, const LineForm& X) {
  if (X.constraints() == 0) return draw.from(X);
  const Index g = X.generators();
  const double sum = X.b[0], low = std::max(-1.0, sum - 1), high = std::min(1.0, sum + 1);
  const double first = low + (high - low) * (1 + draw()) / 2;
  return draw.from(make_zonotope(X.c, X.G.leftCols(g - 2))) + first * X.G.col(g - 2) +
         (sum - first) * X.G.col(g - 1);
}

/// The mode's model with disturbances and matrices of this step alone.
Model at_this_step(const Mode& mode, Draw& draw) {
  Model model = mode.model;
  LinearModel& m = model.linear;
  for (auto [center, radius] :
       {std::pair(&m.A, &m.A_radius), {&m.B, &m.B_radius}, {&m.C, &m.C_radius}}) {
    if (radius->size() != 0)
      *center += radius->cwiseProduct(draw_matrix(draw, radius->rows(), radius->cols(), 1));
  }
  model.W = make_point(point_of(draw, model.W));
  model.V = make_point(point_of(draw, model.V));
  return model;
}

/// What a random bank may have; all of it is drawn.
struct RandomBank {
  ModeBank bank;
  Params parameters;
};

enum class Differ { actuators, sensors, models };

RandomBank random_bank(std::uint64_t seed, Differ what) {
  Draw draw{std::mt19937_64(seed)};
  const Index n = 1 + below(draw, 3), p = 1 + below(draw, 2), q = 1 + below(draw, 2),
              modes = 1 + below(draw, 4);
  RandomBank made;
  const Matrix A =
      draw_matrix(draw, n, n, .5 / static_cast<double>(n)) + .2 * Matrix::Identity(n, n);
  const Matrix B = draw_matrix(draw, n, p, 1), C = draw_matrix(draw, q, n, 1),
               D = draw_matrix(draw, q, p, .5);
  const LineForm U = box_around(draw_matrix(draw, p, 1, 2), Vector::Constant(p, .5));
  const LineForm X0 = make_zonotope(draw_matrix(draw, n, 1, 1), draw_matrix(draw, n, n, .3));
  for (Index i = 0; i < modes; ++i) {
    Mode mode{"mode_" + std::to_string(i), {}};
    LinearModel& m = mode.model.linear;
    m.A = A;
    m.B = B;
    m.C = C;
    m.D = D;
    m.Bw = draw_matrix(draw, n, below(draw, 3), 1);
    m.Dv = draw_matrix(draw, q, below(draw, 3), 1);
    mode.model.X0 = X0;
    mode.model.U = U;
    mode.model.W = any_set(draw, m.Bw.cols(), .2, .05);
    mode.model.V = any_set(draw, m.Dv.cols(), .2, .05);
    m.actuator = effectiveness(draw, p, .1);
    if (what == Differ::sensors) m.sensor = effectiveness(draw, q, .03);
    if (what == Differ::models) {
      m.A += draw_matrix(draw, n, n, .2 / static_cast<double>(n));
      m.C += draw_matrix(draw, q, n, .3);
      m.D += draw_matrix(draw, q, p, .3);
    }
    made.bank.modes.push_back(mode);
  }
  made.bank.nominal = below(draw, modes);
  Params& params = made.parameters;
  params.set("waiting_time", static_cast<std::int64_t>(1 + below(draw, 20)));
  if (what == Differ::models)
    params.set("state_set", box_around(Vector::Zero(n), Vector::Constant(n, 80)));
  if (below(draw, 2) == 0)
    params.set("gain", draw_matrix(draw, n, q, .2 / static_cast<double>(n * q)));
  if (below(draw, 2) == 0) params.set("strip_gain", draw_matrix(draw, n, q, .5));
  if (below(draw, 2) == 0)
    params.set("max_generators", static_cast<std::int64_t>(n + below(draw, 4)));
  return made;
}

/// Some of the matrices of some modes become intervals.
void add_intervals(ModeBank& bank, std::uint64_t seed) {
  Draw draw{std::mt19937_64(seed + 1000)};
  for (Mode& mode : bank.modes) {
    LinearModel& m = mode.model.linear;
    for (auto [center, radius] :
         {std::pair(&m.A, &m.A_radius), {&m.B, &m.B_radius}, {&m.C, &m.C_radius}}) {
      if (below(draw, 3) != 0)
        *radius = draw_matrix(draw, center->rows(), center->cols(), .01).cwiseAbs();
    }
  }
}

struct Tally {
  int runs = 0, refused = 0, resets = 0, isolated = 0;
};

/// Every third output is missing at random, and sometimes all of them.
Sample with_gaps(Sample sample, Draw& draw) {
  const bool none = below(draw, 20) == 0;
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (!none && below(draw, 3) != 0) continue;
    sample.y[i] = std::numeric_limits<double>::quiet_NaN();
    sample.missing.push_back(i);
  }
  return sample;
}

/// One run with changes of mode at random times; the truth is never excluded, and a set of the
/// truth holds the state.
void run(Diagnoser& diagnoser, const ModeBank& bank, const SetBackend& sets, std::uint64_t seed,
         bool gaps, Tally& tally) {
  Draw draw{std::mt19937_64(seed), seed % 2 == 0};
  Index truth = bank.nominal, truth_since = 0;
  const Index pause = 1 + below(draw, 40);
  Vector x = draw.from(bank[bank.nominal].model.X0);
  diagnoser.start();
  for (Index k = 0; k < 60; ++k) {
    if (k > 0 && below(draw, pause) == 0) {
      const Index next = below(draw, bank.size());
      if (next != truth) truth_since = k;
      truth = next;
    }
    const Vector u = draw.from(bank[0].model.U), now = x;
    const Vector y = simulate(at_this_step(bank[truth], draw), x, u, draw);
    const Sample sample{k, u, y};
    const Diagnosis diagnosis = diagnoser.step(gaps ? with_gaps(sample, draw) : sample);
    const ModeEvidence& evidence = diagnosis.modes[static_cast<std::size_t>(truth)];
    CAPTURE(k);
    CAPTURE(truth);
    CAPTURE(evidence.why.margin);
    tally.resets += diagnosis.reset;
    const bool speaks_of_truth = diagnosis.since >= truth_since;
    if (speaks_of_truth) REQUIRE(evidence.consistent != Answer::no);
    if (diagnosis.mode == truth && speaks_of_truth && diagnosis.estimate) {
      tally.isolated += diagnosis.since > 0;
      const Vector slack = Vector::Constant(now.size(), 1e-9 * (1 + now.cwiseAbs().maxCoeff()));
      REQUIRE((*diagnosis.estimate)->is_disjoint_from(*sets.box({now - slack, now + slack})) !=
              Answer::yes);
    }
  }
  ++tally.runs;
}

std::shared_ptr<const SetBackend> backend_of(const std::string& name, bool outward) {
  Params p;
  if (outward) p.set("rounding", std::string("outward"));
  return registry().make<BackendEntry>(name, p);
}

Params consistency_parameters(std::uint64_t seed, const std::string& observer, ModeBank& bank) {
  Draw draw{std::mt19937_64(seed)};
  const Index n = bank[0].model.linear.states();
  Params inner;
  if (below(draw, 2) == 0)
    inner.set("max_generators", static_cast<std::int64_t>(n + 6 + below(draw, 20)));
  if (observer == "descriptor" && below(draw, 2) == 0) {
    for (Mode& mode : bank.modes) mode.model.linear.E = Matrix::Identity(n, n);
    const double scale = .5 + below(draw, 3);
    for (Mode& mode : bank.modes) {
      LinearModel& m = mode.model.linear;
      for (Matrix* M : {&m.E, &m.A, &m.B, &m.Bw}) *M *= scale;
    }
  }
  Params params;
  params.set("observer", std::make_shared<const ComponentSpec>(ComponentSpec{observer, inner}))
      .set("waiting_time", static_cast<std::int64_t>(1 + below(draw, 20)));
  params.set("start", std::string(below(draw, 2) == 0 ? "any" : "nominal"));
  params.set("restart_set", box_around(Vector::Zero(n), Vector::Constant(n, 80)));
  return params;
}

std::uint64_t seeds() {
  const char* wanted = std::getenv("CORDON_SEEDS");
  return wanted ? std::stoull(wanted) : 4;
}

void check_banks(Differ what, const std::string& observer = "", bool gaps = false,
                 bool intervals = false) {
  const std::string type = observer.empty() ? "observer_bank" : "consistency_bank";
  const std::uint64_t count = observer.empty() ? seeds() : (seeds() + 2) / 3;
  for (const std::string name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    Tally tally;
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
      CAPTURE(seed);
      RandomBank random = random_bank(seed, what);
      if (intervals) {
        add_intervals(random.bank, seed);
        if (what == Differ::models)
          random.parameters.set("state_set",
                                box_around(Vector::Zero(random.bank[0].model.states()),
                                           Vector::Constant(random.bank[0].model.states(), 20)));
      }
      const ModeBank plant = random.bank;  // without E
      if (!observer.empty())
        random.parameters = consistency_parameters(seed, observer, random.bank);
      const auto sets = backend_of(name, seed % 3 == 0);
      if (const auto problems =
              registry().check<DiagnoserEntry>(type, {random.bank, sets}, random.parameters);
          !problems.empty()) {
        ++tally.refused;
        continue;
      }
      const auto diagnoser =
          registry().make<DiagnoserEntry>(type, {random.bank, sets}, random.parameters);
      for (std::uint64_t k = 0; k < 2; ++k)
        run(*diagnoser, plant, *sets, 2 * seed + k, gaps, tally);
    }
    CHECK(tally.runs > tally.refused);
    const bool never_empty = observer == "descriptor" && (name == "interval" || name == "zonotope");
    CHECK((tally.resets > 0) == !never_empty);
    CHECK((tally.isolated > 0) == !never_empty);
  }
}

}  // namespace

TEST_CASE("modes that differ in actuators") { check_banks(Differ::actuators); }
TEST_CASE("modes that differ in sensors") { check_banks(Differ::sensors); }
TEST_CASE("modes that differ in everything") { check_banks(Differ::models); }
TEST_CASE("banks of samples that lack outputs") {
  for (const Differ what : {Differ::actuators, Differ::sensors, Differ::models})
    check_banks(what, "", true);
}
TEST_CASE("banks of interval matrices, with gaps and without") {
  for (const Differ what : {Differ::actuators, Differ::sensors, Differ::models}) {
    check_banks(what, "", false, true);
    check_banks(what, "", true, true);
    check_banks(what, "prediction_correction", false, true);
    check_banks(what, "prediction_correction", true, true);
  }
}
TEST_CASE("estimates in place of residuals") {
  for (const std::string observer : {"prediction_correction", "descriptor"}) {
    CAPTURE(observer);
    check_banks(Differ::actuators, observer);
    check_banks(Differ::sensors, observer);
    check_banks(Differ::models, observer);
  }
}

TEST_CASE("without reductions, residual sets end in those that were promised in advance") {
  for (const Differ what : {Differ::actuators, Differ::sensors, Differ::models}) {
    int pairs = 0, told_apart = 0;
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      CAPTURE(seed);
      RandomBank random = random_bank(seed, what);
      random.parameters.set("max_generators", std::int64_t{100'000});
      const auto sets = backend("zonotope");
      if (!registry()
               .check<DiagnoserEntry>("observer_bank", {random.bank, sets}, random.parameters)
               .empty())
        continue;
      const auto diagnoser =
          registry().make<DiagnoserEntry>("observer_bank", {random.bank, sets}, random.parameters);
      const auto promised = diagnoser->guarantees();
      REQUIRE(promised.has_value());
      Draw draw{std::mt19937_64(seed), seed % 2 == 0};
      const Index truth = below(draw, random.bank.size());
      Vector x = draw.from(random.bank[truth].model.X0);
      diagnoser->start();
      Diagnosis last;
      for (Index k = 0; k < 100; ++k) {  // what is left of the start is far below the slack
        const Vector u = draw.from(random.bank[0].model.U);
        last =
            diagnoser->step({k, u, simulate(at_this_step(random.bank[truth], draw), x, u, draw)});
      }
      for (const PairGuarantee& pair : promised->pairs) {
        if (pair.mode != truth) continue;
        CAPTURE(pair.observer);
        const Box& R = last.modes[static_cast<std::size_t>(pair.observer)].residual;
        const double slack = 1e-3 * (1 + pair.residual.longest_half_edge());
        CHECK((R.lower.array() >= pair.residual.lower.array() - slack).all());
        CHECK((R.upper.array() <= pair.residual.upper.array() + slack).all());
        ++pairs;
        if (R.dim() > 1 || pair.observer == truth || pair.holds != Answer::yes) continue;
        CHECK_FALSE(R.contains(Vector::Zero(1)));
        ++told_apart;
      }
    }
    CHECK(pairs > 0);
    CHECK(told_apart > 0);
  }
}

TEST_CASE("numbers that cancel leave rounding errors, which exclude nothing") {
  Model model;
  LinearModel& m = model.linear;
  m.A = .9 * Matrix::Identity(2, 2);
  m.B = Matrix{{1}, {1}};
  m.Bw = Matrix(2, 0);
  m.C = Matrix{{1, -1}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix(1, 0);
  model.X0 = make_point(Vector{{1e6, 1e6}});
  model.W = model.V = make_point(Vector(0));
  model.U = box_around(Vector::Constant(1, 1e6), Vector::Constant(1, 1e6));
  ModeBank bank{{{"healthy", model}, {"fault", model}}, 0};
  bank.modes[1].model.linear.B = Matrix{{1}, {1 - 1e-5}};  // small, but beyond rounding
  Params params;
  params.set("gain", Matrix{{.3}, {-.1}}).set("waiting_time", std::int64_t{5});
  for (const bool two_outputs : {false, true}) {
    CAPTURE(two_outputs);
    if (two_outputs) {
      for (Mode& mode : bank.modes) {
        mode.model.linear.C = Matrix{{1, -1}, {-1, 1}};
        mode.model.linear.D = Matrix::Zero(2, 1);
        mode.model.linear.Dv = Matrix(2, 0);
      }
      params.set("gain", Matrix{{.3, 0}, {-.1, .1}});
    }
    for (const std::string name :
         {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
      CAPTURE(name);
      const auto diagnoser =
          registry().make<DiagnoserEntry>("observer_bank", {bank, backend(name)}, params);
      Draw draw{std::mt19937_64(1)};
      Vector x = model.X0.c;
      for (Index k = 0; k < 100; ++k) {
        CAPTURE(k);
        const Vector u = draw.from(model.U), y = simulate(bank[0].model, x, u, draw);
        REQUIRE(diagnoser->step({k, u, y}).modes[0].consistent != Answer::no);
      }
      for (Index k = 100; k < 103; ++k) {
        const Vector u = Vector::Constant(1, 1e6), y = simulate(bank[1].model, x, u, draw);
        CHECK(diagnoser->step({k, u, y}).reset == (k == 101));
      }
    }
  }
}
