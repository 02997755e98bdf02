// SPDX-License-Identifier: GPL-3.0-or-later
// Results files are read without the lists that grow with the run.
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "experiments/report/outline.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using report::Outline;
using report::outline_of;

namespace {

struct Read {
  Outline outline;
  std::vector<std::pair<std::size_t, std::string>> items;
};

Read read(const std::string& text) {
  const Scratch scratch;
  std::ofstream(scratch / "results.json", std::ios::binary) << text;
  Read found;
  found.outline =
      outline_of(scratch / "results.json", [&](std::size_t pipeline, const std::string& item) {
        found.items.emplace_back(pipeline, item);
      });
  return found;
}

using Items = std::vector<std::pair<std::size_t, std::string>>;

}  // namespace

TEST_CASE("steps of pipelines are handed over one by one, and nothing else") {
  const Read found = read(R"({"steps": [1], "study": {"a": [1, {"steps": [2]}]}, "pipelines": [
    {"name": "a", "steps": [ {"k": 0, "steps": [3]}, {"k": 1} ], "gains": [[4]]},
    {"name": "b", "steps": []}, {"summary": {"steps": [5]}, "steps": [6,
      7]}], "x": 8})");
  CHECK(found.outline.text == R"({"steps": [1], "study": {"a": [1, {"steps": [2]}]}, "pipelines": [
    {"name": "a", "steps": [], "gains": [[4]]},
    {"name": "b", "steps": []}, {"summary": {"steps": [5]}, "steps": []}], "x": 8})");
  CHECK(found.items == Items{{0, R"({"k":0,"steps":[3]})"}, {0, R"({"k":1})"}, {2, "6"}, {2, "7"}});
  CHECK(found.outline.study == R"({"a": [1, {"steps": [2]}]})");
}

TEST_CASE("points of a sweep") {
  const Read found =
      read(R"({"points": [{"point": 0, "error": "a, \"b\" ] }"},{"point": 1}], "study": 1})");
  CHECK(found.outline.text == R"({"points": [], "study": 1})");
  CHECK(found.items == Items{{0, R"({"point":0,"error":"a, \"b\" ] }"})"}, {0, R"({"point":1})"}});
  CHECK(found.outline.study == "1");
}

TEST_CASE("brackets and keys inside of texts are texts") {
  const std::string text =
      R"({"a": "{\"points\": [", "\"points": [1], "pipelines": [{"n": "\\", "steps": [2]}], "b": "points", "c": [3]})";
  const Read found = read(text);
  CHECK(found.items == Items{{0, "2"}});
  CHECK(
      found.outline.text ==
      R"({"a": "{\"points\": [", "\"points": [1], "pipelines": [{"n": "\\", "steps": []}], "b": "points", "c": [3]})");
  CHECK(found.outline.study.empty());
}

TEST_CASE("what cannot be read is refused with its reason") {
  const Scratch scratch;
  CHECK_THROWS_WITH_AS(outline_of(scratch / "results.json"), doctest::Contains("no such file"),
                       InputError);
  CHECK_THROWS_WITH_AS(outline_of(scratch.path()), doctest::Contains("is a directory"), InputError);
  std::ofstream(scratch / "deep.json") << std::string(1000, '[');
  CHECK_THROWS_WITH_AS(outline_of(scratch / "deep.json"), doctest::Contains("nested too deeply"),
                       InputError);
  std::ofstream(scratch / "item.json")
      << R"({"points": [")" << std::string((16 << 20) + 10, 'x') << "\"]}";
  CHECK_THROWS_WITH_AS(outline_of(scratch / "item.json"), doctest::Contains("is larger than any"),
                       InputError);
}

TEST_CASE("a text that no list is left out of comes through as it is, whatever it is") {
  CHECK(rc::check([] {
    const auto bytes = *rc::gen::container<std::string>(
        rc::gen::elementOf(std::string("[]{}\",:\\ \nastudypoints0")));
    const std::string text = "[" + bytes;
    RC_ASSERT(read(text).outline.text == text);
  }));
}
