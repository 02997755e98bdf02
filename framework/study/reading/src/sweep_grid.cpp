// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/sweep_grid.hpp"

#include "cordon/core/error.hpp"

namespace cordon {

SweepGrid::SweepGrid(const Study& study) : pipelines_(study.pipelines.size()) {
  std::int64_t points = static_cast<std::int64_t>(pipelines_);
  for (const SweepAxis& axis : study.sweep) {
    const auto values = static_cast<std::int64_t>(axis.values.size());
    if (__builtin_mul_overflow(points, values, &points)) {
      throw Error(Errc::invalid,
                  "the sweep has more points than can be counted; give its axes fewer values");
    }
    combinations_ *= values;
    sizes_.push_back(axis.values.size());
  }
}

SweepPoint SweepGrid::operator[](std::int64_t index) const {
  if (index < 0 || index >= size()) {
    throw Error(Errc::invalid, "there is no point " + std::to_string(index) +
                                   "; the sweep has the points 0 to " + std::to_string(size() - 1));
  }
  const auto pipelines = static_cast<std::int64_t>(pipelines_);
  SweepPoint point{index, std::vector<std::size_t>(sizes_.size()),
                   static_cast<std::size_t>(index % pipelines)};
  std::int64_t rest = index / pipelines;
  for (std::size_t i = sizes_.size(); i-- > 0;) {
    const auto size = static_cast<std::int64_t>(sizes_[i]);
    point.at[i] = static_cast<std::size_t>(rest % size);
    rest /= size;
  }
  return point;
}

}  // namespace cordon
