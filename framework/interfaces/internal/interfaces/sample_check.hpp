// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/interfaces/model.hpp"

namespace cordon {
class Archive;
}

namespace cordon::detail {

/// The sample of these values; an output that is NaN is missing.
Sample sample_of(Index k, VectorIn u, VectorIn y);

/// Throws unless the sample fits the model, has finite numbers where none is missing, and follows
/// the sample of the time `before`.
void check_sample(const Sample& sample, std::optional<Index> before, const Model& model);

/// The same of a sample that was read from there: refused, Errc::invalid.
void check_saved(const Sample& sample, const Model& model, const Archive& archive);

/// Throws Errc::unsupported: this kind of component does not take the sample's missing outputs.
[[noreturn]] void refuse_missing(const Sample& sample, const char* kind);

}  // namespace cordon::detail
