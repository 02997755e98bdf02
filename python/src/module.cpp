// SPDX-License-Identifier: GPL-3.0-or-later
// The extension below the package `cordon`: thin, for the package alone.
#include "bindings.hpp"

PYBIND11_MODULE(_cordon, module) {
  module.doc() = "The C++ part of the package cordon; use the package.";
  cordon::python::bind_errors(module);
  cordon::python::bind_sets(module);
  cordon::python::bind_components(module);
  cordon::python::bind_studies(module);
  cordon::python::bind_sessions(module);
  cordon::python::bind_extensions(module);
  cordon::python::bind_info(module);
}
