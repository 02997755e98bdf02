// SPDX-License-Identifier: GPL-3.0-or-later
#include "formula_equations.hpp"

#include <vector>

#include "cordon/core/tolerances.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::detail {

namespace {

/// Nominal proofs exceed rounding errors this many times, and so does what is no rounding here.
constexpr double rounding_doubt = tolerances::proof_margin / tolerances::product_noise;

/// x, u and k are points.
std::vector<Interval> box_of(const Vector& x, const LineForm& drawn, const Sample& known) {
  const Box hull = interval_hull(drawn);
  std::vector<Interval> variables;
  for (const double entry : x) variables.push_back({entry, entry});
  for (Index i = 0; i < hull.dim(); ++i) variables.push_back({hull.lower[i], hull.upper[i]});
  for (const double entry : known.u) variables.push_back({entry, entry});
  variables.push_back({static_cast<double>(known.k), static_cast<double>(known.k)});
  return variables;
}

/// By contraction, row after row.
bool has_no_solution(const std::shared_ptr<const formulas::Function>& function, const Vector& x,
                     const LineForm& drawn, const Sample& known, const std::vector<Index>& rows,
                     const Vector& values, double share) {
  std::vector<Interval> variables = box_of(x, drawn, known);
  formulas::Evaluator evaluator(function, Rounding::outward);
  for (const Index row : rows) {
    const double value = values[row], room = share * std::abs(value);
    if (!evaluator.contract(variables, row, {value - room, value + room})) return true;
  }
  return false;
}

}  // namespace

bool no_disturbance_leads(const Model& model, const Record& before, const Record& now,
                          double share) {
  std::vector<Index> rows;
  for (Index i = 0; i < model.states(); ++i) rows.push_back(i);
  return has_no_solution(model.nonlinear->f, *before.truth, model.W, before.sample, rows,
                         *now.truth, share);
}

bool no_noise_shows(const Model& model, const Record& now, double share) {
  std::vector<Index> rows = present_outputs(now.sample);
  Vector values = Vector::Zero(model.nonlinear->g->rows());
  values.head(model.outputs()) = now.sample.y;
  for (Index row = model.outputs(); share == 0 && row < values.size(); ++row) rows.push_back(row);
  return has_no_solution(model.nonlinear->g, *now.truth, model.V, now.sample, rows, values, share);
}

bool misses_invariants(const Model& model, const Record& now) {
  formulas::Evaluator evaluator(model.nonlinear->g, Rounding::outward);
  evaluator.evaluate(box_of(*now.truth, model.V, now.sample));
  evaluator.bound_rounding();
  for (Index row = model.outputs(); row < evaluator.function().rows(); ++row) {
    const Interval value = evaluator.value(row);
    const double room = rounding_doubt * evaluator.rounding_error(row);
    if (value.lower > room || value.upper < -room) return true;
  }
  return false;
}

}  // namespace cordon::detail
