// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace cordon::bench {

/// Calls of malloc, calloc, realloc and aligned_alloc by this thread so far.
long allocations();

}  // namespace cordon::bench
