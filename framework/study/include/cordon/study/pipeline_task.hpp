// SPDX-License-Identifier: GPL-3.0-or-later
// What a pipeline is, in specification, outcome and finished results alike.
#pragma once

#include <variant>

namespace cordon {

enum class PipelineKind { estimation, diagnosis, design };

/// One of three: a pipeline estimates states, diagnoses modes, or designs an input. What is known
/// of it, its specification for example, is an `Estimation`, a `Diagnosis` or a `Design`.
template <class Estimation, class Diagnosis, class Design>
struct PipelineTask {
  std::variant<Estimation, Diagnosis, Design> task = {};

  PipelineKind kind() const { return static_cast<PipelineKind>(task.index()); }
  /// Null: it is one of the other two.
  const Estimation* estimation() const { return std::get_if<Estimation>(&task); }
  const Diagnosis* diagnosis() const { return std::get_if<Diagnosis>(&task); }
  const Design* design() const { return std::get_if<Design>(&task); }
  Estimation* estimation() { return std::get_if<Estimation>(&task); }
  Diagnosis* diagnosis() { return std::get_if<Diagnosis>(&task); }
  Design* design() { return std::get_if<Design>(&task); }
};

}  // namespace cordon
