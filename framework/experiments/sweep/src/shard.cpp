// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/experiments/sweep.hpp"

namespace cordon {

bool Shard::has(const SweepPoint& point, std::size_t pipelines) const {
  const std::int64_t combination = point.index / static_cast<std::int64_t>(pipelines);
  return (combination + static_cast<std::int64_t>(point.pipeline)) % of == part - 1;
}

}  // namespace cordon
