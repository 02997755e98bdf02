// SPDX-License-Identifier: GPL-3.0-or-later
// A JSON file of any length, of which a part is wanted: what is not, is passed over while it is
// read.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// Places in a file, as JSON pointers in which "*" stands for every element of an array.
struct Wanted {
  std::vector<std::string> kept;  ///< with all that is below them, but for what is streamed
  /// Whole values that are handed over as soon as they are complete, and forgotten. `at` holds the
  /// indices for the "*" on the way. Without `take` they are left out.
  std::vector<std::string> streamed = {};
  std::function<void(const Cursor& value, const std::vector<std::size_t>& at)> take = {};
  /// An object or array whose bytes are wanted as they stand, kept or not; no more than
  /// `max_bytes` + 1 of them.
  std::string copied = {};
};

struct LargeJson {
  /// What is kept, with the objects and arrays on the way to it; elements of arrays that hold
  /// nothing of it are null.
  Value tree;
  std::string copy = {};  ///< the text of `copied`
};

/// Reports what `parse` reports, and stops at the first text that is not JSON. Throws InputError if
/// the file cannot be read, or holds a text or a run of blanks larger than `max_bytes`.
LargeJson read_large(const std::filesystem::path& file, const Wanted& wanted, Problems& problems);

}  // namespace cordon::json
