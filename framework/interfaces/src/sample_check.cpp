// SPDX-License-Identifier: GPL-3.0-or-later
#include "interfaces/sample_check.hpp"

#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"

namespace cordon::detail {

namespace {

void check_missing(const Sample& sample) {
  Index last = -1;
  for (const Index i : sample.missing) {
    const bool fits = i > last && i < sample.y.size();
    if (!fits || !std::isnan(sample.y[i])) {
      throw Error(Errc::invalid, "sample " + std::to_string(sample.k) +
                                     ": missing outputs are told in ascending order, and have NaN "
                                     "for a value");
    }
    last = i;
  }
}

}  // namespace

Sample sample_of(Index k, VectorIn u, VectorIn y) {
  Sample sample{k, u, y, {}};
  for (Index i = 0; i < y.size(); ++i) {
    if (std::isnan(y[i])) sample.missing.push_back(i);
  }
  return sample;
}

void check_sample(const Sample& sample, std::optional<Index> before, const Model& model) {
  if (sample.u.size() != model.inputs() || sample.y.size() != model.outputs()) {
    throw Error(Errc::dimension,
                "sample " + std::to_string(sample.k) + " has " + std::to_string(sample.u.size()) +
                    " inputs and " + std::to_string(sample.y.size()) + " outputs, the model has " +
                    std::to_string(model.inputs()) + " and " + std::to_string(model.outputs()));
  }
  if (!sample.is_complete()) check_missing(sample);
  const bool finite =
      sample.is_complete() ? sample.y.allFinite() : sample.y(present_outputs(sample)).allFinite();
  if (!sample.u.allFinite() || !finite) {
    throw Error(Errc::not_finite,
                "sample " + std::to_string(sample.k) + " has a NaN or infinite value");
  }
  if (before && sample.k != *before + 1) {
    throw Error(Errc::invalid, "sample " + std::to_string(sample.k) + " follows sample " +
                                   std::to_string(*before) +
                                   "; samples come one time after another");
  }
}

void check_saved(const Sample& sample, const Model& model, const Archive& archive) {
  try {
    check_sample(sample, std::nullopt, model);
  } catch (const Error& error) {
    archive.refuse(error.what());
  }
}

void refuse_missing(const Sample& sample, const char* kind) {
  throw Error(Errc::unsupported,
              "output " + std::to_string(sample.missing.front() + 1) +
                  " is missing at k = " + std::to_string(sample.k) + ", and this " + kind +
                  " takes complete samples only; use another one, or fill the gaps");
}

}  // namespace cordon::detail
