// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/mode_elimination.hpp"

#include <doctest/doctest.h>

using namespace cordon;
using cordon::estimators::ModeElimination;

namespace {

constexpr Index waiting_time = 5;

std::vector<bool> none() { return {false, false, false}; }
std::vector<bool> these(std::initializer_list<Index> modes) {
  std::vector<bool> excluded = none();
  for (const Index j : modes) excluded[static_cast<std::size_t>(j)] = true;
  return excluded;
}

}  // namespace

TEST_CASE("a known mode is monitored, whatever is said of the others") {
  ModeElimination logic(3, waiting_time, 0);
  CHECK(logic.decision() == Decision::monitoring);
  CHECK(logic.mode() == 0);
  CHECK_FALSE(logic.update(1, these({1, 2})));
  CHECK(logic.mode() == 0);
  CHECK(logic.since() == 0);
}

TEST_CASE("without a known mode every mode is a candidate") {
  ModeElimination logic(3, waiting_time, {});
  logic.start(7);
  CHECK(logic.decision() == Decision::isolating);
  CHECK(logic.mode() == -1);
  CHECK_FALSE(logic.update(8, these({0, 2})));
  CHECK(logic.decision() == Decision::monitoring);
  CHECK(logic.mode() == 1);
  CHECK(logic.since() == 7);
}

TEST_CASE("an excluded mode begins an isolation that ends with the one that is left") {
  ModeElimination logic(3, waiting_time, 0);
  REQUIRE(logic.update(51, these({0})));
  CHECK(logic.decision() == Decision::isolating);
  CHECK(logic.since() == 51);
  for (Index j = 0; j < 3; ++j) CHECK(logic.is_candidate(j));
  CHECK_FALSE(logic.update(52, these({0, 2})));
  CHECK(logic.decision() == Decision::monitoring);
  CHECK(logic.mode() == 1);
  SUBCASE("and the way back is the same") {
    REQUIRE(logic.update(101, these({1})));
    CHECK(logic.decision() == Decision::isolating);
    CHECK_FALSE(logic.update(102, these({1, 2})));
    CHECK(logic.mode() == 0);
  }
  SUBCASE("a mode that lasted for less than the waiting time cannot be in the bank") {
    REQUIRE(logic.update(55, these({1})));
    CHECK(logic.decision() == Decision::unknown_fault);
    CHECK(logic.mode() == -1);
  }
  SUBCASE("at the waiting time it can") {
    REQUIRE(logic.update(56, these({1})));
    CHECK(logic.decision() == Decision::isolating);
  }
}

TEST_CASE("an exclusion is never taken back before a reset") {
  ModeElimination logic(3, waiting_time, {});
  logic.start(0);
  logic.update(1, these({1}));
  logic.update(2, none());
  CHECK_FALSE(logic.is_candidate(1));
}

TEST_CASE("several candidates after the waiting time are ambiguous, and may still be told apart") {
  ModeElimination logic(3, waiting_time, 0);
  logic.update(10, these({0}));
  logic.update(11, these({0}));
  for (Index k = 12; k < 15; ++k) {
    logic.update(k, none());
    CHECK(logic.decision() == Decision::isolating);
  }
  logic.update(15, none());
  CHECK(logic.decision() == Decision::ambiguous);
  SUBCASE("one is left") {
    logic.update(16, these({2}));
    CHECK(logic.decision() == Decision::monitoring);
    CHECK(logic.mode() == 1);
  }
  SUBCASE("none is left: after that time the mode may have changed") {
    REQUIRE(logic.update(16, these({1, 2})));
    CHECK(logic.decision() == Decision::isolating);
    CHECK(logic.since() == 16);
  }
}

TEST_CASE("no candidate left is an unknown fault, which ends when one mode has lasted") {
  ModeElimination logic(3, waiting_time, 0);
  logic.update(10, these({0}));
  REQUIRE(logic.update(11, these({0, 1, 2})));
  CHECK(logic.decision() == Decision::unknown_fault);
  CHECK(logic.since() == 11);
  SUBCASE("not at once: the others may go first by chance") {
    CHECK_FALSE(logic.update(12, these({1, 2})));
    CHECK(logic.decision() == Decision::unknown_fault);
    REQUIRE(logic.update(13, these({0})));
    CHECK(logic.decision() == Decision::unknown_fault);
    CHECK(logic.since() == 13);
  }
  SUBCASE("after the waiting time") {
    logic.update(12, these({1, 2}));
    for (Index k = 13; k < 16; ++k) {
      logic.update(k, none());
      CHECK(logic.decision() == Decision::unknown_fault);
    }
    logic.update(16, none());
    CHECK(logic.decision() == Decision::monitoring);
    CHECK(logic.mode() == 0);
  }
  SUBCASE("several that last are ambiguous") {
    for (Index k = 12; k < 17; ++k) logic.update(k, these({1}));
    CHECK(logic.decision() == Decision::ambiguous);
  }
}
