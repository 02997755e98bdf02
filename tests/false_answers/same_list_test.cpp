// SPDX-License-Identifier: GPL-3.0-or-later
// docs/false_answers.md and the tests of this folder have the same cases.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <doctest/doctest.h>

namespace {

std::filesystem::path source(const char* path) {
  return std::filesystem::path(CORDON_SOURCE_DIR) / path;
}

/// Name of each test of the folder, but for those of this file.
std::set<std::string> tested() {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(source("tests/false_answers"))) {
    const std::filesystem::path path = file.path();
    if (path.extension() != ".cpp" || path.filename() == "same_list_test.cpp") continue;
    std::ifstream in(path);
    const std::string start = "TEST_CASE(\"";
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with(start)) continue;
      const std::size_t end = line.find("\")", start.size());
      REQUIRE(end != std::string::npos);
      CHECK(names.insert(line.substr(start.size(), end - start.size())).second);
    }
  }
  return names;
}

/// Text of each entry of the page, and its references, "[NAME]: https://…".
struct Page {
  std::map<std::string, std::string> entries;
  std::set<std::string> sources;
};

Page listed() {
  std::ifstream in(source("docs/false_answers.md"));
  REQUIRE(in);
  Page page;
  std::string* entry = nullptr;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("### ")) {
      CHECK_FALSE(page.entries.contains(line.substr(4)));
      entry = &page.entries[line.substr(4)];
    } else if (line.starts_with("[") && line.find("]: https://") != std::string::npos) {
      page.sources.insert(line.substr(0, line.find("]: ") + 1));
    } else if (line.starts_with("#")) {
      entry = nullptr;
    } else if (entry) {
      *entry += line + "\n";
    }
  }
  return page;
}

/// One of the references, the bibliography, or our own source.
bool has_source(const std::string& text, const std::set<std::string>& sources) {
  for (const std::string& name : sources) {
    if (text.find(name) != std::string::npos) return true;
  }
  return text.find("](notation.md#bibliography)") != std::string::npos ||
         text.find("](../plugins/") != std::string::npos;  // answers of our own
}

}  // namespace

TEST_CASE("the page and the tests have the same cases") {
  std::set<std::string> names;
  const Page page = listed();
  for (const auto& [name, text] : page.entries) {
    CAPTURE(name);
    names.insert(name);
    for (const char* part : {"- Set: ", "- Answer: ", "- Elsewhere: ", "- Cordon: "})
      CHECK(text.find(part) != std::string::npos);
    CHECK(has_source(text, page.sources));
  }
  CHECK(names == tested());
  CHECK(names.size() >= 20);
  for (const std::string& name : page.sources) {
    CAPTURE(name);
    bool used = false;
    for (const auto& entry : page.entries) used |= entry.second.find(name) != std::string::npos;
    CHECK(used);
  }
}
