// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/exact_budget.hpp"

#include <string>
#include <utility>

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

thread_local ExactBudget* budget_of_this_thread = nullptr;
thread_local ExactWatch* watch_of_this_thread = nullptr;

}  // namespace

ExactBudget::ExactBudget(double operations)
    : limit_(operations), outer_(std::exchange(budget_of_this_thread, this)) {}

ExactBudget::~ExactBudget() { budget_of_this_thread = outer_; }

void ExactBudget::spend(double operations) {
  if (watch_of_this_thread) watch_of_this_thread->look();
  for (ExactBudget* budget = budget_of_this_thread; budget; budget = budget->outer_) {
    budget->spent_ += operations;
    if (budget->spent_ > budget->limit_) {
      throw Error(Errc::unsupported,
                  "polytope: more than " +
                      std::to_string(static_cast<long long>(budget->limit_ / 1e6)) +
                      " million operations on machine words, the limit of exact work, are needed");
    }
  }
}

ExactWatch::ExactWatch(std::function<void()> look)
    : look_(std::move(look)), outer_(std::exchange(watch_of_this_thread, this)) {}

ExactWatch::~ExactWatch() { watch_of_this_thread = outer_; }

}  // namespace cordon
