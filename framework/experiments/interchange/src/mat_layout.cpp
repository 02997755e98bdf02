// SPDX-License-Identifier: GPL-3.0-or-later
#include "mat_layout.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>
#include <zlib.h>

#include "cordon/core/error.hpp"
#include "experiments/interchange/mat_file.hpp"

namespace cordon::mat {

namespace {

/// Thrown inside only: the sizes contradict each other, or the variable is one that is refused by
/// its size.
struct Damaged {};
struct TooLarge {};

void require(bool holds) {
  if (!holds) throw Damaged{};
}

/// Bytes one after the other. Too few of them: Damaged.
class Input {
 public:
  virtual ~Input() = default;
  virtual void read(char* to, std::size_t size) = 0;
  void skip(std::uint64_t size) {
    char part[4096];
    for (; size > 0; size -= std::min<std::uint64_t>(size, sizeof(part)))
      read(part, std::min<std::uint64_t>(size, sizeof(part)));
  }
};

class FileInput : public Input {
 public:
  explicit FileInput(std::istream& stream) : stream_(stream) {}
  void read(char* to, std::size_t size) override {
    require(bool(stream_.read(to, static_cast<std::streamsize>(size))));
  }

 private:
  std::istream& stream_;
};

/// What the next `size` bytes are when they are unpacked.
class PackedInput : public Input {
 public:
  PackedInput(std::istream& stream, std::uint64_t size) : file_(stream), left_(size) {
    if (inflateInit(&state_) != Z_OK)
      throw Error(Errc::internal, "a compressed variable cannot be read");
  }
  ~PackedInput() override { inflateEnd(&state_); }
  PackedInput(const PackedInput&) = delete;
  PackedInput& operator=(const PackedInput&) = delete;

  void read(char* to, std::size_t size) override { require(unpack(to, size) == size); }
  /// Nothing may follow, and the check sum must be right.
  void expect_end() {
    char more;
    require(unpack(&more, 1) == 0);
  }

 private:
  /// As many as there are, up to `size`.
  std::size_t unpack(char* to, std::size_t size) {
    state_.next_out = reinterpret_cast<Bytef*>(to);
    state_.avail_out = static_cast<uInt>(size);
    while (state_.avail_out > 0 && !ended_) {
      if (state_.avail_in == 0) refill();
      const int result = inflate(&state_, Z_NO_FLUSH);
      require(result == Z_OK || result == Z_STREAM_END);
      ended_ = result == Z_STREAM_END;
    }
    return size - state_.avail_out;
  }
  void refill() {
    const std::size_t size = std::min<std::uint64_t>(left_, sizeof(buffer_));
    require(size > 0);
    file_.read(buffer_, size);
    left_ -= size;
    state_.next_in = reinterpret_cast<Bytef*>(buffer_);
    state_.avail_in = static_cast<uInt>(size);
  }

  FileInput file_;
  std::uint64_t left_;
  z_stream state_{};
  bool ended_ = false;
  char buffer_[1 << 14];
};

// The numbers of the format.
enum Type : std::uint32_t {
  int8 = 1,
  uint8 = 2,
  int32 = 5,
  uint32 = 6,
  matrix_type = 14,
  packed = 15,
  utf8 = 16
};
enum Class : std::uint32_t {
  cells = 1,
  structs = 2,
  objects = 3,
  characters = 4,
  sparse = 5,
  first_numeric = 6,
  last_numeric = 15
};

/// 0 for what is no type of numbers or characters.
std::uint64_t size_of(std::uint32_t type) {
  constexpr std::uint64_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8, 0, 0, 1, 2, 4};
  return type < std::size(sizes) ? sizes[type] : 0;
}

struct Element {
  std::uint32_t type = 0;
  std::uint64_t bytes = 0;
  bool small = false;  ///< its data stand in `data`
  char data[4] = {};
};

/// The elements of a variable. Each takes its bytes from those that are left of the one around it.
class Layout {
 public:
  Layout(Input& input, bool swapped) : input_(input), swapped_(swapped) {}

  std::uint32_t number(const char* bytes) const {
    std::uint32_t x = 0;
    std::memcpy(&x, bytes, sizeof(x));
    return swapped_ ? __builtin_bswap32(x) : x;
  }

  Element element(std::uint64_t& left) {
    char tag[8];
    take(tag, sizeof(tag), left);
    Element e{number(tag), number(tag + 4)};
    if (e.type >> 16 == 0) return e;
    e.small = true;
    e.bytes = e.type >> 16, e.type &= 0xFFFF;
    require(e.bytes <= sizeof(e.data));
    std::copy(tag + 4, tag + 8, e.data);
    return e;
  }

  /// A matrix whose tag has been read.
  void matrix(const Element& tag, std::uint64_t& around, int depth) {
    require(tag.type == matrix_type && !tag.small && tag.bytes <= around);
    around -= tag.bytes;
    std::uint64_t left = tag.bytes;
    if (left == 0) return;  // as good as []
    if (depth > max_nesting) throw TooLarge{};
    const std::vector<std::uint32_t> flags = numbers(left, uint32, 2);
    const std::uint32_t kind = flags[0] & 0xFF;
    const bool known = (kind >= cells && kind <= last_numeric) && kind != objects;
    if (known) {
      content(kind, (flags[0] & 0x800) != 0, left, depth);
      require(left == 0);
    }
    input_.skip(left);
  }

 private:
  void take(char* to, std::size_t size, std::uint64_t& left) {
    require(size <= left);
    input_.read(to, size);
    left -= size;
  }

  void pass(const Element& e, std::uint64_t& left) {
    if (e.small) return;
    const std::uint64_t padded = (e.bytes + 7) / 8 * 8;
    require(padded <= left);
    input_.skip(padded);
    left -= padded;
  }

  /// An element of at most 16 whole numbers, or of this many.
  std::vector<std::uint32_t> numbers(std::uint64_t& left, std::uint32_t type,
                                     std::uint64_t count = 0) {
    const Element e = element(left);
    require(e.type == type && e.bytes % 4 == 0 && e.bytes <= 64 &&
            (count == 0 || e.bytes == 4 * count));
    char data[64] = {};
    if (e.small) {
      std::copy(std::begin(e.data), std::end(e.data), data);
    } else {
      take(data, (e.bytes + 7) / 8 * 8, left);
    }
    std::vector<std::uint32_t> all;
    for (std::uint64_t i = 0; i < e.bytes / 4; ++i) all.push_back(number(data + 4 * i));
    return all;
  }

  /// An element with exactly this many entries, or as many as it says where `count` is negative.
  std::uint64_t entries(std::uint64_t& left, std::int64_t count) {
    const Element e = element(left);
    const std::uint64_t size = size_of(e.type);
    require(size > 0 && e.bytes % size == 0);
    require(count < 0 || e.bytes == static_cast<std::uint64_t>(count) * size);
    pass(e, left);
    return e.bytes / size;
  }

  /// Characters of one size, or UTF-8, where some count the bytes and others the units of UTF-16.
  void text(std::uint64_t& left, std::uint64_t count) {
    const Element e = element(left);
    const std::uint64_t size = size_of(e.type);
    require(size > 0 && e.bytes <= 4 * count);
    if (e.type != utf8 || e.bytes == count) {
      require(e.bytes == count * size);
      return pass(e, left);
    }
    std::vector<char> bytes(e.small ? sizeof(e.data) : (e.bytes + 7) / 8 * 8);
    if (e.small) {
      std::copy(std::begin(e.data), std::end(e.data), bytes.begin());
    } else {
      take(bytes.data(), bytes.size(), left);
    }
    std::uint64_t units = 0;
    for (std::uint64_t i = 0; i < e.bytes; ++i) {
      const auto byte = static_cast<unsigned char>(bytes[i]);
      units += (byte & 0xC0) == 0x80 ? 0 : byte >= 0xF0 ? 2 : 1;
    }
    require(units == count);
  }

  void name(std::uint64_t& left) {
    const Element e = element(left);
    require(e.type == int8 || e.type == uint8 || e.type == utf8);
    pass(e, left);
  }

  void content(std::uint32_t kind, bool complex, std::uint64_t& left, int depth) {
    const std::vector<std::uint32_t> dims = numbers(left, int32);
    require(dims.size() >= 2);
    std::uint64_t count = 1;
    for (const std::uint32_t dim : dims) {
      if (dim > max_numbers || (count *= dim) > static_cast<std::uint64_t>(max_numbers))
        throw TooLarge{};
    }
    name(left);
    if (kind == cells) return items(count, left, depth);
    if (kind == structs) return items(count * fields(left), left, depth);
    if (kind != sparse && (total_ += count) > static_cast<std::uint64_t>(max_numbers))
      throw TooLarge{};
    if (count == 0 && left == 0) return;
    if (kind == sparse) {
      entries(left, -1);
      entries(left, std::int64_t{dims[1]} + 1);
    }
    if (kind == characters) return text(left, count);
    const auto real = entries(left, kind == sparse ? -1 : static_cast<std::int64_t>(count));
    if (complex) entries(left, static_cast<std::int64_t>(real));
  }

  std::uint64_t fields(std::uint64_t& left) {
    const std::uint32_t length = numbers(left, int32, 1)[0];
    const Element e = element(left);
    require(e.type == int8 && (e.bytes == 0 || (length > 0 && e.bytes % length == 0)) &&
            e.bytes < (1 << 24));
    pass(e, left);
    return e.bytes == 0 ? 0 : e.bytes / length;
  }

  void items(std::uint64_t count, std::uint64_t& left, int depth) {
    for (; count > 0; --count) {
      const Element e = element(left);  // at least 8 bytes: no count is larger than the file
      matrix(e, left, depth + 1);
    }
  }

  Input& input_;
  bool swapped_;
  std::uint64_t total_ = 0;
};

void check_variable(std::istream& stream, const Element& tag, bool swapped) {
  try {
    if (tag.type != packed) {
      FileInput input(stream);
      std::uint64_t left = tag.bytes;
      return Layout(input, swapped).matrix(tag, left, 0);
    }
    PackedInput input(stream, tag.bytes);
    Layout layout(input, swapped);
    std::uint64_t left = std::uint64_t{1} << 33;
    const Element inside = layout.element(left);
    layout.matrix(inside, left, 0);
    input.expect_end();
  } catch (const TooLarge&) {  // nobody reads it
  }
}

}  // namespace

void check_layout(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char header[128] = {};
  stream.read(header, sizeof(header));
  const bool little = header[126] == 'I', version5 = header[little ? 125 : 124] == 1;
  if (stream && !version5) return;
  const bool swapped = little != (std::endian::native == std::endian::little);
  try {
    require(bool(stream));
    const std::uint64_t end = std::filesystem::file_size(file);
    for (std::uint64_t at = sizeof(header); at < end;) {
      stream.seekg(static_cast<std::streamoff>(at));
      std::uint64_t left = end - at;
      FileInput input(stream);
      const Element tag = Layout(input, swapped).element(left);
      require(!tag.small && (tag.type == matrix_type || tag.type == packed) && tag.bytes <= left);
      check_variable(stream, tag, swapped);
      at += 8 + tag.bytes;
    }
  } catch (const Damaged&) {
    throw Error(Errc::invalid, "is damaged: it is cut off, or its sizes do not fit what it holds");
  }
}

}  // namespace cordon::mat
