// SPDX-License-Identifier: GPL-3.0-or-later
// What samples say of a model, computed another way than by output tubes: one step after another,
// by exact set operations.
#pragma once

#include <vector>

#include "cordon/interfaces/model.hpp"
#include "cordon/solvers/exact_questions.hpp"

namespace diagnosis_test {

using namespace cordon;

/// The states x_{k+1} that the samples of 0 … k allow; empty if they contradict the model. Nothing
/// is reduced.
inline LineForm next_states(const Model& model, const std::vector<Sample>& samples) {
  const LinearModel& m = model.linear;
  const Index n = m.states();
  LineForm X = model.X0;
  for (const Sample& now : samples) {
    const LineForm outputs = affine_map(model.V, -m.Dv, now.y - m.D * now.u);
    const LineForm measured = intersection(X, m.C, outputs);
    const LineForm moved = minkowski_sum(affine_map(measured, m.A, m.B * now.u),
                                         affine_map(model.W, m.Bw, Vector::Zero(m.Bw.rows())));
    X = m.is_descriptor() ? intersection(make_space(n), m.E, moved) : moved;
  }
  return X;
}

/// Do the samples contradict the model? Decided in rational arithmetic.
inline bool contradicts(const Model& model, const std::vector<Sample>& samples) {
  return exact::is_empty(next_states(model, samples)) == Answer::yes;
}

}  // namespace diagnosis_test
