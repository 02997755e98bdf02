// SPDX-License-Identifier: GPL-3.0-or-later
// Studies that are texts in memory: they are read as the same text in a file is.
#include <fstream>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;

namespace {

Study study_of_text(const std::string& text, const std::filesystem::path& file,
                    const std::vector<std::string>& settings = {}) {
  Registry registry;
  registry.add(register_fakes);
  return read_study_text(text, file, registry, SearchPath{}, StudyPlugins::refuse,
                         StudyData::needed, settings);
}

std::optional<InputError> refusal(const std::string& text, const std::filesystem::path& file) {
  try {
    study_of_text(text, file);
  } catch (const InputError& error) {
    return error;
  }
  return std::nullopt;
}

std::string recorded(const std::string& file) {
  const std::string text = valid_study;
  const std::size_t from = text.find("\"simulate\""), to = text.find("},\n\"pipelines\"");
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  return text.substr(0, from) + R"("csv": {"file": ")" + file +
         R"(", "inputs": ["a"], "outputs": ["b"]})" + "\n" + text.substr(to);
}

}  // namespace

TEST_CASE("a text is read as the file with it is") {
  const Scratch scratch;
  for (const char* const text :
       {valid_study, diagnosis_study, uncertain_study, design_study, sweep_study}) {
    const auto file = scratch.write("study.json", text);
    const Study of_file = read_file(file);
    std::filesystem::remove(file);
    const Study of_text = study_of_text(text, file);
    CHECK(same(of_file, of_text));
    CHECK(of_file.resolved == of_text.resolved);
    CHECK(of_text.file == file);
    REQUIRE(of_text.source);
    CHECK(*of_text.source == *of_file.source);
    CHECK_FALSE(std::filesystem::exists(file));
  }
}

TEST_CASE("the file of the name is not opened, whatever it holds") {
  const Scratch scratch;
  const auto file = scratch.write("study.json", "no study at all");
  CHECK(study_of_text(valid_study, file).title == "a study");
  CHECK(bytes_of(file) == "no study at all");
  // a name needs no folder, and there need be none of that name
  CHECK(study_of_text(valid_study, "memory.json").title == "a study");
  CHECK(study_of_text(valid_study, scratch / "none/such.json").title == "a study");
}

TEST_CASE("data are found from the folder of the name") {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "data");
  scratch.write("data/d.csv", "a,b\n1,2\n");
  const Study study = study_of_text(recorded("data/d.csv"), scratch / "study.json");
  CHECK(std::get<CsvSpec>(study.data).file == scratch / "data/d.csv");
  const Study beside = study_of_text(recorded("d.csv"), scratch / "data/study.json");
  CHECK(std::get<CsvSpec>(beside.data).file == scratch / "data/d.csv");
  const Study anywhere =
      study_of_text(recorded((scratch / "data/d.csv").string()), "/nowhere/at/all.json");
  CHECK(std::get<CsvSpec>(anywhere.data).file == scratch / "data/d.csv");
  const auto error = refusal(recorded("d.csv"), scratch / "study.json");
  REQUIRE(error);
  REQUIRE(error->diagnostics().size() == 1);
  CHECK(error->diagnostics()[0].pointer == "/data/csv/file");
}

TEST_CASE("problems of a text have pointers and lines, all at once") {
  const auto name = std::filesystem::path("somewhere/of a program");
  std::string text = exchanged(valid_study, "\"C\": [[1, 0]]", "\"C\": [[1, 0, 0]]");
  text = exchanged(text, "\"seed\": 7", "\"sed\": 7");
  const auto error = refusal(text, name);
  REQUIRE(error);
  CHECK(error->file() == name.string());
  REQUIRE(error->diagnostics().size() == 2);
  const Diagnostic &matrix = error->diagnostics()[0], &word = error->diagnostics()[1];
  CHECK(matrix.pointer == "/system/C");
  CHECK(matrix.line == 10);
  CHECK(word.pointer == "/data/simulate/sed");
  CHECK(word.line == 20);
  CHECK(word.suggestion.find("seed") != std::string::npos);
  const std::string what = error->what();
  CHECK(what.find(name.string()) != std::string::npos);
  // no JSON at all
  const auto broken = refusal("{\"cordon\": 1,\n \"title\": }", name);
  REQUIRE(broken);
  CHECK(broken->diagnostics()[0].line == 2);
  const auto nothing = refusal("", name);
  REQUIRE(nothing);
  CHECK_FALSE(nothing->diagnostics().empty());
}

TEST_CASE("settings take the place of what the text has") {
  const Study study =
      study_of_text(valid_study, "memory.json", {"/title=another", "/data/simulate/steps=5"});
  CHECK(study.title == "another");
  CHECK(std::get<SimulateSpec>(study.data).steps == 5);
  CHECK(study.resolved == study_of_text(exchanged(exchanged(valid_study, "a study", "another"),
                                                  "\"steps\": 20", "\"steps\": 5"),
                                        "memory.json")
                              .resolved);
}
