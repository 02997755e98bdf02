// SPDX-License-Identifier: GPL-3.0-or-later
// An observer as a plugin: prediction by the model, correction by the outputs, on any backend.
// Start from here and replace the recursion by your own.
#include <cordon/interfaces/archive.hpp>
#include <cordon/registry/plugin.hpp>

namespace {

using namespace cordon;

class MyObserver final : public Observer {
 public:
  MyObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_{params.integer("max_generators"), 10},
        W_(backend().import(context.model.W)),
        V_(backend().import(context.model.V)) {}

  /// Each estimate holds the successors of the one before: `cordon verify` compares them.
  bool follows_its_sets() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    return X_ = corrected(X0 ? *X0 : backend().import(model().X0), first);
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    const LinearModel& m = model().linear;
    const Term disturbance{m.Bw, W_};
    const Enclosure predicted = timed(Phase::predict, [&] {
      return backend().predict(X_, {m.A, m.B * before.u, {&disturbance, 1}});
    });
    return X_ = corrected(predicted, now);
  }
  void do_replace(const Enclosure& X) override { X_ = X; }
  /// What later steps depend on, to go on from after a restart of the program.
  void do_serialize(Archive& archive) override { archive.set(X_, model().states()); }

  /// {x ∈ X : y - D u - C x ∈ Dv V}, within the budget.
  Enclosure corrected(const Enclosure& X, const Sample& now) {
    const LinearModel& m = model().linear;
    const Enclosure narrowed = timed(Phase::correct, [&] {
      return backend().correct(X, {m.C, now.y - m.D * now.u, {m.Dv, V_}});
    });
    return timed(Phase::reduce, [&] { return backend().reduce(narrowed, budget_); });
  }

  Budget budget_;
  Enclosure W_, V_, X_;
};

/// Told with all other problems of a study, before anything runs.
std::vector<Diagnostic> problems_of(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  if (context.model.linear.is_descriptor())
    problems.push_back({"", "takes systems without E", "use the observer \"descriptor\""});
  if (params.integer("max_generators") < context.model.states())
    problems.push_back({"/max_generators", "is smaller than the number of states",
                        "allow one generator per state at least"});
  return problems;
}

void register_components(Registrar& registrar) {
  ParamSchema schema;
  schema.integer("max_generators", "most generators of an estimate", 20, 1, 100'000);
  registrar.add(ObserverEntry{
      {"my_observer", "prediction and correction", "", schema},
      problems_of,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<MyObserver>(context, params);
      }});
}

}  // namespace

CORDON_PLUGIN("my_observer", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "an observer of my own",
              register_components)
