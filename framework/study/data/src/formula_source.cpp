// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/formula_source.hpp"

#include <initializer_list>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::detail {

std::optional<Vector> values_at(formulas::Evaluator& evaluator, Index rows, const Vector& x,
                                const Vector& drawn, const Vector& u, std::int64_t k) {
  std::vector<Interval> point;
  for (const Vector* part : std::initializer_list<const Vector*>{&x, &drawn, &u})
    for (const double entry : *part) point.push_back({entry, entry});
  point.push_back({static_cast<double>(k), static_cast<double>(k)});
  evaluator.evaluate(point);
  Vector made(rows);
  for (Index row = 0; row < rows; ++row) {
    if (!evaluator.is_enclosed(row)) return std::nullopt;
    const Interval value = evaluator.value(row);
    made[row] = 0.5 * value.lower + 0.5 * value.upper;
  }
  return made;
}

FormulaSource::FormulaSource(const Model& model, const SimulateSpec& spec, std::string file)
    : spec_(spec),
      file_((check_simulation(model, spec, file), std::move(file))),
      model_(model.nonlinear),
      draws_(model, spec_, file_),
      inputs_(spec_.input),
      f_(model_->f, Rounding::outward),
      g_(model_->g, Rounding::outward) {
  std::optional<Vector> start = spec_.x0;
  if (!start) start = spec_.x0_set ? start_draws(spec_, file_).at(0) : central_point(model.X0);
  if (!start) {
    fail("/system/X0", "no point of the set was found to start from",
         "check its constraints, or give /data/simulate/x0");
  }
  x_ = *start;
}

void FormulaSource::fail(const std::string& pointer, const std::string& message,
                         const std::string& suggestion) const {
  throw InputError(file_, {{pointer, message, suggestion}});
}

Vector FormulaSource::values(formulas::Evaluator& evaluator, Index rows, const char* what,
                             const Vector& drawn, const Vector& u, std::int64_t k) {
  if (auto made = values_at(evaluator, rows, x_, drawn, u, k)) return std::move(*made);
  Index row = 0;
  while (evaluator.is_enclosed(row)) ++row;
  const formulas::Violation* why = evaluator.violation_of(row);
  fail(std::string("/system/") + what + "/" + std::to_string(row),
       "cannot be simulated at k = " + std::to_string(k) + ": " +
           (why ? why->to_string(evaluator.function()) : "the value overflows"),
       "simulate fewer steps, or with other inputs or another x0");
}

std::optional<Record> FormulaSource::next() {
  if (k_ > spec_.steps) return std::nullopt;
  const std::int64_t k = k_++;
  const Draw draw = draws_.at(k);
  Record record;
  record.sample.k = static_cast<Index>(k);
  record.sample.u = inputs_.at(k);
  record.truth = x_;
  record.sample.y = values(g_, model_->outputs(), "g", draw.v, record.sample.u, k);
  if (k < spec_.steps) x_ = values(f_, model_->states(), "f", draw.w, record.sample.u, k);
  return record;
}

}  // namespace cordon::detail
