// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "experiments/report/figure.hpp"

namespace cordon::report {

enum class Detail {
  page,  ///< curves, times and vertices thinned out so that a page stays small, whatever the length
         ///< of the run is
  all    ///< every number of the files
};

/// The figures of a finished run or sweep, from its files alone. With Detail::page, memory does not
/// depend on the length of the run. Throws InputError: a file is missing, or is not as `cordon run`
/// wrote it; Errc::io.
Report read_report(const std::filesystem::path& directory, Detail detail = Detail::page);

}  // namespace cordon::report
