// SPDX-License-Identifier: GPL-3.0-or-later
// What rounding can do to the filter: systems in which it grows, cancels or decides.
#include <cmath>

#include <rapidcheck.h>

#include "diagnosers/fault_estimation_filter/filter_rounding.hpp"
#include "fault_estimation/filters.hpp"

using namespace faults;

namespace {

Model lti(const Matrix& A, const Matrix& C, const Matrix& F) {
  Model model;
  LinearModel& m = model.linear;
  m.A = A;
  m.B = Matrix::Zero(A.rows(), 1);
  m.C = C;
  m.D = Matrix::Zero(C.rows(), 1);
  m.F = F;
  m.Bw = Matrix(A.rows(), 0);
  m.Dv = Matrix(C.rows(), 0);
  model.X0 = make_point(Vector::Zero(A.rows()));
  model.W = make_point(Vector(0));
  model.V = make_point(Vector(0));
  return model;
}

double promised(const Model& model) {
  return filter(model, parameters("shared"))->guarantees()->faults[0].half_width;
}

}  // namespace

TEST_CASE("rounding errors of earlier steps grow with an unstable error map") {
  // the zero 1.2 of the fault's transfer function is an eigenvalue of TA - G C
  Model model = lti(Matrix{{-.5, 1}, {-.7, 1.2}}, Matrix{{1, 0}}, Matrix{{1}, {0}});
  model.linear.B = Matrix{{1}, {1}};
  model.linear.Bw = Matrix{{1}, {0}};
  model.X0 = make_point(Vector{{.3, .7}});
  model.W = make_zonotope(Vector::Zero(1), .1 * Matrix::Identity(1, 1));
  const auto diagnoser = filter(model, parameters("shared"));
  const auto input = [](Index k) {
    return Vector(Vector::Constant(1, std::sin(.3 * static_cast<double>(k))));
  };
  const Signal none = [](Index) { return Vector(Vector::Zero(1)); };
  const FaultyRun plant(model, input, none, Draw{std::mt19937_64(1), Noise::uniform});
  CHECK(run(*diagnoser, plant, none, 400,
            [](const Diagnosis& now) { CHECK(now.modes[0].candidate); }) == 400);
  CHECK(std::isinf(promised(model)));
}

TEST_CASE("rounding stays next to nothing where the error map is stable, however it turns") {
  // eigenvalues below .8, and a row sum of magnitudes of 2.7: boxes around sets grow with each step
  Model model = lti(Matrix{{.728, .209, -.273}, {.512, -.621, .078}, {-.581, .46, .106}},
                    Matrix{{.563, -.723, .46}}, Matrix{{.589}, {-.732}, {-.792}});
  model.linear.Bw = Matrix::Identity(3, 3);
  model.linear.Dv = Matrix::Identity(1, 1);
  model.W = make_zonotope(Vector::Zero(3), .02 * Matrix::Identity(3, 3));
  model.V = make_zonotope(Vector::Zero(1), .05 * Matrix::Identity(1, 1));
  model.X0 = make_zonotope(Vector::Zero(3), .5 * Matrix::Identity(3, 3));
  const auto diagnoser = filter(model, parameters("shared", 0));
  const Signal none = [](Index) { return Vector(Vector::Zero(1)); };
  const FaultyRun plant(
      model, [](Index) { return Vector(Vector::Zero(1)); }, none,
      Draw{std::mt19937_64(1), Noise::uniform});
  Diagnosis last;
  run(*diagnoser, plant, none, 1000, [&](const Diagnosis& now) { last = now; });
  const double half_width = (last.faults.at(0).upper - last.faults.at(0).lower) / 2;
  CHECK(half_width <= diagnoser->guarantees()->faults[0].half_width * (1 + 1e-8));
}

TEST_CASE("a transient that has passed leaves its rounding errors behind") {
  Model model =
      lti(Matrix{{-.5, 1}, {-.495, .99}}, Matrix{{1, 0}}, Matrix{{1}, {0}});  // a zero at .99
  const auto diagnoser = filter(model, parameters("shared"));
  const Signal pulse = [](Index k) { return Vector(Vector::Constant(1, k == 20 ? 1e9 : 0)); };
  const FaultyRun plant(
      model, [](Index) { return Vector(Vector::Zero(1)); }, pulse,
      Draw{std::mt19937_64(1), Noise::none});
  run(*diagnoser, plant, pulse, 400);
}

TEST_CASE("outputs that repeat each other give no gain made of rounding") {
  Model model = lti(Matrix{{.5, .5}, {.3, -.6}}, Matrix{{1, .3}, {.37, .111}}, Matrix{{1}, {.5}});
  model.linear.Bw = Matrix::Identity(2, 2);
  model.X0 = make_zonotope(Vector::Zero(2), .1 * Matrix::Identity(2, 2));
  model.W = make_zonotope(Vector::Zero(2), .01 * Matrix::Identity(2, 2));
  const Signal step = [](Index k) { return Vector(Vector::Constant(1, k < 50 ? 0 : 1)); };
  for (const bool noise : {false, true}) {
    if (noise) {
      model.linear.Dv = Matrix{{1}, {.37}};
      model.V = make_zonotope(Vector::Zero(1), .01 * Matrix::Identity(1, 1));
    }
    const FaultyRun plant(
        model, [](Index) { return Vector(Vector::Zero(1)); }, step,
        Draw{std::mt19937_64(1), Noise::uniform});
    double widest = 0;
    run(*filter(model, parameters("shared")), plant, step, 1000, [&](const Diagnosis& now) {
      for (const FaultBound& bound : now.faults)
        widest = std::max(widest, (bound.upper - bound.lower) / 2);
    });
    CHECK(widest < .5);
    CHECK(promised(model) <= widest * (1 + 1e-6));
    CHECK(promised(model) > .01);
  }
}

TEST_CASE("large signals beside outputs that are exact, and that repeat each other") {
  Model model = lti(Matrix{{0, 0}, {.3, .7}}, Matrix{{0, 1}, {1, 0}, {0, 1}}, Matrix{{1}, {0}});
  model.linear.B = model.linear.F;
  model.linear.Bw = Matrix{{0}, {.02}};
  model.linear.Dv = Matrix{{0}, {0}, {.2}};
  model.X0 = make_zonotope(Vector::Zero(2), Matrix::Identity(2, 2));
  model.W = model.V = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  const Signal none = [](Index) { return Vector(Vector::Zero(1)); };
  const Signal pulses = [](Index k) { return Vector(Vector::Constant(1, k % 4 == 0 ? 1e9 : 0)); };
  for (const char* coupling : {"shared", "independent"}) {
    run(*filter(model, parameters(coupling)),
        FaultyRun(model, pulses, none, Draw{std::mt19937_64(1)}), none, 60,
        [](const Diagnosis& now) { CHECK(now.modes[0].candidate); });
    run(*filter(model, parameters(coupling)),
        FaultyRun(model, none, pulses, Draw{std::mt19937_64(1)}), pulses, 60);
  }
}

/// Dense, or with zeros and entries in tenths; outputs that repeat each other; noise in a part.
Model random_model(Draw& draw) {
  const Index n = 2 + draw.below(4), q = 1 + draw.below(2), p = 3 + draw.below(2);
  const bool dense = draw.below(2) == 0;
  const auto entries = [&](Index rows, Index cols) {
    return Matrix(draw.matrix(rows, cols).unaryExpr([&](double x) {
      return dense ? x : draw.below(3) == 0 ? std::round(10 * x) / 10 : 0;
    }));
  };
  Matrix A = entries(n, n), C = entries(p, n);
  A *= .9 / std::max(1e-3, A.cwiseAbs().rowwise().sum().maxCoeff());
  C.row(p - 1) = (dense ? .3 : 1) * C.row(0);
  Model model = lti(A, C, entries(n, q));
  model.linear.B = entries(n, 1);
  model.linear.Bw = Matrix::Identity(n, n);
  model.linear.Dv = Matrix::Identity(p, p);
  const auto partly_exact = [&](Index rows) {
    Vector radii = .2 * draw.matrix(rows, 1).cwiseAbs();
    for (double& radius : radii) radius *= static_cast<double>(draw.below(2));
    return make_zonotope(Vector::Zero(rows), radii.asDiagonal().toDenseMatrix());
  };
  model.X0 = partly_exact(n);
  model.W = partly_exact(n);
  model.V = partly_exact(p);
  return model;
}

TEST_CASE("large signals in random systems with exact and repeated outputs") {
  Index bounds = 0;
  CHECK(rc::check([&](std::uint64_t seed) {
    Draw draw{std::mt19937_64(seed)};
    const Model model = random_model(draw);
    const Params params = parameters(draw.below(2) == 0 ? "shared" : "independent", 12);
    RC_PRE(
        banks::registry()
            .check<DiagnoserEntry>("fault_estimation_filter", {alone(model), zonotopes()}, params)
            .empty());
    const Signal pulses = [](Index k) { return Vector(Vector::Constant(1, k % 4 == 0 ? 1e9 : 0)); };
    const bool in_fault = draw.below(3) == 0;
    const Signal fault = [&](Index k) {
      return Vector(Vector::Constant(model.linear.faults(), in_fault && k % 7 == 3 ? 1e7 : 0));
    };
    bounds += run(*filter(model, params),
                  FaultyRun(model, pulses, fault, Draw{std::mt19937_64(seed + 1), Noise::uniform}),
                  fault, 40);
  }));
  CHECK(bounds > 3000);
}

TEST_CASE("a large fault that shows by the smallest entries") {
  // T = I - N C has the entry -c₁ c₂ / (1 + CCᵀ): it is far below the others, and F₂ large
  const Signal none = [](Index) { return Vector(Vector::Zero(1)); };
  Index given = 0;
  for (const double c1 : {1., 30., 100., 300.}) {
    for (const double c2 : {1e-10, 1e-12, -1e-13, 1e-15}) {
      for (const double f1 : {1e-7, -1e-8, 1e-9, 0.}) {
        for (const double f2 : {1e3, 1e6}) {
          Model model = lti(Matrix::Zero(2, 2), Matrix{{c1, c2}}, Matrix{{f1}, {f2}});
          model.linear.Dv = Matrix{{1e-9}};
          model.V = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
          if (!banks::registry()
                   .check<DiagnoserEntry>("fault_estimation_filter", {alone(model), zonotopes()},
                                          {})
                   .empty())
            continue;
          ++given;
          const Signal step = [](Index k) { return Vector(Vector::Constant(1, k < 3 ? 0 : 1000)); };
          run(*filter(model, {}), FaultyRun(model, none, step, Draw{std::mt19937_64(1)}), step, 10);
        }
      }
    }
  }
  CHECK(given > 50);
}

TEST_CASE("a design whose rounding decides how large a fault is gives no bounds") {
  const Model model = lti(Matrix::Zero(2, 2), Matrix{{100, 1e-12}}, Matrix{{1e-8}, {1e6}});
  std::vector<Diagnostic> problems;
  auto design = estimators::design_filter(model.linear, Matrix::Zero(2, 3), problems);
  REQUIRE(design);
  const estimators::FilterNoise none{Matrix(2, 0), Matrix(1, 0)};
  const auto slack_of = [&](const estimators::FilterDesign& of) {
    estimators::FilterRecursion recursion(of, model.linear, none, 4,
                                          estimators::NoiseCoupling::shared);
    recursion.start(Matrix(2, 0));
    estimators::FilterRounding rounding(of, model.linear, none);
    rounding.start({Vector::Zero(2), Vector::Zero(1), Vector::Ones(1)}, recursion);
    return rounding.slack()[0];
  };
  CHECK(slack_of(*design) < .1);
  design->T(0, 1) = 0;  // 1e-14 of the largest entry, and most of what the fault shows
  design->Psi = design->T * model.linear.F;
  design->Upsilon = model.linear.C * design->Psi;
  design->M = design->Upsilon.cwiseInverse();
  CHECK_THROWS_WITH_AS(slack_of(*design),
                       doctest::Contains("rounding decides how large a fault is"), Error);
}

TEST_CASE("faults that nearly the same outputs tell apart, in other units") {
  const Matrix I = Matrix::Identity(2, 2);
  const Signal none = [](Index) { return Vector(Vector::Zero(1)); };
  const Signal first = [](Index k) { return Vector{{k % 3 == 0 ? 1e7 : 0, 0}}; };
  for (const double unit : {1., 300., 2e4}) {
    for (const double turn : {.1, .7, 1.3}) {
      const Matrix turned{{std::cos(turn), std::sin(turn)}, {-std::sin(turn), std::cos(turn)}};
      const Model model = lti(.5 * turned, Matrix{{unit, unit}, {0, 1}}, I);
      run(*filter(model, parameters("shared")),
          FaultyRun(model, none, first, Draw{std::mt19937_64(1)}), first, 40);
    }
  }
}

TEST_CASE("no promise where errors stay or grow slowly") {
  Model model = lti(Matrix{{.5, 1}, {0, 1}}, Matrix{{1, 0}}, Matrix{{1}, {0}});
  model.linear.Bw = Matrix::Identity(2, 2);
  model.linear.Dv = Matrix{{.001}};
  model.X0 = make_zonotope(Vector::Zero(2), Matrix{{.1, 0}, {0, .5}});
  model.W = make_zonotope(Vector::Zero(2), Matrix{{.001, 0}, {0, 1e-7}});
  model.V = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  CHECK(std::isinf(promised(model)));
  model.linear.A = Matrix{{-.5, 1}, {-.7, 1.02}};  // grows from almost nothing
  model.X0 = make_zonotope(Vector::Zero(2), Matrix{{.1, 0}, {0, 1e-30}});
  model.W = make_zonotope(Vector::Zero(2), Matrix{{.001}, {0}});
  CHECK(std::isinf(promised(model)));
}

TEST_CASE("whether a fault shows does not depend on units") {
  // f acts on the measured state by 1e-13 of what it does to the other, and is seen a step later
  Model model = lti(Matrix{{.5, 0}, {1, .5}}, Matrix{{0, 1}}, Matrix{{1}, {1e-13}});
  const auto seen = [](const Model& of) {
    return filter(of, parameters("shared"))->guarantees()->faults[0].delay;
  };
  CHECK(seen(model) == 1);
  model.linear.F = Matrix{{1}, {0}};
  CHECK(seen(model) == 2);
  model.linear.A = .5 * Matrix::Identity(2, 2);
  model.linear.F = Matrix{{1e13}, {1}};
  CHECK(seen(model) == 1);
  Model small = published();
  small.linear.E *= 1e-9;
  small.linear.A *= 1e-9;
  small.linear.B *= 1e-9;
  small.linear.F *= 1e-9;
  small.linear.Bw *= 1e-9;
  const auto problems = banks::registry().check<cordon::DiagnoserEntry>(
      "fault_estimation_filter", {alone(small), zonotopes()}, parameters("shared"));
  for (const Diagnostic& problem : problems)
    CHECK(problem.message.find("not show") == std::string::npos);
}

TEST_CASE("among several modes the filter does not come back to one of them") {
  Model model = published();
  ModeBank bank = alone(model);
  bank.modes.push_back({"other", model});
  const auto diagnoser = banks::registry().make<cordon::DiagnoserEntry>(
      "fault_estimation_filter", {bank, zonotopes()}, parameters("shared"));
  const Signal pulse = [](Index k) { return Vector(Vector{{k >= 20 && k < 30 ? 1.0 : 0.0, 0.0}}); };
  const FaultyRun plant(
      model, [](Index) { return Vector(Vector::Zero(2)); }, pulse,
      Draw{std::mt19937_64(1), Noise::uniform});
  run(*diagnoser, plant, pulse, 60, [](const Diagnosis& now) {
    const Decision expected = now.k <= 20   ? Decision::monitoring
                              : now.k <= 30 ? Decision::isolating
                                            : Decision::ambiguous;
    CHECK(now.decision == expected);
    CHECK(now.mode == (now.k <= 20 ? 0 : -1));
  });
}
