// SPDX-License-Identifier: GPL-3.0-or-later
// A plant as a plugin: a pendulum with friction, one Euler step per sample. Start from here and
// replace the equations by your own: one template says them in numbers and as formulas.
#include <cmath>
#include <cordon/formulas/expression.hpp>
#include <cordon/interfaces/plant_formulas.hpp>
#include <cordon/registry/plugin.hpp>

namespace {

using namespace cordon;

class MyPlant final : public Plant {
 public:
  explicit MyPlant(const Params& params)
      : sampling_(params.real("sampling")), friction_(params.real("friction")) {}

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }

  template <class Number>
  Number next_speed(const Number& angle, const Number& speed, const Number& torque) const {
    using std::sin;
    return speed + sampling_ * (torque - friction_ * speed - sin(angle));
  }
  Vector do_next(Index, VectorIn x, VectorIn u) const override {
    return Vector{{x[0] + sampling_ * x[1], next_speed<double>(x[0], x[1], u[0])}};
  }
  Vector do_output(Index, VectorIn x, VectorIn) const override { return x.head(1); }
  std::optional<PlantFormulas> do_formulas(const PlantVariables& of) const override {
    return PlantFormulas{{of.x[0] + sampling_ * of.x[1], next_speed(of.x[0], of.x[1], of.u[0])},
                         {of.x[0]}};
  }

  double sampling_, friction_;
};

void register_components(Registrar& registrar) {
  ParamSchema schema;
  schema.real("sampling", "sampling time, s", 0.1, 1e-6, 1);
  schema.real("friction", "friction, 1/s", 0.5, 0, 100);
  registrar.add(PlantEntry{
      {"my_plant", "a pendulum: states angle and speed, input torque, output angle", "", schema},
      [](const Params& params) -> std::unique_ptr<Plant> {
        return std::make_unique<MyPlant>(params);
      }});
}

}  // namespace

CORDON_PLUGIN("my_plant", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "a plant of my own",
              register_components)
