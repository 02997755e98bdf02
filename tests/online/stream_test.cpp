// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon stream` from a shell.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "online/study.hpp"
#include "run/program.hpp"

using namespace online_test;
using test::cordon_with;

namespace {

struct Streamed {
  int code;
  std::vector<nlohmann::json> lines;
  std::string err;
};

Streamed stream(const std::string& options, const std::string& input,
                const std::string& online = "") {
  const Scratch scratch;
  const auto study = scratch.write("study.json", study_text(online));
  const auto data = scratch.write("input", input);
  const test::Outcome outcome =
      cordon_with("stream " + study.string() + " " + options + " < " + data.string());
  Streamed result{outcome.code, {}, outcome.err};
  std::istringstream text(outcome.out);
  for (std::string line; std::getline(text, line);)
    result.lines.push_back(nlohmann::json::parse(line));
  return result;
}

}  // namespace

TEST_CASE("each sample is answered by a line, and the end by a summary") {
  const Streamed result = stream("--pipeline zonotope",
                                 "{\"u\": [0], \"y\": [0.1, 0]}\n\n{\"u\": [0], \"y\": [0, null]}\n"
                                 "{\"u\": [0]}");
  CHECK(result.code == 0);
  REQUIRE(result.lines.size() == 3);
  for (int k = 0; k < 3; ++k) {
    CHECK(result.lines[k]["k"] == k);
    CHECK(result.lines[k]["consistent"] == "yes");
    CHECK(result.lines[k]["hull"]["lower"].size() == 2);
  }
  CHECK(result.err.find("3 samples") != std::string::npos);
  CHECK(result.err.find("largest") != std::string::npos);
}

TEST_CASE("broken lines are answered and counted, and the stream goes on") {
  const Streamed result =
      stream("--pipeline constrained",
             "{\"u\": [0], \"y\": [0, 0]}\n{\"u\": [0]\n{\"u\": [0, 0], \"y\": [0, 0]}\n"
             "{\"k\": 9, \"u\": [0], \"y\": [0, 0]}\n{\"k\": 1, \"u\": [0], \"y\": [0, 0]}\n");
  CHECK(result.code == 0);
  REQUIRE(result.lines.size() == 5);
  for (const int i : {1, 2, 3}) {
    CHECK(result.lines[i].contains("error"));
    CHECK(result.lines[i]["line"] == i + 1);
  }
  CHECK(result.lines[4]["k"] == 1);
  CHECK(result.err.find("3 refused") != std::string::npos);
}

TEST_CASE("the rule that a sample out of order meets is said") {
  const Streamed result =
      stream("--pipeline zonotope", "k,u_1,y_1,y_2\n0,0,0,0\n3,0,0,\n3,0,0,0.1\n3,0,0,0.1\n",
             R"({"jumps": "fill",
             "late": "correct", "repeated": "ignore"})");
  REQUIRE(result.lines.size() == 8);
  CHECK(result.lines[1]["how"] == "filled");
  CHECK(result.lines[2]["k"] == 1);
  CHECK(result.lines[4]["k"] == 3);
  CHECK(result.lines[5]["how"] == "corrected");
  CHECK(result.lines[6]["k"] == 3);
  CHECK(result.lines[7]["how"] == "repeated");
}

TEST_CASE("a pipeline has to be named, and a designer takes no samples") {
  CHECK(stream("", "").code == 2);
  CHECK(stream("--pipeline nothing", "").err.find("there is no pipeline") != std::string::npos);
}

TEST_CASE("a reader that goes away ends the stream in order") {
  const Scratch scratch;
  const auto study = scratch.write("study.json", study_text());
  std::string input;
  for (int k = 0; k < 20'000; ++k) input += "{\"u\": [0], \"y\": [0, 0]}\n";
  const auto data = scratch.write("input", input);
  const test::Outcome outcome = cordon_with("stream " + study.string() + " --pipeline zonotope < " +
                                            data.string() + " | head -1");
  CHECK(outcome.code == 0);
  CHECK(outcome.says("\"k\": 0"));
  CHECK(outcome.complains("samples"));
}

TEST_CASE("SIGTERM ends a stream after the sample at hand") {
  const Scratch scratch;
  const auto study = scratch.write("study.json", study_text());
  const std::string out = (scratch / "out").string();
  const std::string in = (scratch / "in").string();
  const std::string feed = "{ echo '{\"u\": [0], \"y\": [0, 0]}'; exec sleep 30; } > " + in;
  const std::string wait = "for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.2; [ -s " + out +
                           " ] && break; done";
  const test::Outcome outcome = cordon_with(
      "stream " + study.string() + " --pipeline zonotope < " + in + " > " + out +
          " & stream=$!; " + feed + " & feeder=$!; " + wait +
          "; kill -TERM $stream; wait $stream; code=$?; kill $feeder; exit $code",
      "true; mkfifo " + in + ";");
  CHECK(outcome.code == 0);
  CHECK(outcome.complains("1 sample"));
  CHECK(bytes_of(out).find("\"k\": 0") != std::string::npos);
}
