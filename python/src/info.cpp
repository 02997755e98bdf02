// SPDX-License-Identifier: GPL-3.0-or-later
// What components say of themselves, as `cordon info` has it.
#include <pybind11/stl.h>
#include <string>

#include "bindings.hpp"
#include "cordon/cordon.hpp"
#include "cordon/registry/build.hpp"

namespace cordon::python {

namespace {

py::object fallback_of(const ParamSpec& spec) {
  if (!spec.fallback) return py::none();
  if (const auto* integer = std::get_if<std::int64_t>(&*spec.fallback)) return py::int_(*integer);
  if (const auto* real = std::get_if<double>(&*spec.fallback)) return py::float_(*real);
  if (const auto* flag = std::get_if<bool>(&*spec.fallback)) return py::bool_(*flag);
  if (const auto* text = std::get_if<std::string>(&*spec.fallback)) return py::str(*text);
  return py::none();
}

py::dict parameter_of(const ParamSpec& spec) {
  py::dict made;
  made["name"] = spec.name;
  made["type"] = std::string(to_string(spec.kind));
  made["doc"] = spec.doc;
  made["required"] = spec.required;
  made["default"] = fallback_of(spec);
  made["lowest"] = spec.lowest;
  made["highest"] = spec.highest;
  made["choices"] = spec.choices;
  made["kind"] = spec.component_kind;
  made["takes_matrix"] = !spec.matrix_type.empty();
  made["takes_at_most"] = !spec.at_most.empty();
  return made;
}

py::dict info(const std::string& kind, const std::string& name) {
  const Registry& registry = installed_components();
  const ComponentInfo& found = info_of(kind, name);
  py::list parameters;
  for (const ParamSpec& spec : found.schema.specs()) parameters.append(parameter_of(spec));
  py::dict made;
  made["kind"] = kind;
  made["name"] = found.name;
  made["plugin"] = registry.plugin_of(kind, name);
  made["summary"] = found.summary;
  made["citation"] = found.citation;
  made["details"] = found.details;
  made["parameters"] = parameters;
  return made;
}

}  // namespace

const ComponentInfo& info_of(const std::string& kind, const std::string& name) {
  const Registry& registry = installed_components();
  if (const ComponentInfo* const found = registry.info(kind, name)) return *found;
  if (const PluginReport* const refused = registry.refused_provider(name)) {
    throw Error(Errc::plugin, "no " + kind + " \"" + name + "\": " + refused->file.string() +
                                  " was refused: " + refused->reason + "; " + refused->fix);
  }
  throw Error(Errc::invalid,
              "there is no " + kind + " \"" + name + "\"; " + suggest(name, registry.names(kind)));
}

void bind_info(py::module_& module) {
  module.def("components",
             [](const std::string& kind) { return installed_components().names(kind); });
  module.def("kinds", [] { return Registry::kinds(); });
  module.def("info", &info);
  module.def("version", [] { return build_info().version; });
}

}  // namespace cordon::python
