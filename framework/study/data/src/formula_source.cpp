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

FormulaSource::Regime::Regime(const Model& of, DrawSource draws_of)
    : model(of),
      draws(std::move(draws_of)),
      f(of.nonlinear->f, Rounding::outward),
      g(of.nonlinear->g, Rounding::outward) {}

FormulaSource::FormulaSource(const Model& model, const SimulateSpec& spec, std::string file,
                             bool modes)
    : spec_(spec),
      file_((check_simulation(model, spec, file), std::move(file))),
      modes_(modes),
      timeline_(spec_.faults, file_),
      nominal_(model, DrawSource(model, spec_, file_)),
      inputs_(spec_.input) {
  enter(0);
  start();
}

void FormulaSource::start() {
  std::optional<Vector> start = spec_.x0;
  if (!start)
    start = spec_.x0_set ? start_draws(spec_, file_).at(0) : central_point(acting().model.X0);
  if (!start) {
    fail("/system/X0", "no point of the set was found to start from",
         "check its constraints, or give /data/simulate/x0");
  }
  x_ = *start;
}

/// Makes the mode of time k the acting one.
void FormulaSource::enter(std::int64_t k) {
  const Index acting_then = timeline_.at(k);
  if (acting_then == acting_) return;
  acting_ = acting_then;
  fault_.reset();
  if (acting_ >= 0) {
    const auto index = static_cast<std::size_t>(acting_);
    fault_.emplace(spec_.faults[index].model, DrawSource(spec_, index, file_));
  }
  const Index parameters = acting().model.nonlinear->parameters;
  if (k > 0 && parameters > 0) x_.tail(parameters) = acting().model.X0.c.tail(parameters);
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
  enter(k);
  Draw draw = nominal_.draws.at(k);  // at every step, so that other modes change no later draw
  Regime& now = acting();
  if (fault_) draw = now.draws.at(k);
  Record record;
  record.sample.k = static_cast<Index>(k);
  record.sample.u = inputs_.at(k);
  record.truth = x_;
  record.sample.y = values(now.g, now.model.outputs(), "g", draw.v, record.sample.u, k);
  if (k < spec_.steps) x_ = values(now.f, now.model.states(), "f", draw.w, record.sample.u, k);
  if (modes_) record.mode = acting_ < 0 ? 0 : spec_.faults[static_cast<std::size_t>(acting_)].mode;
  return record;
}

}  // namespace cordon::detail
