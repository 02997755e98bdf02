// SPDX-License-Identifier: GPL-3.0-or-later
// What every command does alike: exit codes, output, colours, loading of plugins.
#pragma once

#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/registry/registry.hpp"

namespace cordon::apps {

enum class Exit {
  done = 0,
  internal = 1,    ///< a defect of this program
  invalid = 2,     ///< invalid input, or a file that cannot be read or written
  plugin = 3,      ///< a plugin that is needed was refused, or failed
  violated = 4,    ///< a claimed guarantee was violated
  unanswered = 5,  ///< a solver gave no answer in its limit
  resources = 6    ///< memory, or a thread, that the machine does not give
};
/// For the footer of --help.
extern const char* const exit_codes_help;

Exit exit_for(Errc code) noexcept;
/// Prints the error of a command to stderr and gives its exit code. Call in a catch block.
Exit report_current_exception() noexcept;

/// Before the reason why a report could not be written.
inline const std::string no_report = "the results are complete, but report.html was not written: ";

/// Results: to stdout, flushed. A reader that has gone away (closed pipe) is not an error: the rest
/// is dropped. Throws Errc::io otherwise.
void print(const std::string& text);
/// Progress, warnings, errors: to stderr; "error: …" and "warning: …" are coloured on a terminal.
void note(const std::string& text);
void warn(const std::string& text);
void complain(const std::string& text);

/// A word or a path as a shell reads it, in quotes where it needs them.
std::string quoted(const std::string& word);
/// Why a text names no file, for options; empty if it does. An empty one would name files in the
/// working directory.
std::string path_problem(const std::string& text);
/// The same file, named so that a program cannot take it for an option.
std::filesystem::path as_operand(const std::filesystem::path& path);

/// Colours for a stream: none off a terminal, with NO_COLOR set (to anything but "") or TERM=dumb.
class Paint {
 public:
  explicit Paint(std::FILE* stream);
  std::string bold(const std::string& text) const { return wrap("1", text); }
  std::string red(const std::string& text) const { return wrap("1;31", text); }
  std::string yellow(const std::string& text) const { return wrap("33", text); }
  std::string green(const std::string& text) const { return wrap("32", text); }

 private:
  std::string wrap(const char* code, const std::string& text) const;
  bool on_;
};

/// A title in capitals, but for its unit: µs, or what stands in brackets.
std::string heading(std::string title);

/// Columns aligned by two spaces, first row bold; cells are UTF-8. The last column is not padded.
std::string table(const std::vector<std::vector<std::string>>& rows, const Paint& paint);

/// Loads the default search path with `first` before it.
void load_plugins(Registry& registry, std::span<const std::filesystem::path> first);
/// One warning per refused plugin and per component that was left out, for commands that can do
/// without.
void warn_refused(const Registry& registry);

/// One component of any kind.
struct Component {
  std::string kind;
  const ComponentInfo* info;
  std::string plugin;
};
std::vector<Component> components(const Registry& registry);  ///< by kind, then by name

/// A parameter's default and limits as text; "" if there is none.
std::string default_text(const ParamSpec& spec);
std::string range_text(const ParamSpec& spec);

/// "1 step", "2 steps".
std::string count(std::int64_t number, const char* noun);

/// Empty for a text that is a number of seconds above 0; else what is wrong.
std::string time_problem(const std::string& text);
/// So many seconds from now, some thirty years at most.
std::chrono::steady_clock::time_point time_after(double seconds);

}  // namespace cordon::apps
