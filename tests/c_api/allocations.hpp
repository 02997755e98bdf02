// SPDX-License-Identifier: GPL-3.0-or-later
// A `new` that fails when a test wants it to.
#pragma once

#include <cstdint>

namespace c_test {

/// The next `n` allocations of this thread succeed, the one that follows throws std::bad_alloc, and
/// those after it succeed again.
void fail_after(std::int64_t n);
/// Has it happened since? From now on all succeed.
bool has_failed();

}  // namespace c_test
