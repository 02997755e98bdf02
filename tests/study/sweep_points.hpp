// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with a sweep that are read with their registry, and the studies of their points.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/experiments/sweep.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/same_study.hpp"

namespace study_test {

using namespace cordon;

using Combination = std::vector<std::size_t>;

/// A study with its registry.
struct Read {
  explicit Read(const std::string& text) {
    registry.add(register_fakes);
    study = read_study(scratch.write("study.json", text), registry, SearchPath{});
  }
  Study at(const Combination& combination) const { return study_at(study, combination, registry); }

  Scratch scratch;
  Registry registry;
  Study study;
};

/// The sweep study with another third axis.
inline std::string with_axis(const std::string& path, const std::string& values) {
  return exchanged(sweep_study, "\"path\": \"/data/simulate/seed\", \"range\": [1, 9, 4]",
                   "\"path\": \"" + path + "\", \"values\": " + values);
}

inline void expect_same(const Study& a, const Study& b) {
  CHECK(a.resolved == b.resolved);
  CHECK(same(a, b));
}

/// Every point of the study, and of the study that its resolved text is, reads the same.
inline void expect_points_round_trip(const Read& read) {
  const Read again(read.study.resolved);
  CHECK(same(read.study, again.study));
  CHECK(read.study.resolved == again.study.resolved);
  Combination at(read.study.sweep.size(), 0);
  for (std::size_t axis = 0; axis < at.size();) {
    CAPTURE(at);
    expect_same(read.at(at), again.at(at));
    for (axis = 0; axis < at.size() && ++at[axis] == read.study.sweep[axis].values.size(); ++axis)
      at[axis] = 0;
  }
}

}  // namespace study_test
