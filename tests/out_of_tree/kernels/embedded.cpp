// SPDX-License-Identifier: GPL-3.0-or-later
// A program that embeds the library: it loads the plugins and takes a step of an observer.
#include <cordon/registry/registry.hpp>
#include <iostream>

int main() {
  using namespace cordon;
  Registry registry;
  registry.load(default_search_path());
  Model model;
  model.linear.A = model.linear.C = model.linear.Bw = model.linear.Dv = Matrix::Identity(1, 1);
  model.linear.B = model.linear.D = Matrix(1, 0);
  model.X0 = model.W = model.V = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  model.U = make_point(Vector(0));
  const auto backend = registry.make<BackendEntry>("zonotope", {});
  const auto observer = registry.make<ObserverEntry>("prediction_correction", {model, backend}, {});
  observer->start();
  const Estimate estimate = observer->step({0, Vector(0), Vector::Ones(1)});
  std::cout << "prediction_correction estimates " << estimate.set->interval_hull().upper[0] << '\n';
}
