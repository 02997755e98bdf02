// SPDX-License-Identifier: GPL-3.0-or-later
// The sets W of the study of the non-linear tank: do they hold what its linear model misses of the
// plant?
#include <algorithm>
#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/study/study.hpp"

using namespace cordon;

namespace {

constexpr int seeds = 400, steps = 100;
/// The samples behind W reach 2/3 of it; a study that has lost this margin is to be noticed before
/// it is wrong.
constexpr double room = 0.8;

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

/// Largest |ξ| over the samples, per mode, of W = {c + G ξ}.
std::vector<double> shares(const ModeBank& bank, const Plant& plant) {
  const Model& nominal = bank[bank.nominal].model;
  std::vector<double> largest(static_cast<std::size_t>(bank.size()), 0.0);
  std::vector<Matrix> inverses;
  for (const Mode& mode : bank.modes) inverses.push_back(linalg::pseudo_inverse(mode.model.W.G));
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
      const auto m = static_cast<std::size_t>(fault.mode(k));
      const Vector v = fault.effectiveness().cwiseProduct(input.at(k));
      Vector next = plant.next(k, x, v);
      const LinearModel& model = nominal.linear;
      const Vector e = next - linalg::product(model.A, x) - linalg::product(model.B, v);
      const Vector xi = linalg::product(inverses[m], e - bank.modes[m].model.W.c);
      largest[m] = std::max(largest[m], xi.cwiseAbs().maxCoeff());
      x = std::move(next);
    }
  }
  return largest;
}

TEST_CASE("W of the non-linear tank holds the errors of linearisation with room, in every mode") {
  Registry registry;
  const Study study =
      read_study(CORDON_SOURCE_DIR "/examples/studies/cstr_nonlinear.json", registry,
                 {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const auto& simulate = std::get<SimulateSpec>(study.data);
  REQUIRE(simulate.made_plant);
  const ModeBank bank = bank_of(study);
  REQUIRE(bank.size() == 3);
  for (const Mode& mode : bank.modes) {
    REQUIRE(mode.model.W.generators() == 2);  // a parallelogram: the factors of a point are unique
    REQUIRE(mode.model.W.constraints() == 0);
    REQUIRE(mode.model.linear.Bw.isIdentity(0));
  }
  const std::vector<double> largest = shares(bank, *simulate.made_plant);
  for (std::size_t m = 0; m < largest.size(); ++m) {
    CAPTURE(m);
    CHECK(largest[m] <= room);
    CHECK(largest[m] >= 0.4);  // and the samples do reach out, else the test says nothing
  }
}

}  // namespace
