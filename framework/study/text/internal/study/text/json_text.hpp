// SPDX-License-Identifier: GPL-3.0-or-later
// JSON text to a tree that remembers the line of every value, so that each problem of a file can be
// reported with its place.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/core/error.hpp"

namespace cordon::json {

struct Parts;

/// A JSON value (RFC 8259) with its line. `broken` stands for a value that was reported already:
/// readers pass over it in silence. Copies share their parts, which never change once the value is
/// made: a copy is cheap, and safe to use from another thread.
struct Value {
  enum class Kind : std::uint8_t { null, boolean, number, text, array, object, broken };

  Kind kind = Kind::null;
  bool flag = false;
  int line = 0;
  double number = 0;                   ///< finite
  std::shared_ptr<const Parts> parts;  ///< of texts, arrays and objects

  const std::string& text() const;
  const std::vector<Value>& items() const;  ///< elements of an array, values of an object
  const std::vector<std::string>& keys()
      const;  ///< of an object, in the order of the file, each once
  const Value* find(std::string_view key) const;  ///< null if there is none
};

struct Parts {
  std::string text;
  std::vector<Value> items;
  std::vector<std::string> keys;
};

/// "is a text", for messages.
std::string_view kind_name(Value::Kind kind) noexcept;

/// `word` in double quotes, control characters escaped, cut after about `limit` bytes: what comes
/// from a file is printed to a terminal.
std::string in_quotes(std::string_view word, std::size_t limit = 60);
/// One more step of a JSON pointer (RFC 6901): "~" and "/" of the key are escaped.
std::string child(std::string_view pointer, std::string_view key);
std::string child(std::string_view pointer, std::size_t index);

/// Problems of one file, in the order they were found; a hostile file cannot make more than a
/// thousand.
class Problems {
 public:
  void add(std::string pointer, int line, std::string message, std::string suggestion = "");
  /// The same for a key that does not belong there, whatever its value.
  void add_unknown(std::string pointer, int line, std::string message, std::string suggestion);
  bool is_unknown(const std::string& pointer) const { return unknown_.count(pointer) > 0; }
  bool any() const { return count_ > 0; }
  std::size_t count() const { return count_; }
  /// A reader met a value that was reported before.
  void pass_over() { ++passed_over_; }
  /// Grows with every wrong value that a reader meets: unchanged over a section, the section is
  /// right.
  std::size_t met() const { return count_ + passed_over_; }
  const std::vector<Diagnostic>& found() const { return found_; }
  /// In the order of their lines; the last one tells how many were left out.
  std::vector<Diagnostic> sorted() const;

 private:
  std::vector<Diagnostic> found_;
  std::set<std::string> unknown_;
  std::size_t count_ = 0, passed_over_ = 0;
};

inline constexpr std::size_t max_bytes = std::size_t{64} << 20;
inline constexpr int max_depth = 64;
inline constexpr std::size_t max_values = 10'000'000;

/// The bytes of a file. Throws InputError: missing, not a regular file, not readable, more than
/// `max_bytes`.
std::string read_file(const std::string& file);

/// The tree of a text. Reports what is wrong: not UTF-8 or not JSON (one problem with line and
/// column; the result is then `broken`), a key that is repeated, a number beyond the range of
/// double, NaN and the like. A byte order mark is skipped. O(size of the text).
Value parse(std::string_view text, Problems& problems);

}  // namespace cordon::json
