// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "study/text/sink.hpp"

namespace cordon::detail {

/// Keeps what is written.
class StringSink final : public Sink {
 public:
  void write(std::string_view bytes) override { text += bytes; }
  std::string text;
};

}  // namespace cordon::detail
