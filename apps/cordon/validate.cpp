// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "cordon/experiments/sweep.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"
#include "json_text.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

struct ValidateArguments {
  std::vector<std::string> studies;
  bool json = false;
};

std::string describe_system(const Study& study) {
  const LinearModel& model = study.model.linear;
  const std::string faults =
      model.faults() > 0 ? ", " + count(model.faults(), "additive fault") : "";
  const std::string sampled =
      study.continuous
          ? fmt::format(", sampled every {:.6g} s from continuous time (W then has {})",
                        study.labels.sampling_time, count(study.model.W.generators(), "generator"))
          : "";
  std::string kind = model.is_descriptor() ? "descriptor" : "lti";
  if (!study.model.is_linear()) kind = "nonlinear";
  if (study.plant) kind += " (" + study.plant->type + ")";
  return fmt::format("{}{}, {}, {}, {}, {}, {}{}{}", model.is_uncertain() ? "uncertain " : "", kind,
                     count(study.model.states(), "state"), count(study.model.inputs(), "input"),
                     count(study.model.outputs(), "output"),
                     count(study.model.disturbances(), "disturbance"),
                     count(study.model.noises(), "noise"), faults, sampled);
}

constexpr std::int64_t most_samples = 1'000'000, most_simulated = 10'000;  // that are looked at

/// ": 241 samples over 1200 s; gauge 1 is missing in 12, nothing is there in 3".
std::string describe_samples(const Study& study, const DataOverview& data) {
  const Labels& labels = study.labels;
  std::string text =
      fmt::format(": {}{}", data.is_whole ? "" : "more than ", count(data.samples, "sample"));
  if (data.is_whole && labels.sampling_time > 0)
    text += fmt::format(" over {:.6g} s", static_cast<double>(data.last) * labels.sampling_time);
  std::string gaps;
  const auto add = [&](const std::string& what, std::int64_t times) {
    if (times > 0) gaps += fmt::format("{}{} in {}", gaps.empty() ? "; " : ", ", what, times);
  };
  for (std::size_t i = 0; i < data.missing.size(); ++i)
    add(label_of(labels.outputs, "y", static_cast<Index>(i)) + " is missing",
        data.missing[i] - data.empty);
  add("all outputs are missing", data.empty);
  return text + gaps;
}

/// Has it pipelines that take samples?
bool takes_samples(const Study& study) {
  return std::any_of(study.pipelines.begin(), study.pipelines.end(),
                     [](const PipelineSpec& pipeline) { return !pipeline.design(); });
}

std::string describe_data(const Study& study, const DataOverview& data) {
  if (const auto* simulate = std::get_if<SimulateSpec>(&study.data)) {
    const std::string by = simulate->plant      ? " by " + simulate->plant->type
                           : simulate->formulas ? " by formulas"
                                                : "";
    const std::uint64_t first = simulate->seed,
                        last = first + static_cast<std::uint64_t>(simulate->seeds) - 1;
    const std::string seeds =
        last == first ? fmt::format("seed {}", first) : fmt::format("seeds {} to {}", first, last);
    if (!takes_samples(study))
      return "experiments with every mode and the designed inputs, " + seeds;
    if (!study.has_data) return "none: samples come on line";
    return fmt::format("simulated{}, {}, {}", by, count(simulate->steps, "step"), seeds);
  }
  return "recorded, " + std::get<CsvSpec>(study.data).file.string() + describe_samples(study, data);
}

/// "weak from k = 3 to 5"; the last one may have no end.
std::string describe_fault(const Study& study, const FaultSpec& fault, std::int64_t steps) {
  const std::string until = fault.to < steps ? fmt::format(" to {}", fault.to) : "";
  return fmt::format("{} from {}{}{}", fault.name, time_text(study.labels, fault.from), until,
                     fault.mode < 0 ? " (not in the bank)" : "");
}

/// "outputs 1, 2 from k = 3 to 5, with probability 0.3, spared every 5 steps".
std::string describe_dropout(const Labels& labels, const DropoutSpec& dropout, std::int64_t steps) {
  std::vector<std::string> outputs;
  for (const Index output : dropout.outputs) {
    outputs.push_back(labels.outputs.empty() ? fmt::format("{}", output + 1)
                                             : label_of(labels.outputs, "y", output));
  }
  std::string text = fmt::format("{} {} from {}", outputs.size() == 1 ? "output" : "outputs",
                                 fmt::join(outputs, ", "), time_text(labels, dropout.from));
  if (dropout.to < steps) text += fmt::format(" to {}", dropout.to);
  if (dropout.probability < 1) text += fmt::format(", with probability {}", dropout.probability);
  if (dropout.every > 0) text += fmt::format(", spared every {}", count(dropout.every, "step"));
  return text;
}

std::string describe_modes(const Study& study) {
  std::string text;
  if (!study.modes.empty()) {
    std::vector<std::string> names{study.nominal};
    for (const Mode& mode : study.modes) names.push_back(mode.name);
    text += fmt::format("  modes     {}\n", fmt::join(names, ", "));
  }
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  if (!simulate) return text;
  const char* label = "faults";
  for (const FaultSpec& fault : simulate->faults) {
    text += fmt::format("  {:<9} {}\n", label, describe_fault(study, fault, simulate->steps));
    label = "";
  }
  label = "additive";
  for (const AdditiveFaultSpec& fault : simulate->additive_faults) {
    const std::string until = fault.to < simulate->steps ? fmt::format(" to {}", fault.to) : "";
    const std::string name = study.labels.faults.empty()
                                 ? fmt::format("fault {}", fault.fault + 1)
                                 : label_of(study.labels.faults, "n", fault.fault);
    text += fmt::format("  {:<9} {} from {}{}\n", label, name, time_text(study.labels, fault.from),
                        until);
    label = "";
  }
  label = "dropouts";
  for (const DropoutSpec& dropout : simulate->dropouts) {
    text += fmt::format("  {:<9} {}\n", label,
                        describe_dropout(study.labels, dropout, simulate->steps));
    label = "";
  }
  label = "outliers";
  for (const OutlierSpec& outlier : simulate->outliers) {
    text +=
        fmt::format("  {:<9} {}, off by {}\n", label,
                    describe_dropout(study.labels, outlier.when, simulate->steps), outlier.shift);
    label = "";
  }
  return text;
}

std::vector<std::string> components_of(const PipelineSpec& pipeline) {
  std::vector<std::string> names{pipeline.backend.type};
  for (const auto& [kind, component] : algorithms_of(pipeline)) names.push_back(component->type);
  return names;
}

/// "generators: 3 values; seed: 50 values, repeated", and how many points that makes with the
/// pipelines.
std::string describe_sweep(const Study& study) {
  std::vector<std::string> axes;
  auto points = static_cast<std::int64_t>(study.pipelines.size());
  for (const SweepAxis& axis : study.sweep) {
    const auto size = static_cast<Index>(axis.values.size());
    points *= size;
    axes.push_back(
        fmt::format("{}: {}{}", axis.name, count(size, "value"), axis.repeat ? ", repeated" : ""));
  }
  return axes.empty()
             ? ""
             : fmt::format("  sweep     {}\n  points    {}\n", fmt::join(axes, "; "), points);
}

std::string describe(const Study& study, const DataOverview& data) {
  const Paint paint(stdout);
  std::string text = fmt::format("{}: {}\n  title     {}\n  system    {}\n  data      {}\n",
                                 study.file.string(), paint.green("ok"), study.title,
                                 describe_system(study), describe_data(study, data));
  text += describe_modes(study);
  const char* label = "pipelines";
  for (const PipelineSpec& pipeline : study.pipelines) {
    text += fmt::format("  {:<9} {}: {}\n", label, pipeline.name,
                        fmt::join(components_of(pipeline), ", "));
    label = "";
  }
  std::vector<std::string> metrics;
  for (const ComponentSpec& metric : study.metrics) metrics.push_back(metric.type);
  if (!metrics.empty()) text += fmt::format("  metrics   {}\n", fmt::join(metrics, ", "));
  return text + describe_sweep(study);
}

Json as_json(const Study& study, const std::vector<std::string>& warnings) {
  Json entry{{"file", study.file.string()},
             {"valid", true},
             {"warnings", warnings},
             {"errors", Json::array()}};
  entry["study"] = Json::parse(study.resolved);
  return entry;
}

void add_errors(Json& errors, const Error& error) {
  const auto* input = dynamic_cast<const InputError*>(&error);
  if (!input) errors.push_back({{"message", error.what()}});
  for (const Diagnostic& d : input ? input->diagnostics() : std::vector<Diagnostic>{}) {
    errors.push_back({{"file", input->file()},
                      {"pointer", d.pointer},
                      {"line", d.line},
                      {"message", d.message},
                      {"suggestion", d.suggestion}});
  }
}

/// What is wrong with the data, under every value of the axes that choose a file or its columns;
/// the same error once.
std::vector<std::exception_ptr> wrong_data(const Study& study, const Registry& registry) {
  constexpr std::size_t most = 1000;  // of one axis
  std::vector<std::exception_ptr> errors;
  std::set<std::string> known;
  const auto open = [&](const auto& made) {
    try {
      open_data(made());
    } catch (const Error& error) {
      if (known.insert(error.what()).second) errors.push_back(std::current_exception());
    }
  };
  if (!study.has_data && takes_samples(study)) return {};  // they come on line
  open([&] { return study; });
  for (std::size_t axis = 0; axis < study.sweep.size(); ++axis) {
    if (!study.sweep[axis].path.starts_with("/data/csv") && study.sweep[axis].path != "/data")
      continue;
    std::vector<std::size_t> at(study.sweep.size(), 0);
    for (at[axis] = 1; at[axis] < std::min(most, study.sweep[axis].values.size()); ++at[axis])
      open([&] { return study_at(study, at, registry); });
  }
  return errors;
}

/// Of data that nobody needs: nothing.
DataOverview overview_of(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  if (simulate && simulate->steps == 0) return {};  // of designers alone
  return overview_of_data(study, simulate ? most_simulated : most_samples);
}

/// Inputs that are known already to break an assumption.
std::vector<std::string> warnings_of(const Study& study, const DataOverview& data) {
  std::vector<std::string> all = study.warnings;
  if (!data.unused_time.empty()) {
    all.push_back(fmt::format(
        "the column \"{}\" of the data is not used: \"time\": \"{}\" in /data/csv would check "
        "that its rows are the steps",
        data.unused_time, data.unused_time));
  }
  if (data.outside_U == 0) return all;
  all.push_back(fmt::format(
      "{} of {}{} have inputs outside /system/U, the first at {}; what is promised in advance "
      "rests on U: widen it, or choose other inputs",
      data.outside_U, data.is_whole ? "" : "the first ", count(data.samples, "sample"),
      time_text(study.labels, data.first_outside_U)));
  return all;
}

/// Tells every error, as a text or in an entry for programs; the exit code is that of the first.
Exit refuse(const std::string& file, const std::vector<std::exception_ptr>& wrong, Json* entries) {
  std::optional<Exit> exit;
  Json entry{
      {"file", file}, {"valid", false}, {"warnings", Json::array()}, {"errors", Json::array()}};
  for (const std::exception_ptr& one : wrong) {
    try {
      std::rethrow_exception(one);
    } catch (const Error& error) {
      if (!exit) entry["code"] = to_string(error.code());
      add_errors(entry["errors"], error);
      const Exit its = entries ? exit_for(error.code()) : report_current_exception();
      if (!exit) exit = its;
    }
  }
  if (entries) entries->push_back(std::move(entry));
  return exit.value_or(Exit::done);
}

/// Reads one study and its data as `cordon run` would, but runs nothing, writes nothing, and opens
/// no plugin that only the study names.
Exit validate_one(const std::string& file, const Program& program, Json* entries) {
  try {
    Registry registry;
    registry.load(SearchPath{program.plugins});
    const StudyPlugins plugins = program.trust_plugins ? StudyPlugins::load : StudyPlugins::ignore;
    const Study study =
        read_study(file, registry, default_search_path(), plugins, StudyData::needed_unless_online);
    if (const auto wrong = wrong_data(study, registry); !wrong.empty())
      return refuse(file, wrong, entries);
    const DataOverview data = overview_of(study);
    const std::vector<std::string> warnings = warnings_of(study, data);
    if (entries) {
      entries->push_back(as_json(study, warnings));
    } else {
      for (const std::string& warning : warnings) warn(warning);
      print(describe(study, data));
    }
    return Exit::done;
  } catch (const Error&) {
    return refuse(file, {std::current_exception()}, entries);
  }
}

/// The exit code is that of the first study that fails; the others are looked at all the same.
Exit validate(const Program& program, const ValidateArguments& arguments) {
  Exit exit = Exit::done;
  Json entries = Json::array();
  for (const std::string& file : arguments.studies) {
    const Exit one = validate_one(file, program, arguments.json ? &entries : nullptr);
    if (exit == Exit::done) exit = one;
  }
  if (arguments.json) print(json_text(Json{{"studies", std::move(entries)}}));
  return exit;
}

}  // namespace

CORDON_COMMAND(validate) {
  CLI::App* command = app.add_subcommand(
      "validate", "Check study files and their data, and show every error at once");
  const auto arguments = std::make_shared<ValidateArguments>();
  command->add_option("STUDY", arguments->studies, "Study files (JSON)")->required();
  command->add_flag("--json", arguments->json,
                    "Print JSON for programs: errors, warnings, and the study with every default");
  command->footer(
      "Directories of plugins that only a study names are not opened: what needs their components "
      "is reported as not checked,\n"
      "with exit code 3. With --trust-plugins they are.");
  command->callback([&program, arguments] { program.exit = validate(program, *arguments); });
}

}  // namespace cordon::apps
