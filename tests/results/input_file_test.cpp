// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/input_file.hpp"

#include <sys/stat.h>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using detail::InputFile;

TEST_CASE("what is no regular file is refused at once, with its name and kind") {
  const Scratch scratch;
  REQUIRE(::mkfifo((scratch / "pipe").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", scratch / "zero");
  CHECK_THROWS_WITH_AS(InputFile(scratch / "pipe"), doctest::Contains("pipe: 1 error"), InputError);
  CHECK_THROWS_WITH_AS(InputFile(scratch / "pipe"),
                       doctest::Contains("is a pipe, not a regular file"), InputError);
  CHECK_THROWS_WITH_AS(InputFile(scratch / "zero"),
                       doctest::Contains("is a device, not a regular file"), InputError);
  CHECK_THROWS_WITH_AS(InputFile(scratch.path()),
                       doctest::Contains("is a directory, not a regular file"), InputError);
  CHECK_THROWS_WITH_AS(InputFile(scratch / "absent", "look elsewhere"),
                       doctest::Contains("no such file; look elsewhere"), InputError);
}

TEST_CASE("an error of reading is none of the end") {
  char byte = 0;
  std::string text;
  // The first page of this file cannot be read: an error that every system has.
  CHECK_THROWS_WITH_AS(InputFile("/proc/self/mem").read(&byte, 1),
                       doctest::Contains("cannot be read to its end"), InputError);
  CHECK_THROWS_AS(InputFile("/proc/self/mem").line(text, 10), InputError);
  CHECK_THROWS_AS(InputFile("/proc/self/mem").rest(10, ""), InputError);
}

TEST_CASE("lines, with and without their ends") {
  const Scratch scratch;
  const std::string longest(200'000, 'x');
  InputFile file(scratch.write("lines", "a\n\n" + longest + "\nlast"));
  std::string text;
  for (const std::string& line : {std::string("a"), std::string(), longest}) {
    REQUIRE(file.line(text, 200'000));
    CHECK(text == line);
    CHECK(file.ended_line());
  }
  REQUIRE(file.line(text, 200'000));
  CHECK(text == "last");
  CHECK_FALSE(file.ended_line());
  CHECK_FALSE(file.line(text, 200'000));
  CHECK(file.lines() == 4);
  InputFile again(scratch / "lines");
  REQUIRE(again.line(text, 10));
  REQUIRE(again.line(text, 10));
  CHECK_THROWS_WITH_AS(again.line(text, 199'999),
                       doctest::Contains("line 3: a line is longer than 199999 bytes"), InputError);
}

TEST_CASE("a file is read up to its limit") {
  const Scratch scratch;
  const std::string bytes(300'000, 'x');
  InputFile file(scratch.write("bytes", bytes));
  CHECK(file.rest(300'000, "") == bytes);
  CHECK(file.rest(300'000, "").empty());
  CHECK_THROWS_WITH_AS(InputFile(scratch / "bytes").rest(299'999, "be short"),
                       doctest::Contains("be short"), InputError);
  std::filesystem::resize_file(scratch / "bytes", std::uintmax_t{1} << 40);
  CHECK_THROWS_AS(InputFile(scratch / "bytes").rest(1 << 20, ""), InputError);
}
