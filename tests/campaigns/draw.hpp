// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon::campaigns {

/// Draws that do not depend on the standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  Index below(Index count) {
    return static_cast<Index>(engine_() % static_cast<std::uint64_t>(count));
  }
  /// A place in a list.
  std::size_t place(std::size_t count) {
    return static_cast<std::size_t>(below(static_cast<Index>(count)));
  }
  const std::string& among(const std::vector<std::string>& list) {
    return list[place(list.size())];
  }
  bool one_in(Index count) { return below(count) == 0; }
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-52 - 1; }
  /// A number as somebody would write it, or one with all digits.
  double number() {
    const double x = 2 * uniform();
    return digits_ ? std::round(100 * x) / 100 : x;
  }
  void write_decimals(bool on) { digits_ = on; }

  Matrix matrix(Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) a = one_in(6) ? 0 : number();
    return A;
  }

 private:
  std::mt19937_64 engine_;
  bool digits_ = true;
};

}  // namespace cordon::campaigns
