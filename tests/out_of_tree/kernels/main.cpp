// SPDX-License-Identifier: GPL-3.0-or-later
// A program that uses set operations and invariant sets without the framework's objects;
// headers.hpp includes every installed header.
#include <iostream>

#include "headers.hpp"

int main() {
  const cordon::Box square{cordon::Vector{{-1, -1}}, cordon::Vector{{1, 1}}};
  const cordon::Box sum = cordon::sets::minkowski_sum(
      square, cordon::Box{cordon::Vector{{0, 0}}, cordon::Vector{{2, 2}}});
  cordon::invariant::require_schur(cordon::Matrix{{0.5, 1}, {0, 0.5}}, "A");
  std::cout << sum.upper[0] << '\n';
}
