// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_check.hpp"

#include "cordon/core/error.hpp"

namespace cordon::detail {

void check_sample(const Sample& sample, const std::optional<Sample>& before,
                  const LinearModel& model) {
  if (sample.u.size() != model.inputs() || sample.y.size() != model.outputs()) {
    throw Error(Errc::dimension,
                "sample " + std::to_string(sample.k) + " has " + std::to_string(sample.u.size()) +
                    " inputs and " + std::to_string(sample.y.size()) + " outputs, the model has " +
                    std::to_string(model.inputs()) + " and " + std::to_string(model.outputs()));
  }
  if (!sample.u.allFinite() || !sample.y.allFinite()) {
    throw Error(Errc::not_finite,
                "sample " + std::to_string(sample.k) + " has a NaN or infinite value");
  }
  if (before && sample.k != before->k + 1) {
    throw Error(Errc::invalid, "sample " + std::to_string(sample.k) + " follows sample " +
                                   std::to_string(before->k) +
                                   "; samples come one time after another");
  }
}

}  // namespace cordon::detail
