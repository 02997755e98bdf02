// SPDX-License-Identifier: GPL-3.0-or-later
// MAT-files of MATLAB and Octave, through libmatio.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/interchange/mat_value.hpp"

namespace cordon::mat {

inline constexpr Index max_numbers = Index{1} << 24;  ///< of one file that is read
inline constexpr int max_nesting = 32;                ///< of structs and cells

/// The bytes of a MAT-file of version 5, compressed; the same for the same variables. Throws
/// Errc::invalid if a variable is too large for the format (2 GB).
std::string to_bytes(const Variables& variables);

/// The variables of a MAT-file of version 5 to 7.3. libmatio reads in a process of its own, whose
/// memory and time are limited: a damaged file may bring that down, and is an InputError here. What
/// cannot be used (complex numbers, objects, …) is `refused`.
Variables read_file(const std::filesystem::path& file);

}  // namespace cordon::mat
