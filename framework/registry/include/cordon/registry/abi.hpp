// SPDX-License-Identifier: GPL-3.0-or-later
// The ABI tag: a text of everything that changes the layout of a shared type or the allocator
// behind it. Host and plugin compare it in the plugin's file, before the library is opened; built
// with other flags, a plugin would corrupt memory instead.
#pragma once

#include <Eigen/Core>

#include "cordon/registry/headers_hash.hpp"  // generated: CORDON_HEADERS_HASH

#define CORDON_ABI_VERSION 3u

#define CORDON_ABI_TEXT_(x) #x
#define CORDON_ABI_TEXT(x) CORDON_ABI_TEXT_(x)

#if defined(_GLIBCXX_DEBUG)
#define CORDON_ABI_DEBUG "1"
#else
#define CORDON_ABI_DEBUG "0"
#endif
#if defined(EIGEN_DEFAULT_TO_ROW_MAJOR)
#define CORDON_ABI_ORDER "row"
#else
#define CORDON_ABI_ORDER "column"
#endif
#if defined(__SANITIZE_ADDRESS__)
#define CORDON_ABI_ASAN "1"
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CORDON_ABI_ASAN "1"
#endif
#endif
#if !defined(CORDON_ABI_ASAN)
#define CORDON_ABI_ASAN "0"
#endif
#if defined(__SANITIZE_THREAD__)
#define CORDON_ABI_TSAN "1"
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define CORDON_ABI_TSAN "1"
#endif
#endif
#if !defined(CORDON_ABI_TSAN)
#define CORDON_ABI_TSAN "0"
#endif
// Arithmetic that the compiler may reorder or take to be finite proves nothing.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#define CORDON_ABI_FAST_MATH "1"
#else
#define CORDON_ABI_FAST_MATH "0"
#endif

#define CORDON_ABI_TAG \
  "gxx_abi=" CORDON_ABI_TEXT(__GXX_ABI_VERSION) ";cxx11_abi=" CORDON_ABI_TEXT(_GLIBCXX_USE_CXX11_ABI)            \
  ";stl_debug=" CORDON_ABI_DEBUG ";eigen=" CORDON_ABI_TEXT(EIGEN_WORLD_VERSION) "." CORDON_ABI_TEXT(            \
      EIGEN_MAJOR_VERSION) "." CORDON_ABI_TEXT(EIGEN_MINOR_VERSION) ";order=" CORDON_ABI_ORDER                   \
  ";index=" CORDON_ABI_TEXT(EIGEN_DEFAULT_DENSE_INDEX_TYPE) ";align=" CORDON_ABI_TEXT(EIGEN_MAX_ALIGN_BYTES)     \
  ";malloc=" CORDON_ABI_TEXT(EIGEN_MALLOC_ALREADY_ALIGNED) ";asan=" CORDON_ABI_ASAN ";tsan=" CORDON_ABI_TSAN     \
  ";fast_math=" CORDON_ABI_FAST_MATH ";headers=" CORDON_HEADERS_HASH
