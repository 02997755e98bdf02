// SPDX-License-Identifier: GPL-3.0-or-later
// Variables as bytes between two processes of this program.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "experiments/interchange/mat_value.hpp"

namespace cordon::mat {

std::string to_wire(const Variables& variables);
/// Nothing if the bytes are not what `to_wire` has made: the process that sends them may have lost
/// its mind.
std::optional<Variables> from_wire(std::string_view bytes);

}  // namespace cordon::mat
