// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of a finished run or sweep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cordon {

struct ReportOptions {
  bool html = true;  ///< report.html: one file that needs nothing else
  bool svg = false;  ///< figures/NAME.svg
  bool csv = false;  ///< figures/NAME.csv: the numbers of each figure
  bool pdf = false;  ///< figures/NAME.pdf: the same drawings
};

/// Reads the files that `cordon run` has left in `directory`, and no plugin, and writes the figures
/// there. Size of the page and memory (but for `csv`, which holds every number) do not depend on
/// the length of the run: curves are thinned out so that bands still enclose what they stand for.
/// Returns the files. Throws InputError, Errc::io.
std::vector<std::filesystem::path> write_report(const std::filesystem::path& directory,
                                                const ReportOptions& options = {});

/// report.html of results that are complete, for a caller that holds the directory; added to
/// `files`. A report that fails is no reason to lose results: why it failed is returned, "" if it
/// did not.
std::string add_report(const std::filesystem::path& directory,
                       std::vector<std::filesystem::path>& files) noexcept;

/// Points in the order of x; NaN is a gap.
struct Curve {
  std::string title, x_label, y_label;
  std::vector<double> x, y;
};
/// The curve through them as an SVG file for a paper.
std::string svg_of(const Curve& curve);

}  // namespace cordon
