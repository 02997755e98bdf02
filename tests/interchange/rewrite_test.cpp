// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices change their form, and nothing else changes.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/experiments/interchange.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

void put(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

json rewritten(const std::string& text, MatrixForm form) {
  const Scratch scratch;
  put(scratch / "in.json", text);
  rewrite_matrices(scratch / "in.json", {scratch / "out.json"}, form);
  return json::parse(bytes_of(scratch / "out.json"));
}

std::string diagonal(int n) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    text += i == 0 ? "[" : ", [";
    for (int j = 0; j < n; ++j) text += std::string(j == 0 ? "" : ", ") + (i == j ? "2.5" : "0");
    text += "]";
  }
  return "[" + text + "]";
}

}  // namespace

TEST_CASE("a large diagonal becomes sparse, and comes back") {
  const std::string set =
      R"({"type": "zonotope", "center": [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], "generators": )" +
      diagonal(12) + "}";
  const json sparse = rewritten(set, MatrixForm::sparse);
  CHECK(sparse["generators"]["rows"] == 12);
  CHECK(sparse["generators"]["cols"] == 12);
  REQUIRE(sparse["generators"]["entries"].size() == 12);
  CHECK(sparse["generators"]["entries"][11] == json::parse("[12, 12, 2.5]"));
  CHECK(rewritten(sparse.dump(), MatrixForm::dense) == json::parse(set));
}

TEST_CASE("rows come before columns") {
  const std::string zeros(60, '0');
  std::string row;
  for (const char c : zeros) row += std::string(row.empty() ? "" : ", ") + c;
  const json sparse =
      rewritten(R"({"cordon": 1, "A": [[)" + row + ", 7], [" + row + ", 0]]}", MatrixForm::sparse);
  CHECK(sparse["A"] == json::parse(R"({"rows": 2, "cols": 61, "entries": [[1, 61, 7]]})"));
}

TEST_CASE("what would be longer stays dense") {
  const std::string set =
      R"({"type": "zonotope", "center": [0, 0], "generators": [[1, 0], [0, 1]]})";
  CHECK(rewritten(set, MatrixForm::sparse) == json::parse(set));
}

TEST_CASE("nothing but matrices is touched") {
  const std::string text =
      R"({"cordon": 1, "$comment": [[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]],
    "system": {"A": [[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]],
      "modes": [{"actuator": [[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]]}],
      "B": {"rows": 2, "cols": 2, "entries": []}},
    "big": 9007199254740993, "real": 1e300, "text": "π", "list": [true, null, -0.5], "sweep": [{"path": "/system/C/0/1", "values": [[[0, 0]]]}]})";
  const json before = json::parse(text), after = rewritten(text, MatrixForm::sparse);
  CHECK(after["$comment"] == before["$comment"]);
  CHECK(after["system"]["A"]["cols"] == 34);
  CHECK(after["system"]["modes"] == before["system"]["modes"]);
  CHECK(after["system"]["B"] == json::parse("[[0, 0], [0, 0]]"));
  CHECK(after["real"] == before["real"]);
  CHECK(after["text"] == "π");
  CHECK(after["list"] == before["list"]);
  CHECK(after["sweep"] == before["sweep"]);
}

TEST_CASE("a matrix that a sweep looks into keeps its form") {
  const std::string zeros =
      "[[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, "
      "0, 0, 0, 0, 0]]";
  const std::string head = R"({"cordon": 1, "pipelines": [{"gain": )" + zeros + R"(}], "other": )" +
                           zeros + R"(, "sweep": [{"path": ")";
  const json swept = rewritten(head + "/pipelines/*/gain/0/3\"}]}", MatrixForm::sparse);
  CHECK(swept["pipelines"][0]["gain"].is_array());
  CHECK(swept["other"].is_object());
  CHECK(rewritten(head + "/pipelines/0/gains/0/3\"}]}", MatrixForm::sparse)["pipelines"][0]["gain"]
            .is_object());
  CHECK(rewritten(head + "/other\"}]}", MatrixForm::sparse)["other"]
            .is_object());  // the whole matrix is exchanged
  const json kept = rewritten(
      R"({"cordon": 1, "A": {"rows": 3, "cols": 3, "entries": [[1, 2, 3], [2, 2, 2]]}, "sweep": [{"path": "/A/entries/0/2"}]})",
      MatrixForm::dense);
  CHECK(kept["A"]["entries"] == json::parse("[[1, 2, 3], [2, 2, 2]]"));
}

TEST_CASE("a study is the same study in both forms") {
  const Scratch scratch;
  for (const char* text : {study_test::valid_study, study_test::diagnosis_study,
                           study_test::uncertain_study, study_test::design_study}) {
    put(scratch / "in.json", text);
    CHECK(json_file(scratch / "in.json") == JsonFile::study);
    rewrite_matrices(scratch / "in.json", {scratch / "sparse.json", true}, MatrixForm::sparse);
    rewrite_matrices(scratch / "sparse.json", {scratch / "dense.json", true}, MatrixForm::dense);
    const std::string resolved = study_test::read_text(text).resolved;
    CHECK(study_test::read_text(bytes_of(scratch / "sparse.json")).resolved == resolved);
    CHECK(study_test::read_text(bytes_of(scratch / "dense.json")).resolved == resolved);
  }
}

TEST_CASE("files of other kinds are refused") {
  const Scratch scratch;
  for (const auto& [text, kind] :
       std::vector<std::pair<std::string, JsonFile>>{{"{\"cordon_results\": 1}", JsonFile::results},
                                                     {"[1, 2]", JsonFile::other},
                                                     {"{\"type\": \"ball\"}", JsonFile::other},
                                                     {"[]", JsonFile::other}}) {
    put(scratch / "in.json", text);
    CHECK(json_file(scratch / "in.json") == kind);
    CHECK_THROWS_AS(
        rewrite_matrices(scratch / "in.json", {scratch / "out.json"}, MatrixForm::dense),
        InputError);
    CHECK_FALSE(std::filesystem::exists(scratch / "out.json"));
  }
  put(scratch / "in.json", "{");
  CHECK_THROWS_AS(json_file(scratch / "in.json"), InputError);
}
