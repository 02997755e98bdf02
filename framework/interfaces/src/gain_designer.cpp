// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/gain_designer.hpp"

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

void require_gain(const Matrix& L, const LinearModel& model) {
  const Index n = model.states(), p = model.outputs();
  if (L.rows() == n && L.cols() == p && L.allFinite()) return;
  const std::string what = L.allFinite() ? std::to_string(L.rows()) + "×" + std::to_string(L.cols())
                                         : "with numbers that are not finite";
  throw Error(Errc::violated, "the gain designer violates its contract: its gain is " + what +
                                  ", must be " + std::to_string(n) + "×" + std::to_string(p));
}

}  // namespace

Matrix GainDesigner::update(const Model& model, MatrixIn P) const {
  const Index n = model.linear.states();
  if (P.rows() != n || P.cols() != n) {
    throw Error(Errc::dimension, "the covariation is " + std::to_string(P.rows()) + "×" +
                                     std::to_string(P.cols()) + ", the model has " +
                                     std::to_string(n) + " states");
  }
  Matrix L = do_update(model, P);
  require_gain(L, model.linear);
  return L;
}

Matrix GainDesigner::do_update(const Model&, MatrixIn) const {
  throw Error(Errc::internal, "this gain designer has no gain that varies in time");
}

}  // namespace cordon
