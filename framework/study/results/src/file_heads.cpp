// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/file_heads.hpp"

#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/registry/build.hpp"
#include "study/reading/formula_graph.hpp"
#include "study/results/measures.hpp"
#include "study/text/fingerprint.hpp"
#include "study/text/host.hpp"

namespace cordon::detail {

using Layout = JsonWriter::Layout;

namespace {

/// Of a plant, which its plugin has made.
void write_formulas(JsonWriter& json, const NonlinearModel& model) {
  json.key("formulas").begin_object(Layout::lines).member("inputs", model.inputs);
  json.key("f");
  json::write_graph(*model.f, json);
  json.key("g");
  json::write_graph(*model.g, json);
  json.end_object();
}

}  // namespace

void begin_results_file(JsonWriter& json, const Study& study, const Registry& registry,
                        const std::vector<Measure>& measures) {
  const BuildInfo build = build_info();
  json.begin_object(Layout::lines).member("cordon_results", 1);
  json.key("cordon")
      .begin_object()
      .member("version", build.version)
      .member("abi_tag", build.abi_tag)
      .end_object();
  json.key("tools").begin_object();
  for (const auto& [tool, version] : build.tools) json.member(tool, version);
  json.end_object();
  json.key("plugins").begin_array();
  for (const PluginReport& report : registry.reports()) {
    if (report.state != PluginReport::State::loaded) continue;
    json.begin_object().member("name", report.name).member("version", report.version).end_object();
  }
  json.end_array();
  json.member("title", study.title).member("study_hash", fingerprint(study.resolved));
  json.key("study");
  study.resolved.empty() ? json.null() : json.raw(study.resolved);
  if (study.plant && study.sweep.empty()) write_formulas(json, *study.model.nonlinear);
  write_measures(json, measures);
}

void begin_run_file(JsonWriter& json, const Study& study, const Registry& registry,
                    const std::string& started) {
  const Host host = this_host();
  json.begin_object(Layout::lines)
      .member("cordon_run", 1)
      .member("study", study.file.string())
      .member("started", started);
  json.key("host")
      .begin_object()
      .member("name", host.name)
      .member("system", host.system)
      .member("cpu", host.cpu)
      .end_object();
  json.key("plugins").begin_array(Layout::lines);
  for (const PluginReport& report : registry.reports()) {
    if (report.state != PluginReport::State::loaded) continue;
    json.begin_object()
        .member("name", report.name)
        .member("file", report.file.string())
        .end_object();
  }
  json.end_array();
  json.key("warnings").begin_array(Layout::lines);
  for (const std::string& warning : study.warnings) json.value(warning);
  json.end_array();
}

}  // namespace cordon::detail
