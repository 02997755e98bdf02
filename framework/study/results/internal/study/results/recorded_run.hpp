// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a finished run, read with every size and number checked.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/interfaces/diagnoser.hpp"
#include "cordon/study/design.hpp"
#include "cordon/study/pipeline_task.hpp"
#include "cordon/study/study.hpp"
#include "study/results/recorded_assumption.hpp"
#include "study/text/input_file.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/manifest.hpp"

namespace cordon::verification {

/// One entry of steps[] in results.json.
struct RecordedStep {
  Index k = 0;
  Box hull;
  Answer consistent = Answer::unknown;
  Tightness tightness = Tightness::outer;
  int line = 0;                      ///< of the file
  std::vector<Index> left_out = {};  ///< outputs of the sample, ascending
};

struct RecordedEstimation {
  /// Each set holds all successors of the one before that are consistent with the data. Observers
  /// that know more than their last set, as a bound of their error for all times, may keep to less.
  bool follows_its_sets = false;
  Index lag = 0;  ///< of steps behind the samples; those of the last so many times are not there
  LineForm initial_set;
  std::optional<LineForm> admissible_set;
  std::optional<LineForm> restart_set = {};  ///< where it begins anew after an empty estimate
  bool has_outliers = false;  ///< outputs of some samples are left out, as the summary says
  std::vector<RecordedStep> steps = {};
  std::vector<Diagnostic> contradictions = {};  ///< where the summary says what the steps do not

  /// Does the observer begin anew with step i > 0?
  bool begins_anew(std::size_t i) const {
    return restart_set && i > 0 && steps[i - 1].consistent == Answer::no;
  }
  bool leaves_out() const {
    for (const RecordedStep& step : steps) {
      if (!step.left_out.empty()) return true;
    }
    return false;
  }
};

/// No sets are stored: which modes are excluded when, and where the state is said to be.
struct RecordedDiagnosis {
  struct Step {
    Index k = 0, since = 0;
    bool reset = false;
    std::string mode = {};                            ///< "" for none
    std::vector<char> candidate = {}, excluded = {};  ///< by mode; excluded by this step
    int line = 0;                                     ///< of the file
    /// Of a reset: what modes begin anew from; none: what is assumed of them.
    std::vector<LineForm> restarts = {};
  };
  /// A box that holds the state as long as the plant is in the mode.
  struct Estimate {
    Index k = 0, mode = 0;
    Box hull;
    std::string pointer;
  };
  /// What the summary says of a mode at one time.
  struct Event {
    Index k = 0, mode = 0;
    bool isolates = false;  ///< else it excludes
    std::string pointer;
  };
  std::optional<DiagnosisAssumptions> assumptions;  ///< none: nothing can be checked
  std::vector<Step> steps;
  std::vector<Estimate> estimates;
  std::vector<Event> events;
};

struct RecordedDesign {
  /// Horizon, input, what is said of pairs and tubes; nothing: there is no input.
  std::optional<DesignOutcome> design;
  /// What results say of the design: the designer, and what the host has proven of its pairs and
  /// tubes.
  Answer claimed_separation = Answer::unknown, proven_separation = Answer::unknown;
  std::optional<InputDesign> proven;
  std::vector<std::string> refuted;  ///< what of the answer the run found to be false
};

struct RecordedPipeline : PipelineTask<RecordedEstimation, RecordedDiagnosis, RecordedDesign> {
  std::string name = {}, backend = {};
  std::optional<RecordedAssumption> failed = {};  ///< that the run found to fail
  Rounding rounding = Rounding::nominal;
  bool stopped = false;  ///< by an error, perhaps before the end of the data
};

/// One line of sets.jsonl.
struct RecordedSet {
  std::string pipeline;
  Index k = 0;
  Tightness tightness = Tightness::outer;  ///< like `consistent`, as in the step
  Answer consistent = Answer::unknown;
  bool exact_exchange = true;  ///< `set` is the reported set, without inequalities
  LineForm set;
  Inequalities rows;  ///< that hold for the reported set
  /// Is the form larger than the set by more than rounding?
  bool is_cut() const { return rows.rows() > 0; }
  Certificate proof;
  std::vector<Certificate> hull_proofs;  ///< two per coordinate; none for an empty set
  std::int64_t line = 0;
};

struct RecordedRun {
  detail::RecordedFiles files;
  Model model;
  ModeBank bank;
  Labels labels;
  CsvSpec data;  ///< data.csv
  std::vector<RecordedPipeline> pipelines;
};

/// A set in exchange form, as results files write it.
std::optional<LineForm> read_form(const json::Cursor& at, std::optional<Index> dim);

/// All but the sets. Throws InputError.
RecordedRun read_run(const std::filesystem::path& directory);

/// Streams sets.jsonl.
class SetReader {
 public:
  explicit SetReader(const detail::RecordedFiles& files);
  /// The next line; nothing at the end, where `files` must be unchanged. Lines of times that are
  /// not `wanted` are passed over unread. Throws InputError.
  std::optional<RecordedSet> next(const std::function<bool(Index)>& wanted = {});

 private:
  const detail::RecordedFiles& files_;
  detail::InputFile input_;
};

}  // namespace cordon::verification
