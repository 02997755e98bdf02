// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a run, streamed. All but run.json are the same byte for byte when a run is repeated.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "cordon/study/run.hpp"
#include "study/results/diagnosis_json.hpp"
#include "study/results/metric_board.hpp"
#include "study/results/summaries.hpp"
#include "study/text/atomic_directory.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

/// What is written about one step.
struct StepResult {
  const Estimate& estimate;
  const Box& hull;
  const std::vector<Certificate>&
      hull_proofs;                  ///< two per coordinate: of the upper and of the lower bound
  const std::optional<Box>& inner;  ///< if the observer offers one
  const MetricValues& metrics;
  const PhaseTimes& times;
  double hull_us;
  const std::vector<Index>& left_out;  ///< outputs of the sample
};

/// The same of a diagnosis.
struct DiagnosisResult {
  const Diagnosis& diagnosis;
  const std::optional<Index>& truth;  ///< the true mode
  const std::vector<JudgedBound>& faults;
  double step_us;
};

/// What a pipeline takes for granted beyond the model's W and V.
struct Assumptions {
  LineForm initial_set;
  std::optional<LineForm> admissible_set;
  bool follows_its_sets = false;             ///< as the observer says
  std::optional<LineForm> restart_set = {};  ///< where it begins anew after an empty estimate
  Index lag = 0;                             ///< of estimates behind the samples
};

class SetsFile;

/// Writes into `out`:
///   results.json  resolved study, versions, and per pipeline gains, steps[] {k, hull, consistent,
///   tightness, metrics}, last
///                 and summary
///   sets.jsonl    one line per step and pipeline: the estimate's exchange form, the proofs of its
///   emptiness or non-emptiness and of its
///                 hull's bounds
///   data.csv      the samples, and the truth where it is known
///   steps.csv, summary.csv   the same numbers as tables (∞ as inf, absent values as empty fields)
///   diagnosis.csv the steps of pipelines with a diagnoser, if there are any (their steps[] in
///   results.json hold decisions) inputs.csv    the designed inputs, if there are pipelines with a
///   designer summary.tex, summary.md, benchmarks.csv   the summaries as tables to print, with
///   times run.json      host, times, and what else differs from run to run manifest.json which
///   files these are
/// Nothing is visible under its name before `commit`, and then all is.
class Results {
 public:
  /// Into the directory of `out`, which lives longer.
  Results(const Study& study, const Registry& registry, const DirectoryLock& out,
          const RunOptions& options);
  ~Results();

  /// `samples`: how many there will be; 0: not known.
  void begin_estimation(const PipelineSpec& spec, std::optional<Rounding> rounding,
                        const std::optional<Assumptions>& assumptions,
                        const std::vector<Gain>& gains, std::int64_t samples);
  /// Every pipeline hands over its records; each is written once.
  void data(const Record& record);
  /// Throws Errc::plugin, before anything is written, if the metrics have names that they had not
  /// in an earlier pipeline.
  void check_columns(const MetricValues& metrics);
  void estimate(const StepResult& result);
  void end_estimation(const PipelineOutcome& outcome, const MetricValues& summary);

  /// The same of a pipeline with a diagnoser.
  void begin_diagnosis(const PipelineSpec& spec, std::optional<Rounding> rounding,
                       const DiagnosisOutcome& outcome);
  void diagnosis(const DiagnosisResult& result);
  void end_diagnosis(const PipelineOutcome& outcome);

  /// All of a pipeline with a designer.
  void design(const PipelineSpec& spec, std::optional<Rounding> rounding,
              const PipelineOutcome& outcome);

  std::vector<std::filesystem::path> commit(const RunOutcome& outcome);

 private:
  void begin_results(const Registry& registry);
  void begin_run(const Registry& registry);
  /// Heads of the pipeline in results.json and run.json: what it is made of.
  void begin_pipeline(const PipelineSpec& spec, std::optional<Rounding> rounding);
  void write_set(const StepResult& result);
  void write_row(const StepResult& result);
  void write_header(Index states);
  void write_diagnosis_header(std::size_t modes);
  void write_summaries();

  const Study& study_;
  AtomicDirectory directory_;
  OutputFile& data_file_;
  std::unique_ptr<SetsFile> sets_;
  OutputFile& steps_file_;
  OutputFile& summary_file_;
  OutputFile* diagnosis_file_ = nullptr;  ///< if there are diagnosers
  OutputFile* inputs_file_ = nullptr;     ///< if there are designers
  TableFiles tables_;
  OutputFile& run_file_;
  OutputFile& results_file_;
  JsonWriter results_, run_;
  std::string pipeline_;  ///< name of the current one, as a CSV field
  std::string pipeline_json_;
  std::optional<std::vector<std::string>>
      columns_;  ///< of metrics in steps.csv, from the first step
  bool header_written_ = false, diagnosis_header_written_ = false, with_mode_ = false;
  std::vector<std::string> modes_;    ///< names, in a diagnosis
  std::optional<Index> last_sample_;  ///< the last k in data.csv
  Index last_estimate_ = 0;           ///< k of the last step
  struct Summary {
    std::vector<std::string> fields = {};  ///< of the columns that every pipeline has
    std::map<std::string, std::string> metrics = {};
    std::vector<std::string> diagnosis = {};  ///< none of pipelines without a diagnoser
    std::vector<std::string> design = {};     ///< none of pipelines without a designer
  };
  /// Ends the summary of results.json, and the pipeline in all files.
  void end_pipeline(const PipelineOutcome& outcome, Summary row,
                    const std::vector<MetricValue>& measured = {});
  std::vector<Summary> summaries_;
  std::vector<std::string> summary_columns_;
  std::optional<Rounding> rounding_;
};

}  // namespace cordon::detail
