// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>

#include "bindings.hpp"
#include "cordon/core/error.hpp"

namespace cordon::python {

namespace {

py::list problems_of(const std::vector<Diagnostic>& diagnostics) {
  py::list problems;
  for (const Diagnostic& d : diagnostics)
    problems.append(py::make_tuple(d.pointer, d.message, d.suggestion, d.line));
  return problems;
}

/// Raises the exception of the package's that stands for it.
void raise(const Error& error, const py::list& problems, const char* type) {
  const py::object made =
      py::module_::import("cordon.errors")
          .attr(type)(error.what(), std::string(to_string(error.code())), problems);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise(error, problems_of(error.diagnostics()), "InputError");
    } catch (const Error& error) {
      raise(error, py::list(), "Error");
    }
  });
}

}  // namespace cordon::python
