// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of Python, and what is told of them.
#pragma once

#include <atomic>
#include <optional>
#include <pybind11/pybind11.h>
#include <stdexcept>

#include "cordon/interfaces/diagnoser.hpp"
#include "cordon/interfaces/observer.hpp"

namespace cordon::python {

namespace py = pybind11;

/// While one thread works with an object no other one can.
class Turn {
 public:
  explicit Turn(std::atomic_flag& busy) : busy_(busy) {
    if (busy_.test_and_set())
      throw std::runtime_error(
          "this object is at work in another thread: each thread needs its own");
  }
  ~Turn() { busy_.clear(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic_flag& busy_;
};

/// NaN among the outputs is refused here: what is missing is named, by indices of outputs.
Sample sample_of(Index k, py::handle u, py::handle y, py::handle missing);

/// (k, set, answer): what the package makes an Estimate of.
py::tuple estimate_of(const Estimate& estimate);
/// {"k", "output", "distance", "before"}, or None.
py::object contradiction_of(const std::optional<Contradiction>& found);
/// What it makes a Diagnosis of.
py::dict diagnosis_of(const Diagnosis& found);

}  // namespace cordon::python
