// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/atomic_directory.hpp"

#include <csignal>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "run/scratch.hpp"

using cordon::Errc;
using cordon::Error;
using cordon::detail::AtomicDirectory;

namespace fs = std::filesystem;

TEST_CASE("files appear at commit, all of them") {
  const Scratch scratch;
  const fs::path out = scratch / "new" / "results";
  AtomicDirectory directory(out);
  directory.create("a").write("first");
  directory.create("b").write(std::string(200000, 'x'));
  CHECK(tree(out).count("a") == 0);
  const auto files = directory.commit();
  CHECK(files == std::vector<fs::path>{out / "a", out / "b"});
  CHECK(tree(out) ==
        std::map<std::string, std::string>{{"a", "first"}, {"b", std::string(200000, 'x')}});
}

TEST_CASE("without commit old files stay and nothing else is left") {
  const Scratch scratch;
  {
    AtomicDirectory directory(scratch.path());
    directory.create("a").write("old");
    directory.commit();
  }
  {
    AtomicDirectory directory(scratch.path());
    directory.create("a").write(std::string(200000, 'x'));
  }
  CHECK(tree(scratch.path()) == std::map<std::string, std::string>{{"a", "old"}});
  { const AtomicDirectory directory(scratch / "x" / "y" / ""); }
  CHECK(tree(scratch.path()).size() == 1);  // directories it made are gone too
  {
    AtomicDirectory directory(scratch.path());
    directory.create("a").write("new");
    directory.commit();
  }
  CHECK(tree(scratch.path()) == std::map<std::string, std::string>{{"a", "new"}});
}

TEST_CASE(
    "a target that is a file, lies below a file, or holds a directory of a result's name is "
    "refused") {
  const Scratch scratch;
  std::ofstream(scratch / "file") << "mine";
  CHECK_THROWS_WITH_AS(AtomicDirectory(scratch / "file"),
                       doctest::Contains("it is a file; name a directory"), Error);
  CHECK_THROWS_AS(AtomicDirectory(scratch / "file" / "below"), Error);
  CHECK(bytes_of(scratch / "file") == "mine");
  fs::create_directory(scratch / "a");
  AtomicDirectory directory(scratch.path());
  directory.create("a").write("x");
  CHECK_THROWS_WITH_AS(directory.commit(), doctest::Contains("it is a directory"), Error);
}

TEST_CASE("a directory without permission is refused before anything is computed") {
  if (::geteuid() == 0) {
    CHECK_THROWS_WITH_AS(AtomicDirectory("/proc/cordon"), doctest::Contains("/proc/cordon"),
                         Error);  // root may write elsewhere
    return;
  }
  const Scratch scratch;
  fs::permissions(scratch.path(), fs::perms::owner_read | fs::perms::owner_exec);
  CHECK_THROWS_WITH_AS(AtomicDirectory{scratch.path()}, doctest::Contains("Permission denied"),
                       Error);
  fs::permissions(scratch.path(), fs::perms::owner_all);
}

TEST_CASE("leftovers of dead processes are removed, those of living ones stay") {
  const Scratch scratch;
  fs::create_directory(scratch /
                       ".partial-1-0");  // the number of a living process, but nobody holds it
  std::ofstream(scratch / ".partial-1-0/results.json") << "half";
  std::ofstream(scratch / ".partial-note") << "a file";
  AtomicDirectory living(scratch.path());
  living.create("a").write("x");
  CHECK(tree(scratch.path()).count(".partial-1-0") == 0);
  const std::size_t before = tree(scratch.path()).size();
  { const AtomicDirectory second(scratch.path()); }
  CHECK(tree(scratch.path()).size() == before);
  living.commit();
  CHECK(tree(scratch.path()) ==
        std::map<std::string, std::string>{{".partial-note", "a file"}, {"a", "x"}});
}

TEST_CASE("a process that is killed leaves old results, and its leftovers go at the next start") {
  const Scratch scratch;
  std::ofstream(scratch / "a") << "old";
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    AtomicDirectory directory(scratch.path());
    directory.create("a").write(std::string(200000, 'x'));
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFSIGNALED(status));
  CHECK(bytes_of(scratch / "a") == "old");
  CHECK(tree(scratch.path()).size() == 3);
  { const AtomicDirectory directory(scratch.path()); }
  CHECK(tree(scratch.path()) == std::map<std::string, std::string>{{"a", "old"}});
}

TEST_CASE("a write that fails is told and leaves old files") {
  const Scratch scratch;
  std::ofstream(scratch / "a") << "old";
  struct rlimit before, small;
  ::getrlimit(RLIMIT_FSIZE, &before);
  small = before;
  small.rlim_cur = 100000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string message, late;
  try {
    AtomicDirectory directory(scratch.path());
    directory.create("a").write(std::string(300000, 'x'));
  } catch (const Error& error) {
    CHECK(error.code() == Errc::io);
    message = error.what();
  }
  try {  // the last bytes are written by commit
    AtomicDirectory directory(scratch.path());
    auto& file = directory.create("a");
    file.write(std::string(70000, 'x'));
    file.write(std::string(50000, 'y'));
    directory.commit();
  } catch (const Error& error) {
    late = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  CHECK(message.find("File too large; earlier results are unchanged") != std::string::npos);
  CHECK(late.find("File too large") != std::string::npos);
  CHECK(tree(scratch.path()) == std::map<std::string, std::string>{{"a", "old"}});
}
