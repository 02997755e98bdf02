// SPDX-License-Identifier: GPL-3.0-or-later
// What goes between the languages beside arrays.
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cordon/core/error.hpp"
#include "cordon/values/convex_set.hpp"

namespace cordon::python {

namespace {

Matrix block_of(const py::dict& blocks, const char* name, Index rows, Index columns) {
  if (!blocks.contains(name)) return Matrix::Zero(rows, columns);
  return matrix_of(blocks[name], name);
}

Params::Value value_from(py::handle given, const char* name) {
  if (py::isinstance<py::bool_>(given)) return given.cast<bool>();
  if (py::isinstance<py::int_>(given)) {
    int overflow = 0;
    const std::int64_t value = PyLong_AsLongLongAndOverflow(given.ptr(), &overflow);
    if (overflow != 0) throw py::value_error(std::string(name) + ": the integer is too large");
    return value;
  }
  if (py::isinstance<py::float_>(given)) return given.cast<double>();
  if (py::isinstance<py::str>(given)) return given.cast<std::string>();
  if (py::isinstance<ConvexSet>(given)) {
    const View seen = given.cast<const ConvexSet&>().view();
    if (!seen.is_exact_form()) {
      throw Error(Errc::unsupported, std::string(name) +
                                         ": a set with an exact form is needed; take an enclosure, "
                                         "X.as_(\"constrained_zonotope\")");
    }
    return seen.form;
  }
  if (py::isinstance<py::dict>(given)) {
    throw py::type_error(std::string(name) +
                         ": a number, a text, an array or a set is needed, not a dictionary; "
                         "parameters are given by their names, max_generators=20");
  }
  const py::array a = py::array::ensure(given);
  if (!a) {
    PyErr_Clear();
    throw py::type_error(std::string(name) + ": a number, a text, an array or a set is needed");
  }
  if (a.ndim() == 0 && a.itemsize() <= 8 && py::hasattr(given, "item"))  // a scalar of numpy's
    return value_from(given.attr("item")(), name);
  if (a.ndim() == 1) return vector_of(given, name);
  return matrix_of(given, name);
}

}  // namespace

py::object certificate_of(const Certificate& why) {
  if (why.kind == Certificate::Kind::none) return py::none();
  return py::make_tuple(std::string(to_string(why.kind)), array_of(why.data), why.margin);
}

py::tuple answer_of(Answer answer, const Certificate& why) {
  return py::make_tuple(std::string(to_string(answer)),
                        answer == Answer::unknown ? py::object(py::none()) : certificate_of(why));
}

py::tuple box_of(const Box& box) {
  return py::make_tuple(array_of(box.lower), array_of(box.upper));
}

py::dict form_of(const LineForm& form) {
  py::dict blocks;
  blocks["c"] = array_of(form.c);
  blocks["M"] = array_of(form.M);
  blocks["G"] = array_of(form.G);
  blocks["S"] = array_of(form.S);
  blocks["A"] = array_of(form.A);
  blocks["b"] = array_of(form.b);
  return blocks;
}

LineForm form_from(const py::dict& blocks) {
  LineForm form;
  form.c = vector_of(blocks["c"], "c");
  form.b = blocks.contains("b") ? vector_of(blocks["b"], "b") : Vector(0);
  form.M = block_of(blocks, "M", form.c.size(), 0);
  form.G = block_of(blocks, "G", form.c.size(), 0);
  form.S = block_of(blocks, "S", form.b.size(), form.M.cols());
  form.A = block_of(blocks, "A", form.b.size(), form.G.cols());
  check(form, "the set");
  return form;
}

Params params_from(const py::dict& given) {
  Params params;
  for (const auto& [key, value] : given) {
    const std::string name = key.cast<std::string>();
    if (!value.is_none()) params.set(name, value_from(value, name.c_str()));
  }
  return params;
}

}  // namespace cordon::python
