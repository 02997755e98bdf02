// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of samples: JSON and CSV, right, wrong and hostile.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "online/study.hpp"

using namespace online_test;

TEST_CASE("a JSON line is a sample") {
  Loaded loaded;
  SampleLines lines(loaded.study);
  const auto sample = lines
                          .read(R"({"k": 7, "u": [0.5], "y": [1.25, null]})"
                                "\r\n")
                          .sample;
  REQUIRE(sample);
  CHECK(sample->k == 7);
  CHECK(sample->u[0] == 0.5);
  CHECK(sample->y[0] == 1.25);
  CHECK(std::isnan(sample->y[1]));
  CHECK_FALSE(lines.read("  \n").sample);
  CHECK(std::isnan(lines.read(R"({"u": [1]})").sample->y[0]));
  CHECK_FALSE(lines.read(R"({"u": [1], "y": null})").sample->k);
}

TEST_CASE("rows of a CSV file are samples, by the names of its columns") {
  Loaded loaded;
  SampleLines lines(loaded.study);
  CHECK_FALSE(lines.read("\xEF\xBB\xBFtime,k,y_2,u_1,\"y_1\"\n").sample);
  const auto sample = lines.read("0.5,3, 2.5 ,-1,nan\n").sample;
  REQUIRE(sample);
  CHECK(sample->k == 3);
  CHECK(sample->u[0] == -1);
  CHECK(std::isnan(sample->y[0]));
  CHECK(sample->y[1] == 2.5);
  CHECK_THROWS_WITH_AS(lines.read("1,2,3\n"), doctest::Contains("3 fields"), InputError);
  CHECK_THROWS_WITH_AS(lines.read("0,3.5,1,1,1\n"), doctest::Contains("step"), InputError);
  CHECK_THROWS_WITH_AS(lines.read("0,3,1,,1\n"), doctest::Contains("u_1"), InputError);
}

TEST_CASE("samples have times on a clock where the system has a sampling time") {
  Loaded loaded(study_with_clock(), Loaded::whole);
  SampleLines json(loaded.study), rows(loaded.study), numbered(loaded.study);
  const auto sample = json.read(R"({"t": 1.5e9, "u": [0], "y": [0, 0]})").sample;
  CHECK(sample->t == 1.5e9);
  CHECK_FALSE(sample->k);
  CHECK_THROWS_AS(json.read(R"({"t": "noon", "u": [0], "y": [0, 0]})"), InputError);
  CHECK(rows.have_times());  // nothing is known yet
  rows.read("t,u_1,y_1,y_2\n");
  CHECK(rows.have_times());
  CHECK(rows.passed_over().empty());
  CHECK(rows.read("2.5,0,0,0\n").sample->t == 2.5);
  CHECK_FALSE(rows.read(",0,0,0\n").sample->t);
  CHECK_THROWS_WITH_AS(rows.read("2.5s,0,0,0\n"), doctest::Contains("\"t\""), InputError);
  CHECK_THROWS_WITH_AS(rows.read("2026-01-01,0,0,0\n"), doctest::Contains("holds seconds"),
                       InputError);
  numbered.read("t,k,u_1,y_1,y_2\n");  // k is enough, and t may be anything
  CHECK_FALSE(numbered.read("noon,3,0,0,0\n").sample->t);
  Loaded timeless;
  SampleLines without(timeless.study);
  without.read("t,u_1,y_1,y_2\n");
  CHECK_FALSE(without.read("noon,0,0,0\n").sample->t);
}

TEST_CASE("columns of times have some names, and others are told to be passed over") {
  Loaded loaded(study_with_clock(), Loaded::whole);
  for (const char* name : {"t", "t [s]", "time", "time [s]"}) {
    SampleLines rows(loaded.study);
    rows.read(std::string("u_1,y_1,y_2,") + name);
    CHECK(rows.read("0,0,0,2.5").sample->t == 2.5);
  }
  SampleLines rows(loaded.study);
  rows.read("stamp,u_1,y_1,note,y_2");
  CHECK_FALSE(rows.have_times());
  CHECK(rows.passed_over() == std::vector<std::string>{"stamp", "note"});
}

TEST_CASE("a column is of one signal, by the study's names before the numbers") {
  std::string text = study_text();
  text.insert(text.find("\"A\""), "\"names\": {\"outputs\": [\"y_0\", \"y_1\"]}, ");
  Loaded loaded(text, Loaded::whole);
  SampleLines named(loaded.study), numbered(loaded.study), twice(loaded.study);
  named.read("u_1,y_0,y_1");
  const auto sample = named.read("0,0.9,-0.5").sample;
  CHECK(sample->y[0] == 0.9);
  CHECK(sample->y[1] == -0.5);
  CHECK_THROWS_WITH_AS(numbered.read("u_1,y_1,y_2"), doctest::Contains("of several signals"),
                       InputError);
  CHECK_THROWS_WITH_AS(twice.read("u_1,y_0,y_1,y_0"), doctest::Contains("more than once"),
                       InputError);
  CHECK(twice.read("\xEF\xBB\xBF{\"u\": [0]}").sample);
}

TEST_CASE("numbers may be names") {
  std::string text = study_text();
  text.insert(text.find("\"A\""),
              "\"names\": {\"inputs\": [\"1\"], \"outputs\": [\"2\", \"3\"]}, ");
  Loaded loaded(text, Loaded::whole);
  SampleLines lines(loaded.study);
  CHECK_FALSE(lines.read("3,2,1").sample);
  CHECK(lines.read("5,6,7").sample->y[0] == 6);
}

TEST_CASE("what is no header row says so") {
  Loaded loaded;
  SampleLines lines(loaded.study);
  const auto refused = [&](const char* line, const char* because) {
    CHECK_THROWS_WITH_AS(lines.read(line), doctest::Contains(because), InputError);
  };
  refused("0.5,1,2", "no header row has named its columns");
  refused("0.5,,nan", "such as u_1,y_1,y_2");
  refused("u_1;y_1;y_2", "separated by commas");
  refused("u_1\ty_1\ty_2", "separated by commas");
  refused("hello", "no column \"u_1\"");
}

TEST_CASE("all that is wrong with a line is told at once") {
  Loaded loaded;
  SampleLines lines(loaded.study);
  try {
    lines.read(R"({"k": -1, "u": [1, 2], "y": [1, "a"], "z": 0})");
    FAIL("a wrong line was taken");
  } catch (const InputError& error) {
    CHECK(error.diagnostics().size() == 4);
  }
  CHECK_THROWS_AS(lines.read("{\"u\": [1e999], \"y\": [1, 2]}"), InputError);
  CHECK_THROWS_AS(lines.read("{\"u\": [1], \"u\": [2], \"y\": [1, 2]}"), InputError);
  CHECK_THROWS_AS(lines.read(std::string(2'000'000, ' ') + "{" + std::string(2'000'000, 'x')),
                  InputError);
  CHECK_THROWS_AS(lines.read("{" + std::string(100'000, '[')), InputError);
}

TEST_CASE("requests stand between samples") {
  Loaded loaded;
  SampleLines lines(loaded.study);
  CHECK(lines.read(R"({"do": "acknowledge"})").request == Request::acknowledge);
  CHECK(lines.read(R"({"do": "start"})").request == Request::start);
  CHECK_THROWS_WITH_AS(lines.read(R"({"do": "acknowlege"})"), doctest::Contains("acknowledge"),
                       InputError);
  CHECK_THROWS_AS(lines.read(R"({"do": "start", "u": [0]})"), InputError);
}

namespace {

/// Lines that have been a sample, of a study that may have a sampling time.
void expect_no_harm_of_mutations(const std::string& study, const std::string& valid, int count) {
  Loaded loaded(study, Loaded::whole);
  SampleLines lines(loaded.study);
  OnlineSession session(loaded.study, loaded.registry, "zonotope");
  std::mt19937 engine(1);
  const std::string bytes = "{}[]\",:.-+eE0123456789 nulltrue\\\n\x01\x80\xFF";
  const auto any = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(engine);
  };
  int taken = 0, refused = 0;
  for (int i = 0; i < count; ++i) {
    std::string line = valid;
    for (std::size_t changes = 1 + any(3); changes > 0 && !line.empty(); --changes) {
      const std::size_t at = any(line.size());
      switch (any(3)) {
        case 0:
          line[at] = bytes[any(bytes.size())];
          break;
        case 1:
          line.erase(at, 1);
          break;
        default:
          line.insert(at, 1, bytes[any(bytes.size())]);
      }
    }
    if (line.front() != '{') continue;  // else a header of a CSV file
    try {
      const auto sample = lines.read(line).sample;
      if (sample) session.take(*sample);
      ++taken;
    } catch (const Error&) {
      ++refused;
    }
    if (session.has_ended()) session.start();
  }
  CHECK(taken > 1000);
  CHECK(refused > 1000);
  session.start();
  CHECK(session.take(*lines.read(valid).sample).how == Taken::How::taken);
}

}  // namespace

TEST_CASE("mutated lines are samples or refused, and a session goes on after them") {
  const std::string rules = R"({"jumps": "fill", "repeated": "ignore", "late": "correct"})";
  expect_no_harm_of_mutations(study_text(rules), R"({"k": 12, "u": [0.5], "y": [1.25, -0.75]})",
                              100'000);
  expect_no_harm_of_mutations(study_with_clock(rules),
                              R"({"t": 6.25, "u": [0.5], "y": [1.25, -0.75]})", 30'000);
}
