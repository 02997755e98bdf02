// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace cordon::detail {

/// Where bytes go.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void write(std::string_view bytes) = 0;
};

}  // namespace cordon::detail
