// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/mistake.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "study/fakes.hpp"

namespace study_test {

namespace {

int line_of(const std::string& text, const std::string& piece) {
  const std::size_t at = text.find(piece);
  return 1 + static_cast<int>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

}  // namespace

void expect_reported(const std::string& study, const Mistake& mistake) {
  const std::string text = exchanged(study, mistake.from, mistake.to);
  CAPTURE(mistake.to);
  const auto problems = problems_of(text);
  REQUIRE(!problems.empty());
  if (problems.size() > 1)
    CHECK(problems[0].pointer + " and " + problems[1].pointer + ": " + problems[1].message ==
          mistake.pointer);
  CHECK(problems[0].pointer == mistake.pointer);
  CAPTURE(problems[0].message);
  CAPTURE(problems[0].suggestion);
  CHECK(problems[0].message.find(mistake.message) != std::string::npos);
  CHECK(problems[0].suggestion.find(mistake.suggestion) != std::string::npos);
  if (mistake.suggestion.empty()) CHECK(problems[0].suggestion.empty());
  CHECK(problems[0].line == (mistake.line > 0 ? mistake.line : line_of(text, mistake.to)));
}

}  // namespace study_test
