// SPDX-License-Identifier: GPL-3.0-or-later
// The sets W of studies of non-linear plants: they hold what the linear models miss of the plants.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/linearisation/linearise.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/study.hpp"
#include "run/scratch.hpp"

using namespace cordon;

namespace {

constexpr int seeds = 400, steps = 100;
/// Inputs over all of U: sines, pseudo-random binary signals, uniform noise.
class InputSignal {
 public:
  InputSignal(const Box& U, int kind, std::mt19937_64& random)
      : U_(U),
        kind_(kind),
        random_(random),
        omega_(uniform(0.01, 2)),
        phase_(uniform(0, 6.3)),
        hold_(1 + random() % 29) {}
  Vector at(int k) {
    if (kind_ == 1 && k % static_cast<int>(hold_) == 0) level_ = random_() % 2 ? 1 : -1;
    const double s = kind_ == 0   ? std::sin(omega_ * k + phase_)
                     : kind_ == 1 ? level_
                                  : uniform(-1, 1);
    return U_.center() + s * U_.radius();
  }
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

 private:
  Box U_;
  int kind_;
  std::mt19937_64& random_;
  double omega_, phase_;
  std::uint64_t hold_;
  double level_ = 1;
};

/// Which mode, and where in its ranges: constant, at the ends, or anew in each step.
class FaultSequence {
 public:
  FaultSequence(const ModeBank& bank, int kind, std::mt19937_64& random)
      : bank_(bank), kind_(kind), random_(random) {
    constant_ = std::uniform_real_distribution<double>(-1, 1)(random_);
  }
  Index mode(int k) {
    if (k >= until_) {
      until_ = k + 1 + static_cast<int>(random_() % 59);
      mode_ = static_cast<Index>(random_() % static_cast<std::uint64_t>(bank_.size()));
    }
    return mode_;
  }
  Vector effectiveness() {
    const LinearModel& model = bank_[mode_].model.linear;
    const double s = kind_ == 0   ? constant_
                     : kind_ == 1 ? (random_() % 2 ? 1.0 : -1.0)
                                  : std::uniform_real_distribution<double>(-1, 1)(random_);
    return model.actuator_center() + s * model.actuator_radius();
  }

 private:
  const ModeBank& bank_;
  int kind_;
  std::mt19937_64& random_;
  double constant_ = 0;
  Index mode_ = 0;
  int until_ = 0;
};

/// Largest |ξ| over the samples, of Bw W = {Bw (c + G ξ)}.
double largest_share(const ModeBank& bank, const Plant& plant) {
  const Model& nominal = bank[bank.nominal].model;
  double largest = 0;
  const Matrix inverse = linalg::pseudo_inverse(linalg::product(nominal.linear.Bw, nominal.W.G));
  const Vector center = linalg::product(nominal.linear.Bw, nominal.W.c);
  const Box U{nominal.U.c - nominal.U.G.cwiseAbs().rowwise().sum(),
              nominal.U.c + nominal.U.G.cwiseAbs().rowwise().sum()};
  for (int seed = 0; seed < seeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    InputSignal input(U, seed % 3, random);
    FaultSequence fault(bank, seed / 3 % 3, random);
    Vector x = nominal.X0.c;
    for (Index g = 0; g < nominal.X0.generators(); ++g)
      x += input.uniform(-1, 1) * nominal.X0.G.col(g);
    for (int k = 0; k < steps; ++k) {
      CHECK(nominal.region->states.contains(x));
      fault.mode(k);
      const Vector v = fault.effectiveness().cwiseProduct(input.at(k));
      Vector next = plant.next(k, x, v);
      const LinearModel& model = nominal.linear;
      const Vector e = next - linalg::product(model.A, x) - linalg::product(model.B, v);
      largest = std::max(largest, linalg::product(inverse, e - center).cwiseAbs().maxCoeff());
      x = std::move(next);
    }
  }
  return largest;
}

Study study_called(const std::string& name, Registry& registry) {
  return read_study(CORDON_SOURCE_DIR "/examples/studies/" + name + ".json", registry,
                    {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
}

/// The same plant as a system by formulas, without disturbances.
Model formulas_of(const std::string& plant, Registry& registry) {
  const Scratch scratch;
  const std::string nothing = R"({"type": "point", "center": [0, 0]})";
  const std::string study = R"({"cordon": 1, "system": {"type": "nonlinear", "plant": )" + plant +
                            R"(, "X0": )" + nothing + R"(, "W": )" + nothing +
                            R"(, "V": {"type": "point", "center": [0]}}, "pipelines":
                               [{"backend": "interval", "observer": "nonlinear"}]})";
  return read_study(scratch.write("s.json", study), registry, {}, StudyPlugins::refuse,
                    StudyData::optional)
      .model;
}

TEST_CASE("the linear model of the stirred tank is that of its formulas over the region, proven") {
  Registry registry;
  const Study study = study_called("cstr_nonlinear", registry);
  const Model plant = formulas_of(R"({"type": "stirred_tank", "substeps": 10})", registry);
  const Linearised made = linearise(plant, study.model.region->states, study.model.region->inputs);
  const LinearModel &proven = made.model.linear, &used = study.model.linear;
  CHECK(used.A.isApprox(proven.A, 1e-15));
  CHECK(used.B.isApprox(proven.B, 1e-15));
  CHECK(used.Bw.isApprox(Matrix(proven.Bw.rightCols(2)), 1e-15));
  CHECK_FALSE(made.model.region->nonlinear_outputs);
  const Box wanted = interval_hull(made.model.W), given = interval_hull(study.model.W);
  CHECK(given.lower.isApprox(Vector(wanted.lower.tail(2)), 1e-12));
  CHECK(given.upper.isApprox(Vector(wanted.upper.tail(2)), 1e-12));
}

TEST_CASE("samples of the stirred tank keep to its region, and reach out in W") {
  Registry registry;
  const Study study = study_called("cstr_nonlinear", registry);
  const auto& simulate = std::get<SimulateSpec>(study.data);
  REQUIRE(simulate.made_plant);
  const ModeBank bank = bank_of(study);
  REQUIRE(bank.size() == 3);
  const double largest = largest_share(bank, *simulate.made_plant);
  CHECK(largest <= 1);
  CHECK(largest >= 0.4);  // else the test says nothing
}

TEST_CASE("W of the two tanks holds the error of linearisation between their equilibria") {
  Registry registry;
  const Study study = study_called("two_tanks", registry);
  const LinearModel& m = study.model.linear;
  const Model plant = formulas_of(R"("coupled_tanks")", registry);
  // Levels of 10.3 to 20.2 and 12.1 to 23.8 cm, voltages of 1.25 to 1.75 V, as deviations.
  const Linearised made = linearise(plant, {Vector{{-4.6, -5.4}}, Vector{{5.5, 6.4}}},
                                    {Vector{{-0.25}}, Vector{{0.25}}}, &m);
  CHECK(made.model.linear.A == m.A);
  for (const LinearisedRow& row : made.f) {
    CAPTURE(row.remainder.lower);
    CAPTURE(row.remainder.upper);
    CHECK(row.remainder.magnitude() <= 0.006);
    CHECK(row.remainder.magnitude() > 0.004);
  }
}

}  // namespace
