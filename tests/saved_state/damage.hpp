// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <random>
#include <string>

/// A few bytes changed, cut out, put in twice, or the end cut off.
inline std::string damage(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
  for (std::size_t times = 1 + below(3); times > 0 && !bytes.empty(); --times) {
    const std::size_t at = below(bytes.size());
    const std::size_t count = std::min<std::size_t>(1 + below(16), bytes.size() - at);
    switch (below(6)) {
      case 0:
        bytes.erase(at, count);
        break;
      case 1:
        bytes.insert(at, bytes.substr(below(bytes.size()), count));
        break;
      case 2:
        if (below(4) == 0) bytes.resize(at);
        break;
      case 3:
        bytes[at] = static_cast<char>(random());
        break;
      case 4:  // small numbers are where counts and kinds are
        bytes[at] = static_cast<char>(below(5));
        break;
      default:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
    }
  }
  return bytes;
}
