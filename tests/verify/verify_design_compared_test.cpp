// SPDX-License-Identifier: GPL-3.0-or-later
// Exact proofs of what an input sequence separates, against output tubes and against a designer.
#include <random>
#include <utility>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/design.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"
#include "study/checks/common_runs.hpp"
#include "verify/designs.hpp"

using namespace cordon;
using namespace verify_test;

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
    const TimedModel first(bank[0].model), second(bank[1].model);
    const std::vector<const TimedModel*> both{&first, &second};
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
        .make<DesignerEntry>("given", {bank, examples::backend("line_zonotope")}, params)
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
