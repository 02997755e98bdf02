// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes with a name and a check sum before them: what a program has saved for itself.
#pragma once

#include <string>
#include <string_view>

#include "cordon/core/error.hpp"
#include "study/text/fingerprint.hpp"

namespace cordon::detail {

/// "NAME\nCHECK SUM\nBYTES".
inline std::string sealed(std::string_view name, std::string_view bytes) {
  return std::string(name) + "\n" + fingerprint(bytes) + "\n" + std::string(bytes);
}

/// The bytes again. Throws Errc::invalid for what was not sealed under this name, or has changed
/// since: the check sum finds damage, not malice.
inline std::string unsealed(std::string_view name, std::string_view text) {
  const std::size_t begin = name.size() + 1;
  const std::size_t end = text.size() < begin ? text.npos : text.find('\n', begin);
  if (end == text.npos || !text.starts_with(name) || text[begin - 1] != '\n')
    throw Error(Errc::invalid, "is no " + std::string(name));
  const std::string_view bytes = text.substr(end + 1);
  if (fingerprint(bytes) != text.substr(begin, end - begin))
    throw Error(Errc::invalid,
                "is a damaged " + std::string(name) + ": its check sum does not fit");
  return std::string(bytes);
}

}  // namespace cordon::detail
