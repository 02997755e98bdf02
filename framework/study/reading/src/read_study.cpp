// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/study.hpp"
#include "resolve_sweep.hpp"
#include "settings.hpp"
#include "sweep_check.hpp"

namespace cordon {

namespace {

using namespace json;

bool holds_plugins(const std::filesystem::path& directory) {
  std::error_code failure;
  for (std::filesystem::directory_iterator file(directory, failure), end; !failure && file != end;
       file.increment(failure)) {
    if (file->path().extension() == ".so") return true;
  }
  return false;
}

/// Reads one file.
class StudyReader {
 public:
  StudyReader(const std::filesystem::path& file, Registry& registry, const SearchPath& path,
              StudyPlugins plugins, StudyData data)
      : registry_(registry),
        path_(path),
        plugins_(plugins),
        source_(std::make_shared<StudySource>()) {
    source_->file = file;
    source_->data = data;
    std::error_code
        failure;  // absolute, so that a later change of the working directory does not matter
    const std::filesystem::path absolute = std::filesystem::absolute(file, failure);
    source_->folder = (failure ? file : absolute).parent_path();
  }

  Study read(std::string text, const std::vector<std::string>& settings);

 private:
  void parse(std::string text, const std::vector<std::string>& settings);
  void load_plugins(const Cursor& root);
  bool is_trusted(const std::filesystem::path& directory) const;
  void pass_over(const Cursor& at, const std::filesystem::path& directory);
  void add_plugin_warnings(Study& study) const;
  void finish(const std::vector<Diagnostic>& refusals);

  Registry& registry_;
  const SearchPath& path_;
  const StudyPlugins plugins_;
  Problems problems_;
  std::vector<Diagnostic> untrusted_;  ///< directories
  std::vector<std::string> barren_;    ///< directories without plugins
  std::shared_ptr<StudySource> source_;
};

bool StudyReader::is_trusted(const std::filesystem::path& directory) const {
  const auto is_it = [&](const std::filesystem::path& known) {
    std::error_code unknown;  // a directory that does not exist is equivalent to none
    return std::filesystem::equivalent(known, directory, unknown);
  };
  return plugins_ == StudyPlugins::load ||
         std::any_of(path_.directories.begin(), path_.directories.end(), is_it) ||
         std::any_of(registry_.searched().begin(), registry_.searched().end(), is_it);
}

/// Opens no library of the directory, and says so.
void StudyReader::pass_over(const Cursor& at, const std::filesystem::path& directory) {
  const std::string trust =
      "if you trust what is in " + in_quotes(directory.string(), 1000) +
      ", give --trust-plugins, or that directory by --plugins or CORDON_PLUGIN_PATH";
  registry_.refuse(
      directory,
      "it was not opened and nothing of it is checked, since only the study names its directory",
      trust);
  if (plugins_ == StudyPlugins::ignore) return;
  untrusted_.push_back({at.pointer(),
                        "plugins are programs, and only the study names this directory of them",
                        trust, at.value().line});
}

void StudyReader::load_plugins(const Cursor& root) {
  SearchPath path;
  if (const auto at = root.find("plugins")) {
    const std::vector<std::string> names =
        read_names(*at, "directory").value_or(std::vector<std::string>{});
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::filesystem::path directory = source_->folder / names[i];
      std::error_code failure;
      if (!std::filesystem::is_directory(directory, failure)) {
        at->item(i).error("no such directory: " + in_quotes(directory.string(), 1000),
                          "the path is relative to the folder of the study");
      } else if (is_trusted(directory)) {
        path.directories.push_back(directory);
        if (!holds_plugins(directory)) barren_.push_back(names[i]);
      } else {
        pass_over(at->item(i), directory.lexically_normal());
      }
    }
  }
  path.directories.insert(path.directories.end(), path_.directories.begin(),
                          path_.directories.end());
  registry_.load(path);
}

void StudyReader::add_plugin_warnings(Study& study) const {
  for (const std::string& name : barren_) {
    study.warnings.push_back("/plugins: there is no plugin (no .so file) in " +
                             in_quotes(name, 1000));
  }
  for (const PluginReport& report : registry_.reports()) {
    for (const std::string& component : report.left_out) {
      study.warnings.push_back("plugin " + report.file.string() + ": " + component +
                               "; rename it, or remove one of the two");
    }
    if (report.state != PluginReport::State::refused) continue;
    study.warnings.push_back("plugin " + report.file.string() + " was refused: " + report.reason +
                             "; " + report.fix);
  }
}

/// Throws if there is any problem. Directories that are not trusted and components of refused
/// plugins are a matter of the installation: they make the exit code only if the file itself is
/// right, and are listed with its problems otherwise.
void StudyReader::finish(const std::vector<Diagnostic>& refusals) {
  if (!problems_.any() && refusals.empty()) return;
  const bool file_is_right = !problems_.any();
  for (const Diagnostic& d : refusals) problems_.add(d.pointer, d.line, d.message, d.suggestion);
  const InputError all(source_->file.string(), problems_.sorted());
  if (file_is_right) throw Error(Errc::plugin, all.what());
  throw all;
}

/// The file's tree, with the settings, and what is no study refused.
void StudyReader::parse(std::string text, const std::vector<std::string>& settings) {
  source_->text = std::move(text);
  source_->tree = json::parse(source_->text, problems_);
  const Cursor root(source_->tree, "", problems_);
  const std::string ending = source_->file.extension().string();
  if (problems_.any() && (ending == ".csv" || ending == ".mat")) {
    throw InputError(source_->file.string(),
                     {{"", "is no study: a study is a JSON file",
                       ending == ".csv" ? "name the data in its /data/csv"
                                        : "\"cordon convert\" makes a study of a MAT-file"}});
  }
  if (root.is(Value::Kind::object) && root.find("cordon_results")) {
    root.error("these are the results of a run, not a study",
               "\"cordon verify\", \"cordon report\" and \"cordon compare\" take their directory; "
               "the study that was run is their member \"study\"");
    finish({});
  }
  if (!root.is(Value::Kind::object)) return;
  load_plugins(root);
  if (settings.empty()) return;
  source_->tree = with_settings(source_->tree, settings, registry_, problems_);
  source_->text = written_json(source_->tree).dump(1);
}

Study StudyReader::read(std::string text, const std::vector<std::string>& settings) {
  parse(std::move(text), settings);
  source_->sweep = read_sweep(Cursor(source_->tree, "", problems_));
  TreeReading reading = read_first_values(*source_, registry_, !problems_.any(), problems_);
  reading.refusals.insert(reading.refusals.begin(), untrusted_.begin(), untrusted_.end());
  finish(reading.refusals);
  Study study = std::move(reading.study);
  add_plugin_warnings(study);
  const bool measured =
      std::any_of(study.pipelines.begin(), study.pipelines.end(),
                  [](const PipelineSpec& spec) { return spec.estimation() != nullptr; });
  if (!study.metrics.empty() && !measured) {
    study.warnings.push_back(
        "/metrics: they measure pipelines with an observer, and there is none: they are not used");
  }
  for (const WrittenAxis& axis : source_->sweep) {
    SweepAxis& made = study.sweep.emplace_back(
        SweepAxis{axis.name, axis.path_text(), {}, axis.repeat, axis.labels});
    for (const Value& value : axis.values) made.values.push_back(canonical_text(value));
  }
  if (std::string warning = overlapping_seeds(study, source_->sweep); !warning.empty())
    study.warnings.push_back(std::move(warning));
  study.resolved = resolve(study, reading.written, source_->sweep, registry_);
  if (source_->sweep.empty()) {
    source_->tree = Value{};
    source_->system = nullptr;
  }
  study.source = share(source_);
  return study;
}

}  // namespace

Study read_study(const std::filesystem::path& file, Registry& registry, const SearchPath& path,
                 StudyPlugins plugins, StudyData data, const std::vector<std::string>& settings) {
  return read_study_text(read_file(file.string()), file, registry, path, plugins, data, settings);
}

Study read_study_text(const std::string& text, const std::filesystem::path& file,
                      Registry& registry, const SearchPath& path, StudyPlugins plugins,
                      StudyData data, const std::vector<std::string>& settings) {
  return StudyReader(file, registry, path, plugins, data).read(text, settings);
}

std::vector<std::pair<std::string, const ComponentSpec*>> algorithms_of(const PipelineSpec& spec) {
  if (const EstimationSpec* const estimation = spec.estimation())
    return {{"observer", &estimation->observer}};
  if (const DiagnosisSpec* const diagnosis = spec.diagnosis())
    return {{"diagnoser", &diagnosis->diagnoser}};
  const DesignSpec& design = *spec.design();
  if (!design.diagnoser) return {{"designer", &design.designer}};
  return {{"designer", &design.designer}, {"diagnoser", &*design.diagnoser}};
}

ModeBank bank_of(const Study& study) {
  ModeBank bank;
  bank.modes.push_back({study.nominal, study.model});
  bank.modes.insert(bank.modes.end(), study.modes.begin(), study.modes.end());
  return bank;
}

}  // namespace cordon
