// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the bytes of a file are, it is accepted, or refused by an error that says why: no crash,
// no other exception, no reading without end, no memory beyond a limit. Every kind of file that is
// read is made CORDON_CAMPAIGN_FILES times (default 150) from valid examples, with the seed
// CORDON_CAMPAIGN_SEED (default 1).
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <optional>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <doctest/doctest.h>

#include "campaigns/files/mutate.hpp"
#include "cordon/experiments/compare.hpp"
#include "cordon/experiments/interchange.hpp"
#include "cordon/experiments/report.hpp"
#include "cordon/experiments/sweep.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/run.hpp"
#include "cordon/study/verify.hpp"
#include "experiments/sweep/journal.hpp"
#include "run/scratch.hpp"
#include "study/text/manifest.hpp"

using namespace cordon;

namespace fs = std::filesystem;

namespace {

std::size_t from_environment(const char* name, std::size_t fallback) {
  const char* const text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : fallback;
}

char last_file[4096] = "";  ///< for the handler of a signal

[[noreturn]] void took_too_long(int) {
  const char text[] = "\nthis took longer than 60 s of processor time: ";
  [[maybe_unused]] ssize_t written = ::write(STDERR_FILENO, text, sizeof(text) - 1);
  written = ::write(STDERR_FILENO, last_file, std::strlen(last_file));
  ::_exit(1);
}

/// Limits of this process, and of each file.
class Limits {
 public:
  Limits() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const rlimit memory{rlim_t{3} << 30, rlim_t{3} << 30};
    ::setrlimit(RLIMIT_DATA, &memory);
#endif
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    std::signal(SIGVTALRM, took_too_long);
  }
  static void begin(const fs::path& file) {
    std::strncpy(last_file, file.c_str(), sizeof(last_file) - 1);
    const itimerval limit{{0, 0}, {60, 0}};
    ::setitimer(ITIMER_VIRTUAL, &limit, nullptr);
  }
};

/// Makes files from the examples, writes each to `file` and hands it to `read`. How many broke the
/// rule; these are kept beside the temporary directory, and named. Some have to be refused: else
/// nothing was tried.
std::size_t broken_files(const char* kind, const std::vector<std::string>& examples,
                         const fs::path& file, const std::function<void()>& read) {
  static const Limits limits;
  const std::size_t count = from_environment("CORDON_CAMPAIGN_FILES", 150),
                    seed = from_environment("CORDON_CAMPAIGN_SEED", 1);
  std::size_t accepted = 0, refused = 0, broke = 0;
  double slowest = 0;
  for (const std::string& example : examples) {
    fs::remove_all(file);
    std::ofstream(file, std::ios::binary) << example;
    REQUIRE_NOTHROW(read());
  }
  for (std::size_t i = 0; i < count; ++i) {
    campaign::Random random(seed * 1'000'003 + i);
    const std::string bytes = campaign::mutated(random, examples[i % examples.size()]);
    fs::remove_all(file);
    std::ofstream(file, std::ios::binary) << bytes;
    Limits::begin(file);
    const auto begin = std::chrono::steady_clock::now();
    std::string broken;
    try {
      read();
      ++accepted;
    } catch (const InputError& error) {
      ++refused;
      if (error.diagnostics().empty() || error.file().empty())
        broken = "an error without place and reason";
      for (const Diagnostic& one : error.diagnostics()) {
        if (one.message.empty()) broken = "an error without a reason";
      }
    } catch (const Error& error) {
      ++refused;
      if (error.code() == Errc::internal || *error.what() == '\0')
        broken = std::string("not an error of the input: ") + error.what();
    } catch (const std::exception& error) {
      broken = std::string("another exception: ") + error.what();
    } catch (...) {
      broken = "an exception of unknown type";
    }
    slowest = std::max(
        slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (broken.empty()) continue;
    ++broke;
    const fs::path kept = fs::temp_directory_path() /
                          (std::string("cordon-campaign-") + kind + "-" + std::to_string(i));
    std::ofstream(kept, std::ios::binary) << bytes;
    FAIL_CHECK(kind << " " << i << " (" << kept.string() << "): " << broken);
  }
  std::cout << kind << ": " << accepted << " accepted, " << refused << " refused, slowest "
            << slowest << " s" << std::endl;
  CHECK(refused > 0);
  return broke;
}

void load(Registry& registry) {
  registry.load({{fs::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
}

/// Small studies: with data, modes, designers, a sweep.
std::vector<std::string> studies() {
  const std::string system = R"("system": {
    "type": "lti", "A": [[0, -0.5], [1, 1]], "B": [[1], [0]], "Bw": [[-0.12], [0.02]], "C": [[-2, 1]], "Dv": [[0.2]],
    "X0": {"type": "box", "lower": [-3, -3], "upper": [3, 3]},
    "W": {"type": "box", "lower": [-1], "upper": [1]}, "V": {"type": "zonotope", "center": [0], "generators": [[1]]})";
  const std::string pipelines = R"("pipelines": [
    {"name": "Zonotope", "backend": {"type": "zonotope"}, "observer": {"type": "prediction_correction", "max_generators": 8}},
    {"name": "Interval", "backend": "interval", "observer": "prediction_correction"}])";
  const std::string data =
      R"("data": {"simulate": {"steps": 6, "seed": 3, "x0": [1, -1], "input": [{"type": "constant", "offset": 1}]}})";
  std::vector<std::string> all;
  all.push_back("{\n  \"cordon\": 1, \"title\": \"plain\",\n  " + system + "},\n  " + data +
                ",\n  " + pipelines +
                ",\n  \"metrics\": [\"radius\", \"volume\", \"contains_truth\"]\n}\n");
  all.push_back(
      "{\n  \"cordon\": 1, \"title\": \"sweep\",\n  " + system + "},\n  " + data + ",\n  " +
      pipelines +
      ",\n  \"sweep\": [{\"name\": \"seed\", \"path\": \"/data/simulate/seed\", \"range\": [1, 2]},"
      " {\"name\": \"w\", \"path\": \"/system/W/upper/0\", \"values\": [0.5, 1]}]\n}\n");
  all.push_back("{\n  \"cordon\": 1, \"title\": \"csv\",\n  " + system +
                "},\n  \"data\": {\"csv\": {\"file\": \"data.csv\", \"inputs\": [\"u\"], "
                "\"outputs\": [\"y\"]}},\n  " +
                pipelines + "\n}\n");
  for (const char* name :
       {"descriptor_four_representations", "cstr_actuator_faults", "interval_observers_monotone",
        "active_diagnosis_unbounded", "compare_representations"}) {
    all.push_back(
        bytes_of(fs::path(CORDON_SOURCE_DIR) / "examples/studies" / (std::string(name) + ".json")));
  }
  return all;
}

const std::string table = "k,u,y\n0,1,0.25\n1,1,-0.5\n2,0.5,1e-3\n3,\"1\",2\n";

/// Runs and sweeps that the campaigns on results begin with.
class Finished {
 public:
  Finished() {
    load(registry_);
    RunOptions options;
    options.out = scratch_ / "run";
    run_study(read(0), registry_, options);
    for (const int part : {1, 2}) {
      SweepOptions sweep;
      sweep.out = scratch_ / ("part " + std::to_string(part));
      sweep.shard = {part, 2};
      run_sweep(read(1), registry_, sweep);
    }
  }
  fs::path operator/(const std::string& name) const { return scratch_ / name; }

  /// A copy in which files are exchanged one after another.
  fs::path copy(const std::string& of, bool listed) const {
    const fs::path made = scratch_ / ("copy of " + of);
    fs::remove_all(made);
    fs::copy(scratch_ / of, made);
    if (!listed) fs::remove(made / "manifest.json");
    return made;
  }

 private:
  Study read(std::size_t which) {
    return read_study(scratch_.write("study.json", studies()[which]), registry_, {});
  }

  Scratch scratch_;
  Registry registry_;
};

Finished& finished() {
  static Finished all;
  return all;
}

/// Files of results, each with what reads it; the others stay as they are.
std::size_t broken_results(const char* kind, const std::string& of,
                           const std::vector<const char*>& names,
                           const std::function<void(const fs::path&)>& read) {
  std::size_t broke = 0;
  for (const char* name : names) {
    const fs::path directory = finished().copy(of, false);
    broke += broken_files((std::string(kind) + "-" + name).c_str(), {bytes_of(directory / name)},
                          directory / name, [&] { read(directory); });
  }
  return broke;
}

}  // namespace

TEST_CASE("studies") {
  const Scratch scratch;
  scratch.write("data.csv", table);
  Registry registry;
  load(registry);
  CHECK(broken_files("study", studies(), scratch / "study.json", [&] {
          const Study study = read_study(scratch / "study.json", registry, {});
          if (study.sweep.empty()) return;
          std::vector<std::size_t> last;
          for (const SweepAxis& axis : study.sweep) last.push_back(axis.values.size() - 1);
          study_at(study, last, registry);
        }) == 0);
}

TEST_CASE("tables of recorded data") {
  const Scratch scratch;
  Registry registry;
  load(registry);
  scratch.write("data.csv", table);
  const Study study = read_study(scratch.write("study.json", studies()[2]), registry, {});
  const std::vector<std::string> examples{table, "\xEF\xBB\xBF" + table,
                                          "k,\"u\",y,z\r\n0,1,2,\"a,\"\"b\"\r\n1,2,3,4\r\n"};
  CHECK(broken_files("csv", examples, scratch / "data.csv", [&] {
          const auto data = open_data(study);
          while (data->next()) {
          }
        }) == 0);
}

TEST_CASE("MAT-files") {
  const Scratch scratch;
  Registry registry;
  load(registry);
  study_to_mat(read_study(scratch.write("study.json", studies()[0]), registry, {}),
               {scratch / "study.mat", true});
  results_to_mat(finished() / "run", {scratch / "run.mat", true}, true);
  const std::vector<std::string> examples{bytes_of(scratch / "study.mat"),
                                          bytes_of(scratch / "run.mat")};
  CHECK(broken_files("mat", examples, scratch / "in.mat", [&] {
          mat_to_json(scratch / "in.mat", {scratch / "out.json", true});
        }) == 0);
}

TEST_CASE("results that are verified") {
  CHECK(broken_results("verify", "run", {"results.json", "sets.jsonl", "data.csv"},
                       [](const fs::path& d) {
                         VerifyOptions options;
                         options.directions = 2;
                         verify_run(d, options);
                       }) == 0);
}

TEST_CASE("results that are drawn") {
  CHECK(broken_results("report", "run",
                       {"results.json", "run.json", "steps.csv", "data.csv", "sets.jsonl"},
                       [](const fs::path& d) { write_report(d); }) == 0);
  CHECK(broken_results("report-sweep", "part 1", {"results.json", "run.json"},
                       [](const fs::path& d) { write_report(d); }) == 0);
}

TEST_CASE("results that are compared, converted and merged") {
  CHECK(broken_results("compare", "run", {"results.json", "run.json"}, [](const fs::path& d) {
          compare_results({finished() / "run", d});
        }) == 0);
  const Scratch scratch;
  CHECK(broken_results("convert", "run", {"results.json", "sets.jsonl", "data.csv"},
                       [&](const fs::path& d) {
                         results_to_mat(d, {scratch / "out.mat", true}, true);
                       }) == 0);
  CHECK(broken_results("merge", "part 1", {"results.json", "run.json"}, [&](const fs::path& d) {
          merge_sweeps({d, finished() / "part 2"}, scratch / "whole");
        }) == 0);
}

TEST_CASE("manifests") {
  const fs::path directory = finished().copy("run", true);
  const std::string whole = bytes_of(directory / "manifest.json");
  CHECK(broken_files("manifest", {whole}, directory / "manifest.json", [&] {
          const detail::RecordedFiles files(directory);
          for (const char* name : {"results.json", "sets.jsonl", "data.csv"}) files.file(name);
        }) == 0);
}

TEST_CASE("files that were changed are refused wherever there is a manifest") {
  for (const char* name : {"results.json", "sets.jsonl", "data.csv"}) {
    const fs::path directory = finished().copy("run", true);
    const std::string whole = bytes_of(directory / name);
    CHECK(broken_files((std::string("listed-") + name).c_str(), {whole}, directory / name, [&] {
            const bool same = bytes_of(directory / name) == whole;
            try {
              verify_run(directory);
            } catch (const InputError&) {
              if (same) throw Error(Errc::internal, "an unchanged file was refused");
              throw;
            }
            if (!same) throw Error(Errc::internal, "a changed file was taken");
          }) == 0);
  }
}

TEST_CASE("journals") {
  const Scratch scratch;
  const detail::JournalHead head{"fnv1a64:0123", "1.0", "tag", {"a 1", "b 2"}, {1, 1}, 2.5, "then"};
  {
    detail::Journal journal(scratch.path(), head, detail::Journal::Start::fresh, {});
    for (std::int64_t i = 0; i < 5; ++i) {
      journal.add(detail::line_of(
          {i, {{{"steps", false}, 3.0}, {{"wall_s", true}, 0.1 * static_cast<double>(i)}}, ""}));
    }
    journal.sync();
  }
  const fs::path file = scratch / ".sweep/journal";
  const std::string whole = bytes_of(file);
  CHECK(broken_files("journal", {whole}, file, [&] {
          const detail::Journal journal(
              scratch.path(), head, detail::Journal::Start::resume,
              [](const detail::PointResult& point) {
                const bool right = point.index >= 0 && point.index < 5 &&
                                   point.numbers.size() == 2 && point.error.empty();
                if (!right) throw Error(Errc::internal, "a point that nobody wrote");
              });
        }) == 0);
}
