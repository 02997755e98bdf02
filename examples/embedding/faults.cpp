// SPDX-License-Identifier: GPL-3.0-or-later
// A bank of modes behind a callback: somebody else owns the loop, and calls with every sample.
#include <cordon/cordon.hpp>
#include <functional>
#include <iostream>

using namespace cordon;

/// One tank with an inflow u and a level y; a part of what it holds leaves it in every step.
Mode tank(std::string name, double leaving) {
  Model model;
  model.linear.A = Matrix{{1 - leaving}};
  model.linear.B = model.linear.Bw = model.linear.C = model.linear.Dv = Matrix::Identity(1, 1);
  model.linear.D = Matrix::Zero(1, 1);
  model.X0 = make_box({Vector{{0}}, Vector{{10}}});
  model.W = make_box({Vector{{-0.0625}}, Vector{{0.0625}}});
  model.V = make_box({Vector{{-0.125}}, Vector{{0.125}}});
  model.U = make_space(1);
  return {std::move(name), std::move(model)};
}

/// Tells which modes are left. One object belongs to one thread at a time.
class Watch {
 public:
  explicit Watch(const ModeBank& bank) {
    Params params;
    params.set("observer",
               std::make_shared<const ComponentSpec>(ComponentSpec{"prediction_correction", {}}));
    params.set("restart_set", bank[bank.nominal].model.X0);  // the tank is never fuller
    diagnoser_ = installed_components().make<DiagnoserEntry>(
        "consistency_bank", {bank, representation("constrained_zonotope")}, params);
    diagnoser_->start();
  }

  void operator()(const Vector& u, const Vector& y) {
    const Diagnosis now = diagnoser_->step({k_++, u, y});
    if (now.decision != Decision::monitoring || now.mode == mode_) return;
    mode_ = now.mode;
    std::cout << "k = " << now.k << ": " << diagnoser_->bank()[mode_].name << '\n';
  }

 private:
  std::shared_ptr<Diagnoser> diagnoser_;
  Index k_ = 0, mode_ = -1;
};

/// What is somebody else's: a plant that begins to leak, and its callback.
void run_plant(const std::function<void(const Vector& u, const Vector& y)>& on_sample) {
  double level = 5;
  for (int k = 0; k < 40; ++k) {
    on_sample(Vector{{0.5}}, Vector{{level}});
    level += 0.5 - (k < 20 ? 0.125 : 0.25) * level;
  }
}

int main() {
  ModeBank bank{{tank("healthy", 0.125), tank("leak", 0.25)}};
  try {
    Watch watch(bank);
    run_plant([&watch](const Vector& u, const Vector& y) { watch(u, y); });
  } catch (const Error& error) {  // of every kind: a program that may not stop catches it here
    std::cerr << error.what() << '\n';
    return 1;
  }
}
