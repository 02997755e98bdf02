// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/journal.hpp"

#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <set>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "experiments/sweep/sweep_files.hpp"
#include "run/scratch.hpp"
#include "study/text/fingerprint.hpp"
#include "sweep/sweeps.hpp"

using namespace cordon;
using detail::Journal;
using detail::JournalHead;
using detail::PointResult;
using Start = detail::Journal::Start;

namespace {

JournalHead head() {
  return {"fnv1a64:0123", "1.0", "tag", {"a 1", "b 2"}, {2, 3}, infinity, "then"};
}

PointResult point(std::int64_t index) {
  const auto i = static_cast<double>(index);
  PointResult result{
      index,
      {{{"steps", false}, i}, {{"wall_s", true}, i / 3}, {{"radius", false}, -infinity}},
      ""};
  if (index == 2) {
    result.error = "out of\n\"order\"";
    result.code = Errc::solver;
  }
  return result;
}

bool same(const PointResult& a, const PointResult& b) {
  const auto numbers = [](const PointResult& p) {
    std::map<std::pair<std::string, bool>, double> all;
    for (const ResultNumber& n : p.numbers) all[{n.column.name, n.column.measured}] = n.value;
    return all;
  };
  return a.index == b.index && a.error == b.error && a.code == b.code && numbers(a) == numbers(b);
}

/// Writes the points 0 … count - 1.
std::string write(const std::filesystem::path& out, std::int64_t count) {
  Journal journal(out, head(), Start::restart, {});
  for (std::int64_t i = 0; i < count; ++i) journal.add(line_of(point(i)));
  journal.sync();
  return bytes_of(out / ".sweep/journal");
}

std::vector<PointResult> read(const std::filesystem::path& out, const JournalHead& with = head()) {
  std::vector<PointResult> points;
  const Journal journal(out, with, Start::resume,
                        [&](PointResult p) { points.push_back(std::move(p)); });
  return points;
}

void put(const std::filesystem::path& out, const std::string& bytes) {
  std::ofstream(out / ".sweep/journal", std::ios::binary) << bytes;
}

/// Every byte near the end of a line, every seventh elsewhere: each costs a wait for the disk.
std::size_t stride(const std::string& text, std::size_t at) {
  return text.substr(at < 3 ? 0 : at - 3, 14).find('\n') == std::string::npos ? 7 : 1;
}

/// Why a journal of `head()` does not go on as one of `other`.
std::string refusal(const std::filesystem::path& out, const JournalHead& other) {
  try {
    read(out, other);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("what is no file is not read") {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / ".sweep");
  REQUIRE(::mkfifo((scratch / ".sweep/journal").c_str(), 0600) == 0);
  CHECK(refusal(scratch.path(), head()).find("is no regular file") != std::string::npos);
  REQUIRE(::mkfifo((scratch / ".sweep/journal.new").c_str(), 0600) == 0);
  {
    const Journal journal(scratch.path(), head(), Journal::Start::restart,
                          [](const PointResult&) {});
  }
  CHECK(std::filesystem::is_regular_file(scratch / ".sweep/journal"));
  REQUIRE(::mkfifo((scratch / "results.json").c_str(), 0600) == 0);
  CHECK_THROWS_WITH_AS(detail::read_sweep(scratch.path()),
                       doctest::Contains("is a pipe, not a regular file"), InputError);
}

TEST_CASE("a line gives back what was written") {
  CHECK(rc::check([] {
    PointResult p;
    p.index = *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 40);
    std::set<std::string> names;
    for (const auto& [name, value] :
         *rc::gen::arbitrary<std::vector<std::pair<std::string, double>>>()) {
      std::string ascii = name;
      std::erase_if(ascii, [](char c) { return static_cast<unsigned char>(c) > 126; });
      if (names.insert(ascii).second) p.numbers.push_back({{ascii, names.size() % 3 == 0}, value});
    }
    p.numbers.push_back({{"zero", false}, -0.0});
    p.numbers.push_back({{"tiny", false}, 5e-324});
    if (*rc::gen::arbitrary<bool>()) {
      p.error = "é\n\"\\";
      p.code = Errc::time_limit;
    }
    const auto back = detail::point_of(line_of(p));
    RC_ASSERT(back);
    RC_ASSERT(same(*back, p));
    const auto zero = std::find_if(back->numbers.begin(), back->numbers.end(),
                                   [](const auto& n) { return n.column.name == "zero"; });
    RC_ASSERT(std::signbit(zero->value));
  }));
}

TEST_CASE("NaN is left out") {
  PointResult p = point(1);
  p.numbers.push_back({{"nothing", false}, std::nan("")});
  CHECK(same(*detail::point_of(line_of(p)), point(1)));
}

TEST_CASE("texts that are no points") {
  for (const char* text : {"", "{}", "[]", "{\"point\": 1}", "{\"point\": 1, \"numbers\": {}}",
                           "{\"point\": -1, \"numbers\": {}, \"measured\": {}}",
                           "{\"point\": 1.5, \"numbers\": {}, \"measured\": {}}",
                           "{\"point\": 1, \"numbers\": [], \"measured\": {}}",
                           "{\"point\": 1, \"numbers\": {\"a\": true}, \"measured\": {}}",
                           "{\"point\": 1, \"numbers\": {\"a\": \"nan\"}, \"measured\": {}}",
                           "{\"point\": 1, \"numbers\": {}, \"measured\": {}, \"more\": 1}",
                           "{\"point\": 1, \"numbers\": {}, \"measured\": {}, \"error\": 1}"}) {
    CAPTURE(text);
    CHECK_FALSE(detail::point_of(text));
  }
}

TEST_CASE("what was written is read, and the first process stays known") {
  const Scratch scratch;
  write(scratch.path(), 5);
  JournalHead later = head();
  later.started = "now";
  std::vector<PointResult> points;
  {
    Journal journal(scratch.path(), later, Start::resume,
                    [&](PointResult p) { points.push_back(std::move(p)); });
    CHECK(journal.head().started == "then");
    journal.add(line_of(point(7)));
  }
  REQUIRE(points.size() == 5);
  for (std::int64_t i = 0; i < 5; ++i) CHECK(same(points[static_cast<std::size_t>(i)], point(i)));
  points = read(scratch.path(), later);
  REQUIRE(points.size() == 6);
  CHECK(same(points[5], point(7)));
}

TEST_CASE("a journal that is cut off anywhere loses its last point at most") {
  const Scratch scratch;
  const std::string whole = write(scratch.path(), 3);
  for (std::size_t length = 0; length < whole.size(); length += stride(whole, length)) {
    CAPTURE(length);
    const std::string cut = whole.substr(0, length);
    put(scratch.path(), cut);
    const auto ends = std::count(cut.begin(), cut.end(), '\n');
    if (ends == 0) {
      CHECK_THROWS_WITH_AS(read(scratch.path()), doctest::Contains("is damaged"), InputError);
      CHECK(bytes_of(scratch / ".sweep/journal") == cut);  // nothing was thrown away
      continue;
    }
    const auto points = read(scratch.path());
    REQUIRE(points.size() == static_cast<std::size_t>(ends) - 1);
    for (std::size_t i = 0; i < points.size(); ++i)
      CHECK(same(points[i], point(static_cast<std::int64_t>(i))));
    CHECK(whole.starts_with(bytes_of(scratch / ".sweep/journal")));
  }
}

TEST_CASE("a byte that is damaged costs the points of its line at most, and never changes one") {
  const Scratch scratch;
  const std::string whole = write(scratch.path(), 4);
  const std::size_t first = whole.find('\n');
  for (std::size_t i = 0; i < whole.size(); i += stride(whole, i)) {
    CAPTURE(i);
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    put(scratch.path(), damaged);
    if (i <= first) {
      CHECK_THROWS_WITH_AS(read(scratch.path()), doctest::Contains("is damaged"), InputError);
      continue;
    }
    const auto points = read(scratch.path());
    CHECK(points.size() == (whole[i] == '\n' && i + 1 < whole.size()
                                ? 2
                                : 3));  // the end of a line belongs to two of them
    for (const PointResult& p : points) CHECK(same(p, point(p.index)));
  }
}

TEST_CASE("any damage leaves points that are right") {
  const Scratch scratch;
  const std::string whole = write(scratch.path(), 4);
  CHECK(rc::check([&] {
    std::string damaged = whole;
    const auto changes = *rc::gen::inRange(1, 5);
    for (int i = 0; i < changes; ++i) {
      const auto at = *rc::gen::inRange<std::size_t>(whole.find('\n') + 1, damaged.size());
      const auto bytes = *rc::gen::container<std::string>(rc::gen::arbitrary<char>());
      damaged.replace(at, *rc::gen::inRange<std::size_t>(0, 40), bytes);
    }
    put(scratch.path(), damaged);
    for (const PointResult& p : read(scratch.path())) RC_ASSERT(same(p, point(p.index)));
  }));
}

TEST_CASE("what belongs to another sweep is refused, with the reason and the suggestion") {
  const Scratch scratch;
  write(scratch.path(), 2);
  const auto other = [](auto change) {
    JournalHead h = head();
    change(h);
    return h;
  };
  const auto check = [&](auto change, const char* reason, const char* suggestion) {
    const std::string text = refusal(scratch.path(), other(change));
    CAPTURE(text);
    CHECK(text.find(reason) != std::string::npos);
    CHECK(text.find(suggestion) != std::string::npos);
  };
  check([](JournalHead& h) { h.study_hash = "x"; }, "of another study", "--restart");
  check([](JournalHead& h) { h.version = "2.0"; }, "another build of this program (version 1.0)",
        "--restart");
  check([](JournalHead& h) { h.abi_tag = "x"; }, "another build", "--restart");
  check([](JournalHead& h) { h.plugins.pop_back(); }, "other plugins", "--restart");
  check(
      [](JournalHead& h) {
        h.shard = {1, 3};
      },
      "part 2 of 3, and part 1 of 3 was asked for", "--out");
  check([](JournalHead& h) { h.shard = {2, 4}; }, "part 2 of 4 was asked for", "--out");
  check([](JournalHead& h) { h.shard = {}; }, "all points was asked for", "--out");
  check([](JournalHead& h) { h.limit_s = 2; }, "no limit per point, now there is a limit of 2 s",
        "same limit");
  CHECK(refusal(scratch.path(), head()).empty());
}

TEST_CASE("an unfinished sweep is not begun again by accident") {
  const Scratch scratch;
  write(scratch.path(), 2);
  CHECK_THROWS_WITH_AS(Journal(scratch.path(), head(), Start::fresh, {}),
                       doctest::Contains("\"--resume\" goes on with it"), InputError);
  CHECK(read(scratch.path()).size() == 2);
  JournalHead other = head();
  other.study_hash = "x";
  { const Journal journal(scratch.path(), other, Start::restart, {}); }
  CHECK(read(scratch.path(), other).empty());
}

TEST_CASE("two processes do not write one journal") {
  const Scratch scratch;
  for (const Start start : {Start::fresh, Start::resume, Start::restart}) {
    const Journal journal(scratch.path(), head(), Start::restart, {});
    CHECK_THROWS_WITH_AS(Journal(scratch.path(), head(), start, {}),
                         doctest::Contains("is writing results into this directory"), InputError);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      int code = 1;
      try {
        const Journal second(scratch.path(), head(), start, {});
      } catch (const InputError&) {
        code = 0;
      }
      ::_exit(code);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(status == 0);
  }
  CHECK(read(scratch.path()).empty());  // free again
}

TEST_CASE("a line that was torn by a full disk stays the last one") {
  const Scratch scratch;
  struct rlimit before, small;
  ::getrlimit(RLIMIT_FSIZE, &before);
  small = before;
  small.rlim_cur = 1000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  std::int64_t written = 0;
  std::string reason;
  {
    Journal journal(scratch.path(), head(), Start::fresh, {});
    ::setrlimit(RLIMIT_FSIZE, &small);
    try {
      for (;; ++written) journal.add(line_of(point(written)));
    } catch (const Error& error) {
      CHECK(error.code() == Errc::io);
      reason = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    // other jobs, whose error may be the one that is shown, tell the same
    CHECK_THROWS_WITH_AS(journal.add(line_of(point(99))), reason.c_str(), Error);
  }
  std::signal(SIGXFSZ, old_handler);
  CHECK(written > 0);
  CHECK(std::filesystem::file_size(scratch / ".sweep/journal") == 1000);
  CHECK(read(scratch.path()).size() == static_cast<std::size_t>(written));
}

TEST_CASE("removed, it leaves nothing; where it cannot be, it says so") {
  const Scratch scratch;
  Journal(scratch / "new/out", head(), Start::fresh, {}).remove();
  CHECK(tree(scratch / "new/out").empty());
  CHECK_FALSE(Journal::is_in(scratch / "new/out"));
  std::ofstream(scratch / "file") << "mine";
  CHECK_THROWS_WITH_AS(Journal(scratch / "file", head(), Start::fresh, {}),
                       doctest::Contains("it is a file; name a directory"), Error);
}

TEST_CASE("no symbolic link is followed") {
  const Scratch scratch;
  for (const char* name : {"journal", "journal.new"}) std::ofstream(scratch / name) << "mine";
  const auto before = tree(scratch.path());
  const std::filesystem::path out = scratch / "out";
  const auto unharmed = [&] {
    for (const auto& [name, bytes] : before) CHECK(bytes_of(scratch / name) == bytes);
  };
  std::filesystem::create_directories(out);
  std::filesystem::create_directory_symlink(scratch.path(), out / ".sweep");
  for (const Start start : {Start::restart, Start::resume, Start::fresh}) {
    CHECK_THROWS_AS(Journal(out, head(), start, {}), InputError);
    unharmed();
  }
  std::filesystem::remove(out / ".sweep");
  std::filesystem::create_directory(out / ".sweep");
  for (const char* name : {"journal", "journal.new"})
    std::filesystem::create_symlink(scratch / name, out / ".sweep" / name);
  CHECK_THROWS_WITH_AS(Journal(out, head(), Start::resume, {}),
                       doctest::Contains("is no regular file"), InputError);
  CHECK_THROWS_AS(Journal(out, head(), Start::fresh, {}), InputError);
  { const Journal journal(out, head(), Start::restart, {}); }  // the links are replaced
  unharmed();
  CHECK_FALSE(std::filesystem::is_symlink(out / ".sweep/journal"));
}

TEST_CASE("points of no sweep, of another part, or that come twice change nothing") {
  const Scratch scratch;
  const Study study = sweeps::study({fakes::pipeline("a"), fakes::pipeline("b")});
  SweepOptions options = sweeps::into(scratch / "whole");
  options.shard = {1, 2};
  sweeps::run(study, options);
  options.out = scratch / "out";
  std::atomic<bool> stop = true;
  options.stop = &stop;
  REQUIRE(sweeps::run(study, options).interrupted);
  {
    std::ofstream journal(scratch / "out/.sweep/journal", std::ios::app);
    for (const std::int64_t index : {1, 12, 1'000'000}) {  // of part 2, and beyond the grid
      const std::string line = line_of(point(index));
      journal << detail::fnv1a64(line) << ' ' << line << '\n';
    }
  }
  stop = false;
  options.resume = true;
  const SweepOutcome outcome = sweeps::run(study, options);
  CHECK(outcome.progress.resumed == 0);
  CHECK(sweeps::reproducible(scratch / "out") == sweeps::reproducible(scratch / "whole"));
}
