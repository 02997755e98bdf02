// SPDX-License-Identifier: GPL-3.0-or-later
// A disturbance that acts on two states alike is wide in both, and nothing across: there an output
// without noise sees what rounding leaves of terms that cancel. Trajectories in rational numbers
// that keep to the model: no estimate of them is empty, no mode of theirs excluded, no output of
// theirs left out as an outlier.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"
#include "diagnosis/with_observer.hpp"
#include "solvers/rational.hpp"

using namespace cordon;
using namespace banks;
using rational::Rational;

namespace {

constexpr const char* backends[] = {"zonotope", "constrained_zonotope", "line_zonotope"};
constexpr double noise = 1e-19;
constexpr int most_gained = 4;  // seeds: to certify a gain takes a while

double decimal(double x, int digits) {
  const double scale = std::pow(10., digits);
  return std::round(x * scale) / scale;
}

/// Two numbers of many digits and two large ones whose products nearly cancel, in two rows.
struct Cancelling {
  Matrix rows{2, 2};
  Vector factors{2};

  Cancelling(std::mt19937& engine, double size) {
    std::uniform_real_distribution<double> draw(.1, 1), large(size / 2, size);
    const double a = decimal(draw(engine), 2), b = decimal(draw(engine), 2);
    rows << a, b, decimal(.7 * a, 3), decimal(.7 * b, 3);
    factors[0] = decimal(large(engine), 4);
    factors[1] = decimal(-a * factors[0] / b, 4);
  }
};

/// x_3⁺ = x_1 - x_2 and y = x_3, with (w, w) in x_1⁺ and x_2⁺. The products enter as B u, or as A x
/// of two further states that are known exactly.
Model seen_across(const Cancelling& pair, bool by_input) {
  const Index n = by_input ? 3 : 5;
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix::Zero(n, n);
  m.A(2, 0) = 1;
  m.A(2, 1) = -1;
  m.B = Matrix::Zero(n, by_input ? 2 : 0);
  if (by_input) {
    m.B.topRows(2) = pair.rows;
  } else {
    m.A.block(0, 3, 2, 2) = pair.rows;
  }
  m.Bw = Matrix::Zero(n, 1);
  m.Bw(0, 0) = m.Bw(1, 0) = 1;
  m.C = Matrix::Zero(1, n);
  m.C(0, 2) = 1;
  m.D = Matrix::Zero(1, m.B.cols());
  m.Dv = Matrix{{1}};
  Vector start = Vector::Zero(n);
  if (!by_input) start.tail(2) = pair.factors;
  model.X0 = make_point(start);
  model.W = make_box({Vector{{-2}}, Vector{{2}}});
  model.V = make_box({Vector{{-noise}}, Vector{{noise}}});
  const Vector most = Vector::Constant(m.B.cols(), 1e6);
  model.U = make_box({-most, most});
  return model;
}

/// Samples of the model, which begins with w = 1 and the inputs that cancel.
std::vector<Sample> samples_of(const Model& model, const Cancelling& pair) {
  const LinearModel& m = model.linear;
  const Index n = m.states();
  rational::RationalVector x;
  for (Index i = 0; i < n; ++i) x.push_back(rational::exact(model.X0.c[i]));
  std::vector<Sample> samples;
  for (Index k = 0; k < 4; ++k) {
    const Vector u = k == 0 && m.B.cols() > 0 ? pair.factors : Vector(Vector::Zero(m.B.cols()));
    samples.push_back({k, u, Vector{{x[2].get_d()}}});
    rational::RationalVector next(static_cast<std::size_t>(n));
    for (Index i = 0; i < n; ++i) {
      Rational& to = next[static_cast<std::size_t>(i)];
      for (Index j = 0; j < n; ++j)
        to += rational::exact(m.A(i, j)) * x[static_cast<std::size_t>(j)];
      for (Index j = 0; j < u.size(); ++j) to += rational::exact(m.B(i, j)) * rational::exact(u[j]);
      if (k == 0) to += rational::exact(m.Bw(i, 0));
    }
    x = std::move(next);
  }
  return samples;
}

ModeBank beside_a_bias(const Model& model) {
  ModeBank bank{{{"healthy", model}, {"biased", model}}, 0};
  bank.modes[1].model.V = make_box({Vector{{1}}, Vector{{2}}});
  return bank;
}

}  // namespace

TEST_CASE("observers and banks keep what cancelling terms leave of the truth") {
  std::mt19937 engine(7);
  for (int seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const Cancelling pair(engine, 1e4);
    const bool by_input = seed % 4 != 0;
    const Model model = seen_across(pair, by_input);
    const std::vector<Sample> samples = samples_of(model, pair);
    const Matrix none = Matrix::Zero(model.linear.states(), 1);
    for (const char* name : backends) {
      CAPTURE(name);
      for (const bool is_gained : {false, true}) {
        if (is_gained && seed >= most_gained) continue;
        CAPTURE(is_gained);
        Params params;
        if (is_gained) params.set("gain", none);
        const auto observer = registry().make<ObserverEntry>(
            is_gained ? "luenberger" : "prediction_correction", {model, backend(name)}, params);
        observer->leave_out_outliers(1, 4);
        Params of_bank = diagnosis_test::with_observer("prediction_correction", {}, 2);
        if (is_gained) of_bank = Params().set("waiting_time", std::int64_t{2}).set("gain", none);
        const auto diagnoser =
            registry().make<DiagnoserEntry>(is_gained ? "observer_bank" : "consistency_bank",
                                            {beside_a_bias(model), backend(name)}, of_bank);
        diagnoser->start();
        for (const Sample& sample : samples) {
          CAPTURE(sample.k);
          CHECK(observer->step(sample).consistent != Answer::no);
          CHECK(observer->left_out().empty());
          CHECK(diagnoser->step(sample).modes[0].consistent != Answer::no);
        }
      }
    }
  }
}

namespace {

/// D u + x as the double next to it.
double output_of(const Cancelling& pair, const Rational& x) {
  Rational sum = x;
  for (Index j = 0; j < 2; ++j)
    sum += rational::exact(pair.rows(0, j)) * rational::exact(pair.factors[j]);
  return sum.get_d();
}

/// x⁺ = x/2 + f, y = x + D u + v with f known, from x = 0.
Model leaking(const Cancelling& pair, double f) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.B = Matrix::Zero(1, 2);
  m.C = m.Bw = m.Dv = Matrix{{1}};
  m.D = pair.rows.topRows(1);
  model.X0 = make_point(Vector{{0}});
  model.W = make_point(Vector{{f}});
  model.V = make_box({Vector{{-noise}}, Vector{{noise}}});
  const Vector most = Vector::Constant(2, 1e7);
  model.U = make_box({-most, most});
  return model;
}

std::shared_ptr<const SetBackend> rounding(const std::string& name, const std::string& mode) {
  return registry().make<BackendEntry>(name, Params().set("rounding", mode));
}

}  // namespace

TEST_CASE("a bank that is reset at a sample of such inputs keeps the mode that explains it") {
  constexpr double f = 1. / 1024;
  std::mt19937 engine(8);
  for (int seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    const Cancelling pair(engine, 1e5);
    const ModeBank bank{{{"healthy", leaking(pair, 0)}, {"leak", leaking(pair, f)}}, 0};
    for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
      for (const char* mode : {"nominal", "outward"}) {
        CAPTURE(name);
        CAPTURE(mode);
        Params params;
        params.set("waiting_time", std::int64_t{2}).set("gain", Matrix{{0}});
        const auto diagnoser =
            registry().make<DiagnoserEntry>("observer_bank", {bank, rounding(name, mode)}, params);
        diagnoser->start();
        Rational x = 0;
        for (Index k = 0; k < 4; ++k) {
          CAPTURE(k);
          const Vector u = k == 1 ? pair.factors : Vector(Vector::Zero(2));
          const double y = k == 1 ? output_of(pair, x) : x.get_d();
          const Diagnosis now = diagnoser->step({k, u, Vector{{y}}});
          if (k > 0) CHECK(now.modes[1].consistent != Answer::no);
          x = x / 2 + rational::exact(f);
        }
      }
    }
  }
}

TEST_CASE("an output beside such inputs is no outlier") {
  std::mt19937 engine(9);
  for (int seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const Cancelling pair(engine, 1e4);
    const Model model = leaking(pair, 0);
    for (const char* name : {"interval", "zonotope", "line_zonotope"}) {
      for (const char* mode : {"nominal", "outward"}) {
        CAPTURE(name);
        CAPTURE(mode);
        const auto observer = registry().make<ObserverEntry>("prediction_correction",
                                                             {model, rounding(name, mode)}, {});
        observer->leave_out_outliers(1, 4);
        CHECK(observer->step({0, pair.factors, Vector{{output_of(pair, 0)}}}).consistent !=
              Answer::no);
        CHECK(observer->left_out().empty());
      }
    }
  }
}

TEST_CASE("a set that is flat by its constraints is taken as such") {
  // the state stays 0, y_1 = .3 (u_1 + u_2) = .3 exactly, and constraints leave no noise of it
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.B = Matrix{{0, 0}};
  m.Bw = Matrix{{1}};
  m.C = Matrix{{1}, {0}};
  m.D = Matrix{{0, 0}, {.3, .3}};
  m.Dv = Matrix::Identity(2, 2);
  model.X0 = make_box({Vector{{-1}}, Vector{{1}}});
  model.W = make_box({Vector{{-.5}}, Vector{{.5}}});
  model.V = {Matrix(2, 0),       Matrix{{.125, 0, 0}, {0, 1, -1}}, Vector::Zero(2), Matrix(1, 0),
             Matrix{{0, 1, -1}},  // ξ₂ = ξ₃
             Vector{{0}}};
  model.U = make_space(2);
  for (const char* name : {"constrained_zonotope", "line_zonotope"}) {
    for (const std::int64_t generators : {3, 4, 6}) {
      CAPTURE(name);
      CAPTURE(generators);
      const auto observer =
          registry().make<ObserverEntry>("prediction_correction", {model, backend(name)},
                                         Params().set("max_generators", generators));
      Index k = 0;
      for (const double u : {123.25, -577.75, 811.5, -345.125, 997.25}) {
        CAPTURE(k);
        CHECK(observer->step({k++, Vector{{u, 1 - u}}, Vector{{0, .3}}}).consistent != Answer::no);
      }
    }
  }
}
