// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cordon::detail {

/// FNV-1a with 64 bits of bytes that come piece by piece. Two texts that differ in one byte never
/// have the same.
class Fnv1a64 {
 public:
  void add(std::string_view text) {
    std::uint64_t hash = hash_;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    hash_ = hash;
  }
  std::string digits() const {  ///< 16 hexadecimal ones
    std::string digits(16, '0');
    std::uint64_t hash = hash_;
    for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
    return digits;
  }

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

inline std::string fnv1a64(std::string_view text) {
  Fnv1a64 hash;
  hash.add(text);
  return hash.digits();
}

/// To tell studies apart.
inline std::string fingerprint(std::string_view text) { return "fnv1a64:" + fnv1a64(text); }

}  // namespace cordon::detail
