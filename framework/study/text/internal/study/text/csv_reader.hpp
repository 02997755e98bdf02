// SPDX-License-Identifier: GPL-3.0-or-later
// Comma-separated values after RFC 4180, row by row.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "study/text/input_file.hpp"

namespace cordon::detail {

struct CsvRow {
  std::vector<std::string> fields;
  std::int64_t line = 0;  ///< line of the file on which the row starts
  std::string problem;    ///< not empty: the row is malformed
};

/// Reads rows of bytes. Lines end with LF, CR LF or CR; quoted fields may hold commas, quotes ("")
/// and line ends; a UTF-8 byte order mark is skipped; blank lines at the end of the file are
/// ignored, elsewhere they are malformed rows. A row beyond 1 MiB is malformed and skipped to its
/// end of line, so that memory stays bounded for any file. Throws InputError: not a regular file,
/// or an error of reading.
class CsvReader {
 public:
  explicit CsvReader(const std::filesystem::path& file);
  /// False at the end of the file.
  bool next(CsvRow& row);

 private:
  static constexpr int end_of_file = -1;
  static constexpr std::size_t row_limit = 1 << 20;

  int get();
  int peek();
  bool fill();
  void read_row(CsvRow& row, int first);
  void read_quoted(CsvRow& row, std::string& field);
  bool count(CsvRow& row);
  bool grow(CsvRow& row, std::string& field, int c);
  void skip_line();
  bool ends_line(int c);

  InputFile file_;
  std::vector<char> buffer_;
  std::size_t at_ = 0, filled_ = 0;
  std::int64_t line_ = 1;
  std::size_t row_bytes_ = 0;
};

}  // namespace cordon::detail
