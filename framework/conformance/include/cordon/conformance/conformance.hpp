// SPDX-License-Identifier: GPL-3.0-or-later
// The conformance kit: named laws that every component of a kind keeps, tried on random sets and
// systems. A violation is answered by the smallest case that was found and by a command that
// repeats it. Depends on the framework only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/interfaces/backend.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/registry/schema.hpp"

namespace cordon::conformance {

/// A law: its fixed name, "group.law", what it says in one line, and of which kind of components.
struct Law {
  std::string name, statement;
  std::string kind = "backend";
};
/// All laws in the order in which they are checked, kind by kind.
std::vector<Law> laws();

/// Does the name match a pattern of the shell's kind, in which `*` stands for any text and `?` for
/// one character?
bool matches(std::string_view pattern, std::string_view name);

/// What is checked. Of a backend, `make` gives a new one on each call; what it returns keeps its
/// plugin loaded by itself. Components of other kinds are made by `registry`, which has them and
/// what they work with: backends, and components that their parameters name.
struct Subject {
  std::function<std::shared_ptr<const SetBackend>(const Params&)> make;
  Params params;  ///< handed to `make` except where a law tries others; of other kinds those that
                  ///< are given, which laws complete
  const ParamSchema* schema =
      nullptr;  ///< of the parameters; without it the laws about parameters are skipped
  std::filesystem::path library;  ///< the plugin's file and
  std::string
      component;  ///< the component's name in it; without them the laws about unloading are skipped
  std::string command;  ///< how a failure is repeated, without law, seed and cases: "cordon conform
                        ///< x.so --kind backend --component b"
  std::string kind = "backend";
  std::shared_ptr<const Registry> registry = {};  ///< of other kinds than backends
};

struct Options {
  std::string laws = "*";  ///< pattern of names
  std::uint64_t seed = 1;
  Index cases = 80;  ///< per law; expensive laws take a share of it
};

enum class Status {
  passed,
  failed,
  skipped  ///< the law does not apply, or the component refused every case: a backend by
           ///< Errc::unsupported, another one by the problems that its `check` tells as well
};
std::string_view to_string(Status status) noexcept;

/// What became of one law.
struct Result {
  std::string law;
  Status status = Status::passed;
  std::string reason;  ///< failed: what was expected and what was found; skipped: why
  Index cases = 0;     ///< that were tried, the failing one included
  Index unsupported = 0,
        inapplicable = 0;  ///< cases that were refused; cases that do not bear on the law for it
  Index questions = 0,
        unknown =
            0;  ///< three-valued questions that were asked, and how often the answer was `unknown`
  std::string witness;  ///< failed: the smallest failing case, one object per line, in the form of
                        ///< study files
  std::string replay;   ///< failed: the command that repeats it
};

/// Told before each case, and before each trial of the search for a smaller one, which case runs
/// out of how many (-1: the component is made). For progress, and to know what ran when a process
/// ends.
using Progress = std::function<void(const Law& law, Index number, Index planned)>;

/// Checks one law, of the subject's kind. A crash or a hang of the component is one of the caller:
/// `cordon conform` runs this in a child process. Deterministic in the subject and the options.
/// Errors: Errc::invalid for a name that is no law.
Result check(const Subject& subject, std::string_view law, const Options& options,
             const Progress& progress = {});
/// Checks all laws of the subject's kind that match.
std::vector<Result> check(const Subject& subject, const Options& options,
                          const Progress& progress = {});

/// The case of that number as it is generated (not shrunk), for a backend of this kind: what ran
/// when a process ended.
std::string describe_case(std::string_view law, const Options& options, const BackendInfo& info,
                          Index number);

}  // namespace cordon::conformance
