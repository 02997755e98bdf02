// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of Python as vectors and matrices: always a copy, so that nothing of the caller's memory
// is kept.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>

#include "cordon/core/types.hpp"

namespace cordon::python {

namespace py = pybind11;

/// Of arrays, lists and numpy scalars of any real dtype and memory order. Throws TypeError for
/// what holds no real numbers (complex, text, bool, objects) or hides some (masked arrays), and
/// ValueError for integers of 2⁵³ or beyond, which need not be doubles. `name` is the argument's in
/// messages.
Vector vector_of(py::handle given, const char* name);
Matrix matrix_of(py::handle given, const char* name);
/// One number, under the same conditions.
double number_of(py::handle given, const char* name);
/// A number of things: an integer, none below 0.
Index count_of(py::handle given, const char* name);

/// A new array of numpy, of one and of two dimensions; matrices in the order of C.
py::array_t<double> array_of(const Vector& v);
py::array_t<double> array_of(const Matrix& A);

}  // namespace cordon::python
