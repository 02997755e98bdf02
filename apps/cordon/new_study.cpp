// SPDX-License-Identifier: GPL-3.0-or-later
#include "new_study.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "new_file.hpp"
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
  write_new_file(file, content_of(kind, title));
  note(fmt::format("Wrote {}\nNext:", file.string()));
  const std::string shown = quoted(as_operand(file));
  const std::string use =
      kind == "online"
          ? fmt::format("cordon stream {} --pipeline alarms --watch", shown)
          : fmt::format("cordon run {} --out {}", shown, quoted(fs::path("results") / title));
  print(fmt::format("cordon validate {}\n{}\n", shown, use));
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
