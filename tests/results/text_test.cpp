// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/text.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"

using namespace cordon;
using detail::csv_field;
using detail::printable;
using detail::printable_lines;

TEST_CASE("what steers a terminal or turns the direction of writing is shown") {
  CHECK(printable("plain, é, ∞, 日本, 😀") == "plain, é, ∞, 日本, 😀");
  CHECK(printable("a\x1b[2Jb\x7f\n\t") == "a\\u001b[2Jb\\u007f\\u000a\\u0009");
  CHECK(printable(std::string_view("\0", 1)) == "\\u0000");
  CHECK(printable("\u0085\u009b31m") == "\\u0085\\u009b31m");
  CHECK(printable("\u202a\u202e\u2066\u2069\u200e\u200f\u061c") ==
        "\\u202a\\u202e\\u2066\\u2069\\u200e\\u200f\\u061c");
  CHECK(printable("\u2029\u202f\u2065\u206a\u200d\u00a0") ==
        "\u2029\u202f\u2065\u206a\u200d\u00a0");
  CHECK(printable("\x9b\xff\xc3(\xed\xa0\x80\xf0\x9f") ==
        "\\x9b\\xff\\xc3(\\xed\\xa0\\x80\\xf0\\x9f");
  CHECK(printable_lines("a\nb\r\u202e") == "a\nb\\u000d\\u202e");
  CHECK(rc::check([](const std::string& text) {
    const std::string once = printable(text);
    RC_ASSERT(printable(once) == once);
    for (const char c : once) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
  }));
}

TEST_CASE("errors show the names of files and what they hold") {
  const InputError error("a\x1b]0;title\x07.json",
                         {{"/a\u202eb\n", "is \x1b[31mred", "say\u2066 it"}});
  const std::string text = error.what();
  CHECK(text.find("a\\u001b]0;title\\u0007.json: 1 error") == 0);
  CHECK(text.find("/a\\u202eb\\u000a: is \\u001b[31mred; say\\u2066 it") != std::string::npos);
}

TEST_CASE("no field of a table is a formula") {
  CHECK(csv_field("=HYPERLINK(\"x\")") == "\"'=HYPERLINK(\"\"x\"\")\"");
  for (const char* text : {"=1+1", "+a", "-a", "@a", "\tx", "-inf", "--1", "+-1"})
    CHECK(csv_field(text) == std::string(1, '\'') + text);
  CHECK(csv_field("\r=1") == "\"'\r=1\"");
  for (const char* text : {"", "a", "a=b", "-1", "+1e3", "-0.5", "1-1", "é", "'=a"})
    CHECK(csv_field(text) == text);
  CHECK(csv_field("a,b") == "\"a,b\"");
}
