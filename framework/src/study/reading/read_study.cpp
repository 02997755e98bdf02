// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/study.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon {

namespace {

using namespace json;

constexpr std::size_t max_title = 1000;

/// Reads the sections of one file in turn.
class StudyReader {
 public:
  StudyReader(const std::filesystem::path& file, Registry& registry, const SearchPath& path)
      : file_(file), registry_(registry), path_(path) {}

  Study read();

 private:
  void read_sections(const Cursor& root);
  void read_version(const Cursor& root);
  void read_title(const Cursor& root);
  void load_plugins(const Cursor& root);
  void add_plugin_warnings();
  std::filesystem::path folder() const;
  void finish();

  std::filesystem::path file_;
  Registry& registry_;
  const SearchPath& path_;
  Problems problems_;
  std::vector<Diagnostic> refusals_;
  Written written_;
  Study study_;
};

/// Absolute, so that a later change of the working directory does not matter.
std::filesystem::path StudyReader::folder() const {
  std::error_code failure;
  const std::filesystem::path absolute = std::filesystem::absolute(file_, failure);
  return (failure ? file_ : absolute).parent_path();
}

void StudyReader::read_version(const Cursor& root) {
  const auto at = root.need("cordon", "write \"cordon\": 1, the version of the format");
  const auto version = at ? read_number(*at) : std::nullopt;
  if (version && *version != 1) at->error("this version of the format is not known", "this program reads \"cordon\": 1");
}

void StudyReader::read_title(const Cursor& root) {
  const auto at = root.find("title");
  study_.title = at ? read_line(*at, max_title).value_or("") : file_.stem().string();
}

void StudyReader::load_plugins(const Cursor& root) {
  SearchPath path;
  if (const auto at = root.find("plugins")) {
    written_.plugins = read_names(*at, "directory").value_or(std::vector<std::string>{});
    for (std::size_t i = 0; i < written_.plugins.size(); ++i) {
      path.directories.push_back(folder() / written_.plugins[i]);
      std::error_code failure;
      if (!std::filesystem::is_directory(path.directories.back(), failure)) {
        at->item(i).error("no such directory: " + in_quotes(path.directories.back().string(), 1000),
                          "the path is relative to the folder of the study");
      }
    }
  }
  path.directories.insert(path.directories.end(), path_.directories.begin(), path_.directories.end());
  registry_.load(path);
}

void StudyReader::read_sections(const Cursor& root) {
  const std::vector<std::string> keys{"cordon", "title", "plugins", "system", "data", "pipelines", "metrics"};
  if (!root.expect_keys(keys, "key of a study",
                        "a study is an object: {\"cordon\": 1, \"system\": ..., \"data\": ..., \"pipelines\": ...}"))
    return;
  read_version(root);
  read_title(root);
  load_plugins(root);
  const ComponentContext context{registry_, study_.warnings, refusals_};
  SystemPart system;
  if (const auto at = root.need("system", "the plant: {\"type\": \"lti\", ...}")) system = read_system(*at, study_.warnings);
  const DataUse use = data_use(root);
  const auto data =
      use.streamed() ? root.need("data", "{\"simulate\": {...}} or {\"csv\": {...}}" + use.reason()) : root.find("data");
  if (data) {
    DataPart part = read_data(*data, system, use, folder(), context);
    study_.data = std::move(part.data);
    written_.faults = std::move(part.written_faults);
    written_.csv_file = std::move(part.written_file);
  }
  if (const auto at = root.need("pipelines", "a list of pipelines: [{\"backend\": ..., \"observer\": ...}]")) {
    study_.pipelines = read_pipelines(*at, system, context);
  }
  if (const auto at = root.find("metrics")) study_.metrics = read_metrics(*at, context);
  study_.model = std::move(system.model);
  study_.nominal = std::move(system.nominal);
  study_.modes = std::move(system.modes);
  written_.modes = std::move(system.written);
}

void StudyReader::add_plugin_warnings() {
  for (const PluginReport& report : registry_.reports()) {
    if (report.state != PluginReport::State::refused) continue;
    study_.warnings.push_back("plugin " + report.file.string() + " was refused: " + report.reason + "; " + report.fix);
  }
}

/// Throws if there is any problem. Components of refused plugins are a matter of the installation: they make the exit code only
/// if the file itself is right, and are listed with its problems otherwise.
void StudyReader::finish() {
  if (!problems_.any() && refusals_.empty()) return;
  const bool file_is_right = !problems_.any();
  for (const Diagnostic& d : refusals_) problems_.add(d.pointer, d.line, d.message, d.suggestion);
  const InputError all(file_.string(), problems_.sorted());
  if (file_is_right) throw Error(Errc::plugin, all.what());
  throw all;
}

Study StudyReader::read() {
  study_.file = file_;
  const std::string text = read_file(file_.string());
  const Value tree = parse(text, problems_);
  const Cursor root(tree, "", problems_);
  read_sections(root);
  if (!problems_.any()) check_study(root, study_);
  finish();
  add_plugin_warnings();
  study_.resolved = resolve(study_, written_, registry_);
  return std::move(study_);
}

}  // namespace

Study read_study(const std::filesystem::path& file, Registry& registry, const SearchPath& path) {
  return StudyReader(file, registry, path).read();
}

ModeBank bank_of(const Study& study) {
  ModeBank bank;
  bank.modes.push_back({study.nominal, study.model});
  bank.modes.insert(bank.modes.end(), study.modes.begin(), study.modes.end());
  return bank;
}

}  // namespace cordon
