// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "progress_bar.hpp"

using cordon::SweepProgress;
using cordon::apps::progress_line;

TEST_CASE("the remaining time is that of the points that are left, at the rate of this process") {
  CHECK(progress_line(SweepProgress{0, 8, 0, 0, 3}) ==
        "[" + std::string(30, ' ') + "]   0 %  0/8 points");
  CHECK(progress_line(SweepProgress{4, 8, 1, 0, 10}) ==
        "[" + std::string(15, '#') + std::string(15, ' ') +
            "]  50 %  4/8 points  1 failed  10 s left");
  CHECK(progress_line(SweepProgress{4, 8, 0, 2, 10}).ends_with("4/8 points  20 s left"));
  CHECK(progress_line(SweepProgress{4, 8, 0, 4, 10})
            .ends_with("4/8 points"));  // nothing is known yet
  CHECK(progress_line(SweepProgress{8, 8, 0, 0, 10}) ==
        "[" + std::string(30, '#') + "] 100 %  8/8 points  0 s left");
  CHECK(
      progress_line(SweepProgress{1, 1000, 0, 0, 10}).ends_with("1/1000 points  2 h 46 min left"));
  CHECK(progress_line(SweepProgress{0, 0, 0, 0, 0}) ==
        "[" + std::string(30, '#') + "] 100 %  0/0 points");
}
