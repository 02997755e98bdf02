// SPDX-License-Identifier: GPL-3.0-or-later
// The components of this plugin, one register function per file.
#pragma once

#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

void register_prediction_correction(Registrar& registrar);
void register_nonlinear(Registrar& registrar);
void register_nonlinear_strips(Registrar& registrar);
void register_descriptor(Registrar& registrar);
void register_luenberger(Registrar& registrar);
void register_zonotope_uncertain(Registrar& registrar);
void register_interval_trajectory(Registrar& registrar);
void register_integrated(Registrar& registrar);
void register_observer_bank(Registrar& registrar);
void register_consistency_bank(Registrar& registrar);
void register_tube_membership(Registrar& registrar);
void register_given_gain(Registrar& registrar);
void register_kalman_gain(Registrar& registrar);
void register_peak_gain(Registrar& registrar);
void register_poles_gain(Registrar& registrar);
void register_fault_estimation_filter(Registrar& registrar);
void register_h_infinity_gain(Registrar& registrar);
void register_h_infinity_monotone_gain(Registrar& registrar);
void register_w_radius_gain(Registrar& registrar);
void register_facets_designer(Registrar& registrar);
void register_given_designer(Registrar& registrar);
void register_milp_designer(Registrar& registrar);
void register_metrics(Registrar& registrar);
void register_weighted_radius(Registrar& registrar);

}  // namespace cordon::estimators
