// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.hpp"

#include <cmath>

namespace cordon::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& a) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < a.ndim(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(a.shape(i));
  return text + (a.ndim() == 1 ? ",)" : ")");
}

/// An array of numbers, as numpy makes it of what was given.
Doubles numbers_of(py::handle given, const char* name, py::ssize_t dimensions) {
  py::array a = py::array::ensure(given);
  if (!a) {
    PyErr_Clear();
    throw py::type_error(std::string(name) +
                         ": an array of numbers is needed, and numpy makes none"
                         " of what was given");
  }
  const char kind = a.dtype().kind();
  const bool is_nothing = a.size() == 0;  // an empty list has no dtype of its own
  if (kind != 'f' && kind != 'i' && kind != 'u' && !is_nothing) {
    throw py::type_error(std::string(name) + ": real numbers are needed, this is an array of " +
                         py::str(a.dtype()).cast<std::string>());
  }
  if (a.ndim() != dimensions) {
    throw py::value_error(std::string(name) + ": " +
                          (dimensions == 1 ? "a vector is needed" : "a matrix is needed") +
                          ", this has the shape " + shape_of(a));
  }
  if (kind == 'f' && a.itemsize() > 8)
    throw py::type_error(std::string(name) + ": numbers of more than 64 bits would lose digits");
  Doubles doubles(a);
  if (kind == 'i' || kind == 'u') {
    const double* const first = doubles.data();
    for (py::ssize_t i = 0; i < doubles.size(); ++i) {
      if (!(std::abs(first[i]) <= 0x1p53))
        throw py::value_error(std::string(name) + ": an integer beyond 2^53 is no exact number");
    }
  }
  return doubles;
}

}  // namespace

Vector vector_of(py::handle given, const char* name) {
  const Doubles a = numbers_of(given, name, 1);
  return Eigen::Map<const Vector>(a.data(), a.size());
}

Matrix matrix_of(py::handle given, const char* name) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Doubles a = numbers_of(given, name, 2);
  return Eigen::Map<const Rows>(a.data(), a.shape(0), a.shape(1));
}

py::array_t<double> array_of(const Vector& v) {
  py::array_t<double> made(v.size());
  Eigen::Map<Vector>(made.mutable_data(), v.size()) = v;
  return made;
}

py::array_t<double> array_of(const Matrix& A) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  py::array_t<double> made({A.rows(), A.cols()});
  Eigen::Map<Rows>(made.mutable_data(), A.rows(), A.cols()) = A;
  return made;
}

}  // namespace cordon::python
