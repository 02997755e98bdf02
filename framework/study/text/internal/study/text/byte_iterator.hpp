// SPDX-License-Identifier: GPL-3.0-or-later
// What nlohmann-json's parser iterates over.
#pragma once

#include <cstddef>
#include <iterator>

namespace cordon::json {

/// Over bytes that come once: `now()`, `advance()` and `ended()` of a source that lives longer.
template <class Source>
class ByteIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  /// nullptr: the end of any source.
  explicit ByteIterator(Source* source) : source_(source) {}
  char operator*() const { return source_->now(); }
  ByteIterator& operator++() {
    source_->advance();
    return *this;
  }
  friend bool operator==(const ByteIterator& a, const ByteIterator& b) {
    return a.ended() == b.ended();
  }
  friend bool operator!=(const ByteIterator& a, const ByteIterator& b) { return !(a == b); }

 private:
  bool ended() const { return !source_ || source_->ended(); }
  Source* source_;
};

}  // namespace cordon::json
