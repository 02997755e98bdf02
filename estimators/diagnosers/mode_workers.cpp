// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/mode_workers.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <latch>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/system/system_error.hpp>

#include "cordon/solvers/limits.hpp"

namespace cordon::estimators {

struct ModeWorkers::Pool {
  explicit Pool(std::size_t number) : threads(number), size(number) {}
  boost::asio::thread_pool threads;
  std::size_t size;
};

ModeWorkers::ModeWorkers(Index threads) {
  const Index wanted = threads == 0
                           ? static_cast<Index>(std::max(1U, std::thread::hardware_concurrency()))
                           : threads;
  if (wanted <= 1) return;
  try {
    pool_ = std::make_unique<Pool>(static_cast<std::size_t>(wanted));
  } catch (const boost::system::system_error& error) {
    throw std::system_error(
        error.code().value(), std::system_category(),
        "cannot start " + std::to_string(wanted) + " threads, give fewer in \"threads\"");
  }
}

ModeWorkers::~ModeWorkers() {
  if (pool_) pool_->threads.join();
}

void ModeWorkers::for_each(Index count, const std::function<void(Index)>& work) {
  const SolverLimits limits = LimitedSolvers::of_this_thread();
  std::atomic<bool> left_open = false;
  const auto limited = [&](Index j) {
    const LimitedSolvers solvers(limits);
    work(j);
    if (solvers.left_open()) left_open = true;
  };
  if (!pool_ || count < 2) {
    for (Index j = 0; j < count; ++j) limited(j);
    return;
  }
  const auto threads = std::min(pool_->size, static_cast<std::size_t>(count));
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  std::atomic<Index> next = 0;
  std::latch done(static_cast<std::ptrdiff_t>(threads));
  for (std::size_t t = 0; t < threads; ++t) {
    boost::asio::post(pool_->threads, [&] {
      for (Index j = next++; j < count; j = next++) {
        try {
          limited(j);
        } catch (...) {
          failures[static_cast<std::size_t>(j)] = std::current_exception();
        }
      }
      done.count_down();
    });
  }
  done.wait();
  LimitedSolvers::tell_left_open(left_open);
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace cordon::estimators
