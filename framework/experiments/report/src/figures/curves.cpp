// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "figures/columns.hpp"
#include "study/text/input_file.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t max_marks = 50;  ///< of a kind
constexpr std::size_t max_curves = 20'000;

/// Columns of lower and upper bounds by state.
struct BoundColumns {
  std::vector<std::size_t> lower, upper;
};

BoundColumns bounds_of(const ColumnReader& table, const std::string& prefix) {
  BoundColumns columns{table.numbered(prefix + "lower_"), table.numbered(prefix + "upper_")};
  if (columns.lower.size() != columns.upper.size())
    table.refuse("does not have as many upper as lower bounds");
  return columns;
}

void add_bounds(const ColumnReader& table, const BoundColumns& columns, bool empty, std::int64_t k,
                std::vector<Thinner>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double lower = table.number(columns.lower[i]), upper = table.number(columns.upper[i]);
    out[i].add(static_cast<double>(k), empty ? not_available : lower,
               empty ? not_available : upper);
  }
}

/// The true states at one time after another. Times of data.csv increase, so that it is read along
/// with the steps of a pipeline.
class TruthReader {
 public:
  TruthReader(const RunFiles& files, std::size_t states) : table_(open_data_table(files)) {
    if (!table_) return;
    k_ = table_->need("k");
    columns_ = table_->numbered("x_");
    if (columns_.size() != states || columns_.empty() || !table_->next()) table_.reset();
  }

  bool is_known() const { return table_.has_value(); }

  /// Goes on to time k; is the state known there?
  bool reach(std::int64_t k) {
    while (table_ && table_->integer(k_) < k) {
      if (!table_->next()) table_.reset();
    }
    return table_ && table_->integer(k_) == k;
  }
  double state(std::size_t i) const { return table_->number(columns_[i]); }

 private:
  std::optional<ColumnReader> table_;
  std::size_t k_ = 0;
  std::vector<std::size_t> columns_;
};

class StepsReader {
 public:
  StepsReader(const RunFiles& files, Curves& curves)
      : files_(files), curves_(curves), table_(files.files().file("steps.csv")) {
    name_ = table_.need("pipeline");
    k_ = table_.need("k");
    consistent_ = table_.need("consistent");
    tightness_ = table_.need("tightness");
    hull_ = bounds_of(table_, "");
    inner_ = bounds_of(table_, "inner_");
    curves_.all_states = hull_.lower.size();
    curves_.states = files.detail() == Detail::all ? curves_.all_states
                                                   : std::min(curves_.all_states, page_states);
    find_metrics();
    const std::size_t pipelines = files.pipelines().size();
    const std::size_t inner_states = inner_.lower.empty() ? 0 : curves_.states;
    const std::size_t error_states =
        TruthReader(files, curves_.all_states).is_known() ? curves_.states : 0;
    const std::size_t series =
        pipelines * (2 * curves_.states + inner_states + error_states + metrics_.size());
    if (series > max_curves) table_.refuse("holds more curves than a report can show");
    const Thinner curve(points_per_series(files.detail(), series));
    StepCurves empty;
    empty.hull.assign(curves_.states, curve);
    empty.width.assign(curves_.states, curve);
    empty.inner.assign(inner_states, curve);
    empty.error.assign(error_states, curve);
    empty.metrics.assign(metrics_.size(), curve);
    curves_.pipelines.assign(pipelines, empty);
  }

  void read() {
    std::string name;
    int pipeline = 0;
    bool was_empty = false;
    std::unique_ptr<TruthReader> truth;
    while (table_.next()) {
      if (table_.text(name_) != name || name.empty()) {
        name = table_.text(name_);
        pipeline = files_.pipeline(name, "steps.csv");
        was_empty = false;
        anew_.clear();
        times_anew_ = 0;
        truth.reset();
        // Rows of a pipeline stand together: the data are read once for each, whatever the file
        // holds.
        if (curves_.pipelines[static_cast<std::size_t>(pipeline)].first < 0)
          truth = std::make_unique<TruthReader>(files_, curves_.all_states);
      }
      StepCurves& steps = curves_.pipelines[static_cast<std::size_t>(pipeline)];
      if (!steps.error.empty()) add_errors(steps, truth.get());
      was_empty = add(steps, was_empty);
    }
    drop_texts();
    for (const StepCurves& steps : curves_.pipelines) {
      for (const auto* group :
           {&steps.hull, &steps.width, &steps.inner, &steps.error, &steps.metrics}) {
        for (const Thinner& curve : *group) curves_.thinned = curves_.thinned || curve.is_thinned();
      }
    }
  }

 private:
  /// The columns between the hull and the inner bounds.
  void find_metrics() {
    std::set<std::size_t> taken{name_, k_, consistent_};
    taken.insert(tightness_);
    for (const auto* group : {&hull_.lower, &hull_.upper, &inner_.lower, &inner_.upper})
      taken.insert(group->begin(), group->end());
    for (std::size_t i = 0; i < table_.names().size(); ++i) {
      if (!taken.contains(i)) metrics_.push_back(i);
    }
    numeric_.assign(metrics_.size(), true);
  }

  void add_errors(StepCurves& steps, TruthReader* truth) {
    const std::int64_t k = table_.integer(k_);
    const bool known = table_.text(consistent_) != "no" && truth && truth->reach(k);
    for (std::size_t i = 0; i < steps.error.size(); ++i) {
      const double x = known ? truth->state(i) : not_available;
      steps.error[i].add(static_cast<double>(k), table_.number(hull_.lower[i]) - x,
                         table_.number(hull_.upper[i]) - x);
    }
  }

  /// Step k follows one that was empty. One that is empty as well has begun anew too, or the
  /// pipeline has stopped: that shows where a later one is not empty.
  void begin_anew(StepCurves& steps, bool empty, std::int64_t k) {
    if (anew_.size() < max_marks) anew_.push_back(k);
    ++times_anew_;
    if (empty) return;
    steps.times_anew += std::exchange(times_anew_, 0);
    for (const std::int64_t at : std::exchange(anew_, {})) {
      if (steps.anew.size() < max_marks) steps.anew.push_back(at);
    }
  }

  /// Is the estimate proven empty?
  bool add(StepCurves& steps, bool was_empty) {
    const std::int64_t k = table_.integer(k_);
    const bool empty = table_.text(consistent_) == "no";
    if (table_.text(tightness_) == "exact") ++steps.exact;
    if (steps.first < 0) steps.first = k;
    steps.last = std::max(steps.last, k);
    if (empty && !was_empty && steps.empty_from.size() < max_marks) steps.empty_from.push_back(k);
    if (was_empty) begin_anew(steps, empty, k);
    add_bounds(table_, hull_, empty, k, steps.hull);
    for (std::size_t i = 0; i < steps.width.size(); ++i) {
      const double width = table_.number(hull_.upper[i]) - table_.number(hull_.lower[i]);
      steps.width[i].add(static_cast<double>(k), empty ? not_available : width);
    }
    add_bounds(table_, inner_, empty, k, steps.inner);
    for (std::size_t i = 0; i < metrics_.size(); ++i) {
      if (!numeric_[i]) continue;
      const auto value = table_.value(metrics_[i]);
      numeric_[i] = value.has_value();
      if (value) steps.metrics[i].add(static_cast<double>(k), *value);
    }
    return empty;
  }

  /// Columns with texts are no curves, nor are those without any value.
  void drop_texts() {
    for (std::size_t i = metrics_.size(); i-- > 0;) {
      const bool any =
          std::any_of(curves_.pipelines.begin(), curves_.pipelines.end(),
                      [&](const StepCurves& steps) { return steps.metrics[i].has_values(); });
      if (numeric_[i] && any) continue;
      metrics_.erase(metrics_.begin() + static_cast<std::ptrdiff_t>(i));
      for (StepCurves& steps : curves_.pipelines)
        steps.metrics.erase(steps.metrics.begin() + static_cast<std::ptrdiff_t>(i));
    }
    for (const std::size_t column : metrics_) curves_.metrics.push_back(table_.names()[column]);
  }

  const RunFiles& files_;
  Curves& curves_;
  ColumnReader table_;
  std::size_t name_ = 0, k_ = 0, consistent_ = 0, tightness_ = 0;
  BoundColumns hull_, inner_;
  std::vector<std::size_t> metrics_;
  std::vector<bool> numeric_;
  std::vector<std::int64_t> anew_;  ///< of empty steps behind each other, the first ones
  std::int64_t times_anew_ = 0;     ///< how many there are
};

/// Which additive faults are not 0 now, and which mode the plant is in.
std::string plant_state(const RunFiles& files, const ColumnReader& table,
                        const std::vector<std::size_t>& faults,
                        const std::optional<std::size_t>& mode) {
  std::string text;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const double value = table.number(faults[i]);
    if (value != 0 && !std::isnan(value))
      text += (text.empty() ? "fault " : ", fault ") + std::to_string(i + 1);
  }
  if (!text.empty() || !mode || table.text(*mode).empty()) return text;
  return files.mode(table.integer(*mode));
}

void read_data(const RunFiles& files, Curves& curves) {
  auto table = open_data_table(files);
  if (!table) return;
  const std::size_t k_column = table->need("k");
  const std::vector<std::size_t> states = table->numbered("x_"), faults = table->numbered("n_");
  const auto mode = table->find("mode");
  if (states.size() == curves.all_states)
    curves.truth.assign(curves.states,
                        Thinner(points_per_series(files.detail(), curves.states * 10)));
  std::optional<std::string> before;
  while (table->next()) {
    const std::int64_t k = table->integer(k_column);
    for (std::size_t i = 0; i < curves.truth.size(); ++i)
      curves.truth[i].add(static_cast<double>(k), table->number(states[i]));
    std::string now = plant_state(files, *table, faults, mode);
    if (before && now != *before && curves.events.size() < max_marks) {
      curves.events.push_back({k, now.empty() ? "no fault" : now});
    }
    before = std::move(now);
  }
}

}  // namespace

std::optional<ColumnReader> open_data_table(const RunFiles& files) {
  const std::filesystem::path file = files.files().file("data.csv");
  char first = 0;
  if (detail::InputFile(file).read(&first, 1) == 0) return std::nullopt;
  return ColumnReader(file);
}

Curves read_curves(const RunFiles& files) {
  Curves curves;
  StepsReader(files, curves).read();
  read_data(files, curves);
  return curves;
}

std::vector<std::pair<std::int64_t, std::vector<double>>> truth_at(
    const RunFiles& files, const std::set<std::int64_t>& times) {
  std::vector<std::pair<std::int64_t, std::vector<double>>> found;
  auto table = open_data_table(files);
  if (!table) return found;
  const std::size_t k_column = table->need("k");
  const std::vector<std::size_t> states = table->numbered("x_");
  if (states.empty()) return found;
  while (table->next()) {
    const std::int64_t k = table->integer(k_column);
    if (!times.contains(k)) continue;
    std::vector<double> x;
    for (const std::size_t column : states) x.push_back(table->number(column));
    found.emplace_back(k, std::move(x));
  }
  return found;
}

}  // namespace cordon::report
