// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions of C for tests.
#pragma once

#include <cmath>
#include <string>

#include "cordon.h"
#include "online/study.hpp"

namespace c_test {

using namespace online_test;

/// A session that is closed at its end.
class Opened {
 public:
  explicit Opened(const std::string& pipeline, const std::string& online = "")
      : session_(cordon_open_text(study_text(online).c_str(), nullptr, pipeline.c_str(), nullptr)) {
  }
  ~Opened() { cordon_close(session_); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  operator cordon_session*() const { return session_; }

  int step(const GivenSample& sample) {
    return cordon_step(session_, sample.u.data(), static_cast<int>(sample.u.size()),
                       sample.y.data(), static_cast<int>(sample.y.size()));
  }
  int take(const GivenSample& sample) {
    return cordon_take(session_, *sample.k, sample.u.data(), static_cast<int>(sample.u.size()),
                       sample.y.data(), static_cast<int>(sample.y.size()));
  }

 private:
  cordon_session* session_;
};

inline std::string last_error() { return cordon_last_error(); }

inline bool says(const char* text) { return last_error().find(text) != std::string::npos; }

inline GivenSample sample_of(double u, double y_1, double y_2) {
  return {{}, Vector::Constant(1, u), Vector{{y_1, y_2}}};
}

}  // namespace c_test
