// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupt.hpp"

#include <csignal>

namespace cordon::apps {

namespace {

std::atomic<bool> stop_requested = false, acknowledge_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

extern "C" void request_stop(int) {
  stop_requested = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

extern "C" void request_acknowledgement(int) { acknowledge_requested = true; }

}  // namespace

const std::atomic<bool>* stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    if (std::signal(signal, request_stop) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  std::signal(SIGXFSZ, SIG_IGN);
  return &stop_requested;
}

std::atomic<bool>* acknowledge_on_signal() {
  if (std::signal(SIGUSR1, request_acknowledgement) == SIG_IGN) std::signal(SIGUSR1, SIG_IGN);
  return &acknowledge_requested;
}

}  // namespace cordon::apps
