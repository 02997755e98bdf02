// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated data of a model by formulas.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/study/data.hpp"
#include "study/data/draws.hpp"
#include "study/data/fault_timeline.hpp"

namespace cordon::detail {

/// The first rows at a point (x, drawn, u, k): each the middle of an outward enclosure. Nothing
/// where one is not defined or overflows, which the evaluator tells.
std::optional<Vector> values_at(formulas::Evaluator& evaluator, Index rows, const Vector& x,
                                const Vector& drawn, const Vector& u, std::int64_t k);

/// Samples k = 0 … steps of x_{k+1} = f(x_k, w_k, u_k, k), y_k = g(x_k, v_k, u_k, k), with the true
/// state. Each value is the middle of an outward enclosure at the point: the nearest double or its
/// neighbour, the same on every machine. It starts in x0, in a point of x0_set, or in the centre of
/// X0 of the mode that acts at k = 0. Where another mode begins to act, parameters that are states
/// take the middle of its bounds. Throws InputError: sizes, unbounded W or V, a formula that is not
/// defined or overflows.
class FormulaSource final : public DataSource {
 public:
  /// `modes`: records tell which mode acts.
  FormulaSource(const Model& model, const SimulateSpec& spec, std::string file, bool modes);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return spec_.steps + 1; }

 private:
  /// What acts from one change of modes to the next.
  struct Regime {
    Regime(const Model& model, DrawSource draws);

    Model model;
    DrawSource draws;
    formulas::Evaluator f, g;
  };

  Regime& acting() { return fault_ ? *fault_ : nominal_; }
  void enter(std::int64_t k);
  void start();
  Vector values(formulas::Evaluator& evaluator, Index rows, const char* what, const Vector& drawn,
                const Vector& u, std::int64_t k);
  [[noreturn]] void fail(const std::string& pointer, const std::string& message,
                         const std::string& suggestion) const;

  SimulateSpec spec_;
  std::string file_;
  bool modes_;
  FaultTimeline timeline_;
  Regime nominal_;
  std::optional<Regime> fault_;
  Index acting_ = -1;  ///< of the faults; -1: the nominal mode
  InputSource inputs_;
  Vector x_;
  std::int64_t k_ = 0;
};

}  // namespace cordon::detail
