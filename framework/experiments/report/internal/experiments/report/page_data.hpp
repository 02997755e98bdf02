// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "experiments/report/figure.hpp"

namespace cordon::report {

/// The report as JSON that may stand inside a `script` element: what the scripts of the page read.
std::string page_data(const Report& report);

/// The finite values as JSON numbers of six digits, more where they differ little; infinite ones as
/// "inf" and "-inf", NaN as null. Integers in equal steps become {"from", "by", "count"}.
enum class Rounding { nearest, down, up };
std::string packed_numbers(const std::vector<double>& values,
                           Rounding rounding = Rounding::nearest);

/// The table of numbers behind a drawing that the page does not make itself.
struct Numbers {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};
Numbers numbers_of(const Timeline& timeline);
Numbers numbers_of(const Intervals& intervals);

}  // namespace cordon::report
