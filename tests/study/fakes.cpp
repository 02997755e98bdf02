// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/fakes.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "cordon/solvers/set_questions.hpp"
#include "run/scratch.hpp"

namespace study_test {

using namespace cordon;

namespace {

class FakeSet final : public Set {
 public:
  FakeSet(const SetBackend& backend, LineForm X) : Set(backend, X.dim()), X_(std::move(X)) {}

 private:
  Complexity do_complexity() const override {
    return {X_.generators(), X_.lines(), X_.constraints()};
  }
  LineForm do_line_form() const override { return X_; }
  LineForm X_;
};

class FakeBackend final : public SetBackend {
 public:
  explicit FakeBackend(BackendInfo info) : SetBackend(std::move(info)) {}

 private:
  Made do_import(const LineForm& X) const override {
    return {std::make_unique<FakeSet>(*this, X), Tightness::exact};
  }
};

class FakeObserver final : public Observer {
 public:
  FakeObserver(const ObserverContext& context) : Observer(context.model, context.backend) {}

 private:
  Enclosure do_start(const std::optional<Enclosure>&, const Sample&) override {
    return backend().space(model().linear.states());
  }
  Enclosure do_step(const Sample&, const Sample&) override {
    return backend().space(model().linear.states());
  }
  void do_replace(const Enclosure&) override {}
};

class FakeDiagnoser final : public Diagnoser {
 public:
  explicit FakeDiagnoser(const DiagnoserContext& context)
      : Diagnoser(context.bank, context.backend) {}

 private:
  void do_start() override {}
  Diagnosis do_step(const Sample*, const Sample&) override { return {}; }
};

class FakeDesigner final : public InputDesigner {
 public:
  explicit FakeDesigner(const DesignerContext& context)
      : InputDesigner(context.bank, context.backend) {}

 private:
  DesignOutcome do_design(DesignControl&) const override { return {}; }
};

/// x1⁺ = x1/2 + u1 + u2, x2⁺ = tempo x1², y = x2.
class FakePlant final : public Plant {
 public:
  explicit FakePlant(double tempo) : tempo_(tempo) {}

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 2; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index, VectorIn x, VectorIn u) const override {
    return Vector{{x[0] / 2 + u[0] + u[1], tempo_ * x[0] * x[0]}};
  }
  Vector do_output(Index, VectorIn x, VectorIn) const override { return Vector{{x[1]}}; }

  double tempo_;
};

class FakeGain final : public GainDesigner {
  GainDesign do_design(const Model&) const override { return {}; }
};

class FakeMetric final : public Metric {
  std::vector<MetricValue> do_step(const StepView&) override { return {}; }
  std::vector<MetricValue> do_summary() const override { return {}; }
};

void add_backend(Registrar& registrar, const std::string& name, bool unbounded,
                 bool intersections) {
  ParamSchema schema;
  if (name != "interval")
    schema.choice("reduction", "how generators are reduced", {"girard", "pca", "yang_scott"},
                  "yang_scott");
  if (name == "zonotope")
    schema.choice("strip", "how a strip is intersected", {"segments", "volume"}, "segments");
  registrar.add(BackendEntry{{name, "a fake", "", schema}, [=](const Params&) {
                               BackendInfo info;
                               info.name = name;
                               info.unbounded = unbounded;
                               info.intersections = intersections;
                               return std::make_unique<FakeBackend>(info);
                             }});
}

std::vector<Diagnostic> check_sets(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  for (const char* name : {"initial_set", "admissible_set"}) {
    if (!params.has(name)) continue;
    const LineForm& X = params.set_form(name);
    const std::string pointer = std::string("/") + name;
    if (X.dim() != context.model.linear.states())
      problems.push_back({pointer, "has the wrong dimension", "use the number of states"});
    if (!context.backend->info().unbounded && is_bounded(X) != Answer::yes) {
      problems.push_back({pointer, "is unbounded, the backend is not", "use line_zonotope"});
    }
  }
  return problems;
}

ParamSchema observer_schema() {
  ParamSchema schema;
  schema.integer("max_generators", "limit of generators", 100, 1, 100000);
  schema.integer("max_constraints", "limit of constraints", 20, 0, 100000);
  schema.set("initial_set", "replaces X0");
  return schema;
}

/// All but `descriptor` take models with ranges and interval matrices.
void add_observer(Registrar& registrar, const std::string& name, const ParamSchema& schema) {
  registrar.add(ObserverEntry{{name, "a fake", "", schema},
                              check_sets,
                              [](const ObserverContext& context, const Params&) {
                                return std::make_unique<FakeObserver>(context);
                              },
                              name != "descriptor",
                              name != "descriptor"});
}

/// The gain inside is asked about the model.
void add_luenberger(Registrar& registrar) {
  ParamSchema schema;
  schema.component("gain", "of the observer", "gain").or_matrix("given");
  const auto check = [](const ObserverContext& context, const Params& params) {
    if (!params.has("gain")) return std::vector<Diagnostic>{};
    auto problems = context.make->check_gain(params.component("gain"), {context.model});
    for (Diagnostic& d : problems) d.pointer = "/gain" + d.pointer;
    return problems;
  };
  registrar.add(ObserverEntry{{"luenberger", "a fake", "", schema},
                              check,
                              [](const ObserverContext& context, const Params&) {
                                return std::make_unique<FakeObserver>(context);
                              },
                              true,
                              true});
}

void add_gains(Registrar& registrar) {
  const auto create = [](const Params&) { return std::make_unique<FakeGain>(); };
  ParamSchema given;
  given.matrix("matrix", "the gain").required();
  const auto check = [](const GainContext& context, const Params& params) {
    const Matrix& L = params.matrix("matrix");
    std::vector<Diagnostic> problems;
    if (L.rows() != context.model.linear.states())
      problems.push_back({"/matrix", "has a wrong number of rows", "one per state"});
    if (L.size() > 0 && L(0, 0) < 0) problems.push_back({"/matrix/0/0", "is negative", ""});
    return problems;
  };
  registrar.add(GainEntry{{"given", "a fake", "", given}, check, create});
  ParamSchema optimal;
  optimal.real("weight", "of the noise", 0.5, 0, 1).matrix("theta", "directions");
  registrar.add(GainEntry{{"optimal", "a fake", "", optimal}, nullptr, create});
}

/// The observer inside is asked about every mode.
std::vector<Diagnostic> check_bank(const DiagnoserContext& context, const Params& params) {
  for (const Mode& mode : context.bank.modes) {
    auto problems =
        context.make->check_observer(params.component("observer"), {mode.model, context.backend});
    for (Diagnostic& d : problems) d.pointer = "/observer" + d.pointer;
    if (!problems.empty()) return problems;
  }
  return {};
}

void add_diagnoser(Registrar& registrar, const std::string& name, const ParamSchema& schema,
                   decltype(DiagnoserEntry::check) check) {
  registrar.add(DiagnoserEntry{{name, "a fake", "", schema},
                               std::move(check),
                               [](const DiagnoserContext& context, const Params&) {
                                 return std::make_unique<FakeDiagnoser>(context);
                               }});
}

/// The sequence fits the inputs of the bank, and an input set holds one of them.
std::vector<Diagnostic> check_input(const DesignerContext& context, const Params& params) {
  const Index inputs = context.bank[0].model.linear.inputs();
  std::vector<Diagnostic> problems;
  if (params.has("input_set") && params.set_form("input_set").dim() != inputs)
    problems.push_back({"/input_set", "has the wrong dimension", "use the number of inputs"});
  if (params.has("u") && params.matrix("u").cols() != inputs)
    problems.push_back({"/u", "has the wrong width", "a row per time"});
  if (!context.backend->info().unbounded)
    problems.push_back({"", "needs lines, which the backend has not", "use line_zonotope"});
  return problems;
}

void add_designers(Registrar& registrar) {
  const auto create = [](const DesignerContext& context, const Params&) {
    return std::make_unique<FakeDesigner>(context);
  };
  ParamSchema search;
  search.integer("horizon", "N", 3, 0, 1000)
      .or_at_most("longest")
      .integer("longest", "N at most", {}, 1, 20)
      .real("epsilon", "separation", 1e-4, 0, 1)
      .set("input_set", "of each time");
  search.matrix("weights", "a row per time").choice("outputs", "which", {"all", "last"}, "all");
  registrar.add(DesignerEntry{{"search", "a fake", "", search}, check_input, create});
  ParamSchema given;
  given.matrix("u", "a row per time").required();
  registrar.add(DesignerEntry{{"given", "a fake", "", given}, check_input, create});
}

void add_metric(Registrar& registrar, const std::string& name, const ParamSchema& schema = {}) {
  const auto check = [](const MetricContext& context, const Params& params) {
    std::vector<Diagnostic> problems;
    const Index states = context.model.linear.states();
    if (params.has("level") && params.real("level") == 0.75)
      problems.push_back(
          {"/level", "is not known of " + std::to_string(states) + " states", "give another one"});
    return problems;
  };
  registrar.add(MetricEntry{{name, "a fake", "", schema},
                            [](const Params&) { return std::make_unique<FakeMetric>(); },
                            check});
}

}  // namespace

void register_fakes(Registrar& registrar) {
  add_backend(registrar, "interval", false, false);
  add_backend(registrar, "zonotope", false, false);
  add_backend(registrar, "constrained_zonotope", false, true);
  add_backend(registrar, "line_zonotope", true, true);
  add_observer(registrar, "prediction_correction", observer_schema());
  ParamSchema descriptor = observer_schema();
  descriptor.set("admissible_set", "contains the state at all times")
      .flag("static_at_start", "use the static rows at k = 0", true);
  add_observer(registrar, "descriptor", descriptor);
  ParamSchema kinds;
  kinds.integer("order", "a number", {}, 1, 9)
      .real("weight", "a weight", 0.1, 0, 1)
      .flag("fast", "or not", false);
  kinds.choice("norm", "which one", {"one", "two"}, "one")
      .vector("poles", "poles")
      .matrix("gain", "a gain")
      .required();
  kinds.set("safe_set", "a set").text("note", "any text", "none");
  add_observer(registrar, "all_kinds", kinds);
  add_luenberger(registrar);
  add_gains(registrar);
  for (const char* name :
       {"radius", "volume", "contains_truth", "complexity", "step_time", "tightness"})
    add_metric(registrar, name);
  ParamSchema bank;
  bank.component("observer", "of every mode", "observer").required();
  bank.matrices("gains", "one per mode")
      .integer("waiting_time", "in steps", {}, 1, 1000000)
      .required();
  add_diagnoser(registrar, "observer_bank", bank, check_bank);
  ParamSchema committee;
  committee.component("member", "the one that is asked", "diagnoser");
  add_diagnoser(registrar, "committee", committee, nullptr);
  registrar.add(DiagnoserEntry{{"fault_filter", "a fake", "", {}},
                               nullptr,
                               [](const DiagnoserContext& context, const Params&) {
                                 return std::make_unique<FakeDiagnoser>(context);
                               },
                               true,
                               false});
  add_designers(registrar);
  ParamSchema reactor;
  reactor.real("tempo", "of the reaction", 0.25, 0, 1);
  registrar.add(PlantEntry{{"reactor", "a fake", "", reactor}, [](const Params& params) {
                             return std::make_unique<FakePlant>(params.real("tempo"));
                           }});
  ParamSchema quantile;
  quantile.real("level", "between 0 and 1", {}, 0, 1).required();
  add_metric(registrar, "quantile", quantile);
}

std::string exchanged(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos)
    throw std::logic_error("not exactly once: " + from);
  return text.replace(at, from.size(), to);
}

Study read_text(const std::string& text) {
  const Scratch scratch;
  Registry registry;
  registry.add(register_fakes);
  return read_study(scratch.write("study.json", text), registry, SearchPath{});
}

std::vector<Diagnostic> problems_of(const std::string& text) {
  try {
    read_text(text);
  } catch (const InputError& error) {
    return error.diagnostics();
  }
  return {};
}

}  // namespace study_test
