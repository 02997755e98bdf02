// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "cordon/core/types.hpp"

namespace cordon::estimators {

/// Runs the same work for every mode of a bank, on threads that live as long as this object. What
/// each call computes must not depend on the others, so that results are the same bit by bit for
/// any number of threads.
class ModeWorkers {
 public:
  /// 1: in the caller's thread; 0: one thread per core.
  explicit ModeWorkers(Index threads);
  ~ModeWorkers();
  ModeWorkers(const ModeWorkers&) = delete;
  ModeWorkers& operator=(const ModeWorkers&) = delete;

  /// work(0), …, work(count - 1), and waits for all of them. Each has the limits of the caller's
  /// solvers, and the whole number of programs. Of several exceptions, that of the
  /// lowest index is thrown.
  void for_each(Index count, const std::function<void(Index)>& work);

 private:
  struct Pool;
  std::unique_ptr<Pool> pool_;  ///< none: in the caller's thread
};

}  // namespace cordon::estimators
