// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/fakes.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "cordon/solvers/set_questions.hpp"

namespace study_test {

using namespace cordon;

namespace {

class FakeSet final : public Set {
 public:
  FakeSet(const SetBackend& backend, LineForm X) : Set(backend, X.dim()), X_(std::move(X)) {}

 private:
  Complexity do_complexity() const override { return {X_.generators(), X_.lines(), X_.constraints()}; }
  LineForm do_line_form() const override { return X_; }
  LineForm X_;
};

class FakeBackend final : public SetBackend {
 public:
  explicit FakeBackend(BackendInfo info) : SetBackend(std::move(info)) {}

 private:
  Made do_import(const LineForm& X) const override { return {std::make_unique<FakeSet>(*this, X), Tightness::exact}; }
};

class FakeObserver final : public Observer {
 public:
  FakeObserver(const ObserverContext& context) : Observer(context.model, context.backend) {}

 private:
  Enclosure do_start(const std::optional<Enclosure>&, const Sample&) override { return backend().space(model().linear.states()); }
  Enclosure do_step(const Sample&, const Sample&) override { return backend().space(model().linear.states()); }
  void do_replace(const Enclosure&) override {}
};

class FakeMetric final : public Metric {
 public:
  std::vector<MetricValue> step(const StepView&) override { return {}; }
  std::vector<MetricValue> summary() const override { return {}; }
};

void add_backend(Registrar& registrar, const std::string& name, bool unbounded, bool intersections) {
  ParamSchema schema;
  if (name != "interval") schema.choice("reduction", "how generators are reduced", {"girard", "pca", "yang_scott"}, "yang_scott");
  if (name == "zonotope") schema.choice("strip", "how a strip is intersected", {"segments", "volume"}, "segments");
  registrar.backend({{name, "a fake", "", schema}, [=](const Params&) {
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

void add_observer(Registrar& registrar, const std::string& name, const ParamSchema& schema) {
  registrar.observer({{name, "a fake", "", schema}, check_sets, [](const ObserverContext& context, const Params&) {
                        return std::make_unique<FakeObserver>(context);
                      }});
}

void add_metric(Registrar& registrar, const std::string& name, const ParamSchema& schema = {}) {
  registrar.metric({{name, "a fake", "", schema}, [](const Params&) { return std::make_unique<FakeMetric>(); }});
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
  kinds.integer("order", "a number", {}, 1, 9).real("weight", "a weight", 0.1, 0, 1).flag("fast", "or not", false);
  kinds.choice("norm", "which one", {"one", "two"}, "one").vector("poles", "poles").matrix("gain", "a gain").required();
  kinds.set("safe_set", "a set").text("note", "any text", "none");
  add_observer(registrar, "all_kinds", kinds);
  for (const char* name : {"radius", "volume", "contains_truth", "complexity", "step_time", "tightness"})
    add_metric(registrar, name);
  ParamSchema quantile;
  quantile.real("level", "between 0 and 1", {}, 0, 1).required();
  add_metric(registrar, "quantile", quantile);
}

Scratch::Scratch() {
  std::string pattern = (std::filesystem::temp_directory_path() / "cordon_study_XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary directory");
  folder_ = pattern;
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path Scratch::write(const std::string& name, const std::string& text) const {
  const std::filesystem::path file = folder_ / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

const char* const valid_study = R"({
"cordon": 1,
"title": "a study",
"system": {
"type": "descriptor",
"E": [[1, 0], [0, 0]],
"A": [[0.5, 1], [0, 2]],
"B": [[1], [0]],
"Bw": [[1, 0, 0], [0, 1, 1]],
"C": [[1, 0]],
"D": [[0.25]],
"Dv": [[1]],
"X0": {"type": "zonotope", "center": [0, 1], "generators": [[1, 0.5], [0, 1]]},
"W": {"type": "box", "lower": [-1, -1, -1], "upper": [1, 1, 1]},
"V": {"type": "box", "lower": [-0.1], "upper": [0.1]}
},
"data": {
"simulate": {
"steps": 20,
"seed": 7,
"noise": "vertex",
"x0": [0.5, 0.25],
"input": [{"type": "sine", "amplitude": 1, "omega": 0.5}]
}
},
"pipelines": [
{
"name": "first",
"backend": {"type": "zonotope", "strip": "volume"},
"observer": {"type": "descriptor", "max_generators": 30}
},
{
"backend": "line_zonotope",
"observer": {"type": "descriptor", "initial_set": {"type": "space", "dim": 2}}
}
],
"metrics": ["radius", {"type": "quantile", "level": 0.5}]
}
)";

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
