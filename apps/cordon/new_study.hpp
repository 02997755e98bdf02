// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon new study`, a part of `cordon new`.
#pragma once

#include "commands.hpp"

namespace cordon::apps {

void add_new_study(CLI::App& command, Program& program);

}  // namespace cordon::apps
