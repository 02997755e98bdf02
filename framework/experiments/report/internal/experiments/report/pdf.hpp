// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace cordon::report {

/// Makes PDF documents of SVG drawings by the program rsvg-convert, which only those need who want
/// PDF: as a library it would take half as long again to start any command.
class PdfConverter {
 public:
  PdfConverter();  ///< throws Errc::io: no temporary directory
  ~PdfConverter();
  PdfConverter(const PdfConverter&) = delete;
  PdfConverter& operator=(const PdfConverter&) = delete;

  /// One page of the drawing's size, 96 units to the inch, with its fonts within. Throws Errc::io:
  /// the program is missing, or it failed.
  std::string pdf_of(const std::string& svg) const;

 private:
  std::filesystem::path directory_;
};

}  // namespace cordon::report
