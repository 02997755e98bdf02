// SPDX-License-Identifier: GPL-3.0-or-later
// SIGINT and SIGTERM end long work in order; SIGUSR1 takes note of alarms.
#pragma once

#include <atomic>

#include "common.hpp"

namespace cordon::apps {

inline constexpr Exit interrupted =
    static_cast<Exit>(130);  // as a shell reports a process that SIGINT ended

/// A flag that the first SIGINT or SIGTERM sets; the next one gets the system's default and kills.
/// Signals that the process was started to ignore stay ignored. A limit of file size becomes an
/// error of writing instead of the end of the process.
const std::atomic<bool>* stop_on_signals();

/// A flag that SIGUSR1 sets, for whoever takes it back.
std::atomic<bool>* acknowledge_on_signal();

}  // namespace cordon::apps
