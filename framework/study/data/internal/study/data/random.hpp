// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same on every machine: the engine is fixed by the standard, the
// mapping to numbers is ours (the distributions of the standard library differ between
// implementations).
#pragma once

#include <cstdint>
#include <random>

namespace cordon::detail {

/// What a stream is drawn for. Each purpose has its own stream, so that one never depends on how
/// much of another was drawn.
enum class Purpose : std::uint64_t {
  disturbance = 1,
  noise = 2,
  prbs = 3,
  direction = 4,
  effectiveness = 5,
  parameters = 6,
  additive_fault = 7,
  start = 8,
  dropout = 9,
  outlier = 10
};

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t index = 0);

  double unit() {
    return static_cast<double>(engine_() >> 11) * 0x1p-53;
  }                                              ///< uniform in [0,1), multiples of 2⁻⁵³
  double symmetric() { return 2 * unit() - 1; }  ///< uniform in [-1,1)
  double sign() { return engine_() >> 63 ? 1.0 : -1.0; }  ///< ±1 with equal probability

 private:
  std::mt19937_64 engine_;
};

}  // namespace cordon::detail
