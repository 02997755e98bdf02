// SPDX-License-Identifier: GPL-3.0-or-later
// Random systems of the kinds that have gone wrong, as studies with every pipeline there is.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

namespace cordon::campaigns {

enum class Start {
  bounded,           ///< in X0
  unknown,           ///< anywhere, up to 1e7 times as far from the origin; line zonotopes only
  bounded_with_gaps  ///< in X0, and every output is missing in three samples of ten
};

/// The study of this number: the same on every machine. Up to six states and three outputs; stable,
/// unstable and singular A, singular and regular E, units from 1e-6 to 1e6, outputs without noise,
/// repeated rows, matrices of zeros. Its pipelines are all observers on all backends, of which a
/// study may refuse some.
nlohmann::ordered_json random_study(std::uint64_t number, Start start = Start::bounded);

}  // namespace cordon::campaigns
