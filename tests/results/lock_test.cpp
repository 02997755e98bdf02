// SPDX-License-Identifier: GPL-3.0-or-later
#include <csignal>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "run/scratch.hpp"
#include "study/text/directory_lock.hpp"

using namespace cordon;
using detail::DirectoryLock;

namespace fs = std::filesystem;

TEST_CASE("one at a time holds a directory, and the other is told who") {
  const Scratch scratch;
  const fs::path out = scratch / "new" / "out";
  {
    const DirectoryLock lock(out);
    const std::string who = "process " + std::to_string(::getpid()) + " on ";
    CHECK_THROWS_WITH_AS(DirectoryLock{out}, doctest::Contains(who.c_str()), InputError);
    CHECK_THROWS_WITH_AS(DirectoryLock{out},
                         doctest::Contains("is writing results into this directory"), InputError);
    const DirectoryLock other(scratch / "other");
  }
  CHECK_FALSE(fs::exists(scratch / "new"));  // what was made for it has gone with it
  CHECK(tree(scratch.path()).empty());
}

TEST_CASE("a process that is killed holds nothing") {
  const Scratch scratch;
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const DirectoryLock lock(scratch.path());
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFSIGNALED(status));
  CHECK(fs::exists(scratch / ".cordon-lock"));
  { const DirectoryLock lock(scratch.path()); }
  CHECK(tree(scratch.path()).empty());
}

TEST_CASE("the lock follows no link and waits for no pipe") {
  const Scratch scratch;
  const fs::path file = scratch.write("mine", "mine");
  fs::create_symlink(file, scratch / ".cordon-lock");
  CHECK_THROWS_AS(DirectoryLock{scratch.path()}, Error);
  CHECK(bytes_of(file) == "mine");
  fs::remove(scratch / ".cordon-lock");
  REQUIRE(::mkfifo((scratch / ".cordon-lock").c_str(), 0600) == 0);
  CHECK_THROWS_WITH_AS(DirectoryLock{scratch.path()}, doctest::Contains("no regular file"), Error);
}

TEST_CASE("of many that begin at once one holds the directory at a time") {
  const Scratch scratch;
  const fs::path out = scratch / "out", inside = scratch / "inside";
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      int held = 0, code = 0;
      while (held < 50 && code == 0) {
        try {
          const DirectoryLock lock(out);
          code = ::mkdir(inside.c_str(), 0700) == 0 ? 0 : 1;  // fails while another one is there
          ::rmdir(inside.c_str());
          ++held;
        } catch (const Error&) {
        }
      }
      ::_exit(code);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(status == 0);
  }
}
