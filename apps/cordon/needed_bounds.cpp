// SPDX-License-Identifier: GPL-3.0-or-later
#include "needed_bounds.hpp"

#include <vector>

#include <fmt/format.h>

#include "cordon/study/data.hpp"
#include "cordon/study/identify.hpp"

namespace cordon::apps {

namespace {

using Status = BoundFactors::Status;

constexpr Index longest_record = 1000;
constexpr double would_do = 1 + 1e-6;  ///< a factor up to this counts as 1: solvers round
constexpr double patience = 5;         ///< for each question

std::string alone(const char* name, const BoundFactors& factors) {
  if (factors.status == Status::none) return fmt::format("{} alone: never", name);
  return factors.status == Status::found ? fmt::format("{} alone: {:.4g}", name, factors.cost)
                                         : fmt::format("{} alone: not found", name);
}

}  // namespace

std::string needed_bounds_text(const Study& study, Index k) {
  if (k >= longest_record || !why_not_identified(study.model).empty()) return "";
  std::vector<Sample> samples;
  const auto source = open_data(study);
  while (auto record = source->next()) {
    if (record->sample.k > k) break;
    samples.push_back(std::move(record->sample));
  }
  const auto factors = [&](Scaled scaled) {
    return identify_bounds(study.model, samples, {scaled, patience});
  };
  const BoundFactors both = factors(Scaled::both);
  const std::string until = time_text(study.labels, k);
  if (both.status == Status::failed) return "";
  if (both.status == Status::none) {
    return fmt::format(
        "The solver finds no W and V that explain the outputs up to {}, however large: "
        "look at the system and X0\n",
        until);
  }
  if (both.cost <= would_do) {
    return fmt::format(
        "The solver finds a trajectory with the study's W and V that explains the "
        "outputs up to {}: look at what the pipeline assumes beside them, such as its "
        "initial or admissible set\n",
        until);
  }
  return fmt::format(
      "Up to {} the outputs would be explained by W and V {:.4g} times as large "
      "({}, {}; proven: not by less than {:.4g}); see cordon identify\n",
      until, both.cost, alone("W", factors(Scaled::disturbances)),
      alone("V", factors(Scaled::noises)), both.proven);
}

}  // namespace cordon::apps
