// SPDX-License-Identifier: GPL-3.0-or-later
// What somebody is ready to spend on exact polyhedra.
#pragma once

#include <functional>

namespace cordon {

/// As long as it lives, what its thread asks of Polytope may take this many operations on machine
/// words altogether, about 3e8 per second; what takes more ends with Errc::unsupported, and the
/// message names the limit. Counted are conversions, projections of exchange forms, sums, maps,
/// comparisons and simplices of volumes. The same questions count the same on every machine.
/// Budgets may be nested: what an inner one counts, the outer ones count as well. Without one the
/// limits of Polytope alone hold. It is destroyed on the thread that made it.
class ExactBudget {
 public:
  explicit ExactBudget(double operations);
  ExactBudget(const ExactBudget&) = delete;
  ExactBudget& operator=(const ExactBudget&) = delete;
  ~ExactBudget();

  double spent() const { return spent_; }

  /// Counts for every budget of this thread.
  static void spend(double operations);

 private:
  double limit_, spent_ = 0;
  ExactBudget* outer_;
};

/// As long as it lives, `look` is called wherever the work of its thread is counted; what it throws
/// ends the work. Watches may be nested: the innermost one looks. It is destroyed on the thread
/// that made it.
class ExactWatch {
 public:
  explicit ExactWatch(std::function<void()> look);
  ExactWatch(const ExactWatch&) = delete;
  ExactWatch& operator=(const ExactWatch&) = delete;
  ~ExactWatch();

  void look() const { look_(); }

 private:
  std::function<void()> look_;
  ExactWatch* outer_;
};

}  // namespace cordon
