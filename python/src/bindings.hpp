// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the extension, one function each.
#pragma once

#include <chrono>
#include <optional>
#include <pybind11/pybind11.h>
#include <type_traits>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/registry/schema.hpp"

namespace cordon::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_sets(py::module_& module);
void bind_components(py::module_& module);
void bind_studies(py::module_& module);
void bind_sessions(py::module_& module);
void bind_extensions(py::module_& module);
void bind_info(py::module_& module);

/// Of a component; an unknown name is an error with a suggestion.
const ComponentInfo& info_of(const std::string& kind, const std::string& name);

/// ("yes", (kind, data, margin) or None): what the package makes an Answer of.
py::tuple answer_of(Answer answer, const Certificate& why);
py::object certificate_of(const Certificate& why);
py::tuple box_of(const Box& box);        ///< (lower, upper)
py::dict form_of(const LineForm& form);  ///< blocks by name
LineForm form_from(const py::dict& blocks);
Params params_from(const py::dict& given);

/// What ends programs, as Ctrl-C does, where it was raised in a component that is written in
/// Python: it is raised again where the call of the package ends. With the lock.
std::optional<py::error_already_set>& interruption();
/// Raises it, if there is one.
void raise_interruption();
/// Raises what signals ask for, at most twenty times a second; without the lock.
class Signals {
 public:
  void look();

 private:
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
};

/// Without the interpreter's lock, so that other threads of Python run on.
template <class Work>
auto unlocked(Work&& work) {
  const auto run = [&] {
    const py::gil_scoped_release released;
    return work();
  };
  if constexpr (std::is_void_v<decltype(work())>) {
    run();
    raise_interruption();
  } else {
    auto result = run();
    raise_interruption();
    return result;
  }
}

}  // namespace cordon::python
