// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <memory>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "new_study.hpp"
#include "plugin_template.hpp"

namespace cordon::apps {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 64;  ///< file names are made from it

/// The nearest text in lower-case letters, digits and single underscores, a letter first; "" if
/// nothing is left. "MyBox" becomes "my_box".
std::string to_snake_case(std::string_view text) {
  std::string name;
  char before = '_';
  for (const char c : text) {
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z',
               digit = c >= '0' && c <= '9';
    const bool before_is_small =
        (before >= 'a' && before <= 'z') || (before >= '0' && before <= '9');
    if ((upper && before_is_small) || !(upper || lower || digit)) name += '_';
    if (upper) name += static_cast<char>(c - 'A' + 'a');
    if (lower || digit) name += c;
    before = c;
  }
  name.erase(
      std::unique(name.begin(), name.end(), [](char a, char b) { return a == '_' && b == '_'; }),
      name.end());
  name.erase(0, std::min(name.find_first_of("abcdefghijklmnopqrstuvwxyz"), name.size()));
  name.resize(std::min(name.size(), longest_name));
  while (name.ends_with('_')) name.pop_back();
  return name;
}

/// Refuses a name that is no plugin name, or that Cordon or a plugin on the search path has taken.
void require_free_name(const Program& program, const std::string& name) {
  if (const std::string suggestion = to_snake_case(name);
      suggestion.empty() || suggestion != name) {
    throw Error(
        Errc::invalid,
        fmt::format(
            "NAME \"{}\" is no plugin name: it must be in snake_case, a letter first, with "
            "at most {} characters; {}",
            name, longest_name,
            suggestion.empty() ? "such as \"my_set\"" : "did you mean \"" + suggestion + "\"?"));
  }
  const auto taken = [&](const std::string& by) {
    throw Error(Errc::invalid,
                fmt::format("the name \"{}\" is taken by {}; try \"{}\"", name, by, "my_" + name));
  };
  if (name == "cordon") taken("the framework itself");
  Registry registry;
  load_plugins(registry, program.plugins);
  for (const PluginReport& report : registry.reports()) {
    if (report.name == name) taken(fmt::format("the plugin {}", report.file.string()));
  }
  for (const Component& component : components(registry)) {
    if (component.info->name == name)
      taken(fmt::format("the {} of the plugin \"{}\"", component.kind, component.plugin));
  }
}

std::string with_name(std::string_view text, std::string_view template_name,
                      const std::string& name) {
  std::string result;
  for (std::size_t at = 0;;) {
    const std::size_t next = text.find(template_name, at);
    result += text.substr(at, next - at);
    if (next == std::string_view::npos) return result;
    result += name;
    at = next + template_name.size();
  }
}

[[noreturn]] void fail(const std::string& what, int code) {
  throw Error(Errc::io, fmt::format("{}: {}", what, std::strerror(code)));
}

/// A directory under another name, which is removed unless it has been given its own.
class PartialDirectory {
 public:
  explicit PartialDirectory(const fs::path& target)
      : target_(target),
        path_(target.parent_path() /
              fmt::format(".partial-{}-{}", target.filename().string(), getpid())) {
    std::error_code error;
    if (!fs::create_directory(path_, error)) {
      fail(fmt::format("cannot create {}", path_.string()), error ? error.value() : EEXIST);
    }
  }
  ~PartialDirectory() {
    std::error_code ignored;
    if (!kept_) fs::remove_all(path_, ignored);
  }
  PartialDirectory(const PartialDirectory&) = delete;
  PartialDirectory& operator=(const PartialDirectory&) = delete;

  void write(const std::string& file, const std::string& content) const {
    errno = 0;
    std::ofstream stream(path_ / file, std::ios::binary);
    stream << content;
    stream.close();
    if (!stream) fail(fmt::format("cannot write {}", (target_ / file).string()), errno);
  }

  /// Never replaces what has appeared there meanwhile, as far as the file system can promise it.
  void keep() {
    kept_ = renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0;
    std::error_code unknown;
    if (!kept_ && (errno == EINVAL || errno == ENOSYS) && !fs::exists(target_, unknown)) {
      kept_ = std::rename(path_.c_str(), target_.c_str()) == 0;
    }
    if (!kept_) fail(fmt::format("cannot create {}", target_.string()), errno);
  }

 private:
  fs::path target_, path_;
  bool kept_ = false;
};

/// What CMake must be told to find this program's package; `installed` says if it has one.
std::string prefix_option(bool& installed) {
  std::error_code error;
  const fs::path programs = fs::read_symlink("/proc/self/exe", error).parent_path(),
                 prefix = programs.parent_path();
  installed = !error && fs::exists(programs / package_from_programs / "cordonConfig.cmake", error);
  if (!installed) return " -DCMAKE_PREFIX_PATH=PREFIX";
  return prefix == "/usr" || prefix == "/usr/local" ? "" : " -DCMAKE_PREFIX_PATH=" + quoted(prefix);
}

struct NewPlugin {
  std::string name, kind = "backend";
  fs::path directory;
};

Exit new_plugin(const Program& program, const NewPlugin& wanted) {
  const std::string& name = wanted.name;
  std::signal(SIGXFSZ,
              SIG_IGN);  // a limit of file size is an error of write, not the end of the process
  require_free_name(program, name);
  const fs::path shown = wanted.directory.empty() ? fs::path(name) : wanted.directory;
  fs::path target = fs::absolute(shown).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();  // "dir/" is "dir"
  if (std::error_code error; fs::exists(fs::symlink_status(target, error))) {
    throw Error(Errc::invalid, fmt::format("{} exists already; give another directory with --dir",
                                           shown.string()));
  }
  if (std::error_code error; !fs::is_directory(target.parent_path(), error)) {
    throw Error(Errc::invalid,
                fmt::format("{} is no directory; create it first", target.parent_path().string()));
  }
  PartialDirectory directory(target);
  std::vector<std::string> files;
  for (const TemplateFile& file : plugin_template) {
    if (file.kind != wanted.kind) continue;
    files.push_back(with_name(file.path, file.name, name));
    directory.write(files.back(), with_name(file.content, file.name, name));
  }
  directory.keep();
  bool installed = false;
  const std::string option = prefix_option(installed), source = quoted(shown),
                    build = quoted(shown / "build");
  note(fmt::format("Wrote {}: {}\nNext:", shown.string(), fmt::join(files, ", ")));
  print(
      fmt::format("cmake -S {} -B {} -DCMAKE_BUILD_TYPE=Release{}\ncmake --build {}\nctest "
                  "--test-dir {} --output-on-failure\n",
                  source, build, option, build, build));
  if (!installed)
    note(
        "PREFIX: where `cmake --install BUILD --prefix PREFIX` has put Cordon; this program is not "
        "installed");
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(new) {
  CLI::App* command = app.add_subcommand("new", "Write the beginning of something of your own");
  command->require_subcommand(1);
  CLI::App* plugin =
      command->add_subcommand("plugin", "Write a project that builds a plugin with one component");
  plugin->fallthrough();
  const auto wanted = std::make_shared<NewPlugin>();
  plugin->add_option("NAME", wanted->name, "Name of the plugin and of its component, in snake_case")
      ->required();
  plugin
      ->add_option("--kind", wanted->kind,
                   "What it is: backend (a set representation), observer, diagnoser, designer, "
                   "gain, metric or plant [backend]")
      ->check(CLI::IsMember(Registry::kinds()))
      ->option_text("KIND");
  plugin
      ->add_option("--dir", wanted->directory,
                   "The directory to write, which must not exist (default: NAME)")
      ->option_text("DIR");
  plugin->callback([&program, wanted] { program.exit = new_plugin(program, *wanted); });
  add_new_study(*command, program);
}

}  // namespace cordon::apps
