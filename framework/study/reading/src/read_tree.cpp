// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_tree.hpp"

namespace cordon::json {

namespace {

constexpr std::size_t max_title = 1000;

/// Reads the sections of one study in turn.
class TreeReader {
 public:
  TreeReader(const Cursor& root, const Registry& registry, const TreeOptions& options)
      : root_(root), registry_(registry), options_(options) {}

  TreeReading read() {
    read_sections();
    if (options_.checks && !root_.problems().any())
      check_study(root_, result_.study, options_.only);
    return std::move(result_);
  }

 private:
  void read_sections();
  void read_version();
  SystemPart read_known_system(const Cursor& at);

  const Cursor& root_;
  const Registry& registry_;
  const TreeOptions& options_;
  TreeReading result_;
};

void TreeReader::read_version() {
  const auto at = root_.need("cordon", "write \"cordon\": 1, the version of the format");
  const auto version = at ? read_number(*at) : std::nullopt;
  if (version && *version != 1)
    at->error("this version of the format is not known", "this program reads \"cordon\": 1");
}

/// A system that comes from the same text as the known one is the same.
SystemPart TreeReader::read_known_system(const Cursor& at) {
  std::vector<std::string>& warnings = result_.study.warnings;
  result_.known = options_.known;
  if (!result_.known || result_.known->source != at.value().parts) {
    const std::size_t before = at.problems().met(), refusals = result_.refusals.size();
    KnownSystem system{at.value().parts, {}, {}};
    system.part = read_system(at, {registry_, system.warnings, result_.refusals});
    if (at.problems().met() != before || result_.refusals.size() != refusals) {
      warnings.insert(warnings.end(), system.warnings.begin(), system.warnings.end());
      result_.known = nullptr;
      return std::move(system.part);
    }
    result_.known = std::make_shared<const KnownSystem>(std::move(system));
  }
  warnings.insert(warnings.end(), result_.known->warnings.begin(), result_.known->warnings.end());
  return result_.known->part;
}

void TreeReader::read_sections() {
  const std::vector<std::string> keys{"cordon",    "title",   "plugins", "system", "data",
                                      "pipelines", "metrics", "online",  "sweep"};
  if (!root_.expect_keys(keys, "key of a study",
                         "a study is an object: {\"cordon\": 1, \"system\": ..., \"data\": ..., "
                         "\"pipelines\": ...}"))
    return;
  read_version();
  Study& study = result_.study;
  Written& written = result_.written;
  const auto title = root_.find("title");
  study.title = title ? read_line(*title, max_title).value_or("") : options_.file.stem().string();
  const ComponentContext context{registry_, study.warnings, result_.refusals};
  SystemPart system;
  if (const auto at = root_.need("system", "the plant: {\"type\": \"lti\", ...}"))
    system = read_known_system(*at);
  const DataUse use = data_use(root_);
  const auto online = root_.find("online");
  const bool needs_data = options_.data == StudyData::needed ||
                          (options_.data == StudyData::needed_unless_online && !online);
  const auto data =
      use.streamed() && needs_data
          ? root_.need("data", "{\"simulate\": {...}} or {\"csv\": {...}}" + use.reason() +
                                   (online ? "; without data it is for `cordon stream`" : ""))
          : root_.find("data");
  if (data) {
    DataPart part = read_data(*data, system, use, options_.folder, context);
    study.has_data = true;
    study.data = std::move(part.data);
    written.faults = std::move(part.written_faults);
    written.csv_file = std::move(part.written_file);
    written.plant = std::move(part.plant);
  }
  if (const auto at =
          root_.need("pipelines", "a list of pipelines: [{\"backend\": ..., \"observer\": ...}]")) {
    study.pipelines = read_pipelines(*at, system, context, [&](std::size_t i) {
      return (!options_.only || *options_.only == i) && (!options_.asks || options_.asks(i));
    });
  }
  if (const auto at = root_.find("metrics")) study.metrics = read_metrics(*at, system, context);
  if (online) study.online = read_online(*online);
  study.model = std::move(system.model);
  study.nominal = std::move(system.nominal);
  study.modes = std::move(system.modes);
  study.labels = std::move(system.labels);
  study.continuous = system.continuous != nullptr;
  written.modes = std::move(system.written);
  if (system.formulas) study.plant = system.formulas->plant;
  written.formulas = std::move(system.formulas);
}

}  // namespace

TreeReading read_tree(const Value& tree, const Registry& registry, const TreeOptions& options,
                      Problems& problems) {
  const Cursor root(tree, "", problems);
  TreeReading result = TreeReader(root, registry, options).read();
  result.study.file = options.file;
  result.written.tree = tree;
  if (const Value* plugins = tree.find("plugins")) {
    for (const Value& name : plugins->items()) result.written.plugins.push_back(name.text());
  }
  return result;
}

}  // namespace cordon::json
