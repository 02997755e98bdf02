// SPDX-License-Identifier: GPL-3.0-or-later
// What became of the points of a sweep, in memory and as lines of text.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cordon/experiments/sweep.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::detail {

inline constexpr std::int64_t most_parts = 10'000;  ///< of a sweep

struct PointResult {
  std::int64_t index = 0;
  std::vector<ResultNumber> numbers;  ///< none is NaN
  std::string error;                  ///< empty: the point did not fail
  std::optional<Errc> code = {};      ///< of the error
};

/// One line of JSON, without its end. Reading it gives the same result to the last bit, but for
/// numbers that are NaN and bytes that are no UTF-8.
std::string line_of(const PointResult& result);
/// Nothing if the text is no such line.
std::optional<PointResult> point_of(std::string_view line);

/// The error of this name.
std::optional<Errc> error_code(std::string_view name);

/// Adds the members of an object: numbers, "inf" and "-inf". False, and a problem is told, if there
/// is anything else.
bool read_numbers(const json::Cursor& at, bool measured, std::vector<ResultNumber>& numbers);

/// The points that are done, by index.
class SweepRows {
 public:
  void add(const PointResult& result);   ///< the first result of a point counts
  bool extend(const PointResult& more);  ///< adds numbers to a point; false if there is none
  void merge(const SweepRows& other);
  bool has(std::int64_t index) const { return rows_.count(index) > 0; }
  std::int64_t size() const { return static_cast<std::int64_t>(rows_.size()); }
  std::int64_t failed() const { return failed_; }
  std::optional<Errc> first_error() const;
  std::optional<Errc> code(std::int64_t index) const;  ///< of the error of a point
  /// Names come from the study.
  ResultTable table(const Study& study) const;

 private:
  struct Row {
    std::vector<std::pair<std::size_t, double>> numbers;  ///< by name
    std::string error;
    std::optional<Errc> code;
  };

  std::size_t id(const ResultColumn& column);

  std::map<std::int64_t, Row> rows_;
  std::vector<ResultColumn> names_;
  std::map<std::pair<std::string, bool>, std::size_t> ids_;
  std::int64_t failed_ = 0;
};

/// Rows at which a guarantee was violated.
std::int64_t violations(const ResultTable& table);

}  // namespace cordon::detail
