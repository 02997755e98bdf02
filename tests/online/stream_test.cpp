// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon stream` from a shell.
#include <map>
#include <sstream>

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
  const std::string wait = "for i in $(seq 100); do sleep 0.2; [ -s " + out + " ] && break; done";
  const test::Outcome outcome =
      cordon_with("stream " + study.string() + " --pipeline zonotope < " + in + " > " + out +
                      " & stream=$!; " + feed + " & feeder=$!; " + wait +
                      "; kill -TERM $stream; wait $stream; code=$?; kill $feeder; exit $code",
                  "true; mkfifo " + in + ";");
  CHECK(outcome.code == 0);
  CHECK(outcome.complains("1 sample"));
  CHECK(bytes_of(out).find("\"k\": 0") != std::string::npos);
}

namespace {

/// The samples of a plant that leaks from k = 40 on, with a request in between.
std::string leaking() {
  LeakyPlant plant;
  std::string text;
  for (Index k = 0; k < 80; ++k) {
    const GivenSample sample = plant.next(k >= 40);
    text += "{\"k\": " + std::to_string(k) + ", \"u\": [" + nlohmann::json(sample.u[0]).dump() +
            "], \"y\": [" + nlohmann::json(sample.y[0]).dump() + ", " +
            nlohmann::json(sample.y[1]).dump() + "]}\n";
    if (k == 60) text += "{\"do\": \"acknowledge\"}\n";
  }
  return text;
}

std::size_t lines_with(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++count;
  return count;
}

}  // namespace

TEST_CASE("a log is replayed to the same alarms, and one that was changed is told") {
  const Scratch scratch;
  const std::string study = scratch.write("study.json", study_text()).string();
  const std::string input = scratch.write("input", leaking()).string();
  const std::string log = (scratch / "log").string();
  const std::string stream = "stream " + study + " --pipeline bank ";
  const test::Outcome first = cordon_with(stream + "--log " + log + " < " + input);
  CHECK(first.code == 0);
  CHECK(lines_with(bytes_of(log), "{\"alarm\"") >= 2);
  const test::Outcome replayed = cordon_with(stream + "--replay " + log);
  CHECK(replayed.code == 0);
  CHECK(replayed.out == first.out);
  CHECK(cordon_with(stream + "--log " + log + " < " + input).complains("exists already"));

  std::string changed = bytes_of(log);
  changed.replace(changed.find("\"raised_at\": 4"), 14, "\"raised_at\": 9");
  const test::Outcome other =
      cordon_with(stream + "--replay " + scratch.write("changed", changed).string());
  CHECK(other.code == 4);
  CHECK(other.complains("1 alarm change is not as in the log"));
  CHECK(cordon_with(stream + "--replay " + study).complains("is no log"));
  CHECK(cordon_with("stream " + study + " --pipeline zonotope --replay " + log)
            .complains("another pipeline"));
}

TEST_CASE("times in seconds are answered, logged and replayed") {
  const Scratch scratch;
  const std::string study =
      scratch.write("study.json", study_with_clock("{\"jumps\": \"fill\"}")).string();
  const std::string log = (scratch / "log").string();
  const std::string stream = "stream " + study + " --pipeline zonotope ";
  const std::string lines =
      "{\"t\": 1700000000.25, \"u\": [0], \"y\": [0, 0]}\n"
      "{\"t\": 1700000001.75, \"u\": [0], \"y\": [0, 0]}\n"
      "{\"t\": 1700000002.1, \"u\": [0], \"y\": [0, 0]}\n";
  const test::Outcome first =
      cordon_with(stream + "--log " + log + " < " + scratch.write("in", lines).string());
  CHECK(first.code == 0);
  CHECK(first.out.find("\"how\": \"filled\"") != std::string::npos);
  CHECK(first.out.find("{\"k\": 3, ") != std::string::npos);
  CHECK(first.out.find("clock_tolerance") != std::string::npos);
  CHECK(first.complains("1 refused"));
  const test::Outcome replayed = cordon_with(stream + "--replay " + log);
  CHECK(replayed.code == 0);
  CHECK(first.out.starts_with(replayed.out));
}

TEST_CASE("a log that a kill has cut is replayed as far as it goes") {
  const Scratch scratch;
  const std::string study = scratch.write("study.json", study_text()).string();
  const std::string log = (scratch / "log").string();
  const std::string stream = "stream " + study + " --pipeline bank ";
  REQUIRE(
      cordon_with(stream + "--log " + log + " < " + scratch.write("in", leaking()).string()).code ==
      0);
  const std::string whole = bytes_of(log);
  const std::size_t alarm = whole.find("{\"alarm\"");
  const std::size_t next = whole.find('\n', alarm) + 1;  // of the same sample
  const std::pair<std::size_t, const char*> cuts[] = {
      {alarm, "2 alarm changes"}, {next - 1, "2 alarm changes"}, {next, "1 alarm change"}};
  for (const auto& [end, left] : cuts) {
    const test::Outcome replayed =
        cordon_with(stream + "--replay " + scratch.write("cut", whole.substr(0, end)).string());
    CHECK(replayed.code == 0);
    CHECK_MESSAGE(replayed.complains(std::string("within its last sample: ") + left + " of it"),
                  replayed.err);
  }
  // One that is missing in between is told.
  std::string without = whole;
  without.erase(alarm, next - alarm);
  const test::Outcome other =
      cordon_with(stream + "--replay " + scratch.write("without", without).string());
  CHECK(other.code == 4);
  CHECK_MESSAGE(other.complains("alarm changes are not as in the log"), other.err);
}

TEST_CASE("a stream that is killed goes on from its checkpoint, with no alarm lost or doubled") {
  const Scratch scratch;
  const std::string study = scratch.write("study.json", study_text()).string();
  const std::string all = leaking(), log = (scratch / "log").string();
  const std::string stream = "stream " + study + " --pipeline bank --quiet ";
  const test::Outcome whole =
      cordon_with(stream + "--log " + log + ".whole < " + scratch.write("all", all).string());
  for (const std::size_t until : {5, 37, 43, 60, 61, 62, 79}) {
    CAPTURE(until);
    const std::string checkpoint = (scratch / "state").string();
    std::size_t end = 0;
    for (std::size_t line = 0; line < until; ++line) end = all.find('\n', end) + 1;
    const std::string options =
        stream + "--every 7 --checkpoint " + checkpoint + " --log " + log + " < ";
    // Killed while it waits for more.
    const std::string begun = scratch.write("begun", all.substr(0, end)).string();
    const std::string in = (scratch / "in").string(), out = (scratch / "out").string();
    cordon_with(
        options + in + " > " + out + " & stream=$!; { cat " + begun + "; exec sleep 30; } > " + in +
            " & feeder=$!; for i in $(seq 200); do sleep 0.1; [ $(wc -l < " + out + ") -ge " +
            std::to_string(until) + " ] && break; done; kill -KILL $stream; kill $feeder; wait",
        "true; rm -f " + in + "; mkfifo " + in + ";");
    const std::string before = bytes_of(out);
    // The plant sends again what has come since the checkpoint.
    CHECK(cordon_with(stream + "--checkpoint " + checkpoint + " < /dev/null").code == 2);
    const test::Outcome probe = cordon_with(options + "/dev/null");
    std::size_t from = 0;
    const std::size_t taken = nlohmann::json::parse(probe.out)["lines"];
    for (std::size_t line = 0; line < taken; ++line) from = all.find('\n', from) + 1;
    const std::string rest = scratch.write("rest", all.substr(from)).string();
    const test::Outcome after = cordon_with(options + rest);
    REQUIRE(after.code == 0);
    const std::string lines = after.out.substr(after.out.find('\n') + 1);
    CHECK(whole.out.ends_with(lines));
    CHECK(whole.out.starts_with(before));
    CHECK(lines.size() + before.size() >= whole.out.size());
    CHECK(bytes_of(log) == bytes_of(log + ".whole"));
    std::filesystem::remove(checkpoint);
    std::filesystem::remove(log);
  }
}

TEST_CASE("a checkpoint that is damaged, or another file, is refused") {
  const Scratch scratch;
  const std::string study = scratch.write("study.json", study_text()).string();
  const std::string state = (scratch / "state").string();
  const std::string stream = "stream " + study + " --checkpoint " + state + " --pipeline ";
  CHECK(
      cordon_with(stream + "zonotope < " + scratch.write("some", "{\"u\": [0]}\n").string()).code ==
      0);
  const std::string saved = bytes_of(state);
  for (const std::size_t at : {3, 25, 60}) {
    std::string damaged = saved;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    scratch.write("state", damaged);
    const test::Outcome outcome = cordon_with(stream + "zonotope < /dev/null");
    CHECK(outcome.code == 2);
    CHECK(bytes_of(state) == damaged);
  }
  scratch.write("state", saved);
  CHECK(cordon_with(stream + "interval < /dev/null").code == 2);
  CHECK(cordon_with(stream + "zonotope < /dev/null").says("\"next\": 1"));
}

TEST_CASE("what is recorded is a study with its results, and is verified") {
  const Scratch scratch;
  const std::string study =
      scratch.write("study.json", study_text(R"({"jumps": "fill", "late": "correct"})")).string();
  std::string input;
  for (int k = 0; k < 30; ++k) {
    const std::string y = k % 5 == 2 ? "[0.1, null]" : "[0.1, 0.05]";
    if (k == 11 || k == 12) continue;
    input += "{\"k\": " + std::to_string(k) + ", \"u\": [0], \"y\": " + y + "}\n";
    if (k == 9) input += "{\"k\": 7, \"u\": [0], \"y\": [0.1, 0.0625]}\n";
  }
  const std::string data = scratch.write("input", input).string();
  const std::string record = (scratch / "record").string();
  const test::Outcome outcome =
      cordon_with("stream " + study + " --pipeline constrained --record " + record + " < " + data);
  CHECK(outcome.code == 0);
  const auto results = nlohmann::json::parse(bytes_of(record + "/results.json"));
  const auto& steps = results["pipelines"][0]["steps"];
  CHECK(steps.size() == 30);
  CHECK(bytes_of(record + "/data.csv").find("7,0,0.1,0.0625") != std::string::npos);
  std::istringstream lines(outcome.out);
  std::map<int, nlohmann::json> last;  // of each time, as corrected
  for (std::string line; std::getline(lines, line);) {
    const auto step = nlohmann::json::parse(line);
    if (step.contains("k")) last[step["k"]] = step;
  }
  for (const auto& step : steps) CHECK(step["hull"] == last[step["k"]]["hull"]);
  CHECK(cordon_with("verify " + record).code == 0);
  CHECK(cordon_with("stream " + study + " --pipeline constrained --record " + record + " < " + data)
            .complains("holds a record already"));
}

TEST_CASE("a disk that is full ends the record and the log, and not the stream") {
  const Scratch scratch;
  const std::string study = scratch.write("study.json", study_text()).string();
  std::string input;
  for (int k = 0; k < 3000; ++k) input += "{\"u\": [0], \"y\": [0.1, 0.05]}\n";
  const std::string data = scratch.write("input", input).string();
  const test::Outcome outcome = cordon_with(
      "stream " + study + " --pipeline zonotope --record " + (scratch / "record").string() +
          " --log " + (scratch / "log").string() + " < " + data + " | tail -1",
      "ulimit -f 16;");
  CHECK(outcome.says("\"k\": 2999"));
  CHECK(outcome.complains("the log was not written"));
  CHECK(outcome.complains("the record ends"));
}

TEST_CASE("a deadline leaves questions open, and no estimate is wrong") {
  const std::string samples = leaking();
  const std::string until_leak = samples.substr(0, samples.find("{\"k\": 40,"));
  const Streamed free = stream("--pipeline constrained", until_leak),
                 cut = stream("--pipeline constrained --deadline 0.001us", until_leak);
  CHECK(cut.code == 0);
  REQUIRE(free.lines.size() == cut.lines.size());
  bool left_open = false;
  for (std::size_t k = 0; k < free.lines.size(); ++k) {
    left_open = left_open || cut.lines[k].contains("left_open");
    CHECK(cut.lines[k]["consistent"] != "no");
    LeakyPlant plant;
    for (std::size_t i = 0; i < k; ++i) plant.next();
    for (int i = 0; i < 2; ++i) {
      CHECK(cut.lines[k]["hull"]["lower"][i].get<double>() <= plant.x[i]);
      CHECK(cut.lines[k]["hull"]["upper"][i].get<double>() >= plant.x[i]);
    }
  }
  CHECK(left_open);
  CHECK(cut.err.find("limits of work") != std::string::npos);
  const Streamed bank = stream("--pipeline bank --deadline 0.001us", until_leak);
  for (const auto& line : bank.lines) CHECK(line["modes"][0]["candidate"] == true);
  CHECK(stream("--pipeline bank --deadline 5", "").code != 0);
}
