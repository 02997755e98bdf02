// SPDX-License-Identifier: GPL-3.0-or-later
// The points of a sweep, and the study at each of them.
#pragma once

#include <cstdint>
#include <vector>

#include "cordon/study/study.hpp"

namespace cordon {

/// One pipeline under one combination of values.
struct SweepPoint {
  std::int64_t index = 0;       ///< in the grid
  std::vector<std::size_t> at;  ///< per axis: index of the value
  std::size_t pipeline = 0;
};

/// The points of a sweep, in a fixed order: index = combination · pipelines + pipeline, and
/// combinations count like a number whose digits are the axes, the last one fastest. A study
/// without a sweep has one combination.
class SweepGrid {
 public:
  explicit SweepGrid(const Study& study);
  std::int64_t size() const { return combinations_ * static_cast<std::int64_t>(pipelines_); }
  std::int64_t combinations() const { return combinations_; }
  SweepPoint operator[](std::int64_t index) const;

 private:
  std::vector<std::size_t> sizes_;
  std::size_t pipelines_;
  std::int64_t combinations_ = 1;
};

/// The study under one combination of values, with every default. Reads it anew: throws InputError
/// for a combination that is wrong though each value is right. Loads no plugin; safe to call from
/// several threads.
Study study_at(const Study& study, const std::vector<std::size_t>& at, const Registry& registry);
/// One point as a study of its own, with its pipeline alone: another one that does not go together
/// with the model and the data under these values does not matter.
Study study_at(const Study& study, const SweepPoint& point, const Registry& registry);

}  // namespace cordon
