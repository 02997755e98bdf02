// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon run --sets`: which sets are kept, what needs them, and what is foreseen of their size.
#include <vector>

#include <doctest/doctest.h>

#include "run/program.hpp"
#include "study/results/sets_file.hpp"
#include "study/text/string_sink.hpp"

using namespace cordon;
using detail::SetsFile;
using detail::StringSink;
using test::cordon_with;

namespace {

const std::string study = "\"" CORDON_SOURCE_DIR "/examples/studies/linear_two_states.json\"";

std::string run(const Scratch& scratch, const std::string& sets) {
  const std::string directory = (scratch / ("kept " + sets)).string();
  const test::Outcome outcome =
      cordon_with("run " + study + " --quiet --sets " + sets + " --out \"" + directory + "\"");
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  return directory;
}

/// The text without the line that tells which sets were kept.
std::string without_note(std::string text, const std::string& sets) {
  const std::string line = "\n  \"sets\": \"" + sets + "\",";
  const std::size_t at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.erase(at, line.size());
}

/// The last line of each pipeline.
std::string last_lines(const std::string& text) {
  std::string kept, before;
  const auto head = [](const std::string& line) { return line.substr(0, line.find("\"k\"")); };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at) + 1;
    const std::string line = text.substr(at, end - at);
    if (!before.empty() && head(before) != head(line)) kept += before;
    before = line;
    at = end;
  }
  return kept + before;
}

/// What is foreseen, after each of `lines` lines of 100,000 bytes.
struct Foreseen {
  Foreseen(KeptSets kept, std::size_t pipelines, std::int64_t samples, int lines) {
    SetsFile file(sink, pipelines, kept, [&](double bytes) {
      said.push_back(bytes);
      after = sink.text.size();
    });
    file.begin_pipeline(samples);
    for (int i = 0; i < lines; ++i) file.write(std::string(100'000, 'x'));
    file.end_pipeline();
  }

  StringSink sink;
  std::vector<double> said;
  std::size_t after = 0;
};

}  // namespace

TEST_CASE("sets of all steps, of the last ones or of none are kept, and nothing else differs") {
  const Scratch scratch;
  const std::filesystem::path all = run(scratch, "all"), last = run(scratch, "last"),
                              none = run(scratch, "none");
  const std::string sets = bytes_of(all / "sets.jsonl");
  CHECK(bytes_of(last / "sets.jsonl") == last_lines(sets));
  CHECK(bytes_of(last / "sets.jsonl").size() < sets.size() / 5);
  CHECK(bytes_of(none / "sets.jsonl").empty());
  const std::string results = bytes_of(all / "results.json");
  CHECK(without_note(bytes_of(last / "results.json"), "last") == results);
  CHECK(without_note(bytes_of(none / "results.json"), "none") == results);
  for (const char* file : {"steps.csv", "summary.csv", "data.csv"}) {
    CHECK(bytes_of(last / file) == bytes_of(all / file));
    CHECK(bytes_of(none / file) == bytes_of(all / file));
  }
  CHECK(bytes_of(none / "report.html").find("No sets were kept (--sets none).") !=
        std::string::npos);
  CHECK(bytes_of(last / "report.html").find("Only the last sets were kept (--sets last).") !=
        std::string::npos);
}

TEST_CASE("what needs all sets says which were kept") {
  const Scratch scratch;
  CHECK(cordon_with("verify \"" + run(scratch, "all") + "\"").code == 0);
  for (const std::string kept : {"last", "none"}) {
    const std::string directory = run(scratch, kept),
                      told = kept == "last" ? "only the last sets were kept (--sets last)"
                                            : "no sets were kept (--sets none)";
    const test::Outcome verified = cordon_with("verify \"" + directory + "\"");
    CHECK(verified.code == 2);
    CHECK_MESSAGE(verified.complains(told), verified.err);
    CHECK(verified.complains("run the study again without --sets"));
    const std::string mat = "\"" + (scratch / (kept + ".mat")).string() + "\"";
    const test::Outcome converted = cordon_with("convert --sets \"" + directory + "\" " + mat);
    CHECK(converted.code == 2);
    CHECK(converted.complains(told));
    CHECK(cordon_with("convert \"" + directory + "\" " + mat).code == 0);
  }
  const test::Outcome wrong = cordon_with("run " + study + " --sets some");
  CHECK(wrong.code == 2);
  CHECK_MESSAGE(wrong.complains("--sets: \"some\" is no choice; there are"), wrong.err);
}

TEST_CASE("large files of sets are foreseen, once and early") {
  const Foreseen large(KeptSets::all, 2, 1000, 1000);  // 2 * 1,000 * 0.1 MB
  REQUIRE(large.said.size() == 1);
  CHECK(large.said[0] == doctest::Approx(2e8));
  CHECK(large.after <= 1'100'000);
  CHECK(Foreseen(KeptSets::all, 1, 900, 900).said.empty());  // 90 MB
  const Foreseen unknown(KeptSets::all, 1, 0, 1400);         // of samples without end
  REQUIRE(unknown.said.size() == 1);
  CHECK(unknown.said[0] == 0);
  CHECK(unknown.after >= 100'000'000);
  CHECK(Foreseen(KeptSets::last, 2, 1000, 1000).said.empty());
  CHECK(Foreseen(KeptSets::none, 2, 1000, 1000).said.empty());
}
