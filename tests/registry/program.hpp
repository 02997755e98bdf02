// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include "registry/temporary.hpp"

namespace test {

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// Runs `cordon ARGUMENTS` through a shell; the arguments may redirect.
inline Outcome cordon_with(const std::string& arguments, const std::string& environment = "") {
  const TemporaryDirectory directory;
  const std::string out = (directory / "out").string(), err = (directory / "err").string();
  const std::string command = "( " + environment + " \"" CORDON_PROGRAM "\" " + arguments + " ) >" + out + " 2>" + err;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace test
