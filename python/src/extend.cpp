// SPDX-License-Identifier: GPL-3.0-or-later
// Components that are written in Python: adapters that call an object of Python, with the
// interpreter's lock.
#include <algorithm>
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cordon/conformance/conformance.hpp"
#include "cordon/cordon.hpp"

namespace cordon::python {

namespace {

/// Calls into Python: with the lock, and what is raised there as an error of the framework's, which
/// needs no lock to be destroyed.
template <class Call>
auto locked(const std::string& what, Call&& call) {
  const py::gil_scoped_acquire lock;
  try {
    return call();
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_KeyboardInterrupt) || error.matches(PyExc_SystemExit))
      interruption() = error;
    throw Error(Errc::plugin, what + ": " + error.what());
  } catch (const py::cast_error& error) {
    throw Error(Errc::plugin, what + " returns a value of another type than is needed");
  }
}

/// An object of Python that may be released by any thread.
class Kept {
 public:
  explicit Kept(py::object object) : object_(new py::object(std::move(object))) {}
  ~Kept() {
    if (!object_ || Py_IsInitialized() == 0) return;
    const py::gil_scoped_acquire lock;
    delete object_;
  }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

  py::object attr(const char* name) const { return object_->attr(name); }

 private:
  py::object* object_;
};

py::object value_of(const Params::Value& value);

py::dict params_of(const Params& params) {
  py::dict made;
  for (const auto& [name, value] : params.values()) made[py::str(name)] = value_of(value);
  return made;
}

py::object set_of(const LineForm& X) {
  return py::cast(ConvexSet(representation("line_zonotope")->import(X)));
}

struct ValueOf {
  py::object operator()(std::int64_t value) const { return py::int_(value); }
  py::object operator()(double value) const { return py::float_(value); }
  py::object operator()(bool value) const { return py::bool_(value); }
  py::object operator()(const std::string& value) const { return py::str(value); }
  py::object operator()(const Vector& value) const { return array_of(value); }
  py::object operator()(const Matrix& value) const { return array_of(value); }
  py::object operator()(const LineForm& value) const { return set_of(value); }
  py::object operator()(const std::vector<Matrix>& value) const {
    py::list made;
    for (const Matrix& A : value) made.append(array_of(A));
    return made;
  }
  py::object operator()(const std::shared_ptr<const ComponentSpec>& value) const {
    return py::make_tuple(value->type, params_of(value->params));
  }
};

py::object value_of(const Params::Value& value) { return std::visit(ValueOf{}, value); }

py::dict model_of(const Model& model) {
  py::dict made;
  const LinearModel& linear = model.linear;
  const std::pair<const char*, const Matrix*> blocks[] = {
      {"A", &linear.A}, {"B", &linear.B},   {"Bw", &linear.Bw}, {"C", &linear.C},
      {"D", &linear.D}, {"Dv", &linear.Dv}, {"E", &linear.E},   {"F", &linear.F}};
  for (const auto& [name, block] : blocks) made[name] = array_of(*block);
  made["X0"] = set_of(model.X0);
  made["W"] = set_of(model.W);
  made["V"] = set_of(model.V);
  return made;
}

py::tuple sample_of(const Sample& sample) {
  return py::make_tuple(sample.k, array_of(sample.u), array_of(sample.y), sample.missing);
}

class PythonObserver final : public Observer {
 public:
  PythonObserver(const std::string& name, const ObserverContext& context, const py::object& type,
                 const Params& params)
      : Observer(context.model, context.backend),
        name_("observer \"" + name + "\""),
        made_(locked(name_, [&] {
          return type.attr("_made")(model_of(context.model), context.backend->info().name,
                                    params_of(params));
        })) {
    locked(name_, [&] {
      claim_ =
          made_.attr("claim").cast<std::string>() == "exact" ? Tightness::exact : Tightness::outer;
      follows_ = made_.attr("follows_its_sets").cast<bool>();
      takes_missing_ = made_.attr("takes_missing_outputs").cast<bool>();
      uses_outputs_ = made_.attr("uses_outputs_of_its_time").cast<bool>();
    });
  }

  Tightness claim() const override { return claim_; }
  bool follows_its_sets() const override { return follows_; }
  bool takes_missing_outputs() const override { return takes_missing_; }
  bool uses_outputs_of_its_time() const override { return uses_outputs_; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    const Enclosure initial = X0 ? *X0 : backend().import(model().X0);
    return held_ = locked(name_, [&] {
             return returned(made_.attr("_begin")(ConvexSet(initial), sample_of(first)));
           });
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    return held_ = locked(name_, [&] {
             return returned(
                 made_.attr("_advance")(ConvexSet(held_), sample_of(before), sample_of(now)));
           });
  }
  void do_replace(const Enclosure& X) override { held_ = X; }

  Enclosure returned(const py::object& X) const {
    const ConvexSet made = X.cast<ConvexSet>();
    if (made.dim() != model().states())
      throw Error(Errc::plugin, name_ + " returns a set of " + std::to_string(made.dim()) +
                                    " dimensions for " + std::to_string(model().states()) +
                                    " states");
    return backend().import(made.enclosure());
  }

  std::string name_;
  Kept made_;
  Enclosure held_;
  Tightness claim_ = Tightness::outer;
  bool follows_ = false, takes_missing_ = false, uses_outputs_ = true;
};

class PythonMetric final : public Metric {
 public:
  PythonMetric(const std::string& name, const py::object& type, const Params& params)
      : name_("metric \"" + name + "\""),
        made_(locked(name_, [&] { return type.attr("_made")(params_of(params)); })) {}

 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    return locked(name_, [&] {
      py::object truth = py::none();
      if (view.truth) truth = array_of(*view.truth);
      return values_of(made_.attr("_step")(view.estimate.k, ConvexSet(view.estimate.set),
                                           answer_of(view.estimate.consistent, view.estimate.why),
                                           box_of(view.hull), truth));
    });
  }
  std::vector<MetricValue> do_summary() const override {
    return locked(name_, [&] { return values_of(made_.attr("summary")()); });
  }

  std::vector<MetricValue> values_of(const py::object& told) const {
    std::vector<MetricValue> values;
    for (const auto& [key, value] : told.cast<py::dict>()) {
      MetricValue one{key.cast<std::string>(), 0.0};
      if (py::isinstance<py::str>(value))
        one.value = value.cast<std::string>();
      else if (py::isinstance<py::int_>(value))
        one.value = value.cast<Index>();
      else
        one.value = value.cast<double>();
      values.push_back(std::move(one));
    }
    return values;
  }

  std::string name_;
  Kept made_;
};

class PythonPlant final : public Plant {
 public:
  PythonPlant(const std::string& name, const py::object& type, const Params& params)
      : name_("plant \"" + name + "\""),
        made_(locked(name_, [&] { return type.attr("_made")(params_of(params)); })) {
    locked(name_, [&] {
      states_ = made_.attr("states").cast<Index>();
      inputs_ = made_.attr("inputs").cast<Index>();
      outputs_ = made_.attr("outputs").cast<Index>();
    });
  }

 private:
  Index do_states() const override { return states_; }
  Index do_inputs() const override { return inputs_; }
  Index do_outputs() const override { return outputs_; }
  Vector do_next(Index k, VectorIn x, VectorIn u) const override { return called("next", k, x, u); }
  Vector do_output(Index k, VectorIn x, VectorIn u) const override {
    return called("output", k, x, u);
  }

  Vector called(const char* method, Index k, VectorIn x, VectorIn u) const {
    return locked(name_, [&] {
      return vector_of(made_.attr(method)(k, array_of(Vector(x)), array_of(Vector(u))), method);
    });
  }

  std::string name_;
  Kept made_;
  Index states_ = 0, inputs_ = 0, outputs_ = 0;
};

/// The schema of parameters that are written as (name, kind, doc, default, lowest, highest,
/// choices).
ParamSchema schema_from(const py::list& parameters) {
  ParamSchema schema;
  for (const py::handle& given : parameters) {
    const auto p = given.cast<py::tuple>();
    const auto name = p[0].cast<std::string>(), kind = p[1].cast<std::string>(),
               doc = p[2].cast<std::string>();
    const py::object fallback = p[3];
    const double lowest = p[4].cast<double>(), highest = p[5].cast<double>();
    if (kind == "integer") {
      schema.integer(name, doc, fallback.cast<std::optional<std::int64_t>>(),
                     static_cast<std::int64_t>(std::max(lowest, -0x1p53)),
                     static_cast<std::int64_t>(std::min(highest, 0x1p53)));
    } else if (kind == "real") {
      schema.real(name, doc, fallback.cast<std::optional<double>>(), lowest, highest);
    } else if (kind == "flag") {
      schema.flag(name, doc, fallback.is_none() ? false : fallback.cast<bool>());
    } else if (kind == "choice") {
      schema.choice(name, doc, p[6].cast<std::vector<std::string>>(), fallback.cast<std::string>());
    } else if (kind == "text") {
      schema.text(name, doc, fallback.cast<std::optional<std::string>>());
    } else if (kind == "vector") {
      schema.vector(name, doc);
    } else if (kind == "matrix") {
      schema.matrix(name, doc);
    } else if (kind == "set") {
      schema.set(name, doc);
    } else {
      throw Error(Errc::invalid, "parameter \"" + name + "\": there is no kind \"" + kind + "\"");
    }
    if (p[7].cast<bool>()) schema.required();
  }
  return schema;
}

/// What a class refuses of a model or of parameters, by a ValueError: the problems of the study.
template <class Make>
std::vector<Diagnostic> refused(const std::string& name, Make&& make) {
  try {
    make();
  } catch (const Error& error) {
    if (error.code() != Errc::plugin) throw;
    std::string reason = error.what();
    const std::size_t place = reason.find("\n\nAt:");
    return {{"", reason.substr(0, place), "the class \"" + name + "\" says so", 0}};
  }
  return {};
}

void add_entry(ComponentEntry entry) {
  static const ComponentEntry* pending = nullptr;  // with the interpreter's lock
  pending = &entry;
  installed_components().add([](Registrar& registrar) {
    std::visit([&](const auto& one) { registrar.add(one); }, *pending);
  });
}

/// `kept` is the class that is asked, as long as the process lives.
void add_type(const std::string& kind, const std::string& name, ComponentInfo info,
              const py::object& kept) {
  if (kind == "observer") {
    ObserverEntry entry{std::move(info), {}, {}};
    entry.create = [name, &kept](const ObserverContext& context, const Params& params) {
      return std::make_unique<PythonObserver>(name, context, kept, params);
    };
    entry.check = [name, &kept](const ObserverContext& context, const Params& params) {
      return refused(name, [&] { PythonObserver(name, context, kept, params); });
    };
    add_entry(std::move(entry));
  } else if (kind == "metric") {
    MetricEntry entry{std::move(info), [name, &kept](const Params& params) {
                        return std::make_unique<PythonMetric>(name, kept, params);
                      }};
    add_entry(std::move(entry));
  } else {
    PlantEntry entry{std::move(info), [name, &kept](const Params& params) {
                       return std::make_unique<PythonPlant>(name, kept, params);
                     }};
    add_entry(std::move(entry));
  }
}

void register_type(const std::string& kind, const py::object& type, const std::string& name,
                   const std::string& summary, const py::list& parameters) {
  // Never destroyed: the registry lives as long as the process.
  static auto& known = *new std::map<std::string, std::pair<py::object, std::string>>;
  const std::string key = kind + " " + name, written = py::repr(parameters).cast<std::string>();
  const auto before = known.find(key);
  if (before != known.end() && before->second.second == written) {
    before->second.first = type;
    return;
  }
  add_type(kind, name, {name, summary, "", schema_from(parameters)},
           known.try_emplace(key, type, written).first->second.first);
}

py::list conform(const std::string& kind, const std::string& name, const py::dict& parameters,
                 const std::string& laws, std::uint64_t seed, Index cases) {
  const Registry& registry = installed_components();
  conformance::Subject subject;
  subject.kind = kind;
  subject.component = name;
  subject.params = params_from(parameters);
  subject.schema = &info_of(kind, name).schema;
  subject.command = "cordon.conform(\"" + name + "\", kind=\"" + kind + "\")";
  subject.make = [&](const Params& params) { return registry.make<BackendEntry>(name, params); };
  subject.registry = {std::shared_ptr<const void>(), &registry};
  const conformance::Options options{laws, seed, cases};
  Signals signals;
  const auto results = unlocked([&] {
    return conformance::check(subject, options,
                              [&](const conformance::Law&, Index, Index) { signals.look(); });
  });
  py::list made;
  for (const conformance::Result& result : results) {
    made.append(py::make_tuple(result.law, std::string(to_string(result.status)), result.reason,
                               result.cases, result.unsupported, result.witness));
  }
  return made;
}

}  // namespace

void bind_extensions(py::module_& module) {
  module.def("register_type", &register_type);
  module.def("conform", &conform);
}

}  // namespace cordon::python
