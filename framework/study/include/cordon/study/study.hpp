// SPDX-License-Identifier: GPL-3.0-or-later
// A study: one system, its data, and pipelines that are compared on them. Read from a JSON file
// (docs/study_format.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cordon/interfaces/model.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/study/labels.hpp"
#include "cordon/study/pipeline_task.hpp"

namespace cordon {

/// A known input channel over time; time is k, angles are radians.
struct Signal {
  enum class Type {
    constant,  ///< offset
    sine,      ///< offset + amplitude sin(omega k + phase)
    cosine,    ///< offset + amplitude cos(omega k + phase)
    step,      ///< offset, from k = `from` on offset + amplitude
    square,    ///< offset ± amplitude, period `period`, first half positive
    prbs,      ///< offset ± amplitude, pseudo-random, held for `period` steps, from the seed
    table      ///< values[k], the last value held
  };
  Type type = Type::constant;
  double offset = 0, amplitude = 0, omega = 0, phase = 0;
  std::int64_t from = 0, period = 1, seed = 0;
  Vector values;
};

/// How the bounded disturbances are drawn: uniform in the generators' factors, at random vertices
/// of the factor box, all zero (the centre), or as sines of different frequency per factor.
enum class Noise { uniform, vertex, zero, sine };

/// A fault of simulated data: for k = from … to, x_{k+1} and y_k are made with `model`. W, V and
/// effectiveness are drawn from its sets. Of a descriptor system the equation E x_{k+1} = …, static
/// rows included, is the fault's.
struct FaultSpec {
  std::int64_t from = 0;
  std::int64_t to = std::numeric_limits<std::int64_t>::max();
  std::string name;  ///< for people: the mode's, or the fault's own
  Index mode = -1;   ///< index in the study's bank; -1: outside the bank
  Model model;
  /// The whole effectiveness, of which `model` has the exact part in its matrices: what a `plant`
  /// is simulated with. Dimension 0: exactly 1.
  Box actuator = {}, sensor = {};
  /// Where formulas make the data: the mode of the same name of theirs.
  std::optional<Model> formulas = {};
};

/// An additive fault of simulated data: for k = from … to, n_k of the fault is the signal's value
/// at k, to which other entries of the same fault add theirs; it is 0 otherwise. F n_k acts on E
/// x_{k+1} = …, static rows included.
struct AdditiveFaultSpec {
  Index fault = 0;  ///< column of F; in studies counted from 1
  std::int64_t from = 0;
  std::int64_t to = std::numeric_limits<std::int64_t>::max();
  Signal signal = {};
};

/// Samples of simulated data that lack outputs: for k = from … to the outputs are missing at each
/// step with this probability, each by itself; but for every `every`-th step from `from` on, where
/// they are there (0: none is). An output that several dropouts take is missing where one of them
/// says so.
struct DropoutSpec {
  std::vector<Index> outputs;  ///< rows of C; in studies counted from 1
  std::int64_t from = 0;
  std::int64_t to = std::numeric_limits<std::int64_t>::max();
  double probability = 1;
  std::int64_t every = 0;
};

/// Samples of simulated data with outputs that are wrong: at the times that are drawn as those of
/// dropouts are, y_i is larger or smaller by `shift`, as a coin falls, and does not keep to V.
struct OutlierSpec {
  DropoutSpec when;
  double shift = 0;
};

/// What the matrices of an uncertain model are in a simulation; drawn by the kind of its noise:
/// uniform in their intervals, at vertices, or in the middle (zero, sine).
enum class ParameterDraw {
  constant,  ///< drawn once: parameters that do not change
  varying    ///< drawn anew at every step
};

/// Simulated data: x_{k+1}, y_k from the model or what stands in its place, seeded and identical on
/// every machine.
struct SimulateSpec {
  std::int64_t steps = 0;  ///< samples k = 0 … steps
  std::uint64_t seed = 1;
  Noise noise = Noise::uniform;
  /// In place of x0: it is drawn from this set, by the kind of the noise and the seed. Of a
  /// descriptor system the part of the draw that E determines is taken, and draws are repeated
  /// until the whole state lies in the set.
  std::optional<LineForm> x0_set = {};
  std::optional<Vector> x0;   ///< default: the centre of X0. Descriptor systems: must meet the
                              ///< static rows for some w_0 ∈ W
  std::vector<Signal> input;  ///< one per input channel
  std::vector<FaultSpec>
      faults;  ///< in order of time, without overlap; between them the plant is in the nominal mode
  std::optional<ComponentSpec> plant;  ///< in place of the linear model
  std::shared_ptr<const Plant> made_plant;
  std::shared_ptr<const Model> formulas =
      {};  ///< the same as a system by formulas, with its bounds
  std::vector<AdditiveFaultSpec> additive_faults = {};
  ParameterDraw parameters = ParameterDraw::constant;
  std::int64_t seeds = 1;  ///< diagnosers are tried on the seeds seed … seed + seeds - 1
  std::vector<DropoutSpec> dropouts = {};
  std::vector<OutlierSpec> outliers = {};
};

/// What an output without a value, an empty field or NaN, is in recorded data.
enum class MissingValue {
  error,  ///< the file is refused
  skip    ///< missing in this sample
};

/// What rows are whose times leave steps out.
enum class IrregularRows {
  error,  ///< the file is refused
  gaps    ///< steps without outputs; the input is that of the row before
};

/// Recorded data: a CSV file with a header row and named columns.
struct CsvSpec {
  std::filesystem::path file;  ///< absolute, or relative to the study's folder (resolved when read)
  std::vector<std::string> inputs, outputs, truth;  ///< column names; truth may be empty
  std::string mode = {};  ///< column with the names of the true modes; empty: not known
  MissingValue missing = MissingValue::error;
  std::string time = {};  ///< column of times in seconds; empty: rows are the steps
  IrregularRows irregular = IrregularRows::error;
};

/// What follows an estimate that is proven empty.
enum class OnEmpty {
  stop,    ///< it stays empty
  restart  ///< the observer begins anew from a set, with the next sample
};

/// What follows where an estimate has no bounded enclosure by formulas.
enum class OnNotEnclosed {
  stop,    ///< the pipeline ends
  restart  ///< the observer begins anew from the system's admissible set, with this sample
};

struct EstimationSpec {
  ComponentSpec observer;
  OnEmpty on_empty = OnEmpty::stop;
  OnNotEnclosed on_not_enclosed = OnNotEnclosed::stop;
  LineForm restart_set = {};        ///< holds the state where the observer begins anew
  std::int64_t outliers = 0;        ///< samples of which outputs may be left out
  std::int64_t outlier_window = 1;  ///< in so many that follow each other
};

struct DiagnosisSpec {
  ComponentSpec diagnoser;
};

/// The pipeline has an input of its own: the designed one.
struct DesignSpec {
  ComponentSpec designer;
  std::optional<ComponentSpec> diagnoser = {};  ///< tried in experiments with that input
};

struct PipelineSpec : PipelineTask<EstimationSpec, DiagnosisSpec, DesignSpec> {
  std::string name = {};
  ComponentSpec backend = {};
  /// That a step may begin at most, and each mode of a bank; what they leave open is `unknown`.
  std::optional<std::int64_t> max_programs = {};
};

/// The components of a pipeline beside its backend, under the keys that studies give them:
/// observer, diagnoser, or designer and perhaps diagnoser.
std::vector<std::pair<std::string, const ComponentSpec*>> algorithms_of(const PipelineSpec& spec);

/// What becomes of samples that leave times out.
enum class JumpRule {
  refuse,  ///< they are refused
  fill     ///< the times between have no outputs, and the input of the sample before
};

/// What becomes of outputs of times that have passed.
enum class LateRule {
  drop,    ///< they are counted, and left out
  correct  ///< the past is taken again with them, if it is not longer ago than the lag
};

/// What becomes of a sample that brings nothing that was not known.
enum class RepeatRule {
  refuse,  ///< it is answered as an error
  ignore   ///< it is counted, and left out
};

/// How samples on line may miss the order of times (docs/online.md).
struct OnlineSpec {
  JumpRule jumps = JumpRule::refuse;
  std::int64_t longest_gap = 1000;  ///< times that are filled at most; longer jumps are refused
  LateRule late = LateRule::drop;
  std::int64_t lag = 10;  ///< samples that late outputs may lie behind the last one
  RepeatRule repeated = RepeatRule::refuse;
  double clock_tolerance = 0.01;  ///< of a sampling time, that times may miss the plant's by
  double clock_drift = 0.001;     ///< share by which the clock may run fast or slow
};

/// One axis of a sweep: each of its values takes the place of what stands at `path`, in every place
/// that the path matches.
struct SweepAxis {
  std::string name;
  std::string path;  ///< JSON pointer into the study, "*" for every element; or a JSON list of them
  std::vector<std::string> values;  ///< JSON texts, none twice
  bool repeat = false;  ///< repetitions, seeds for example: statistics are taken over this axis
  std::vector<std::string> labels = {};  ///< what the values are called; empty: they have no names
};

/// Of a study with a sweep everything but `sweep` is that of the first values of all axes.
struct Study {
  std::filesystem::path file;
  std::string title;
  Model model;                              ///< of the nominal mode
  std::optional<ComponentSpec> plant = {};  ///< that the system is: the model has its formulas
  std::string nominal = "healthy";          ///< its name
  std::vector<Mode> modes;                  ///< the other modes
  Labels labels = {};                       ///< what states, inputs and so on are called
  bool continuous = false;  ///< the model was written in continuous time, and is sampled here
  std::variant<SimulateSpec, CsvSpec>
      data;  ///< pipelines with a designer take seed, seeds, noise and start of simulated data
  bool has_data = false;  ///< the file has them
  std::vector<PipelineSpec> pipelines;
  std::vector<ComponentSpec> metrics;
  OnlineSpec online = {};
  std::vector<SweepAxis> sweep = {};  ///< in order; the grid of points is described in sweep.hpp
  std::shared_ptr<const std::string> source = {};  ///< the text of the file
  std::vector<std::string> warnings;  ///< e.g. a refused plugin that the study does not need
  std::string resolved;  ///< the study as JSON with every default, for the results file
};

/// The nominal mode first, then the others in the order of the study.
ModeBank bank_of(const Study& study);

/// What becomes of plugins in directories that a study names. Plugins are programs, and a study may
/// come from anywhere: directories count as trusted if they are on `path` or the registry was told
/// to search them before. The others are
enum class StudyPlugins {
  refuse,  ///< reported, each with its place, and nothing of them is loaded
  ignore,  ///< not loaded, with a warning each; components found nowhere else are reported as not
           ///< checked
  load     ///< trusted too
};

/// Must a study have data where its pipelines take samples?
enum class StudyData {
  needed,
  needed_unless_online,  ///< not where it says how samples come on line
  optional               ///< not for what is asked of models alone
};

/// Reads, loads plugins from the directories that the study names, as far as `plugins` says, and
/// then from `path` (the first plugin of a name wins), validates against the registry, and
/// resolves. Throws InputError with every problem at once (pointer, line, reason, suggestion), or
/// Errc::plugin if nothing is wrong but components that are missing because their plugin was
/// refused, or directories that are not trusted. Writes nothing. `settings`, "/path=value" each,
/// take the place of what the file has there: paths are those of sweeps, values JSON or texts.
Study read_study(const std::filesystem::path& file, Registry& registry,
                 const SearchPath& path = default_search_path(),
                 StudyPlugins plugins = StudyPlugins::refuse, StudyData data = StudyData::needed,
                 const std::vector<std::string>& settings = {});

/// The same of a study that is a text in memory. `file` is its name in messages, and its folder is
/// where the files are looked for that it names; no such file is opened.
Study read_study_text(const std::string& text, const std::filesystem::path& file,
                      Registry& registry, const SearchPath& path = default_search_path(),
                      StudyPlugins plugins = StudyPlugins::refuse,
                      StudyData data = StudyData::needed,
                      const std::vector<std::string>& settings = {});

/// JSON Schema (2020-12) of study files, with the components that the registry knows. For editors.
std::string study_json_schema(const Registry& registry);

}  // namespace cordon
