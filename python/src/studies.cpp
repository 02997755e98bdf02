// SPDX-License-Identifier: GPL-3.0-or-later
// Studies: read, run, swept and verified.
#include <atomic>
#include <filesystem>
#include <functional>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <string>

#include "bindings.hpp"
#include "cordon/cordon.hpp"
#include "cordon/experiments/compare.hpp"
#include "cordon/experiments/report.hpp"
#include "cordon/experiments/sweep.hpp"
#include "cordon/study/run.hpp"
#include "cordon/study/verify.hpp"
#include "study_handle.hpp"

namespace cordon::python {

namespace {

/// Passes progress to a function of Python's, and hears of Ctrl-C there.
class Watch {
 public:
  explicit Watch(py::object tell) : tell_(std::move(tell)) {}

  const std::atomic<bool>* stop() const { return &stop_; }

  template <class... Numbers>
  void tell(Numbers... numbers) {
    const py::gil_scoped_acquire locked;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      raise_interruption();
      if (!tell_.is_none()) tell_(numbers...);
    } catch (py::error_already_set& error) {
      if (!failure_) failure_ = std::move(error);
      stop_ = true;
    }
  }

  /// Throws on what stopped the work.
  void finish() {
    if (failure_) throw *std::exchange(failure_, std::nullopt);
  }

 private:
  py::object tell_;
  std::atomic<bool> stop_ = false;
  std::optional<py::error_already_set> failure_;
};

StudyHandle read(const std::string& text, const std::filesystem::path& file,
                 const std::vector<std::string>& settings, bool needs_data, bool trusts_plugins) {
  return unlocked([&] {
    return std::make_shared<const Study>(
        read_study_text(text, file, installed_components(), default_search_path(),
                        trusts_plugins ? StudyPlugins::load : StudyPlugins::refuse,
                        needs_data ? StudyData::needed : StudyData::optional, settings));
  });
}

py::dict run(const StudyHandle& study, const std::filesystem::path& out, const std::string& sets,
             const std::string& pipeline, bool report, py::object progress) {
  Watch watch(std::move(progress));
  RunOptions options;
  options.out = out;
  options.pipeline = pipeline;
  options.sets = sets == "all" ? KeptSets::all : sets == "last" ? KeptSets::last : KeptSets::none;
  options.stop = watch.stop();
  options.progress = [&](std::size_t index, std::int64_t done, std::int64_t total) {
    watch.tell(index, done, total);
  };
  if (report) options.report = add_report;
  const RunOutcome outcome =
      unlocked([&] { return run_study(*study, installed_components(), options); });
  watch.finish();
  py::list pipelines;
  for (const PipelineOutcome& found : outcome.pipelines) {
    py::dict one;
    one["name"] = found.name;
    one["error"] = found.error;
    one["violated_at"] = found.violated_at;
    pipelines.append(one);
  }
  py::dict made;
  made["pipelines"] = pipelines;
  made["files"] = outcome.files;
  made["report_error"] = outcome.report_error;
  return made;
}

py::dict sweep(const StudyHandle& study, const std::filesystem::path& out, int jobs, bool resume,
               bool report, py::object progress) {
  Watch watch(std::move(progress));
  SweepOptions options;
  options.out = out;
  options.jobs = jobs;
  options.resume = resume;
  options.report = report;
  options.stop = watch.stop();
  options.progress = [&](const SweepProgress& now) { watch.tell(0, now.done, now.total); };
  const SweepOutcome outcome =
      unlocked([&] { return run_sweep(*study, installed_components(), options); });
  watch.finish();
  py::dict made;
  made["points"] = outcome.progress.total;
  made["failed"] = outcome.progress.failed;
  made["violated"] = outcome.violated;
  made["files"] = outcome.files;
  return made;
}

py::dict counts_of(const VerifiedPipeline& found) {
  py::dict made;
  made["name"] = found.name;
  made["steps"] = found.steps;
  made["by_polytopes"] = found.by_polytopes;
  made["by_supports"] = found.by_supports;
  made["proofs"] = found.proofs;
  made["exclusions"] = found.exclusions;
  made["states"] = found.states;
  made["exact_claims"] = found.exact_claims;
  made["undecided"] = found.undecided;
  made["first_undecided"] = found.first_undecided;
  return made;
}

py::dict verify(const std::filesystem::path& directory, std::int64_t every, py::object progress) {
  Watch watch(std::move(progress));
  VerifyOptions options;
  options.every = every;
  options.stop = watch.stop();
  options.progress = [&](const std::vector<std::string>&, std::size_t index, std::int64_t done,
                         std::int64_t total) { watch.tell(index, done, total); };
  const VerifyOutcome outcome = unlocked([&] { return verify_run(directory, options); });
  watch.finish();
  py::dict made;
  py::list pipelines;
  for (const VerifiedPipeline& found : outcome.pipelines) pipelines.append(counts_of(found));
  made["pipelines"] = pipelines;
  made["violation"] = py::none();
  if (const auto& violation = outcome.violation) {
    py::dict told;
    told["pipeline"] = violation->pipeline;
    told["k"] = violation->k;
    told["what"] = violation->what;
    told["pointer"] = violation->pointer;
    made["violation"] = told;
  }
  return made;
}

/// A row per number, pipeline, combination of values and run.
py::dict compare(const std::vector<std::filesystem::path>& directories) {
  const Comparison found = unlocked([&] { return compare_results(directories); });
  py::list runs, rows;
  for (const ComparedRun& run : found.runs) runs.append(run.directory);
  for (const ComparedMeasure& measure : found.measures) {
    for (const ComparedRow& row : measure.rows) {
      for (std::size_t i = 0; i < row.runs.size(); ++i) {
        const ComparedNumber& number = row.runs[i];
        rows.append(py::make_tuple(measure.column.name, measure.column.measured, row.pipeline,
                                   row.at, i, number.statistics.mean, number.different,
                                   number.ratio, number.test && number.test->significant()));
      }
    }
  }
  py::dict made;
  made["runs"] = runs;
  made["axes"] = found.axes;
  made["rows"] = rows;
  made["warnings"] = found.warnings;
  return made;
}

}  // namespace

void bind_studies(py::module_& module) {
  py::class_<Study, std::shared_ptr<Study>>(module, "Study")
      .def_property_readonly("title", [](const Study& study) { return study.title; })
      .def_property_readonly("resolved", [](const Study& study) { return study.resolved; })
      .def_property_readonly("warnings", [](const Study& study) { return study.warnings; })
      .def_property_readonly("has_sweep", [](const Study& study) { return !study.sweep.empty(); })
      .def_property_readonly("pipelines", [](const Study& study) {
        std::vector<std::string> names;
        for (const PipelineSpec& spec : study.pipelines) names.push_back(spec.name);
        return names;
      });
  module.def("read_study", &read);
  module.def("run", &run);
  module.def("sweep", &sweep);
  module.def("verify", &verify);
  module.def("compare", &compare);
}

}  // namespace cordon::python
