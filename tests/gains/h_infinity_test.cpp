// SPDX-License-Identifier: GPL-3.0-or-later
// Gains by the bounded-real inequality: published plants, and random ones against their own norms.
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "gains/interval_plants.hpp"

using namespace cordon;
using doctest::Approx;

namespace {

const Plugins& plugins() {
  static const Plugins instance;
  return instance;
}

GainDesign design(const char* type, const Model& model, const std::optional<Matrix>& theta = {}) {
  Params params;
  if (theta) params.set("theta", *theta);
  return plugins().registry.make<GainEntry>(type, params)->design(model);
}

/// The norms of a gain, by the component that takes gains as they are; theta follows from A's
/// radius.
GainCertificate certificate_of(const Model& model, const Matrix& L) {
  return plugins()
      .registry.make<GainEntry>("given", Params().set("matrix", L))
      ->design(model)
      .gain.certificate;
}

Matrix closed_loop(const Model& model, const Matrix& L) {
  return model.linear.A - L * model.linear.sensor_center().asDiagonal() * model.linear.C;
}

/// What is told about γ* holds for the gain: it is below the norm's bounds, within what is
/// promised.
void check_gain(const GainDesign& found) {
  INFO(found.reason);
  REQUIRE(found.feasible == Answer::yes);
  const GainCertificate& c = found.gain.certificate;
  CHECK(c.objective == "γ");
  CHECK(c.spectral_radius < 1);
  CHECK(c.optimum_bound == Approx(c.optimum).epsilon(2e-6));
  CHECK(c.norm_upper <= c.optimum * (1 + 1e-4));
  CHECK(c.norm_lower >= c.optimum_bound * (1 - 1e-5));
  CHECK(c.margin > -1e-7);
  CHECK(c.margin < 1e-3);
}

struct Published {
  const char* name;
  Model model;
  Matrix theta;
  double gamma, monotone;  ///< 0: there is no monotone gain
  Matrix monotone_gain;    ///< empty: it is not unique
};

std::vector<Published> published() {
  using namespace interval_plants;
  const Matrix I3 = Matrix::Identity(3, 3), I2 = Matrix::Identity(2, 2);
  return {
      {"(68), I", three_states(), I3, 6.4319320949, 6.4395880046, Matrix{{.3}, {.2}, {.8}}},
      {"(68), .01 I", three_states(), .01 * I3, .6724654558, .6724654558, Matrix()},
      {"(70), I", three_states(-.1), I3, 6.4163496194, 0, Matrix()},
      {"(70), .01 I", three_states(-.1), .01 * I3, .5191263621, 0, Matrix()},
      {"(72), I", two_tanks(), I2, 62.0283918735, 87.7265779883, Matrix{{0}, {.9903}}},
      {"(72), .3 B", two_tanks(), tank_theta(), 1.6147652880, 5.9736234632, Matrix{{0}, {.9903}}}};
}

/// A plant with `n` states, disturbances on all of them and on the outputs; detectable with
/// probability 1.
Model random_plant(Index n, Index p, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&](Index rows, Index cols) {
    return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return uniform(engine); }));
  };
  Model model = interval_plants::with_unit_boxes(draw(n, n), Matrix(n, 0), draw(p, n), .1, .2);
  model.linear.Bw = draw(n, n);
  return model;
}

}  // namespace

TEST_CASE("h_infinity: the published optima") {
  for (const Published& example : published()) {
    INFO(example.name);
    const GainDesign found = design("h_infinity", example.model, example.theta);
    check_gain(found);
    CHECK(found.gain.certificate.optimum == Approx(example.gamma).epsilon(1e-6));
    CHECK(found.gain.certificate.norm_upper <= example.gamma * (1 + 1e-4));
    CHECK(found.gain.type.empty());
  }
}

TEST_CASE("h_infinity_monotone: the published optima, and a plant without a monotone gain") {
  for (const Published& example : published()) {
    INFO(example.name);
    const GainDesign found = design("h_infinity_monotone", example.model, example.theta);
    if (example.monotone == 0) {
      CHECK(found.feasible == Answer::no);
      CHECK(found.reason == "no monotone gain exists: column 2 of C is zero and A(1,2) < 0");
      CHECK_FALSE(found.suggestion.empty());
      continue;
    }
    check_gain(found);
    CHECK(found.gain.certificate.optimum == Approx(example.monotone).epsilon(1e-6));
    CHECK(found.gain.certificate.monotone != Answer::no);
    CHECK((closed_loop(example.model, found.gain.L).array() >= 0).all());
    if (example.monotone_gain.size() > 0)
      CHECK((found.gain.L - example.monotone_gain).cwiseAbs().maxCoeff() < 1e-5);
  }
}

TEST_CASE("h_infinity: one state with a norm in closed form") {
  // e⁺ = (a - L) e + w - L v, |w| ≤ q, |v| ≤ r: the norm is √(q² + L² r²) / (1 - |a - L|). For 0 ≤
  // L ≤ a the least is at the end or where the derivative is zero.
  Model model = interval_plants::with_unit_boxes(Matrix{{.9}}, Matrix(1, 0), Matrix{{1}}, .5, .25);
  double least = 1e9;
  for (double L = 0; L < 1.8; L += 1e-5)
    least = std::min(least, std::hypot(.5, L * .25) / (1 - std::abs(.9 - L)));
  const GainDesign found = design("h_infinity", model);
  check_gain(found);
  CHECK(found.gain.certificate.optimum == Approx(least).epsilon(1e-6));
  SUBCASE("sets that are not unit boxes") {
    model.linear.Bw = Matrix{{1}};
    model.linear.Dv = Matrix{{5}};
    model.W = make_zonotope(
        Vector{{7}}, Matrix{{.3, .4}});  // {7} ⊕ two generators: the norm takes √(.3² + .4²) = .5
    model.V = make_zonotope(Vector{{-1}}, Matrix{{.05}});
    CHECK(design("h_infinity", model).gain.certificate.optimum == Approx(least).epsilon(1e-6));
  }
  SUBCASE("effectiveness by its middle, uncertainty by the radius of A") {
    model.linear.C = Matrix{{2}};
    model.linear.sensor = Box{Vector{{0}}, Vector{{1}}};
    CHECK(design("h_infinity", model).gain.certificate.optimum == Approx(least).epsilon(1e-6));
    model.linear.Bw = Matrix{{.3}};
    model.linear.A_radius = Matrix{{.4}};
    CHECK(design("h_infinity", model).gain.certificate.optimum == Approx(least).epsilon(1e-6));
    CHECK(design("h_infinity", model, Matrix{{0}}).gain.certificate.optimum < .9 * least);
  }
  SUBCASE("other units") {
    model.linear.Bw *= 1e-6;
    model.linear.Dv *= 1e-6;
    CHECK(design("h_infinity", model).gain.certificate.optimum ==
          Approx(1e-6 * least).epsilon(1e-6));
  }
}

TEST_CASE("outputs without noise, and outputs that say the same") {
  Model model = interval_plants::three_states();
  model.linear.Dv = Matrix(1, 0);
  model.V = make_zonotope(Vector(0), Matrix(0, 0));
  const GainDesign found = design("h_infinity", model);
  check_gain(found);
  model.linear.C = Matrix{{0, 0, 1}, {0, 0, 1}};
  model.linear.Dv = Matrix(2, 0);
  const GainDesign twice = design("h_infinity", model);
  check_gain(twice);
  CHECK(twice.gain.certificate.optimum == Approx(found.gain.certificate.optimum).epsilon(1e-5));
}

TEST_CASE(
    "a mode that no gain reaches is named; without disturbances there is nothing to minimise") {
  Model model = interval_plants::two_tanks();
  model.linear.A = Matrix{{1.2, 0}, {0, .5}};
  model.linear.C = Matrix{{0, 1}};
  for (const char* type : {"h_infinity", "h_infinity_monotone"}) {
    const GainDesign found = design(type, model);
    CHECK(found.feasible == Answer::no);
    CHECK_FALSE(found.reason.empty());
  }
  CHECK(design("h_infinity", model).reason.find("1.2") != std::string::npos);
  model = interval_plants::two_tanks();
  model.linear.Bw.setZero();
  model.linear.Dv.setZero();
  for (const char* type : {"h_infinity", "h_infinity_monotone"}) {
    const GainDesign found = design(type, model);
    CHECK(found.feasible == Answer::unknown);
    CHECK(found.reason.find("nothing disturbs") != std::string::npos);
  }
}

TEST_CASE("parameters and sets are checked beforehand") {
  for (const char* type : {"h_infinity", "h_infinity_monotone", "w_radius"}) {
    Model model = interval_plants::two_tanks();
    CHECK(plugins().registry.check<GainEntry>(type, {model}, {}).empty());
    const auto theta = plugins().registry.check<GainEntry>(
        type, {model}, Params().set("theta", Matrix(Matrix::Identity(3, 3))));
    REQUIRE(theta.size() == 1);
    CHECK(theta[0].pointer == "/theta");
    model.W = make_space(2);
    model.V = make_space(1);
    const auto sets = plugins().registry.check<GainEntry>(type, {model}, {});
    REQUIRE(sets.size() == 2);
    CHECK(sets[0].message.find('W') != std::string::npos);
    CHECK(sets[1].message.find('V') != std::string::npos);
    const ComponentInfo* info = plugins().registry.info("gain", type);
    REQUIRE(info != nullptr);
    CHECK(info->citation == "Pourasghar2021");
    CHECK(info->details.find(type == std::string("w_radius") ? "WA - YC" : "PA - MC") !=
          std::string::npos);
  }
}

TEST_CASE("plants whose inequality the solver does not solve in the coordinates of the states") {
  for (const unsigned seed : {288U, 332U, 352U, 373U, 392U, 478U}) {
    INFO(seed);
    std::mt19937_64 engine(seed);
    const Model model = random_plant(3 + seed % 3, 1, engine);
    const GainDesign found = design("h_infinity", model);
    INFO(found.reason);
    REQUIRE(found.feasible == Answer::yes);
    const GainCertificate& c = found.gain.certificate;
    CHECK(c.optimum_bound == Approx(c.optimum).epsilon(2e-6));
    CHECK(c.norm_lower <= c.optimum * (1 + 1e-4));
    CHECK(c.norm_upper >= c.optimum_bound * (1 - 1e-5));
  }
}

TEST_CASE("a bound of the optimum lies below the norm of the gain, in its last digits too") {
  const auto bound_and_norm = [](const Matrix& A, const Matrix& C, const Vector& w,
                                 const Vector& v) {
    Model model = interval_plants::with_unit_boxes(A, Matrix(A.rows(), 0), C, 1, 1);
    model.W = make_box({-w, w});
    model.V = make_box({-v, v});
    const GainDesign found = design("h_infinity", model);
    REQUIRE(found.feasible == Answer::yes);
    const GainCertificate& c = found.gain.certificate;
    CHECK(c.optimum_bound <= c.norm_upper);
    CHECK(c.optimum_bound == Approx(c.optimum).epsilon(1e-7));
  };
  bound_and_norm(Matrix{{.8438, -1.0273, 0}, {.587, -1.4367, -.1468}, {-.3918, 1.0273, -.1673}},
                 Matrix{{.3, .379, .8}, {-.48, -.392, .9}}, Vector{{0, .01, .1}}, Vector{{0, .1}});
  bound_and_norm(
      Matrix{{.24, .264, .604, .5}, {.35, .75, .7, .2}, {.4, .2, .26, 1.08}, {.26, .08, .4, .77}},
      Matrix{{1, 0, 0, 0}, {0, 1, 0, 0}}, Vector{{.1, 1, 0, .01}}, Vector{{0, .1}});
}

TEST_CASE("random plants: the gain keeps γ*, and no other does better") {
  int solved = 0, all = 0;
  CHECK(rc::check("h_infinity", [&](std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const Index n = *rc::gen::inRange<Index>(1, 6), p = *rc::gen::inRange<Index>(1, 3);
    const Model model = random_plant(n, p, engine);
    const GainDesign found = design("h_infinity", model);
    ++all;
    if (found.feasible != Answer::yes) {
      RC_ASSERT(found.feasible == Answer::unknown);
      return;
    }
    ++solved;
    const GainCertificate& c = found.gain.certificate;
    RC_ASSERT(c.norm_lower <= c.optimum * (1 + 1e-4));
    std::normal_distribution<double> normal;
    for (const double size : {1e-2, .3}) {
      const Matrix other =
          found.gain.L + Matrix::NullaryExpr(n, p, [&] { return size * normal(engine); });
      if (linalg::eigenvalues(closed_loop(model, other)).cwiseAbs().maxCoeff() >= 1) continue;
      RC_ASSERT(certificate_of(model, other).norm_upper >= c.optimum_bound);
    }
  }));
  INFO(solved, " of ", all);
  CHECK(solved == all);
}

TEST_CASE("random plants: a monotone gain is monotone, and not better than the best of all") {
  int solved = 0, possible = 0;
  CHECK(rc::check("h_infinity_monotone", [&](std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const Index n = *rc::gen::inRange<Index>(1, 5), p = *rc::gen::inRange<Index>(1, 3);
    Model model = random_plant(n, p, engine);
    std::uniform_real_distribution<double> uniform(0, 1);
    // A - L₀ C with a stable non-negative matrix, so that there is a gain; zeros of it leave no
    // interior.
    const Matrix closed = Matrix::NullaryExpr(
        n, n, [&] { return std::max(0., uniform(engine) - .3) / static_cast<double>(n); });
    const Matrix L0 = Matrix::NullaryExpr(n, p, [&] { return uniform(engine) - .5; });
    model.linear.A = closed + L0 * model.linear.C;
    const GainDesign found = design("h_infinity_monotone", model);
    RC_ASSERT(found.feasible != Answer::no);
    ++possible;
    if (found.feasible != Answer::yes) return;
    ++solved;
    const Matrix after = closed_loop(model, found.gain.L);
    const double size = model.linear.A.cwiseAbs().maxCoeff() + found.gain.L.cwiseAbs().maxCoeff();
    RC_ASSERT(after.minCoeff() >= -1e-12 * size);
    const GainCertificate& c = found.gain.certificate;
    RC_ASSERT(c.norm_lower <= c.optimum * (1 + 1e-4));
    const GainDesign best = design("h_infinity", model);
    if (best.feasible == Answer::yes)
      RC_ASSERT(c.optimum >= best.gain.certificate.optimum * (1 - 1e-5));
  }));
  INFO(solved, " of ", possible);
  CHECK(solved == possible);
}

TEST_CASE("an optimum that the solver cannot resolve is not told") {
  // x⁺ = .5 x + w, y = x + v: the gain 0 has the norm |W| / (1 - .5)
  for (const auto& [w, v] :
       {std::pair{1e-9, 1.0}, {1e-10, 1.0}, {1e-6, 100.0}, {0.0, 1.0}, {1e-3, 1.0}, {.1, .1}}) {
    CAPTURE(w);
    Model model = interval_plants::with_unit_boxes(Matrix{{.5}}, Matrix(1, 0), Matrix{{1}}, w, v);
    for (const char* type : {"h_infinity", "h_infinity_monotone"}) {
      const GainDesign found = design(type, model);
      CHECK(found.feasible == (w >= 1e-3 ? Answer::yes : Answer::unknown));
      if (found.feasible == Answer::yes)
        CHECK(found.gain.certificate.optimum_bound <= 2 * w * (1 + 1e-4));
    }
  }
}
