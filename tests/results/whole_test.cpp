// SPDX-License-Identifier: GPL-3.0-or-later
// A directory holds the earlier results or the new ones, whatever their writer dies of.
#include <csignal>
#include <sys/wait.h>
#include <unistd.h>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "run/scratch.hpp"
#include "study/text/atomic_directory.hpp"

using namespace cordon;
using detail::AtomicDirectory;
using detail::DirectoryLock;
using detail::RecordedFiles;
using detail::Rename;

namespace fs = std::filesystem;

namespace {

using Names = std::vector<std::string>;
using Contents = std::map<std::string, std::string>;

const Names old_names{"data.csv", "sets.jsonl", "diagnosis.csv", "results.json"},
    new_names{"data.csv", "sets.jsonl", "steps.csv", "run.json", "results.json"};

/// What a generation writes into a file.
std::string content(const std::string& name, const std::string& generation) {
  const std::string head = name == "results.json" ? "{\n  \"cordon_results\": 1,\n" : "";
  return head + name + " of the " + generation + " run\n";
}

Contents contents(const Names& names, const std::string& generation) {
  Contents all{{"notes.txt", "mine"}};
  for (const std::string& name : names) all[name] = content(name, generation);
  return all;
}

void write(const fs::path& out, const Names& names, const std::string& generation,
           Rename rename = detail::rename_file) {
  const DirectoryLock lock(out);
  AtomicDirectory directory(lock, std::move(rename));
  for (const std::string& name : names) directory.create(name).write(content(name, generation));
  directory.commit();
}

/// Renames until the call number `count`, from 0, before which the process kills itself.
Rename killed_at(int count) {
  return [count, calls = 0](const char* from, const char* to) mutable {
    if (calls++ == count) ::raise(SIGKILL);
    return detail::rename_file(from, to);
  };
}

/// In a process of its own; was it killed?
template <class Work>
bool is_killed(Work&& work) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    int code = 1;
    try {
      work();
      code = 0;
    } catch (...) {
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
  return WIFSIGNALED(status);
}

/// What a reader finds: all files that belong to the results, and the user's own.
Contents found(const fs::path& out) {
  const RecordedFiles files(out);
  Contents all = tree(out);
  all.erase(".cordon-lock");  // of a dead process: it holds nothing
  for (const auto& [name, bytes] : all) {
    if (name != "notes.txt" && name != "manifest.json") CHECK(bytes_of(files.file(name)) == bytes);
  }
  files.check_unchanged();
  CHECK(all.erase("manifest.json") == 1);
  return all;
}

}  // namespace

TEST_CASE(
    "killed before any rename, a directory holds the old or the new results and nothing is lost") {
  const Contents old_ones = contents(old_names, "old"), new_ones = contents(new_names, "new");
  int kills = 0, of_old = 0, of_new = 0;
  for (bool goes_on = true; goes_on; ++kills) {
    CAPTURE(kills);
    const Scratch scratch;
    const fs::path out = scratch / "out";
    write(out, old_names, "old");
    std::ofstream(out / "notes.txt") << "mine";
    goes_on = is_killed([&] { write(out, new_names, "new", killed_at(kills)); });
    if (!goes_on) break;
    fs::copy(out, scratch / "read", fs::copy_options::recursive);
    { const DirectoryLock next_writer(out); }
    { const AtomicDirectory next_writer(out); }  // leftovers of the first one go
    const Contents now = found(out);
    CHECK((now == old_ones || now == new_ones));
    (now == old_ones ? of_old : of_new) += 1;
    const Contents read = [&] {
      const RecordedFiles files(scratch / "read");  // a reader does the same
      return bytes_of(files.file("results.json")) == content("results.json", "new") ? new_ones
                                                                                    : old_ones;
    }();
    CHECK(read == now);
  }
  CHECK(of_old == 1);  // before the first rename, which makes the new ones the results
  CHECK(of_new == static_cast<int>(new_names.size()) + 1);
}

TEST_CASE("what finishes the results of a dead process can be killed as well") {
  const Contents new_ones = contents(new_names, "new");
  for (int first = 1; first <= static_cast<int>(new_names.size()) + 1; ++first) {
    for (int second = 0; second < static_cast<int>(new_names.size()) + 1; ++second) {
      CAPTURE(first);
      CAPTURE(second);
      const Scratch scratch;
      const fs::path out = scratch / "out";
      write(out, old_names, "old");
      std::ofstream(out / "notes.txt") << "mine";
      REQUIRE(is_killed([&] { write(out, new_names, "new", killed_at(first)); }));
      is_killed([&] { detail::publish(out, killed_at(second)); });
      CHECK(found(out) == new_ones);
      CHECK_FALSE(fs::exists(out / ".committed"));
    }
  }
}

TEST_CASE("a reader that is overtaken by new results says so") {
  const Scratch scratch;
  write(scratch.path(), old_names, "old");
  {
    const RecordedFiles files(scratch.path());
    CHECK(bytes_of(files.file("data.csv")) == content("data.csv", "old"));
    write(scratch.path(), new_names, "new");
    CHECK_THROWS_WITH_AS(files.file("sets.jsonl"),
                         doctest::Contains("is not the file that manifest.json lists"), InputError);
    CHECK_THROWS_WITH_AS(files.check_unchanged(),
                         doctest::Contains("was given other results while it was read"),
                         InputError);
  }
  fs::remove(scratch / "manifest.json");
  const RecordedFiles files(scratch.path());
  files.check_unchanged();
  write(scratch.path(), new_names, "newer");
  CHECK_THROWS_AS(files.check_unchanged(), InputError);
}

TEST_CASE("a mix of two runs is refused, whichever file is the other one's") {
  const Scratch scratch;
  write(scratch / "one", new_names, "first");
  write(scratch / "two", new_names, "second");
  for (const std::string& name : new_names) {
    CAPTURE(name);
    const fs::path mixed = scratch / ("mixed " + name);
    fs::copy(scratch / "one", mixed, fs::copy_options::recursive);
    fs::copy(scratch / "two" / name, mixed / name, fs::copy_options::overwrite_existing);
    CHECK_THROWS_WITH_AS(RecordedFiles(mixed).file(name), doctest::Contains(name.c_str()),
                         InputError);
    fs::resize_file(mixed / name, 3);
    CHECK_THROWS_AS(RecordedFiles(mixed).file(name), InputError);
    fs::remove(mixed / name);
    CHECK_THROWS_WITH_AS(RecordedFiles(mixed).file(name),
                         doctest::Contains("there is no such file"), InputError);
  }
  CHECK_THROWS_WITH_AS(RecordedFiles(scratch / "one").file("diagnosis.csv"),
                       doctest::Contains("does not list it"), InputError);
}

TEST_CASE("a manifest of any bytes is read or refused, and a hostile one leads nowhere") {
  const Scratch scratch;
  write(scratch / "out", new_names, "new");
  std::ofstream(scratch / "secret") << "secret";
  const fs::path manifest = scratch / "out/manifest.json";
  const std::string whole = bytes_of(manifest);
  const auto refused = [&](const std::string& text) {
    CAPTURE(text);
    std::ofstream(manifest, std::ios::binary) << text;
    CHECK_THROWS_AS(RecordedFiles(scratch / "out"), InputError);
  };
  for (std::size_t length = 0; length < whole.size() - 2; ++length)
    refused(whole.substr(0, length));
  for (const char* name : {"", ".", "..", "../secret", "/etc/passwd", ".partial-1", "a/b",
                           "manifest.json", "a\\nb", "é"}) {
    refused(R"({"cordon_manifest": 1, "files": [{"name": ")" + std::string(name) +
            R"(", "bytes": 1, "fnv1a64": "0"}]})");
  }
  refused(R"({"cordon_manifest": 2, "files": []})");
  refused(R"({"cordon_manifest": 1, "files": [{"name": "a", "bytes": -1, "fnv1a64": "0"}]})");
  refused(R"({"cordon_manifest": 1, "files": [{"name": "a", "bytes": 1e300, "fnv1a64": "0"}]})");
  refused(std::string(std::size_t{2} << 20, ' '));
  fs::remove(manifest);
  fs::create_symlink("/dev/zero", manifest);
  CHECK_THROWS_AS(RecordedFiles(scratch / "out"), InputError);
  fs::create_directory_symlink(scratch.path(), scratch / "out/.committed");
  CHECK_THROWS_WITH_AS(RecordedFiles(scratch / "out"), doctest::Contains("is no directory"),
                       InputError);
  CHECK(bytes_of(scratch / "secret") == "secret");
}
