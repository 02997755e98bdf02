// SPDX-License-Identifier: GPL-3.0-or-later
// Where a cart can be after three steps: a set, mapped and added to in a loop.
#include <cordon/cordon.hpp>
#include <iostream>

int main() {
  using namespace cordon;
  const Matrix A{{1, 0.5}, {0, 0.75}};  // position and speed
  const ConvexSet W = ConvexSet::zonotope(Vector::Zero(2), Matrix{{0.125}, {0.5}});
  ConvexSet X = ConvexSet::box(Vector{{-1, 0}}, Vector{{1, 2}}).as("zonotope");
  for (int k = 0; k < 3; ++k) X = (A * X + W).reduce(20);
  std::cout << X << "\nposition " << X.hull().lower[0] << " to " << X.hull().upper[0] << '\n';
  if (X.contains(Vector{{6, 0}}) == Answer::no) std::cout << "it is not at 6 yet\n";
}
