// SPDX-License-Identifier: GPL-3.0-or-later
// Data with additive faults, and a diagnoser that bounds them, for tests of runs.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cordon/registry/registry.hpp"
#include "cordon/study/data.hpp"

namespace fakes {

using namespace cordon;

/// The additive faults of the tests' data.
inline Vector additive_faults(Index k) {
  return Vector{{k % 20 >= 9 && k % 20 < 14 ? 1. : 0., -.5}};
}

/// Data that tell neither additive faults nor modes.
class WithoutFaults final : public DataSource {
 public:
  explicit WithoutFaults(std::unique_ptr<DataSource> data) : data_(std::move(data)) {}
  std::optional<Record> next() override {
    std::optional<Record> record = data_->next();
    if (!record) return record;
    record->fault.reset();
    record->mode.reset();
    return record;
  }
  std::optional<std::int64_t> size() const override { return data_->size(); }

 private:
  std::unique_ptr<DataSource> data_;
};

/// The study's own data with the additive faults that the fake diagnoser knows of.
class WithFaults final : public DataSource {
 public:
  /// Faults in the nominal mode are what a diagnoser would never meet: excluding it is then false.
  explicit WithFaults(std::unique_ptr<DataSource> data, bool nominal = false)
      : data_(std::move(data)), nominal_(nominal) {}
  std::optional<Record> next() override {
    std::optional<Record> record = data_->next();
    if (!record) return record;
    record->fault = additive_faults(record->sample.k);
    record->mode = nominal_ || (*record->fault)[0] == 0
                       ? 0
                       : -1;  // as if fault 2 were part of the nominal mode
    return record;
  }
  std::optional<std::int64_t> size() const override { return data_->size(); }

 private:
  std::unique_ptr<DataSource> data_;
  bool nominal_;
};

/// Monitors the nominal mode as long as its bounds hold 0: fault 1 at k - 1 and fault 2 at k - 3, ±
/// .25, with an estimate that is off by .125. From k = 12 of run number `crooked` on the bounds of
/// fault 2 are off by `off`. `broken` bounds are none.
class Bounding final : public Diagnoser {
 public:
  Bounding(const DiagnoserContext& context, const Params& p)
      : Diagnoser(context.bank, context.backend),
        crooked_(p.integer("crooked")),
        off_(p.real("off")),
        broken_(p.text("broken")) {}

 private:
  void do_start() override { ++runs_; }
  Diagnosis do_step(const Sample*, const Sample& now) override {
    Diagnosis says;
    says.k = now.k;
    says.since = now.k;  // of the bounds it is their own time
    says.mode = bank().nominal;
    says.modes.resize(static_cast<std::size_t>(bank().size()));
    for (ModeEvidence& evidence : says.modes) evidence.candidate = true;
    if (now.k >= 1) says.faults.push_back(bound(0, now.k - 1, 0));
    if (now.k >= 3)
      says.faults.push_back(bound(1, now.k - 3, runs_ == crooked_ && now.k >= 12 ? off_ : 0));
    if (now.k == 4) spoil(says);
    // fault 2 is there at all times: only fault 1 decides
    if (now.k >= 1 && says.faults[0].lower > 0) {
      says.decision = Decision::unknown_fault;
      says.mode = -1;
      says.modes[0].candidate = false;
      says.modes[0].consistent = Answer::no;
    }
    return says;
  }
  static FaultBound bound(Index fault, Index at, double off) {
    const double middle = additive_faults(at)[fault] + off;
    return {fault, at, middle - .25, middle + .25, middle + .125};
  }
  void spoil(Diagnosis& says) const {
    FaultBound& first = says.faults[0];
    if (broken_ == "order") std::swap(first.lower, first.upper);
    if (broken_ == "estimate") first.estimate = first.upper + 1;
    if (broken_ == "nan") first.lower = std::nan("");
    if (broken_ == "future") first.at = says.k + 1;
    if (broken_ == "before") first.at = -1;
    if (broken_ == "twice") first.fault = 1;
    if (broken_ == "index") first.fault = 2;
  }
  std::optional<Guarantees> do_guarantees() const override {
    Guarantees found;
    found.method = "by hand";
    found.faults = {{0, 1, .25}, {1, 3, std::numeric_limits<double>::infinity()}};
    return found;
  }

  Index crooked_, runs_ = 0;
  double off_;
  std::string broken_;
};

inline void register_bounding(Registrar& registrar) {
  ParamSchema bounds;
  bounds.integer("crooked", "number of the run with false bounds; 0: none", 0, 0, 1000);
  bounds.real("off", "by how much they are off", .5, -10, 10);
  bounds.choice("broken", "what is wrong with a bound",
                {"nothing", "order", "estimate", "nan", "future", "before", "twice", "index"},
                "nothing");
  registrar.add(DiagnoserEntry{
      {"bounding", "bounds additive faults", "", bounds},
      [](const DiagnoserContext&, const Params&) { return std::vector<Diagnostic>{}; },
      [](const DiagnoserContext& c, const Params& p) { return std::make_unique<Bounding>(c, p); },
      true,
      false});
}

}  // namespace fakes
