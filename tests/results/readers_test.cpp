// SPDX-License-Identifier: GPL-3.0-or-later
// Every command that reads results refuses files that are not those of the run, and files that have
// no end.
#include <functional>
#include <sys/stat.h>

#include <doctest/doctest.h>

#include "cordon/experiments/compare.hpp"
#include "cordon/experiments/interchange.hpp"
#include "cordon/experiments/report.hpp"
#include "cordon/experiments/sweep.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/study/run.hpp"
#include "cordon/study/verify.hpp"
#include "run/scratch.hpp"
#include "study/text/input_file.hpp"
#include "study/text/json_text.hpp"

using namespace cordon;

namespace fs = std::filesystem;

namespace {

std::string study(int seed, bool sweep) {
  const std::string axes =
      R"(, "sweep": [{"name": "w", "path": "/system/W/upper/0", "values": [0.5, 1]}])";
  return R"({"cordon": 1, "title": "two states",
  "system": {"type": "lti", "A": [[0, -0.5], [1, 1]], "Bw": [[-0.12], [0.02]], "C": [[-2, 1]], "Dv": [[0.2]],
    "X0": {"type": "box", "lower": [-3, -3], "upper": [3, 3]},
    "W": {"type": "box", "lower": [-1], "upper": [1]}, "V": {"type": "box", "lower": [-1], "upper": [1]}},
  "data": {"simulate": {"steps": 5, "x0": [1, -1], "seed": )" +
         std::to_string(seed) + R"(}},
  "pipelines": [{"name": "Zonotope", "backend": "zonotope", "observer": "prediction_correction"},
                {"name": "Interval", "backend": "interval", "observer": "prediction_correction"}],
  "metrics": ["radius"])" +
         (sweep ? axes : "") + "}";
}

/// A finished run, another one of the same study, and the two parts of a sweep.
class Results {
 public:
  Results() {
    registry_.load({{fs::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    for (const int seed : {1, 2}) {
      RunOptions options;
      options.out = scratch_ / ("run " + std::to_string(seed));
      run_study(read(study(seed, false)), registry_, options);
    }
    for (const int part : {1, 2}) {
      SweepOptions options;
      options.out = scratch_ / ("part " + std::to_string(part));
      options.shard = {part, 2};
      run_sweep(read(study(1, true)), registry_, options);
    }
  }

  fs::path operator/(const std::string& name) const { return scratch_ / name; }

 private:
  Study read(const std::string& text) {
    return read_study(scratch_.write("study.json", text), registry_, {});
  }

  Scratch scratch_;
  Registry registry_;
};

/// A command that reads results, and the files that it reads.
struct Reader {
  const char* name;
  std::string of;
  std::vector<const char*> files;
  std::function<void(const fs::path&, const Results&)> read;
};

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{
      {"verify",
       "run 1",
       {"results.json", "data.csv", "sets.jsonl"},
       [](const fs::path& d, const Results&) { verify_run(d); }},
      {"report",
       "run 1",
       {"results.json", "run.json", "steps.csv", "data.csv", "sets.jsonl"},
       [](const fs::path& d, const Results&) { write_report(d); }},
      {"compare",
       "run 1",
       {"results.json", "run.json"},
       [](const fs::path& d, const Results& results) {
         compare_results({results / "run 2", d});
       }},
      {"convert",
       "run 1",
       {"results.json", "data.csv", "sets.jsonl"},
       [](const fs::path& d, const Results& results) {
         results_to_mat(d, {results / "out.mat", true}, true);
       }},
      {"merge",
       "part 1",
       {"results.json", "run.json"},
       [](const fs::path& d, const Results& results) {
         merge_sweeps({d, results / "part 2"}, results / "whole");
       }}};
  return all;
}

/// Why a reader refuses a directory; "" if it does not.
std::string refusal(const Reader& reader, const fs::path& directory, const Results& results) {
  try {
    reader.read(directory, results);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("files that are not those of the run") {
  const Results results;
  for (const Reader& reader : readers()) {
    CAPTURE(reader.name);
    CHECK(refusal(reader, results / reader.of, results).empty());
    const std::string other = reader.of == "run 1" ? "run 2" : "part 2";
    for (const char* file : reader.files) {
      CAPTURE(file);
      const fs::path copy = results / "copy";
      const auto refused = [&](const std::function<void(const fs::path&)>& change) {
        fs::remove_all(copy);
        fs::copy(results / reader.of, copy);
        change(copy / file);
        const std::string text = refusal(reader, copy, results);
        CAPTURE(text);
        CHECK(holds(text, (copy / file).string() + ": 1 error"));
      };
      refused([&](const fs::path& at) {
        fs::copy(results / other / file, at, fs::copy_options::overwrite_existing);
      });
      refused([](const fs::path& at) { fs::resize_file(at, fs::file_size(at) - 1); });
      refused([](const fs::path& at) { fs::resize_file(at, 0); });
      refused([](const fs::path& at) { fs::remove(at); });
      refused([](const fs::path& at) {
        std::string bytes = bytes_of(at);
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
        std::ofstream(at, std::ios::binary) << bytes;
      });
    }
  }
}

TEST_CASE("files without an end, and files that cannot be read") {
  const Results results;
  for (const bool listed : {true, false}) {
    CAPTURE(listed);
    for (const Reader& reader : readers()) {
      CAPTURE(reader.name);
      for (const char* file : reader.files) {
        CAPTURE(file);
        const fs::path copy = results / "copy", at = copy / file;
        const auto refused = [&](const std::string& reason, const std::function<void()>& put) {
          fs::remove_all(copy);
          fs::copy(results / reader.of, copy);
          if (!listed) fs::remove(copy / "manifest.json");
          fs::remove(at);
          put();
          const std::string text = refusal(reader, copy, results);
          CAPTURE(text);
          CHECK(holds(text, at.string() + ": "));
          CHECK(holds(text, reason));
        };
        refused("is a pipe", [&] { REQUIRE(::mkfifo(at.c_str(), 0600) == 0); });
        refused("is a device", [&] { fs::create_symlink("/dev/zero", at); });
        refused("is a directory", [&] { fs::create_directory(at); });
        refused("cannot be read to its end", [&] { fs::create_symlink("/proc/self/mem", at); });
      }
    }
  }
}

TEST_CASE("figures are not written where a link leads") {
  const Results results;
  const fs::path run = results / "run 1", mine = results / "mine";
  fs::create_directory(mine);
  std::ofstream(mine / "table.csv") << "mine";
  fs::create_directory_symlink(mine, run / "figures");
  for (bool ReportOptions::*kind :
       {&ReportOptions::svg, &ReportOptions::pdf, &ReportOptions::csv}) {
    ReportOptions options;
    options.*kind = true;
    CHECK_THROWS_WITH_AS(write_report(run, options), doctest::Contains("is a symbolic link"),
                         InputError);
    CHECK(tree(mine).size() == 1);
  }
}

TEST_CASE("a line that never ends, and one that is cut off") {
  const Results results;
  const fs::path run = results / "run 1";
  fs::remove(run / "manifest.json");
  fs::remove(run / "report.html");
  const std::string sets = bytes_of(run / "sets.jsonl"), data = bytes_of(run / "data.csv");
  const auto put = [](const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  };
  for (const Reader& reader : readers()) {
    if (reader.of != "run 1" || std::string(reader.name) == "compare") continue;
    CAPTURE(reader.name);
    fs::resize_file(run / "sets.jsonl", std::uintmax_t{1} << 32);
    CHECK(holds(refusal(reader, run, results), "line is longer than"));
    put(run / "sets.jsonl", sets.substr(0, sets.size() - 1));
    CHECK(holds(refusal(reader, run, results), "ends in the middle of a line"));
    put(run / "sets.jsonl", sets);
  }
  put(run / "data.csv", data.substr(0, data.size() - 1));
  CHECK(holds(refusal(readers().front(), run, results), "ends in the middle of a line"));
  put(run / "data.csv", data.substr(0, data.find("\n4,") + 1));  // whole lines, but too few
  CHECK(holds(refusal(readers().front(), run, results), "data.csv"));
  put(run / "data.csv", data);
  CHECK(refusal(readers().front(), run, results).empty());
}

TEST_CASE("results of a long run, beyond the 64 MB that a text read as a whole may have") {
  const Results results;
  const fs::path run = results / "run 1", file = run / "results.json";
  fs::remove(run / "manifest.json");
  const std::string blanks(6'000'000, ' '), step = "{\"k\": ";
  std::string bytes = bytes_of(file);
  for (std::size_t at = bytes.find(step); at != std::string::npos;
       at = bytes.find(step, at + blanks.size()))
    bytes.insert(at + 1, blanks);
  REQUIRE(bytes.size() > json::max_bytes);
  std::ofstream(file, std::ios::binary) << bytes;
  for (const Reader& reader : readers()) {
    if (reader.of != "run 1") continue;
    CAPTURE(reader.name);
    CHECK(refusal(reader, run, results) == "");
  }
}
