// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs that samples of simulated data lack.
#include <cmath>

#include <doctest/doctest.h>

#include "data/records.hpp"

using namespace cordon;
using namespace data_test;

namespace {

/// Two states, both measured.
Study study_of(std::vector<DropoutSpec> dropouts, std::int64_t steps = 400) {
  Study study;
  LinearModel& m = study.model.linear;
  m.A = Matrix{{.5, .1}, {0, .8}};
  m.B = m.D = Matrix::Zero(2, 0);
  m.Bw = m.C = m.Dv = Matrix::Identity(2, 2);
  const LineForm box = make_box({Vector{{-1, -1}}, Vector{{1, 1}}});
  study.model.X0 = study.model.W = study.model.V = box;
  SimulateSpec spec;
  spec.steps = steps;
  spec.dropouts = std::move(dropouts);
  study.data = spec;
  return study;
}

DropoutSpec dropout(std::vector<Index> outputs, double probability = 1) {
  DropoutSpec spec;
  spec.outputs = std::move(outputs);
  spec.probability = probability;
  return spec;
}

}  // namespace

TEST_CASE("outputs are lost as often as asked for, each by itself, and nothing else changes") {
  const auto complete = all(study_of({})), gaps = all(study_of({dropout({0, 1}, .3)}));
  REQUIRE(complete.size() == gaps.size());
  int lost[2] = {0, 0}, both = 0;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const Sample &whole = complete[k].sample, &sample = gaps[k].sample;
    CHECK(*gaps[k].truth == *complete[k].truth);
    for (Index i = 0; i < 2; ++i) {
      if (std::isnan(sample.y[i])) {
        ++lost[i];
      } else {
        CHECK(sample.y[i] == whole.y[i]);
      }
    }
    both += sample.missing == std::vector<Index>{0, 1};
  }
  for (const int count : lost) CHECK(std::abs(count - 120) < 30);
  CHECK(std::abs(both - 36) < 20);
  const auto others = all(study_of({dropout({1}, .3)}));  // what output 2 loses is its own matter
  const auto again = all(study_of({dropout({0, 1}, .3)}));
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    CHECK(std::isnan(others[k].sample.y[1]) == std::isnan(gaps[k].sample.y[1]));
    CHECK(again[k].sample.missing == gaps[k].sample.missing);
  }
}

TEST_CASE("a slow sensor, a time without samples, and both at once") {
  DropoutSpec slow = dropout({1}), nothing = dropout({0, 1});
  slow.from = 3;
  slow.every = 5;
  nothing.from = 8;
  nothing.to = 9;
  for (const Record& record : all(study_of({slow, nothing}, 20))) {
    const Index k = record.sample.k;
    const bool silent = k == 8 || k == 9, is_due = k < 3 || (k - 3) % 5 == 0;
    std::vector<Index> missing;
    if (silent) missing.push_back(0);
    if (silent || !is_due) missing.push_back(1);
    CHECK(record.sample.missing == missing);
  }
}

TEST_CASE("dropouts that do not fit are refused") {
  DropoutSpec backwards = dropout({0});
  backwards.from = 5;
  backwards.to = 4;
  CHECK(message_of(study_of({dropout({2})})).find("no row of /system/C") != std::string::npos);
  CHECK(message_of(study_of({dropout({0}, 2)})).find("[0, 1]") != std::string::npos);
  CHECK(message_of(study_of({backwards})).find("ends before it begins") != std::string::npos);
}
