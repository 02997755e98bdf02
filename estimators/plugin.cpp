// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"

namespace {

void register_components(cordon::Registrar& registrar) {
  cordon::estimators::register_prediction_correction(registrar);
  cordon::estimators::register_nonlinear(registrar);
  cordon::estimators::register_nonlinear_strips(registrar);
  cordon::estimators::register_descriptor(registrar);
  cordon::estimators::register_luenberger(registrar);
  cordon::estimators::register_zonotope_uncertain(registrar);
  cordon::estimators::register_interval_trajectory(registrar);
  cordon::estimators::register_integrated(registrar);
  cordon::estimators::register_observer_bank(registrar);
  cordon::estimators::register_consistency_bank(registrar);
  cordon::estimators::register_tube_membership(registrar);
  cordon::estimators::register_given_gain(registrar);
  cordon::estimators::register_kalman_gain(registrar);
  cordon::estimators::register_peak_gain(registrar);
  cordon::estimators::register_poles_gain(registrar);
  cordon::estimators::register_fault_estimation_filter(registrar);
  cordon::estimators::register_h_infinity_gain(registrar);
  cordon::estimators::register_h_infinity_monotone_gain(registrar);
  cordon::estimators::register_w_radius_gain(registrar);
  cordon::estimators::register_facets_designer(registrar);
  cordon::estimators::register_given_designer(registrar);
  cordon::estimators::register_milp_designer(registrar);
  cordon::estimators::register_metrics(registrar);
  cordon::estimators::register_weighted_radius(registrar);
}

}  // namespace

CORDON_PLUGIN("estimators", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "set-based observers, diagnosers and metrics", register_components)
