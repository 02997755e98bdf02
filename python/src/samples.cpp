// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples.hpp"

#include <algorithm>
#include <cmath>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cordon/cordon.hpp"

namespace cordon::python {

namespace {

/// Indices of outputs, ascending.
std::vector<Index> missing_of(py::handle given) {
  std::vector<Index> missing;
  for (const py::handle& one : given) {
    const bool is_numpy = py::hasattr(one, "dtype");
    if (py::isinstance<py::bool_>(one) ||
        (is_numpy && one.attr("dtype").attr("kind").cast<std::string>() == "b")) {
      throw py::type_error(
          "missing names outputs by their indices, from 0; those of a mask are "
          "np.flatnonzero(mask)");
    }
    if (PyIndex_Check(one.ptr()) == 0) {
      throw py::type_error("missing: indices of outputs are needed, as [0], not " +
                           py::repr(one).cast<std::string>());
    }
    const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(one.ptr()));
    const Index at = number ? PyLong_AsSsize_t(number.ptr()) : -1;
    if (PyErr_Occurred()) {
      PyErr_Clear();
      throw py::index_error("missing: there is no output " + py::repr(one).cast<std::string>());
    }
    missing.push_back(at);
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

py::dict evidence_of(const ModeEvidence& evidence) {
  py::dict made;
  made["candidate"] = evidence.candidate;
  made["consistent"] = answer_of(evidence.consistent, evidence.why);
  if (evidence.residual.dim() > 0) made["residual"] = box_of(evidence.residual);
  if (!evidence.left_open.empty()) made["left_open"] = evidence.left_open;
  return made;
}

}  // namespace

Sample sample_of(Index k, py::handle u, py::handle y, py::handle outputs) {
  const std::vector<Index> missing = missing_of(outputs);
  Sample sample{k, u.is_none() ? Vector(0) : vector_of(u, "u"), vector_of(y, "y")};
  for (const Index i : missing) {
    if (i < 0 || i >= sample.y.size())
      throw py::index_error("missing: there is no output " + std::to_string(i));
  }
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (std::isnan(sample.y[i]) && std::find(missing.begin(), missing.end(), i) == missing.end()) {
      throw py::value_error("y[" + std::to_string(i) + "] is NaN; an output without a value is " +
                            "named: missing=[" + std::to_string(i) + "]");
    }
  }
  return missing_outputs(std::move(sample), missing);
}

py::tuple estimate_of(const Estimate& estimate) {
  return py::make_tuple(estimate.k, ConvexSet(estimate.set),
                        answer_of(estimate.consistent, estimate.why));
}

py::object contradiction_of(const std::optional<Contradiction>& found) {
  if (!found) return py::none();
  py::dict made;
  made["k"] = found->k;
  made["output"] = found->output;
  made["distance"] = found->distance;
  made["before"] = found->before;
  return made;
}

py::dict diagnosis_of(const Diagnosis& found) {
  py::dict made;
  made["k"] = found.k;
  made["decision"] = std::string(to_string(found.decision));
  made["mode"] = found.mode;
  made["since"] = found.since;
  made["reset"] = found.reset;
  made["suggested"] = found.suggested;
  py::list modes, faults;
  for (const ModeEvidence& evidence : found.modes) modes.append(evidence_of(evidence));
  for (const FaultBound& bound : found.faults)
    faults.append(py::make_tuple(bound.fault, bound.at, bound.lower, bound.upper, bound.estimate));
  made["modes"] = modes;
  made["faults"] = faults;
  made["estimate"] = found.estimate ? py::cast(ConvexSet(*found.estimate)) : py::object(py::none());
  return made;
}

}  // namespace cordon::python
