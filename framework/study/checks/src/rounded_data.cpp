// SPDX-License-Identifier: GPL-3.0-or-later
#include "rounded_data.hpp"

#include "formula_equations.hpp"
#include "study/checks/common_runs.hpp"
#include "study/checks/equations.hpp"

namespace cordon::detail {

namespace {

using verification::Equations;

Matrix identity(Index n) { return Matrix::Identity(n, n); }

bool has_ranges(const LinearModel& m) {
  return m.is_uncertain() || !m.actuator_radius().isZero(0) || !m.sensor_radius().isZero(0);
}

/// diag(f) u: a line of its own, so that nothing is multiplied in doubles.
Equations::Line pushed(Equations& rows, const LinearModel& m, const Sample& sample) {
  const Equations::Line u = rows.constant(sample.u), product = rows.line(m.inputs());
  rows.add(m.inputs(),
           {{product, identity(m.inputs())}, {u, -Matrix(m.actuator_center().asDiagonal())}});
  return product;
}

bool has_no_solution(Equations& rows) {
  return verification::exact_emptiness(rows.project(rows.line(0))).empty == Answer::yes;
}

}  // namespace

bool contradicts_dynamics(const Model& model, const Record& before, const Record& now) {
  if (model.nonlinear) return no_disturbance_leads(model, before, now, 0);
  const LinearModel& m = model.linear;
  if (has_ranges(m)) return false;
  const Index n = m.states();
  Equations rows;
  const Equations::Line u = pushed(rows, m, before.sample), x = rows.constant(*before.truth),
                        next = rows.constant(*now.truth), w = rows.element(model.W);
  rows.add(n, {{next, m.is_descriptor() ? m.E : identity(n)}, {x, -m.A}, {u, -m.B}, {w, -m.Bw}});
  return has_no_solution(rows);
}

bool contradicts_outputs(const Model& model, const Record& now) {
  if (model.nonlinear) return no_noise_shows(model, now, 0);
  const Sample sample = without_missing(now.sample);
  const LinearModel m = with_outputs(model.linear, present_outputs(now.sample));
  if (has_ranges(m)) return false;
  const Index p = m.outputs();
  Equations rows;
  const Equations::Line u = pushed(rows, m, sample), x = rows.constant(*now.truth),
                        y = rows.constant(sample.y), v = rows.element(model.V),
                        shown = rows.line(p);
  rows.add(p, {{shown, identity(p)}, {x, -m.C}, {u, -m.D}});
  rows.add(p, {{y, identity(p)}, {shown, -Matrix(m.sensor_center().asDiagonal())}, {v, -m.Dv}});
  return has_no_solution(rows);
}

}  // namespace cordon::detail
