// SPDX-License-Identifier: GPL-3.0-or-later
// The second opinion of a verification.
#pragma once

#include <atomic>
#include <string>

#include "cdd/cddlib.hpp"
#include "cdd/second_opinion.hpp"
#include "cordon/study/verify.hpp"

namespace cordon::verification {

/// As long as it lives, cddlib is asked what this thread asks the project's own engine.
class CddlibListener {
 public:
  explicit CddlibListener(const std::atomic<bool>* stop) : opinion_(cddlib_, stop) {}

  /// What is checked from now on, for messages.
  void asked_by(const std::string& pipeline);
  void asked_by(const std::string& pipeline, Index k);

  SecondOpinionFindings findings() const;

 private:
  cdd::Cddlib cddlib_;
  cdd::SecondOpinion opinion_;
  ObservedExactly observed_{&opinion_};
};

}  // namespace cordon::verification
