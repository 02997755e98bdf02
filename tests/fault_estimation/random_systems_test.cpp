// SPDX-License-Identifier: GPL-3.0-or-later
// Random systems with and without E, with delays of one to three steps: the true faults lie within
// their bounds.
#include <algorithm>
#include <cmath>
#include <limits>

#include <rapidcheck.h>

#include "fault_estimation/filters.hpp"

using namespace cordon;
using namespace faults;

namespace {

constexpr Index steps = 40;

LineForm random_set(Draw& draw, Index n, double size) {
  return make_zonotope(draw.matrix(n, 1), size * draw.matrix(n, n + draw.below(3)));
}

/// Faults in its null space show `delay` steps later or not at all: [C T; C TA T; …].
Matrix silent_rows(const LinearModel& m, const Matrix& T, Index delay) {
  const Index p = m.outputs();
  Matrix rows(p * (delay - 1), m.states()), block = m.C;
  for (Index i = 0; i + 1 < delay; ++i) {
    rows.middleRows(i * p, p) = block * T;
    block = block * T * m.A;
  }
  return rows;
}

/// A system with its filter's free matrix and delays.
struct System {
  Model model;
  Matrix S;
  std::vector<Index> delays;
};

System random_system(Draw& draw) {
  System made;
  LinearModel& m = made.model.linear;
  const Index n = 2 + draw.below(4), p = 1 + draw.below(std::min<Index>(n, 3)),
              q = 1 + draw.below(p);
  m.A = draw.matrix(n, n);
  m.A *= .9 / m.A.cwiseAbs().rowwise().sum().maxCoeff();
  m.B = draw.matrix(n, 2);
  m.Bw = draw.matrix(n, 2);
  m.C = draw.matrix(p, n);
  m.D = draw.matrix(p, 2);
  m.Dv = draw.matrix(p, p);
  Matrix E = Matrix::Identity(n, n);
  if (draw.below(3) > 0) {  // of full rank, or with static rows
    E += .3 * draw.matrix(n, n);
    const Index r = n - draw.below(p + 1);
    E = draw.matrix(n, r) * E.topRows(r);
    m.E = E;
  }
  made.model.W = random_set(draw, 2, .05);
  made.model.V = random_set(draw, p, .05);
  Matrix theta(n + p, n);
  theta << E, m.C;
  const Matrix inverse = linalg::pseudo_inverse(theta);
  made.S = draw.below(2) * draw.matrix(n, n + p);
  const Matrix T =
      (inverse + made.S * (Matrix::Identity(n + p, n + p) - theta * inverse)).leftCols(n);
  m.F = Matrix(n, q);
  for (Index i = 0; i < q; ++i) {
    Index delay = 1 + draw.below(3);
    Matrix basis = linalg::null_space(silent_rows(m, T, delay));
    for (; basis.cols() == 0; basis = linalg::null_space(silent_rows(m, T, delay))) --delay;
    m.F.col(i) = basis * draw.matrix(basis.cols(), 1);
    made.delays.push_back(delay);
  }
  made.model.X0 = make_point(draw.matrix(n, 1));
  return made;
}

/// Can its run be computed, step by step?
bool is_causal(const LinearModel& m) {
  if (!m.is_descriptor()) return true;
  const linalg::Svd svd = linalg::svd(m.E);
  const Index n = m.states(), r = linalg::rank(m.E);
  Matrix left(n, n);
  left << svd.U.leftCols(r).transpose() * m.E, svd.U.rightCols(n - r).transpose() * m.A;
  const Vector sigma = linalg::svd(left).sigma;
  return sigma[n - 1] > 1e-3 * sigma[0];
}

Signal random_faults(Draw& draw, Index q) {
  std::vector<Vector> table;
  for (Index k = 0; k <= steps + 1; ++k) {
    const double size = k < 5 || draw.below(4) == 0 ? 0.0 : draw.below(5) == 0 ? 100.0 : 3.0;
    table.push_back(size * draw.matrix(q, 1));
  }
  return [table](Index k) { return table[static_cast<std::size_t>(k)]; };
}

Model with_start(Model model, const Vector& x) {
  model.X0 = make_point(x);
  return model;
}

/// A box around the states of a run.
LineForm states_of(FaultyRun plant) {
  Box box{plant.state(), plant.state()};
  for (Index k = 0; k <= steps; ++k) {
    box = {box.lower.cwiseMin(plant.state()), box.upper.cwiseMax(plant.state())};
    plant.step();
  }
  return make_box(box);
}

Vector wave(Index k) { return Vector{{std::sin(.3 * static_cast<double>(k)), 1}}; }

}  // namespace

TEST_CASE("random systems") {
  Index found[4] = {0, 0, 0, 0}, descriptors = 0, fine = 0;
  CHECK(rc::check([&](std::uint64_t seed) {
    Draw draw{std::mt19937_64(seed)};
    System system = random_system(draw);
    RC_PRE(is_causal(system.model.linear));
    const std::int64_t columns = draw.below(2) == 0 ? 0 : 12;
    Params params = parameters(draw.below(2) == 0 ? "shared" : "independent", columns);
    params.set("free_matrix", system.S);
    const auto problems = banks::registry().check<DiagnoserEntry>(
        "fault_estimation_filter", {alone(system.model), zonotopes()}, params);
    RC_PRE(problems.empty());
    const Signal fault = random_faults(draw, system.model.linear.faults());
    const Noise noise = draw.below(2) == 0 ? Noise::uniform : Noise::vertex;
    const FaultyRun plant(system.model, wave, fault, Draw{std::mt19937_64(seed + 1), noise});
    const Matrix start = draw.matrix(plant.state().size(), 1 + draw.below(6));
    Vector inside = draw.matrix(start.cols(), 1);
    if (noise == Noise::vertex) inside = inside.cwiseSign();
    system.model.X0 = make_zonotope(plant.state() - start * inside, start);
    const auto diagnoser = filter(system.model, params);
    const Index bounds = run(*diagnoser, plant, fault, steps, [&](const Diagnosis& now) {
      for (const FaultBound& b : now.faults) {
        const Index delay = system.delays[static_cast<std::size_t>(b.fault)];
        CHECK(now.k - b.at == delay);
        ++found[delay];
      }
    });
    CHECK(bounds > 0);
    descriptors += system.model.linear.is_descriptor();
    if (columns == 0) return;
    const Guarantees guarantees = *diagnoser->guarantees();
    for (const FaultGuarantee& g : guarantees.faults) {
      if (std::isinf(g.half_width)) return;
    }
    ++fine;  // the same with a millionth of the noise: narrow bounds
    for (LineForm* set : {&system.model.W, &system.model.V}) set->G *= 1e-6;
    const FaultyRun quiet(with_start(system.model, plant.state()), wave, fault,
                          Draw{std::mt19937_64(seed + 2), noise});
    system.model.X0 = make_zonotope(quiet.state() - 1e-6 * start * inside, 1e-6 * start);
    run(*filter(system.model, params), quiet, fault, steps);
  }));
  for (Index delay = 1; delay <= 3; ++delay) CHECK(found[delay] > 500);
  CHECK(descriptors > 50);
  CHECK(fine > 50);
}

TEST_CASE("random systems whose samples lack outputs now and then") {
  Index told = 0, after_gaps = 0;
  CHECK(rc::check([&](std::uint64_t seed) {
    Draw draw{std::mt19937_64(seed)};
    System system = random_system(draw);
    RC_PRE(is_causal(system.model.linear));
    Params params = parameters(draw.below(2) == 0 ? "shared" : "independent");
    params.set("free_matrix", system.S);
    RC_PRE(banks::registry()
               .check<DiagnoserEntry>("fault_estimation_filter", {alone(system.model), zonotopes()},
                                      params)
               .empty());
    const Signal fault = random_faults(draw, system.model.linear.faults());
    const FaultyRun plant(system.model, wave, fault,
                          Draw{std::mt19937_64(seed + 1), Noise::vertex});
    system.model.X0 = make_point(plant.state());
    params.set("admissible_set", states_of(plant));
    Index last_gap = -1;
    const auto lose = [&](Sample sample) {
      if (draw.below(6) != 0) return sample;
      sample.missing = {draw.below(sample.y.size())};
      sample.y[sample.missing[0]] = std::numeric_limits<double>::quiet_NaN();
      last_gap = sample.k;
      return sample;
    };
    told += run(
        *filter(system.model, params), plant, fault, steps,
        [&](const Diagnosis& now) {
          for (const FaultBound& b : now.faults) CHECK(b.at > last_gap);
          after_gaps += last_gap >= 0 && !now.faults.empty();
        },
        lose);
  }));
  CHECK(after_gaps > 500);
  CHECK(told > after_gaps);
}

TEST_CASE("a gap without a set to begin anew from is an error that says so") {
  const Model model = published();
  const auto diagnoser = filter(model, {});
  diagnoser->start();
  Sample sample{0, Vector::Zero(model.linear.inputs()), Vector::Zero(model.linear.outputs())};
  sample.y[1] = std::numeric_limits<double>::quiet_NaN();
  sample.missing = {1};
  CHECK_THROWS_WITH_AS(diagnoser->step(sample),
                       doctest::Contains("output 2 is missing at k = 0, and a fault in a gap may "
                                         "put the state anywhere: give an admissible_set"),
                       Error);
}
