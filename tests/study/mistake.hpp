// SPDX-License-Identifier: GPL-3.0-or-later
// One mistake in a study that is otherwise valid: exactly one problem is reported, at its place,
// with its reason and suggestion.
#pragma once

#include <string>

namespace study_test {

struct Mistake {
  std::string from, to;  ///< the piece that is exchanged, and what takes its place
  std::string pointer, message, suggestion;
  int line = 0;  ///< 0: the line on which `to` stands
};

void expect_reported(const std::string& study, const Mistake& mistake);

}  // namespace study_test
