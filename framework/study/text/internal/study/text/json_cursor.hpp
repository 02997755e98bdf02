// SPDX-License-Identifier: GPL-3.0-or-later
// Typed reading of a JSON tree. A reader returns nothing when the value is wrong, after it has
// reported why: whoever asked goes on with the rest of the file, and skips only what depends on the
// missing value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/core/types.hpp"
#include "study/text/json_text.hpp"

namespace cordon::json {

inline constexpr Index max_dimension = 1000;
inline constexpr Index max_entries = 1'000'000;  ///< of one matrix
inline constexpr double max_integer =
    9007199254740992;  ///< 2⁵³: every integer up to here is a double

/// A value with its place in the file.
class Cursor {
 public:
  Cursor(const Value& value, std::string pointer, Problems& problems)
      : value_(&value), pointer_(std::move(pointer)), problems_(&problems) {}

  const Value& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  Problems& problems() const { return *problems_; }
  bool is(Value::Kind kind) const { return value_->kind == kind; }
  std::size_t size() const { return value_->items().size(); }
  Cursor item(std::size_t i) const { return {value_->items()[i], child(pointer_, i), *problems_}; }
  std::optional<Cursor> find(std::string_view key) const;
  /// The member, or nothing after "is missing".
  std::optional<Cursor> need(std::string_view key, const std::string& suggestion) const;

  void error(std::string message, std::string suggestion = "") const;
  /// Reports unless the value is of this kind; silent for a value that was reported before.
  bool expect(Value::Kind kind, const std::string& suggestion) const;
  /// An object with no other keys than these ($comment and $schema are always allowed): reports
  /// every other key as an unknown `noun`.
  bool expect_keys(const std::vector<std::string>& keys, const std::string& noun,
                   const std::string& suggestion) const;

 private:
  const Value* value_;
  std::string pointer_;
  Problems* problems_;
};

std::optional<double> read_number(const Cursor& at);
std::optional<std::int64_t> read_integer(const Cursor& at, double lowest, double highest);
std::optional<bool> read_flag(const Cursor& at);
/// A text that is not empty and has at most `limit` bytes.
std::optional<std::string> read_text(const Cursor& at, std::size_t limit);
/// Such a text without control characters, for names and titles: they are printed as they are.
std::optional<std::string> read_line(const Cursor& at, std::size_t limit);
std::optional<std::string> read_choice(const Cursor& at, const std::vector<std::string>& choices);
/// A list of numbers.
std::optional<Vector> read_vector(const Cursor& at, Index limit = max_entries);
/// A list of numbers, "inf" and "-inf".
std::optional<Vector> read_bounds(const Cursor& at);
/// A list of rows of equal length; [] is 0 × 0, [[], []] is 2 × 0. Or the sparse form.
std::optional<Matrix> read_matrix(const Cursor& at);
/// Is this the sparse form of a matrix, right or wrong: {"rows", "cols", "entries": [[row, column,
/// number], …]}, counted from 1?
bool is_sparse_matrix(const Value& value);
/// The place of an entry of a matrix that was read, counted from 0; that of the matrix where the
/// sparse form does not name it.
Cursor entry_of(const Cursor& matrix, Index row, Index column);
/// A list of texts that are all different.
std::optional<std::vector<std::string>> read_names(const Cursor& at, const std::string& noun);

/// "2 × 3".
std::string shape(Index rows, Index cols);
/// "1 row", "2 rows".
std::string counted(Index number, const std::string& noun);
/// Reports a vector of another size.
bool expect_size(const Cursor& at, const Vector& x, Index size, const std::string& like);

}  // namespace cordon::json
