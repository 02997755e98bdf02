// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that includes GLPK. Facts that its users live with: the environment is per thread;
// NaN or a bad index aborts the process, so everything is validated before; an internal error calls
// a hook that must not return, so it jumps out, and the thread's environment is thrown away with
// every problem in it.
#pragma once

#include <cmath>
#include <csetjmp>

#include <glpk.h>

namespace cordon::glpk {

// Trivially destructible on purpose.
inline thread_local std::jmp_buf escape;
inline thread_local unsigned environment =
    0;  ///< grows when the thread's environment was thrown away

/// Says nothing: what breaks GLPK down is printed to the standard output else, whatever was set.
inline int keep_silent(void*, const char*) { return 1; }

[[noreturn]] inline void leave(void*) { std::longjmp(escape, 1); }

/// GLPK frees nothing when a thread ends. Problems that outlive it are lost with its environment,
/// and know it by the counter.
struct Reclaim {
  void keep() const {}
  ~Reclaim() {
    glp_free_env();
    ++environment;
  }
};
inline thread_local Reclaim reclaim;

/// Runs plain C calls (no object with a destructor may live in `work`); false if GLPK broke down.
template <class Work>
bool guarded(Work work) {
  reclaim.keep();  // made with the thread's first call
  glp_term_hook(keep_silent, nullptr);
  glp_error_hook(leave, nullptr);
  if (setjmp(escape) != 0) {
    glp_error_hook(nullptr, nullptr);
    glp_free_env();
    ++environment;
    return false;
  }
  work();
  glp_error_hook(nullptr, nullptr);
  return true;
}

inline int bound_type(double lower, double upper) {
  const bool below = std::isfinite(lower), above = std::isfinite(upper);
  if (below && above) return lower == upper ? GLP_FX : GLP_DB;
  return below ? GLP_LO : above ? GLP_UP : GLP_FR;
}

}  // namespace cordon::glpk
