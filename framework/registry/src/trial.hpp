// SPDX-License-Identifier: GPL-3.0-or-later
// What a library does when it is opened is tried out where it can do no harm to this process.
#pragma once

#include <cfenv>
#include <functional>
#include <optional>

#include "refusal.hpp"

namespace cordon::registry {

struct Trial {
  std::optional<Refusal> refusal;  ///< why this process must not do the same
  bool repeats =
      true;  ///< false: it says something of the system at this moment, not of what was tried
};
/// What is tried; it says why it could not be done, which may depend on the system (a library that
/// is not installed).
using TrialBody = std::function<std::optional<Refusal>()>;

/// Runs `body` in a child process: one that crashes, ends the process, takes longer than 5 s of
/// computing or 30 s of time or more than 1 GiB of memory, or changes the floating-point arithmetic
/// (subnormal numbers, rounding, traps) is refused. Exceptions must not leave `body`. What it
/// prints is part of the reason at most. Not a sandbox: files and the network are within its reach.
Trial try_in_child(const TrialBody& body);

/// Calls `work` at several depths of the stack, and with more and more memory taken; what lies
/// below on the stack is no address. What damaged code does may depend on all that, and this
/// process does not stand where its child stood: what crashes at one of them is found out.
void at_several_depths(const std::function<void()>& work);

/// Puts the floating-point environment back at its end, whatever a library has done to it.
class KeptFloatingPoint {
 public:
  KeptFloatingPoint() { std::fegetenv(&kept_); }
  ~KeptFloatingPoint() { std::fesetenv(&kept_); }
  KeptFloatingPoint(const KeptFloatingPoint&) = delete;
  KeptFloatingPoint& operator=(const KeptFloatingPoint&) = delete;

 private:
  std::fenv_t kept_;
};

}  // namespace cordon::registry
