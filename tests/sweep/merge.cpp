// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that do not make a sweep, and files that are not as they were written.
#include <fstream>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "sweep/sweeps.hpp"

using sweeps::into;
using namespace cordon;
namespace fs = std::filesystem;

namespace {

Study small(int seeds = 2) {
  return sweeps::study({fakes::pipeline("a"), fakes::pipeline("b", "breaking")}, seeds);
}

fs::path part(const Scratch& scratch, const std::string& name, const Study& study, Shard shard) {
  SweepOptions options = into(scratch / name);
  options.shard = shard;
  sweeps::run(study, options);
  return options.out;
}

std::string refusal(const std::vector<fs::path>& parts, const fs::path& out) {
  try {
    merge_sweeps(parts, out);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Without the manifest, which knows other bytes.
void put(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  fs::remove(file.parent_path() / "manifest.json");
}

std::string exchanged(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("parts that do not belong together are refused, and nothing is written") {
  const Scratch scratch;
  const Study study = small();
  const fs::path one = part(scratch, "one", study, {1, 3}),
                 two = part(scratch, "two", study, {2, 3}),
                 three = part(scratch, "three", study, {3, 3}),
                 other = part(scratch, "other", small(3), {3, 3}),
                 of_two = part(scratch, "of two", study, {2, 2}),
                 whole = part(scratch, "whole", study, {});
  const auto refused = [&](const std::vector<fs::path>& parts, const std::string& reason) {
    const std::string text = refusal(parts, scratch / "out");
    CAPTURE(text);
    CHECK(text.find(reason) != std::string::npos);
    CHECK_FALSE(fs::exists(scratch / "out"));
  };
  refused({}, "no parts");
  refused({one}, "of 3 parts these are missing: 2, 3");
  refused({three, one}, "these are missing: 2");
  refused({one, two, two, three}, "is part 2, which came before");
  refused({one, two, other}, "is of another study");
  refused({one, of_two}, "is a part of 2");
  refused({one, whole}, "holds a whole sweep");
  refused({whole, one}, "holds a whole sweep");
  refused({one, scratch / "absent"}, "there is no such file");
  CHECK(refusal({one, two, three}, two).find("is one of the parts") != std::string::npos);
  const std::string results = bytes_of(three / "results.json");
  put(three / "results.json", exchanged(results, "\"version\": \"", "\"version\": \"9"));
  refused({one, two, three}, "another build");
  put(three / "results.json", exchanged(results, "\"abi_tag\": \"", "\"abi_tag\": \"9"));
  refused({one, two, three}, "another build");
  put(three / "results.json", exchanged(results, "\"plugins\": [", "\"plugins\": [1"));
  refused({one, two, three}, "other plugins or libraries");
  put(three / "results.json", results);
  put(three / "results.json",
      exchanged(results, "\"point_limit_s\": null", "\"point_limit_s\": 2"));
  refused({one, two, three}, "another time limit per point");
  put(three / "results.json", results);
  const SweepOutcome merged = merge_sweeps({three, one, two}, scratch / "out");
  CHECK(merged.progress.done == 8);
  CHECK(merged.first_error == Errc::unsupported);
  CHECK(sweeps::reproducible(scratch / "out") == sweeps::reproducible(whole));
}

TEST_CASE("a sweep in one part is whole, and merged as such") {
  const Scratch scratch;
  const fs::path whole = part(scratch, "whole", small(), {1, 1});
  CHECK(merge_sweeps({whole}, scratch / "out").progress.done == 8);
  CHECK(sweeps::reproducible(scratch / "out") == sweeps::reproducible(whole));
}

TEST_CASE("the time of a step is known to sweeps and to what is merged, where no axis changes it") {
  const Scratch scratch;
  const auto merged_time = [&](const std::string& name, Study study) {
    study.labels.sampling_time = 0.5;
    nlohmann::ordered_json resolved = nlohmann::ordered_json::parse(study.resolved);
    resolved["system"]["sampling_time"] = 0.5;
    study.resolved = resolved.dump(2);
    const double whole = sweeps::run(study, into(scratch / (name + " whole"))).table.sampling_time;
    const fs::path part_of_one = part(scratch, name, study, {1, 1});
    const double merged =
        merge_sweeps({part_of_one}, scratch / (name + " out")).table.sampling_time;
    CHECK(merged == whole);
    CHECK(read_result_table(scratch / (name + " out")).sampling_time == whole);
    return merged;
  };
  CHECK(merged_time("fixed", small()) == 0.5);
  const std::string path = "/data/simulate/noise";
  Study swept = small();
  swept.sweep[0].path = "/system/sampling_time";
  swept.resolved.replace(swept.resolved.find(path), path.size(), swept.sweep[0].path);
  CHECK(merged_time("swept", swept) == 0);
}

TEST_CASE("an unfinished part is not merged, and no unfinished sweep is written over") {
  const Scratch scratch;
  const Study study = small();
  const fs::path one = part(scratch, "one", study, {1, 2}),
                 two = part(scratch, "two", study, {2, 2});
  const std::atomic<bool> stop = true;
  SweepOptions options = into(scratch / "three");
  options.stop = &stop;
  REQUIRE(sweeps::run(study, options).interrupted);
  CHECK(refusal({one, two, options.out}, scratch / "out").find("unfinished part") !=
        std::string::npos);
  CHECK(refusal({one, two}, options.out).find("holds an unfinished sweep") != std::string::npos);
}

TEST_CASE("points have to be those of the part") {
  const Scratch scratch;
  const Study study = small();
  const fs::path one = part(scratch, "one", study, {1, 2}),
                 two = part(scratch, "two", study, {2, 2});
  const std::string results = bytes_of(two / "results.json"), run = bytes_of(two / "run.json");
  const auto refused = [&](const std::string& reason) {
    const std::string text = refusal({one, two}, scratch / "out");
    CAPTURE(text);
    CHECK(text.find(reason) != std::string::npos);
  };
  const auto changed = [&](const std::string& from, const std::string& to,
                           const std::string& reason) {
    CAPTURE(from);
    put(two / "results.json", exchanged(results, from, to));
    refused(reason);
  };
  changed("\"point\": 1, ", "\"point\": 99, ", "this line is no point");
  changed("\"point\": 1, ", "\"point\": 2, ",
          "this line is no point");  // where it is said to be does not fit
  changed("\"point\": 1, \"pipeline\": 1", "\"point\": 0, \"pipeline\": 0",
          "point 0 does not belong here");
  changed("\"at\": [0, 0]", "\"at\": [0]", "this line is no point");
  changed("\"at\": [0, 0]", "\"at\": [0, 1]", "this line is no point");
  changed("\"of\": 2", "\"of\": 1", "a shard that is none");
  changed("\"of\": 2", "\"of\": 1000000", "a shard that is none");
  changed("\"error\": null", "\"error\": 1", "this line is no point");
  changed("\"error\": null", "\"error\": \"why?\"", "this line is no point");  // without a code
  changed("\"error\": null", "\"error\": null, \"error_code\": \"io\"", "this line is no point");
  changed("\"error_code\": \"unsupported\"", "\"error_code\": \"bad\"", "this line is no point");
  changed("\"error_code\": \"unsupported\"", "\"error_code\": 1", "this line is no point");
  changed("\"point_limit_s\": null", "\"point_limit_s\": \"x\"", "must be a number");
  changed("\n  ]\n}\n", "", "ends in the middle");
  changed("\"cordon_results\": 1", "\"cordon_results\": []", "cordon_results");
  changed("\"points\": [", "\"point\": [", "has no points");
  const std::size_t begin = results.find("    {\"point\""), end = results.find('\n', begin) + 1;
  put(two / "results.json", results.substr(0, begin) + results.substr(end));
  refused("is missing");
  put(two / "results.json", results.substr(0, end) + results.substr(begin));
  refused("this line is no point");  // it comes twice
  put(two / "results.json", results);
  put(two / "run.json", exchanged(run, "\"point\": 1, ", "\"point\": 0, "));
  refused("this line is no point");
  put(two / "run.json", exchanged(run, "\n  \"wall_s\"", "\n  \"wall\""));
  refused("wall_s");
  put(two / "run.json", exchanged(run, "\n  \"wall_s\": ", "\n  \"wall_s\": \"x\", \"y\": "));
  refused("must be a number");
  put(two / "run.json", run);
  CHECK(refusal({one, two}, scratch / "out").empty());
}

TEST_CASE("files with any bytes are read or refused") {
  const Scratch scratch;
  const Study study = small(1);
  const fs::path one = part(scratch, "one", study, {1, 2}),
                 two = part(scratch, "two", study, {2, 2});
  for (const char* name : {"results.json", "run.json"}) {
    const std::string whole = bytes_of(two / name);
    CHECK(rc::check([&] {
      std::string damaged = whole;
      const auto changes = *rc::gen::inRange(1, 4);
      for (int i = 0; i < changes; ++i) {
        const auto at = *rc::gen::inRange<std::size_t>(0, damaged.size());
        damaged.replace(at, *rc::gen::inRange<std::size_t>(0, 30),
                        *rc::gen::container<std::string>(rc::gen::arbitrary<char>()));
      }
      put(two / name, damaged);
      try {
        merge_sweeps({one, two}, scratch / "out");
      } catch (const Error&) {
      }
    }));
    put(two / name, whole);
  }
}
