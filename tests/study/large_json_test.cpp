// SPDX-License-Identifier: GPL-3.0-or-later
// Of a large JSON file what is wanted is kept, handed over or copied, and nothing else.
#include "study/text/large_json.hpp"

#include <cmath>
#include <fstream>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "run/scratch.hpp"
#include "study/reading/read_sweep.hpp"

using namespace cordon;

namespace {

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("what is wanted of a large file") {
  const Scratch scratch;
  const auto read = [&](const std::string& text) {
    write_bytes(scratch / "x.json", text);
    json::Problems problems;
    std::string seen;
    const json::Wanted wanted{{"/a", "/l/*/x"},
                              {"/s/*/t/*"},
                              [&](const json::Cursor& at, const std::vector<std::size_t>& place) {
                                seen += at.pointer() + "@" + std::to_string(at.value().line) + ":" +
                                        std::to_string(place.at(0)) + "," +
                                        std::to_string(place.at(1)) + " ";
                              }};
    const auto tree = json::read_large(scratch / "x.json", wanted, problems).tree;
    for (const Diagnostic& problem : problems.sorted())
      seen += "!" + problem.pointer + "@" + std::to_string(problem.line);
    if (const auto* a = tree.find("a"))
      seen += (std::signbit(a->number) ? "-a@" : "a@") + std::to_string(a->line) + " ";
    if (const auto* l = tree.find("l")) {
      for (const auto& item : l->items()) seen += std::to_string(item.items().size());
    }
    return seen;
  };
  CHECK(read("{\"a\": 1}") == "a@1 ");
  CHECK(read("{\"a\": -0}") == "-a@1 ");
  CHECK(read("{\"a\": 0}") == "a@1 ");
  CHECK(read("{\n\"b\": [[{\"a\": 1}]],\n\"a\":\n{\"x\": [1]}}") == "a@4 ");
  CHECK(read("{\"b\": 7\n,\n\"a\": 5\n}") == "a@3 ");
  CHECK(read("{\"l\": [{\"x\": 1, \"y\": 2}, {\"y\": 2}, 3, {\"x\": {\"y\": 1}}]}") == "1001");
  CHECK(read("{\"s\": [{\"t\": [1,\n2]}, {\"u\": [1]}, {\"t\": [[3]]}]}") ==
        "/s/0/t/0@1:0,0 /s/0/t/1@2:0,1 /s/2/t/0@2:2,0 ");
  CHECK(read("{\"a\": 1,\n\"a\": 2}") == "!/a@2a@1 ");
  CHECK(read("{\"b\": 1, \"b\": 2, \"a\": 2}") == "a@1 ");
  CHECK(read("{\"a\":\n 1e999}").find("!/a@2") == 0);
  CHECK(read("{\"a\": 1} x").find("!") == 0);
  CHECK(read(std::string("{\"a\": 1}\0x", 10)).find("!") == 0);
  CHECK(read("{\"a\": \"\xff\"}").find("!/a@1") == 0);
  CHECK(read("").find("!") == 0);
  std::string deep = "{\"a\": ", deeper = "{\"b\": ";
  for (int i = 0; i < 100; ++i) deep += '[';
  CHECK(read(deep).find("!/a/0") == 0);
  for (int i = 0; i < 300000; ++i) deeper += '[';
  CHECK(read(deeper).find("!") == 0);  // nothing of it is kept, and no stack grows
}

TEST_CASE("streamed out of what is kept, copied as it stands") {
  using namespace json;
  const Scratch scratch;
  Problems problems;
  const auto read = [&](const std::string& text, const Wanted& wanted) {
    write_bytes(scratch / "x.json", text);
    return read_large(scratch / "x.json", wanted, problems);
  };
  const std::string study = "{\"a\":  [1, {\"steps\": [2]}], \"b\": \"]}\\\"\"}";
  const std::string text = "{\"steps\": [1],\n \"study\": " + study +
                           ", \"pipelines\": [{\"name\": \"p\", \"steps\": [ {\"k\": 0}, 6], "
                           "\"s\": {\"steps\": [5]}}, {\"steps\": [7]}], \"x\": 8}";
  std::string seen;
  Wanted wanted{.kept = {"/pipelines"}, .streamed = {"/pipelines/*/steps/*"}, .copied = "/study"};
  wanted.take = [&](const Cursor& at, const std::vector<std::size_t>& place) {
    seen +=
        at.pointer() + "=" + canonical_text(at.value()) + " of " + std::to_string(place[0]) + " ";
  };
  const LargeJson found = read(text, wanted);
  CHECK(seen ==
        "/pipelines/0/steps/0={\"k\":0} of 0 /pipelines/0/steps/1=6 of 0 "
        "/pipelines/1/steps/0=7 of 1 ");
  CHECK(found.copy == study);
  CHECK(canonical_text(found.tree) ==
        R"({"pipelines":[{"name":"p","steps":[],"s":{"steps":[5]}},{"steps":[]}]})");
  wanted.take = nullptr;
  CHECK(canonical_text(read(text, wanted).tree) == canonical_text(found.tree));
  // of what is not kept around it, and of what is; a leaf has no copy
  CHECK(read("{\"a\": {\"b\": [ [1 ],2]}}", {.kept = {"/c"}, .copied = "/a"}).copy ==
        "{\"b\": [ [1 ],2]}");
  CHECK(read("{\"a\": {\"b\": [ [1 ],2]}}", {.kept = {"/a"}, .copied = "/a/b"}).copy ==
        "[ [1 ],2]");
  CHECK(read("{\"a\": 7, \"b\": [1]}", {.kept = {"/b"}, .copied = "/a"}).copy == "");
  CHECK_FALSE(problems.any());
  write_bytes(scratch / "x.json", "{\"a\": \"" + std::string(max_bytes, 'x') + "\"}");
  CHECK_THROWS_WITH_AS(read_large(scratch / "x.json", {.kept = {"/b"}}, problems),
                       doctest::Contains("is larger than any"), InputError);
}
