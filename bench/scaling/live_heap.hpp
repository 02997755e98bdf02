// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace cordon::bench {

/// Bytes that this thread allocates and frees from here on, with what the C library rounds them up
/// to. One at a time; while none lives nothing is counted, and allocations take the time they
/// always take.
class LiveHeap {
 public:
  LiveHeap();
  ~LiveHeap();
  LiveHeap(const LiveHeap&) = delete;
  LiveHeap& operator=(const LiveHeap&) = delete;

  long growth() const;  ///< live now beyond what was live at the start; negative: more was freed
                        ///< than allocated
  long peak() const;    ///< the largest growth so far
};

}  // namespace cordon::bench
