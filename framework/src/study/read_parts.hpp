// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a study file. Each reader reports every problem of its section; what it returns is meant for use only if the
// whole file had no problem, except where the result says which parts are known.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cordon/registry/registry.hpp"
#include "cordon/study/study.hpp"
#include "study/json_cursor.hpp"

namespace cordon::json {

/// Sizes that are known; nothing for those whose matrices are wrong: what depends on them is not checked.
struct Sizes {
  std::optional<Index> states, inputs, outputs;
};

struct SystemPart {
  Model model;
  Sizes sizes;
  bool good = false;
};
const std::vector<std::string>& system_types();
SystemPart read_system(const Cursor& system, std::vector<std::string>& warnings);

/// `file` of recorded data as it is written in the study.
struct DataPart {
  std::variant<SimulateSpec, CsvSpec> data;
  std::string written_file;
};
const std::vector<std::string>& signal_types();
const std::vector<std::string>& noise_names();
std::vector<std::string> signal_keys(Signal::Type type);  ///< without "type"; the required ones first
std::size_t required_signal_keys(Signal::Type type);      ///< how many of them are required
DataPart read_data(const Cursor& data, const SystemPart& system, const std::filesystem::path& folder);

struct ComponentContext {
  const Registry& registry;
  std::vector<std::string>& warnings;
  std::vector<Diagnostic>&
      refusals;  ///< components that plugins failed to provide: problems of the installation, not of the file
};
std::vector<PipelineSpec> read_pipelines(const Cursor& pipelines, const SystemPart& system, const ComponentContext& context);
std::vector<ComponentSpec> read_metrics(const Cursor& metrics, const ComponentContext& context);

/// What the resolved text needs besides the study itself.
struct WrittenPaths {
  std::vector<std::string> plugins;
  std::string csv_file;
};
/// The study as JSON with every default: keys in a fixed order, sets in exchange form, doubles in the shortest form that reads
/// back equal.
std::string resolve(const Study& study, const WrittenPaths& paths, const Registry& registry);

}  // namespace cordon::json
