// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/registry/build.hpp"

#include <boost/version.hpp>
#include <fmt/format.h>

#include "build_info.hpp"
#include "cordon/registry/abi.hpp"

namespace cordon {

BuildInfo build_info() {
#if defined(__clang__)
  const std::string compiler = __VERSION__;
#else
  const std::string compiler = std::string("GCC ") + __VERSION__;
#endif
  return {CORDON_VERSION,
          CORDON_ABI_TAG,
          {{"compiler", compiler},
           {"eigen",
            fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
           {"boost", fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000,
                                 BOOST_VERSION % 100)},
           {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                               FMT_VERSION % 100)}}};
}

}  // namespace cordon
