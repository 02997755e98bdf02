// SPDX-License-Identifier: GPL-3.0-or-later
// The components of this plugin, one register function per file.
#pragma once

#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

void register_prediction_correction(Registrar& registrar);
void register_descriptor(Registrar& registrar);
void register_luenberger(Registrar& registrar);
void register_zonotope_uncertain(Registrar& registrar);
void register_interval_trajectory(Registrar& registrar);
void register_integrated(Registrar& registrar);
void register_observer_bank(Registrar& registrar);
void register_consistency_bank(Registrar& registrar);
void register_given_gain(Registrar& registrar);
void register_peak_gain(Registrar& registrar);
void register_metrics(Registrar& registrar);

}  // namespace cordon::estimators
