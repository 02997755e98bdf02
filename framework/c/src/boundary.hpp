// SPDX-License-Identifier: GPL-3.0-or-later
// What stands between C and the framework: exceptions become codes, and arithmetic is the default.
#pragma once

#include <cfenv>
#include <string>
#include <vector>

#include "cordon.h"
#include "cordon/core/error.hpp"

namespace cordon::c {

/// The default floating-point environment, until its end: programs may round otherwise, flush
/// subnormal numbers to zero or trap.
class DefaultArithmetic {
 public:
  DefaultArithmetic() {
    std::fegetenv(&kept_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultArithmetic() { std::fesetenv(&kept_); }
  DefaultArithmetic(const DefaultArithmetic&) = delete;
  DefaultArithmetic& operator=(const DefaultArithmetic&) = delete;

 private:
  std::fenv_t kept_;
};

/// A pointer that must not be NULL is; thrown, and told as CORDON_NULL.
struct NullArgument {
  const char* what;
};

/// In a catch clause: the exception becomes the last error of this thread. Returns its code.
int keep_error(const char* function) noexcept;

constexpr int none = CORDON_NONE, refused = CORDON_REFUSED;

/// What `get` returns, or `otherwise`.
template <class Result, class Get>
Result got(const char* function, Result otherwise, Get&& get) noexcept {
  try {
    return get();
  } catch (...) {
    keep_error(function);
    return otherwise;
  }
}

/// The code of `work`.
template <class Work>
int done(const char* function, Work&& work) noexcept {
  try {
    const DefaultArithmetic arithmetic;
    work();
    return CORDON_OK;
  } catch (...) {
    return keep_error(function);
  }
}

template <class T>
T& required(T* pointer, const char* what) {
  if (!pointer) throw NullArgument{what};
  return *pointer;
}

/// The entry of this index; `what` names one of them.
template <class List>
auto& entry(List& list, int i, const char* what) {
  if (i < 0 || static_cast<std::size_t>(i) >= list.size())
    throw Error(Errc::invalid, "there is no " + std::string(what) + " " + std::to_string(i) +
                                   ": there are " + std::to_string(list.size()) +
                                   ", counted from 0");
  return list[static_cast<std::size_t>(i)];
}

template <class List>
int count_of(const List& list) {
  return static_cast<int>(list.size());
}

}  // namespace cordon::c
