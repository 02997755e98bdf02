// SPDX-License-Identifier: GPL-3.0-or-later
// The sparse form may stand wherever a matrix may, and is checked like one.
#include <doctest/doctest.h>

#include "study/fakes.hpp"
#include "study/mistake.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;

namespace {

const std::string dense_A = "\"A\": [[0.5, 1], [0, 2]]";
const std::string sparse_A =
    R"("A": {"rows": 2, "cols": 2, "entries": [[2, 2, 2], [1, 1, 0.5], [1, 2, 1]]})";

void expect_wrong(const std::string& matrix, const std::string& place, const std::string& message,
                  const std::string& suggestion) {
  expect_reported(valid_study,
                  {dense_A, "\"A\": " + matrix, "/system/A" + place, message, suggestion});
}

}  // namespace

TEST_CASE("every matrix of a system may be sparse") {
  std::string text = exchanged(valid_study, dense_A, sparse_A);
  text = exchanged(text, "\"E\": [[1, 0], [0, 0]]",
                   R"("E": {"rows": 2, "cols": 2, "entries": [[1, 1, 1]]})");
  text =
      exchanged(text, "\"B\": [[1], [0]]",
                R"("B": {"$comment": "one entry", "cols": 1, "entries": [[1, 1, 1]], "rows": 2})");
  text = exchanged(text, "\"Bw\": [[1, 0, 0], [0, 1, 1]]",
                   R"("Bw": {"rows": 2, "cols": 3, "entries": [[1, 1, 1], [2, 2, 1], [2, 3, 1]]})");
  text =
      exchanged(text, "\"C\": [[1, 0]]", R"("C": {"rows": 1, "cols": 2, "entries": [[1, 1, 1]]})");
  text = exchanged(text, "\"D\": [[0.25]]",
                   R"("D": {"rows": 1, "cols": 1, "entries": [[1, 1, 0.25]]})");
  text = exchanged(
      text, "\"generators\": [[1, 0.5], [0, 1]]",
      R"("generators": {"rows": 2, "cols": 2, "entries": [[1, 1, 1], [1, 2, 0.5], [2, 2, 1]]})");
  const Study sparse = read_text(text), dense = read_text(valid_study);
  CHECK(same(sparse, dense));
  CHECK(sparse.resolved == dense.resolved);
}

TEST_CASE("interval matrices, directions of faults and gains may be sparse") {
  std::string text = exchanged(
      uncertain_study, "\"center\": [[0.5, 0.25], [0, 0.75]]",
      R"("center": {"rows": 2, "cols": 2, "entries": [[1, 1, 0.5], [1, 2, 0.25], [2, 2, 0.75]]})");
  text =
      exchanged(text, "\"radius\": [[0.125, 0], [0, 0.0625]]",
                R"("radius": {"rows": 2, "cols": 2, "entries": [[1, 1, 0.125], [2, 2, 0.0625]]})");
  text = exchanged(text, "\"C\": [[1, 0], [0, 1]]",
                   R"("C": {"rows": 2, "cols": 2, "entries": [[1, 1, 1], [2, 2, 1]]})");
  text =
      exchanged(text, "\"F\": [[1, 0.5], [0, 2]]",
                R"("F": {"rows": 2, "cols": 2, "entries": [[1, 1, 1], [1, 2, 0.5], [2, 2, 2]]})");
  text = exchanged(text, "\"gain\": [[0.5, 0], [0, 0.25]]",
                   R"("gain": {"rows": 2, "cols": 2, "entries": [[1, 1, 0.5], [2, 2, 0.25]]})");
  const Study sparse = read_text(text), dense = read_text(uncertain_study);
  CHECK(same(sparse, dense));
  CHECK(sparse.resolved == dense.resolved);
}

TEST_CASE("an exact system takes sparse matrices, and refuses intervals as before") {
  const std::string lti = exchanged(
      valid_study, "\"type\": \"descriptor\",\n\"E\": [[1, 0], [0, 0]],", "\"type\": \"lti\",");
  const std::string text = exchanged(lti, dense_A, sparse_A);
  for (const Diagnostic& d : problems_of(text))
    CHECK(d.pointer.find("/system") == std::string::npos);
  const auto problems =
      problems_of(exchanged(lti, dense_A, R"("A": {"center": [[1]], "radius": [[0]]})"));
  REQUIRE_FALSE(problems.empty());
  CHECK(problems[0].message.find("interval matrix") != std::string::npos);
}

TEST_CASE("a size without entries is a matrix of zeros") {
  const std::string text =
      exchanged(valid_study, "\"D\": [[0.25]]", R"("D": {"rows": 1, "cols": 1, "entries": []})");
  CHECK(read_text(text).model.linear.D(0, 0) == 0);
  const std::string none =
      exchanged(exchanged(valid_study, "\"Bw\": [[1, 0, 0], [0, 1, 1]]",
                          R"("Bw": {"rows": 2, "cols": 0, "entries": []})"),
                "\"W\": {\"type\": \"box\", \"lower\": [-1, -1, -1], \"upper\": [1, 1, 1]},\n", "");
  CHECK(read_text(none).model.linear.disturbances() == 0);
}

TEST_CASE("mistakes are told with their place") {
  const std::string sizes = R"("rows": 2, "cols": 2, )";
  expect_wrong("{" + sizes + R"("entries": [[1, 1, 1], [0, 1, 1]]})", "/entries/1/0",
               "is too small", "between 1 and 2");
  expect_wrong("{" + sizes + R"("entries": [[1, 3, 1]]})", "/entries/0/1", "is too large",
               "between 1 and 2");
  expect_wrong("{" + sizes + R"("entries": [[1, 1.5, 1]]})", "/entries/0/1", "must be an integer",
               "1 and 2");
  expect_wrong("{" + sizes + R"("entries": [[1, 2, 1], [2, 2, 3], [1, 2, 1]]})", "/entries/2",
               "repeats the entry in row 1, column 2", "name each entry once");
  expect_wrong("{" + sizes + R"("entries": [[1, 1]]})", "/entries/0", "has 2 numbers, must have 3",
               "[row, column, number]");
  expect_wrong("{" + sizes + R"("entries": [4]})", "/entries/0", "is a number",
               "[row, column, number]");
  expect_wrong("{" + sizes + R"("entries": [[1, 1, "x"]]})", "/entries/0/2", "is a text",
               "without quotes");
  expect_wrong("{" + sizes + R"("entries": 3})", "/entries", "is a number", "sparse form");
  expect_wrong(R"({"rows": 2, "cols": 2})", "/entries", "is missing", "sparse form");
  expect_wrong(R"({"cols": 2, "entries": []})", "/rows", "is missing", "sparse form");
  expect_wrong(R"({"rows": 2, "cols": -1, "entries": []})", "/cols", "is too small",
               "between 0 and 1000000");
  expect_wrong("{" + sizes + R"("entrys": 1, "entries": []})", "/entrys",
               "unknown key of a sparse matrix", "entries");
  expect_wrong(R"({"rows": 2, "cols": 0, "entries": [[1, 1, 1]]})", "/entries",
               "a matrix that is 2 × 0", "sparse form");
  expect_wrong(R"({"rows": 1000000, "cols": 2, "entries": []})", "", "more than 1000000 entries",
               "");
  expect_wrong(R"({"rows": 9007199254740991, "cols": 1, "entries": []})", "/rows", "is too large",
               "between 0 and 1000000");
  expect_wrong(R"({"rows": 2, "cols": 3, "entries": []})", "", "is 2 × 3, must be square", "");
}

TEST_CASE("only the first wrong entries are told") {
  const auto problems = problems_of(exchanged(
      valid_study, dense_A,
      R"("A": {"rows": 2, "cols": 2, "entries": [[9, 1, 1], [9, 2, 1], [9, 3, 1], [9, 4, 1], [9, 5, 1]]})"));
  std::size_t about_A = 0;
  for (const Diagnostic& d : problems) about_A += d.pointer.find("/system/A") == 0;
  CHECK(about_A <= 6);
  CHECK(about_A >= 3);
}

TEST_CASE("a wrong entry of an interval is told where it stands") {
  expect_reported(
      uncertain_study,
      {"\"radius\": [[0.125, 0], [0, 0.0625]]",
       R"("radius": {"rows": 2, "cols": 2, "entries": [[1, 1, 0.125], [2, 1, 1], [1, 2, -1]]})",
       "/system/A/radius/entries/2", "is negative", "at least 0"});
}
