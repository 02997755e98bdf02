// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated data of a model by formulas.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/study/data.hpp"
#include "study/data/draws.hpp"

namespace cordon::detail {

/// The first rows at a point (x, drawn, u, k): each the middle of an outward enclosure. Nothing
/// where one is not defined or overflows, which the evaluator tells.
std::optional<Vector> values_at(formulas::Evaluator& evaluator, Index rows, const Vector& x,
                                const Vector& drawn, const Vector& u, std::int64_t k);

/// Samples k = 0 … steps of x_{k+1} = f(x_k, w_k, u_k, k), y_k = g(x_k, v_k, u_k, k), with the true
/// state. Each value is the middle of an outward enclosure at the point: the nearest double or its
/// neighbour, the same on every machine. It starts in x0, in a point of x0_set, or in the centre of
/// X0. Throws InputError: sizes, unbounded W or V, a formula that is not defined or overflows.
class FormulaSource final : public DataSource {
 public:
  FormulaSource(const Model& model, const SimulateSpec& spec, std::string file);

  std::optional<Record> next() override;
  std::optional<std::int64_t> size() const override { return spec_.steps + 1; }

 private:
  Vector values(formulas::Evaluator& evaluator, Index rows, const char* what, const Vector& drawn,
                const Vector& u, std::int64_t k);
  [[noreturn]] void fail(const std::string& pointer, const std::string& message,
                         const std::string& suggestion) const;

  SimulateSpec spec_;
  std::string file_;
  std::shared_ptr<const NonlinearModel> model_;
  DrawSource draws_;
  InputSource inputs_;
  formulas::Evaluator f_, g_;
  Vector x_;
  std::int64_t k_ = 0;
};

}  // namespace cordon::detail
