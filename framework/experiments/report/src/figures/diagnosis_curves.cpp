// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/diagnosis_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "figures/columns.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t max_spans = 4000;  ///< of a pipeline
constexpr std::size_t max_diagnosis_curves = 20'000;

class DiagnosisReader {
 public:
  DiagnosisReader(const RunFiles& files, DiagnosisTable& out)
      : files_(files), out_(out), table_(files.files().file("diagnosis.csv")) {
    name_ = table_.need("pipeline");
    k_ = table_.need("k");
    mode_ = table_.need("mode");
    truth_ = table_.need("truth");
    while (const auto candidate = table_.find("candidate_" + std::to_string(modes_.size()))) {
      const std::string number = std::to_string(modes_.size());
      modes_.push_back({*candidate, table_.numbered("lower_" + number + "_"),
                        table_.numbered("upper_" + number + "_")});
      if (modes_.back().lower.size() != modes_.back().upper.size())
        table_.refuse("does not have as many upper as lower bounds");
      if (modes_.back().lower.size() != modes_.front().lower.size())
        table_.refuse("has modes with different outputs");
    }
    for (const char* name : {"at", "lower", "estimate", "upper", "truth"}) {
      faults_.push_back(table_.numbered(std::string("fault_") + name + "_"));
      if (faults_.back().size() != faults_.front().size())
        table_.refuse("does not have all columns of every fault");
    }
    make_curves();
  }

  void read() {
    while (table_.next()) {
      const int pipeline = files_.pipeline(table_.text(name_), "diagnosis.csv");
      add(static_cast<std::size_t>(pipeline));
    }
    for (DiagnosisCurves& curves : out_.pipelines) {
      for (const auto& outputs : curves.residuals) {
        for (const Thinner& curve : outputs) out_.thinned = out_.thinned || curve.is_thinned();
      }
      for (const Thinner& curve : curves.faults) out_.thinned = out_.thinned || curve.is_thinned();
    }
  }

 private:
  struct ModeColumns {
    std::size_t candidate;
    std::vector<std::size_t> lower, upper;
  };

  void make_curves() {
    out_.modes = modes_.size();
    out_.outputs = modes_.empty() ? 0 : modes_.front().lower.size();
    out_.faults = faults_.front().size();
    const std::size_t pipelines = files_.pipelines().size();
    const std::size_t series = pipelines * (out_.modes * out_.outputs + 2 * out_.faults);
    if (series > max_diagnosis_curves) table_.refuse("holds more curves than a report can show");
    const Thinner curve(points_per_series(files_.detail(), series));
    DiagnosisCurves empty;
    empty.residuals.assign(out_.modes, std::vector<Thinner>(out_.outputs, curve));
    empty.faults.assign(out_.faults, curve);
    empty.fault_estimates.assign(out_.faults, curve);
    out_.pipelines.assign(pipelines, empty);
    out_.fault_truth.assign(out_.faults, curve);
    fault_told_.assign(out_.faults, -1);
    open_.assign(pipelines, std::vector<std::size_t>(out_.modes + 1, none));
    last_bound_.assign(pipelines, std::vector<std::int64_t>(out_.faults, -1));
    considered_.assign(pipelines, std::vector<bool>(out_.modes));
  }

  void add(std::size_t pipeline) {
    DiagnosisCurves& curves = out_.pipelines[pipeline];
    curves.any = true;
    const auto k = static_cast<double>(table_.integer(k_));
    const std::int64_t monitored = mode_of(mode_), truth = mode_of(truth_);
    for (std::size_t j = 0; j < modes_.size(); ++j) {
      const bool is_candidate = table_.text(modes_[j].candidate) == "1",
                 is_monitored = static_cast<std::int64_t>(j) == monitored;
      considered_[pipeline][j] = considered_[pipeline][j] || is_candidate || is_monitored;
      Timeline::State state = Timeline::State::excluded;
      if (!considered_[pipeline][j]) state = Timeline::State::unconsidered;
      if (is_candidate) state = Timeline::State::candidate;
      if (is_monitored) state = Timeline::State::monitored;
      extend(curves, open_[pipeline][j], {j, k, k, state}, curves.spans);
      for (std::size_t i = 0; i < out_.outputs; ++i) {
        double lower = table_.number(modes_[j].lower[i]), upper = table_.number(modes_[j].upper[i]);
        if (lower == -infinity && upper == infinity)  // a missing output: nothing is said
          lower = upper = std::numeric_limits<double>::quiet_NaN();
        curves.residuals[j][i].add(k, lower, upper);
      }
    }
    if (!table_.text(truth_).empty()) {
      const bool outside = truth < 0 || truth >= static_cast<std::int64_t>(modes_.size());
      extend(curves, open_[pipeline].back(),
             {outside ? modes_.size() : static_cast<std::size_t>(truth), k, k,
              outside ? Timeline::State::outside : Timeline::State::truth},
             curves.truth);
    }
    for (std::size_t i = 0; i < out_.faults; ++i) add_fault(curves, pipeline, i);
  }

  void add_fault(DiagnosisCurves& curves, std::size_t pipeline, std::size_t i) {
    if (table_.text(faults_[0][i]).empty()) return;
    const std::int64_t at = table_.integer(faults_[0][i]);
    const auto x = static_cast<double>(at);
    std::int64_t& last = last_bound_[pipeline][i];
    if (last >= 0 && at > last + 1) {  // nothing is said of the times between
      constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
      curves.faults[i].add(static_cast<double>(last + 1), nothing, nothing);
      curves.fault_estimates[i].add(static_cast<double>(last + 1), nothing);
    }
    last = at;
    curves.faults[i].add(x, table_.number(faults_[1][i]), table_.number(faults_[3][i]));
    curves.fault_estimates[i].add(x, table_.number(faults_[2][i]));
    if (at <= fault_told_[i]) return;  // an earlier pipeline has told it
    fault_told_[i] = at;
    out_.fault_truth[i].add(x, table_.number(faults_[4][i]));
  }

  std::int64_t mode_of(std::size_t column) const {
    return table_.text(column).empty() ? -1 : table_.integer(column);
  }

  void extend(DiagnosisCurves& curves, std::size_t& open, const Timeline::Span& now,
              std::vector<Timeline::Span>& spans) const {
    if (open != none && spans[open].row == now.row && spans[open].state == now.state) {
      spans[open].to = std::max(spans[open].to, now.to);
    } else if (spans.size() < max_spans) {
      open = spans.size();
      spans.push_back(now);
    } else {
      open = none;
      curves.spans_left_out = true;
    }
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  const RunFiles& files_;
  DiagnosisTable& out_;
  ColumnReader table_;
  std::size_t name_ = 0, k_ = 0, mode_ = 0, truth_ = 0;
  std::vector<ModeColumns> modes_;
  std::vector<std::vector<std::size_t>> faults_;  ///< at, lower, estimate, upper, truth
  std::vector<std::int64_t> fault_told_;
  std::vector<std::vector<std::size_t>>
      open_;  ///< by pipeline, by mode: its last span; the last one: that of the truth
  std::vector<std::vector<std::int64_t>> last_bound_;  ///< by pipeline, by fault: the latest time
  std::vector<std::vector<bool>> considered_;          ///< by pipeline, by mode: so far
};

}  // namespace

DiagnosisTable read_diagnoses(const RunFiles& files) {
  DiagnosisTable table;
  DiagnosisReader(files, table).read();
  return table;
}

}  // namespace cordon::report
