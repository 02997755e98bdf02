// SPDX-License-Identifier: GPL-3.0-or-later
// States of timelines that no diagnosis has left are refused before anything is made of them.
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "study/session/diagnosis_timeline.hpp"

using namespace cordon;
using detail::DiagnosisBefore;
using detail::DiagnosisTimeline;

namespace {

/// Reads a timeline from what is before it, the modes with questions left open, and a number of
/// events that wait.
void read(DiagnosisTimeline& timeline, std::optional<DiagnosisBefore> before, std::size_t open,
          std::size_t untold) {
  std::vector<char> left_open(open);
  Archive out(nullptr);
  out(before, left_open, untold);
  Archive in(nullptr, out.bytes());
  timeline.serialize(in);
}

}  // namespace

TEST_CASE("events that wait belong to a diagnosis, and there is one of each mode at most") {
  DiagnosisBefore before;
  before.candidate = {1, 0};
  for (const std::size_t untold : {std::size_t{1}, std::size_t{3}, ~std::size_t{0} / 2}) {
    DiagnosisTimeline timeline;
    CHECK_THROWS_AS(read(timeline, std::nullopt, 0, untold), Error);
    if (untold > 2) CHECK_THROWS_AS(read(timeline, before, 2, untold), Error);
  }
}

TEST_CASE("a timeline is that of a bank of as many modes") {
  DiagnosisTimeline timeline;
  CHECK(timeline.fits(0));
  CHECK(timeline.fits(3));
  DiagnosisBefore before;
  before.candidate = {1, 0};
  read(timeline, before, 2, 0);
  CHECK(timeline.fits(2));
  CHECK_FALSE(timeline.fits(1));
  CHECK_FALSE(timeline.fits(3));
  DiagnosisTimeline open;
  read(open, std::nullopt, 3, 0);
  CHECK_FALSE(open.fits(2));
}
