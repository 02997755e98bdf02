// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>
#include <new>
#include <utility>

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

void raise_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise(error, problems_of(error.diagnostics()), "InputError");
  } catch (const Error& error) {
    const bool by_argument = error.code() == Errc::dimension || error.code() == Errc::not_finite ||
                             error.code() == Errc::invalid;
    raise(error, py::list(), by_argument ? "ArgumentError" : "Error");
  }
}

}  // namespace

std::optional<py::error_already_set>& interruption() {
  static auto& pending = *new std::optional<py::error_already_set>;
  return pending;
}

void raise_interruption() {
  if (interruption()) throw *std::exchange(interruption(), std::nullopt);
}

void Signals::look() {
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < std::chrono::milliseconds(50)) return;
  looked_ = now;
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error&) {
      if (interruption()) {
        std::exchange(interruption(), std::nullopt)->restore();
        return;
      }
      raise_of(std::current_exception());
    } catch (const std::bad_alloc&) {
      PyErr_SetString(PyExc_MemoryError,
                      "the matrices do not fit into memory: those of a set are dense, n rows and a "
                      "column per generator and line; reduce() keeps sets small");
    }
  });
}

}  // namespace cordon::python
