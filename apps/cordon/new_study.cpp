// SPDX-License-Identifier: GPL-3.0-or-later
#include "new_study.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <memory>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "study_templates.hpp"

namespace cordon::apps {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view placeholder = "\"NAME\"";  // the title
constexpr std::size_t longest_study_name = 200;

/// The name without ".json"; it becomes the title and a file in this or another directory.
std::string title_of(const fs::path& wanted) {
  const fs::path file = wanted.filename();
  const std::string title = (file.extension() == ".json" ? file.stem() : file).string();
  const bool control = std::any_of(title.begin(), title.end(),
                                   [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  if (title.empty() || title == "." || title == ".." || title.size() > longest_study_name ||
      control) {
    throw Error(
        Errc::invalid,
        "a study's name is a name of a file, of at most 200 bytes and without control characters");
  }
  return title;
}

std::string content_of(const std::string& kind, const std::string& title) {
  const auto* found = std::find_if(std::begin(study_templates), std::end(study_templates),
                                   [&](const StudyTemplate& t) { return t.kind == kind; });
  std::string text(found->content);
  const std::string in_json =
      nlohmann::json(title).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text.replace(text.find(placeholder), placeholder.size(), in_json);
}

[[noreturn]] void fail(const fs::path& file, int reason) {
  if (reason == EEXIST)
    throw Error(Errc::invalid, fmt::format("{} exists already; give another name", file.string()));
  throw Error(Errc::io, fmt::format("cannot write {}: {}", file.string(), std::strerror(reason)));
}

/// Whole or not at all, and never over a file that is there.
void write_new(const fs::path& file, const std::string& content) {
  if (std::error_code error; fs::exists(fs::symlink_status(file, error))) fail(file, EEXIST);
  const fs::path partial =
      file.parent_path() / fmt::format(".partial-{}-{}", getpid(), file.filename().string());
  errno = 0;
  std::ofstream stream(partial, std::ios::binary);
  stream << content;
  stream.close();
  int reason = stream ? 0 : std::max(errno, 1);
  if (reason == 0 &&
      renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, file.c_str(), RENAME_NOREPLACE) != 0)
    reason = errno;
  if (reason == EINVAL || reason == ENOSYS)
    reason = std::rename(partial.c_str(), file.c_str()) == 0 ? 0 : errno;
  if (reason == 0) return;
  std::error_code ignored;
  fs::remove(partial, ignored);
  fail(file, reason);
}

Exit new_study(const fs::path& wanted, const std::string& kind) {
  std::signal(SIGXFSZ,
              SIG_IGN);  // a limit of file size is an error of write, not the end of the process
  const std::string title = title_of(wanted);
  const fs::path file = wanted.parent_path() / (title + ".json");
  if (std::error_code error;
      wanted.has_parent_path() && !fs::is_directory(wanted.parent_path(), error)) {
    throw Error(Errc::invalid,
                fmt::format("{} is no directory; create it first", wanted.parent_path().string()));
  }
  write_new(file, content_of(kind, title));
  note(fmt::format("Wrote {}\nNext:", file.string()));
  const std::string shown = quoted(as_operand(file));
  print(fmt::format("cordon validate {}\ncordon run {} --out {}\n", shown, shown,
                    quoted(fs::path("results") / title)));
  return Exit::done;
}

}  // namespace

void add_new_study(CLI::App& command, Program& program) {
  CLI::App* study = command.add_subcommand(
      "study", "Write a study that runs as it is, with comments that explain it");
  study->fallthrough();
  const auto name = std::make_shared<fs::path>();
  const auto kind = std::make_shared<std::string>("estimation");
  std::vector<std::string> kinds;
  for (const StudyTemplate& one : study_templates) kinds.emplace_back(one.kind);
  CLI::Option* const given = study->add_option(
      "NAME", *name, "Its title; the file is NAME.json. Without one the kinds are listed");
  study->add_option("--kind", *kind, "What it is about (default: estimation)")
      ->check(CLI::IsMember(kinds))
      ->option_text("KIND");
  study->callback([&program, name, kind, kinds, given] {
    if (given->count() > 0) {
      program.exit = new_study(*name, *kind);
      return;
    }
    print(fmt::format("\"cordon new study NAME --kind KIND\" writes NAME.json. Kinds: {}.\n",
                      fmt::join(kinds, ", ")));
    program.exit = Exit::done;
  });
}

}  // namespace cordon::apps
