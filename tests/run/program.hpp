// SPDX-License-Identifier: GPL-3.0-or-later
// The program of this build, run to its end through a shell.
#pragma once

#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include "run/scratch.hpp"

namespace test {

struct Outcome {
  int code = -1;  ///< -1: it was ended by a signal
  std::string out, err;

  bool says(const std::string& what) const { return out.find(what) != std::string::npos; }
  bool complains(const std::string& what) const { return err.find(what) != std::string::npos; }
};

/// Runs `ENVIRONMENT cordon ARGUMENTS`; the arguments may redirect. Nothing is inherited from
/// CORDON_PLUGIN_PATH, but what the environment sets again.
inline Outcome cordon_with(const std::string& arguments, const std::string& environment = "") {
  const Scratch directory;
  const std::string out = (directory / "out").string(), err = (directory / "err").string();
  const std::string command = "( CORDON_PLUGIN_PATH= " + environment + " \"" CORDON_PROGRAM "\" " +
                              arguments + " ) >\"" + out + "\" 2>\"" + err + "\"";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(out), bytes_of(err)};
}

}  // namespace test
