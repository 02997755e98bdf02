// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/experiments/sweep.hpp"

using namespace cordon;

namespace {

Study study(const std::vector<std::size_t>& sizes, std::size_t pipelines) {
  Study s;
  s.pipelines.resize(pipelines);
  for (const std::size_t size : sizes)
    s.sweep.push_back({"axis", "/a", std::vector<std::string>(size, "1"), false});
  return s;
}

}  // namespace

TEST_CASE("points count pipelines first, then the last axis") {
  const SweepGrid grid(study({2, 3}, 4));
  CHECK(grid.size() == 24);
  CHECK(grid.combinations() == 6);
  CHECK(grid[0].at == std::vector<std::size_t>{0, 0});
  CHECK(grid[3].at == std::vector<std::size_t>{0, 0});
  CHECK(grid[3].pipeline == 3);
  CHECK(grid[4].at == std::vector<std::size_t>{0, 1});
  CHECK(grid[23].at == std::vector<std::size_t>{1, 2});
  CHECK(grid[23].pipeline == 3);
  CHECK(grid[23].index == 23);
}

TEST_CASE("a study without a sweep has one combination") {
  const SweepGrid grid(study({}, 2));
  CHECK(grid.size() == 2);
  CHECK(grid[1].at.empty());
  CHECK(grid[1].pipeline == 1);
}

TEST_CASE("there are no other points") {
  const SweepGrid grid(study({3}, 2));
  CHECK_THROWS_WITH_AS(grid[6], "there is no point 6; the sweep has the points 0 to 5", Error);
  CHECK_THROWS_AS(grid[-1], Error);
}

TEST_CASE("a sweep beyond counting is refused") {
  CHECK_THROWS_WITH_AS(SweepGrid(study(std::vector<std::size_t>(10, 1000), 1)),
                       doctest::Contains("more points than can be counted"), Error);
}

TEST_CASE("every point belongs to exactly one part, and parts are about equal") {
  CHECK(rc::check([] {
    const auto axes = *rc::gen::inRange<std::size_t>(0, 5);
    const auto sizes =
        *rc::gen::container<std::vector<std::size_t>>(axes, rc::gen::inRange<std::size_t>(1, 5));
    const auto pipelines = *rc::gen::inRange<std::size_t>(1, 6);
    const auto of = *rc::gen::inRange<std::int64_t>(1, 8);
    const SweepGrid grid(study(sizes, pipelines));
    std::vector<std::int64_t> counts(static_cast<std::size_t>(of));
    for (std::int64_t i = 0; i < grid.size(); ++i) {
      int owners = 0;
      for (std::int64_t part = 1; part <= of; ++part) {
        if (!Shard{part, of}.has(grid[i], pipelines)) continue;
        ++owners;
        ++counts[static_cast<std::size_t>(part) - 1];
      }
      RC_ASSERT(owners == 1);
    }
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    RC_ASSERT(*most - *least <= static_cast<std::int64_t>(pipelines));
  }));
}

TEST_CASE("parts take the pipelines in turns") {
  const SweepGrid grid(study({4}, 4));
  const Shard second{2, 4};
  std::vector<std::size_t> pipelines;
  for (std::int64_t i = 0; i < grid.size(); ++i) {
    if (second.has(grid[i], 4)) pipelines.push_back(grid[i].pipeline);
  }
  CHECK(pipelines == std::vector<std::size_t>{1, 0, 3, 2});
}
