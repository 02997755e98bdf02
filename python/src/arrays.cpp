// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.hpp"

#include <cmath>
#include <string_view>

namespace cordon::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& a) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < a.ndim(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(a.shape(i));
  return text + (a.ndim() == 1 ? ",)" : ")");
}

bool is_integer(const py::array& a) { return a.dtype().kind() == 'i' || a.dtype().kind() == 'u'; }

[[noreturn]] void refuse_large(const char* name) {
  throw py::value_error(std::string(name) + ": an integer of 2^53 or beyond need not be a double");
}

Doubles small_integers(const py::array& a, const char* name) {
  Doubles doubles(a);
  const double* const first = doubles.data();
  for (py::ssize_t i = 0; i < doubles.size(); ++i) {
    if (!(std::abs(first[i]) < 0x1p53)) refuse_large(name);
  }
  return doubles;
}

bool is_bool(py::handle given) {
  return py::isinstance<py::bool_>(given) ||
         std::string_view(Py_TYPE(given.ptr())->tp_name).starts_with("numpy.bool");
}

/// What numpy makes an array of without a word, though something is lost: masks, and large integers
/// among floating-point numbers.
void refuse_losses(py::handle given, const char* name, int depth) {
  if (py::isinstance<py::array>(given)) {
    if (py::hasattr(given, "mask") && py::hasattr(given, "filled")) {
      if (given.attr("mask").attr("any")().cast<bool>())
        throw py::type_error(std::string(name) +
                             ": entries of a masked array are masked, which are no numbers");
    } else if (depth > 0) {
      const auto a = py::reinterpret_borrow<py::array>(given);
      if (is_integer(a)) small_integers(a, name);
    }
    return;
  }
  const bool is_list = py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given);
  if (is_list && depth < 4) {
    for (const py::handle entry : given) refuse_losses(entry, name, depth + 1);
  } else if (!is_list && !is_bool(given) && PyIndex_Check(given.ptr()) != 0) {
    const auto integer = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    if (!integer) throw py::error_already_set();
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(integer.ptr(), &overflow);
    if (overflow != 0 || value >= 1LL << 53 || value <= -(1LL << 53)) refuse_large(name);
  }
}

/// An array of numbers, as numpy makes it of what was given.
Doubles numbers_of(py::handle given, const char* name, py::ssize_t dimensions) {
  refuse_losses(given, name, 0);
  py::array a = py::array::ensure(given);
  if (!a) {
    PyErr_Clear();
    throw py::type_error(std::string(name) +
                         ": an array of numbers is needed, and numpy makes none"
                         " of what was given");
  }
  const char kind = a.dtype().kind();
  const bool is_nothing = a.size() == 0;  // an empty list has no dtype of its own
  if (kind != 'f' && !is_integer(a) && !is_nothing) {
    throw py::type_error(std::string(name) + ": real numbers are needed, this is an array of " +
                         py::str(a.dtype()).cast<std::string>());
  }
  if (a.ndim() != dimensions) {
    const char* const needed[] = {"a number", "a vector", "a matrix"};
    throw py::value_error(std::string(name) + ": " + needed[dimensions] +
                          " is needed, this has the shape " + shape_of(a));
  }
  if (kind == 'f' && a.itemsize() > 8)
    throw py::type_error(std::string(name) + ": numbers of more than 64 bits would lose digits");
  return is_integer(a) ? small_integers(a, name) : Doubles(a);
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

double number_of(py::handle given, const char* name) { return *numbers_of(given, name, 0).data(); }

Index count_of(py::handle given, const char* name) {
  const std::string refusal = std::string(name) + ": an integer that is not negative is needed";
  if (is_bool(given) || PyIndex_Check(given.ptr()) == 0) throw py::type_error(refusal);
  const auto integer = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  if (!integer) {
    PyErr_Clear();
    throw py::type_error(refusal);
  }
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(integer.ptr(), &overflow);
  if (overflow != 0 || value < 0) throw py::value_error(refusal);
  return value;
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
