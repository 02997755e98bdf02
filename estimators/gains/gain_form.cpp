// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/gain_form.hpp"

#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/rounded_products.hpp"

namespace cordon::estimators {

Rounded shown_errors(const LinearModel& model, GainForm form) {
  const Matrix C = mean_outputs(model);
  return form == GainForm::predictor ? exactly(C) : times(C, exactly(model.A));
}

ErrorDisturbances error_disturbances(const Model& model, const Matrix& theta, GainForm form) {
  const LinearModel& m = model.linear;
  const Rounded w = times(m.Bw, exactly(invariant::enclosing_zonotope(model.W, "W").G));
  const Rounded v = times(m.Dv, exactly(invariant::enclosing_zonotope(model.V, "V").G));
  const Index of_theta = theta.cols(), of_w = w.value.cols(), of_v = v.value.cols();
  ErrorDisturbances d{exactly(Matrix::Zero(m.states(), of_theta + of_w + of_v)),
                      exactly(Matrix::Zero(m.outputs(), of_theta + of_w + of_v))};
  if (of_theta > 0) d.E.value.leftCols(of_theta) = theta;
  d.E.value.middleCols(of_theta, of_w) = w.value;
  d.E.error.middleCols(of_theta, of_w) = w.error;
  if (form == GainForm::filter) d.N = times(mean_outputs(m), d.E);
  d.N.value.rightCols(of_v) = v.value;
  d.N.error.rightCols(of_v) = v.error;
  return d;
}

const char* name_of_loop(GainForm form) {
  return form == GainForm::predictor ? "A - L C" : "(I - L C) A";
}

}  // namespace cordon::estimators
