// SPDX-License-Identifier: GPL-3.0-or-later
// Gains as parameters of observers: a nested component of the kind "gain", or a matrix.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cordon/registry/plugin.hpp"
#include "gains/gain_form.hpp"

namespace cordon::estimators {

/// Adds the component parameter `name` of kind "gain" that may be written as a matrix.
void add_gain_parameter(ParamSchema& schema, const std::string& name, const std::string& doc);

/// The designer and its gain.
struct ObserverGain {
  std::shared_ptr<const GainDesigner> designer;
  Gain gain;
};

/// What most observers take where no gain is given: "kalman" with "steady".
ComponentSpec steady_kalman();

/// The gain by the parameter `name`, or by `absent` where it is not given. Throws InputError with
/// the reason if there is none. Not every designer knows the filter's form.
ObserverGain observer_gain(const ObserverContext& context, const Params& params,
                           const std::string& name, const ComponentSpec& absent,
                           GainForm form = GainForm::predictor);

/// The gain that varies in time for the states in X, by the outputs of `model`; `steady` where no
/// zonotope contains X.
Matrix gain_for(const ObserverGain& gain, const Model& model, const Enclosure& X,
                const Matrix& steady);

/// Adds the problems of that gain: at "/name" or, of its own parameters, below it; at "" if the
/// parameter is not given.
void check_observer_gain(const ObserverContext& context, const Params& params,
                         const std::string& name, const ComponentSpec& absent,
                         std::vector<Diagnostic>& problems, GainForm form = GainForm::predictor);

}  // namespace cordon::estimators
