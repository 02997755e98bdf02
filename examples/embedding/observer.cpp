// SPDX-License-Identifier: GPL-3.0-or-later
// An observer in a loop: bounds of a state that is measured in part only.
#include <cmath>
#include <cordon/cordon.hpp>
#include <iostream>

using namespace cordon;

int main() {
  Model model;  // x⁺ = A x + B u + Bw w, y = C x + D u + Dv v; x₀ ∈ X0, w ∈ W, v ∈ V
  model.linear.A = Matrix{{0.875, 0.25}, {-0.25, 0.75}};
  model.linear.B = Matrix{{0.5}, {0}};
  model.linear.Bw = Matrix::Identity(2, 2);
  model.linear.C = Matrix{{1, 0}};
  model.linear.D = Matrix::Zero(1, 1);
  model.linear.Dv = Matrix::Identity(1, 1);
  model.X0 = make_zonotope(Vector::Zero(2), 4 * Matrix::Identity(2, 2));
  model.W = make_zonotope(Vector::Zero(2), 0.0625 * Matrix::Identity(2, 2));
  model.V = make_zonotope(Vector::Zero(1), 0.125 * Matrix::Identity(1, 1));
  model.U = make_space(1);

  const auto observer = installed_components().make<ObserverEntry>(
      "prediction_correction", {model, representation("zonotope")},
      Params().set("max_generators", std::int64_t{20}));
  observer->start();
  Vector x{{3, -2}};  // the plant, which nobody knows
  for (Index k = 0; k <= 20; ++k) {
    const Vector u{{k < 10 ? 1.0 : 0.0}}, v{{0.1 * std::sin(7.0 * static_cast<double>(k))}};
    const Estimate estimate = observer->step({k, u, model.linear.C * x + v});
    if (estimate.consistent == Answer::no) return 1;  // the data contradict model or bounds
    const ConvexSet X(estimate.set);
    const Box bounds = X.hull();
    if (k % 10 == 0) std::cout << "k = " << k << ": x2 within " << bounds.radius()[1] << '\n';
    if (X.contains(x) == Answer::no) return 2;  // never happens
    x = model.linear.A * x + model.linear.B * u;
  }
}
