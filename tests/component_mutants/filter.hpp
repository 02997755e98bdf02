// SPDX-License-Identifier: GPL-3.0-or-later
// Small components without a known defect. Mutants derive from them and break one thing each;
// without them they have to pass every law of the conformance kit.
#pragma once

#include <memory>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/registry/plugin.hpp"

namespace component_mutants {

using namespace cordon;

/// Prediction by the model and correction by the outputs that are there, never reduced.
class Filter : public Observer {
 public:
  explicit Filter(const ObserverContext& context)
      : Observer(context.model, context.backend),
        W_(backend().import(context.model.W)),
        V_(backend().import(context.model.V)) {}

  Tightness claim() const override { return Tightness::exact; }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

  /// For a bank, without the samples of the base class.
  void begin(const Sample& first) { X_ = corrected(backend().import(model().X0), first); }
  void go_on(const Sample& before, const Sample& now) {
    X_ = corrected(predicted(X_, before, now), now);
  }
  const Enclosure& held() const { return X_; }
  void save(Archive& archive) { archive(X_); }

 protected:
  virtual Enclosure predicted(const Enclosure& X, const Sample& before, const Sample& /*now*/) {
    const LinearModel& m = model().linear;
    return predicted_with(X, m.B * before.u, m.Bw, W_);
  }
  Enclosure predicted_with(const Enclosure& X, const Vector& forced, const Matrix& Bw,
                           const Enclosure& W) const {
    const Term disturbance{Bw, W};
    return backend().predict(X, {model().linear.A, forced, {&disturbance, 1}});
  }
  virtual Enclosure corrected(const Enclosure& X, const Sample& now) {
    if (now.is_complete()) return corrected_with(X, model().linear, now, V_);
    const std::vector<Index> rows = present_outputs(now);
    if (rows.empty()) return X;
    return corrected_with(X, with_outputs(model().linear, rows), without_missing(now), V_);
  }
  Enclosure corrected_with(const Enclosure& X, const LinearModel& m, const Sample& now,
                           const Enclosure& V) const {
    return backend().correct(X, {m.C, now.y - m.D * now.u, {m.Dv, V}});
  }
  /// What is told of the set that is held.
  virtual Enclosure told(const Enclosure& X) { return X; }

  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    X_ = corrected(X0 ? *X0 : backend().import(initial_set()), first);
    return told(X_);
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    X_ = corrected(predicted(X_, before, now), now);
    return told(X_);
  }
  void do_replace(const Enclosure& X) override { X_ = X; }
  void do_serialize(Archive& archive) override { archive.set(X_, model().states()); }

  Enclosure W_, V_, X_;
};

/// What a component has, and the laws each of which has to notice it: "VERDICT LAW …: defect".
template <class Entry>
ComponentInfo described(const char* name, const char* laws, const char* defect,
                        ParamSchema schema = {}) {
  return {name, std::string(laws) + ": " + defect, "", std::move(schema)};
}

void add_observers(Registrar& registrar);
void add_observers_of_contract(Registrar& registrar);
void add_diagnosers(Registrar& registrar);
void add_designers(Registrar& registrar);
void add_gains(Registrar& registrar);
void add_metrics(Registrar& registrar);
void add_plants(Registrar& registrar);

/// Registers an observer for linear models with exact matrices and without E.
template <class Type>
void add_observer(Registrar& registrar, const char* name, const char* laws, const char* defect) {
  registrar.add(
      ObserverEntry{described<ObserverEntry>(name, laws, defect),
                    [](const ObserverContext& context, const Params&) {
                      std::vector<Diagnostic> problems;
                      if (context.model.linear.is_descriptor())
                        problems.push_back({"", "needs a standard model", "leave out E"});
                      return problems;
                    },
                    [](const ObserverContext& context, const Params&) -> std::unique_ptr<Observer> {
                      return std::make_unique<Type>(context);
                    }});
}

}  // namespace component_mutants
