// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/interfaces/model.hpp"

namespace cordon::detail {

/// Throws unless the sample fits the model, has finite numbers where none is missing, and follows
/// the sample of the time `before`.
void check_sample(const Sample& sample, std::optional<Index> before, const Model& model);

/// Throws Errc::unsupported: this kind of component does not take the sample's missing outputs.
[[noreturn]] void refuse_missing(const Sample& sample, const char* kind);

}  // namespace cordon::detail
