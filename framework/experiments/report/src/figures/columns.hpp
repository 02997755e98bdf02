// SPDX-License-Identifier: GPL-3.0-or-later
// Tables that `cordon run` wrote, row by row, with columns found by their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/text/csv_reader.hpp"

namespace cordon::report {

class ColumnReader {
 public:
  /// Reads the header. Throws InputError: cannot be read, no header, or a column twice.
  explicit ColumnReader(const std::filesystem::path& file);

  const std::vector<std::string>& names() const { return names_; }
  /// Names of coordinates behind the head, "x_1 level [m]", are not part of what is looked for.
  std::optional<std::size_t> find(const std::string& name) const;
  /// Throws InputError if there is none.
  std::size_t need(const std::string& name) const;
  /// Columns PREFIX1, PREFIX2, … up to the first that is missing.
  std::vector<std::size_t> numbered(const std::string& prefix) const;

  /// The next row; false at the end. Throws InputError if it has another number of fields than the
  /// header.
  bool next();
  const std::string& text(std::size_t column) const { return row_.fields[column]; }
  /// NaN for an empty field, ±∞ for "inf" and "-inf"; nothing if it is no number.
  std::optional<double> value(std::size_t column) const;
  /// The same; throws InputError if it is no number.
  double number(std::size_t column) const;
  /// An integer of magnitude 2⁵³ at most; throws InputError otherwise.
  std::int64_t integer(std::size_t column) const;
  [[noreturn]] void refuse(const std::string& reason) const;  ///< about the current row

 private:
  std::filesystem::path file_;
  detail::CsvReader reader_;
  detail::CsvRow row_;
  std::vector<std::string> names_, keys_;
};

}  // namespace cordon::report
