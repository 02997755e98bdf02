// SPDX-License-Identifier: GPL-3.0-or-later
// A small study with two modes, one with the published descriptor system, and equality of records.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "cordon/study/data.hpp"
#include "data/published.hpp"

namespace data_test {

using namespace cordon;

inline LineForm box(Vector lower, Vector upper) {
  return make_box({std::move(lower), std::move(upper)});
}
inline LineForm unit_box(Index n) { return box(-Vector::Ones(n), Vector::Ones(n)); }

inline Model two_states() {
  Model model;
  model.linear.A = Matrix{{.9, .1}, {0, .8}};
  model.linear.B = Matrix{{0.}, {1.}};
  model.linear.Bw = Matrix::Identity(2, 2);
  model.linear.C = Matrix{{1., 0.}};
  model.linear.D = Matrix{{.5}};
  model.linear.Dv = Matrix{{.5}};
  model.X0 = box(Vector{{1., -3.}}, Vector{{2., 5.}});
  model.W = unit_box(2);
  model.V = unit_box(1);
  return model;
}

/// Mode 1 has another A, C and D, and an X0 of its own.
inline Study study_of(SimulateSpec spec = {}) {
  Study study;
  study.file = "study.json";
  study.model = two_states();
  Model weak = two_states();
  weak.linear.A = Matrix{{.5, .2}, {.1, .4}};
  weak.linear.C = Matrix{{.5, 1.}};
  weak.linear.D = Matrix{{.25}};
  weak.X0 = box(Vector{{-7., 6.}}, Vector{{-6., 7.}});
  study.modes = {{"weak", weak}};
  study.data = std::move(spec);
  return study;
}

inline Study descriptor_study(LineForm x0_set) {
  Study study;
  study.file = "study.json";
  study.model = published::descriptor_model();
  SimulateSpec spec;
  spec.x0_set = std::move(x0_set);
  spec.steps = 5;
  spec.input = published::descriptor_input();
  study.data = std::move(spec);
  return study;
}

inline bool same(const std::vector<Record>& a, const std::vector<Record>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Record& p, const Record& q) {
    return p.sample.k == q.sample.k && p.sample.u == q.sample.u && p.sample.y == q.sample.y &&
           *p.truth == *q.truth && p.mode == q.mode;
  });
}

}  // namespace data_test
