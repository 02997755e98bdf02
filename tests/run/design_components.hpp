// SPDX-License-Identifier: GPL-3.0-or-later
// A designer and a diagnoser of its experiments that say what they are told, for tests of runs.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cordon/registry/registry.hpp"
#include "cordon/study/run.hpp"

namespace fakes {

using namespace cordon;

/// Says of an input that is 1 throughout whatever its parameters tell: how it is found, whether a
/// tube is empty, and whether it breaks down; `bounded` assumes a state that is far away. `waits`
/// until it is stopped.
class Designing final : public InputDesigner {
 public:
  Designing(const DesignerContext& context, const Params& params)
      : InputDesigner(context.bank, context.backend), params_(params) {}

 private:
  DesignOutcome do_design(DesignControl& control) const override {
    const std::string& says = params_.text("says");
    control.progress(2, 5, 4);
    if (says == "throws") throw Error(Errc::unsupported, "out of ideas");
    while (says == "waits" && !control.stop()) {
    }
    DesignOutcome outcome;
    outcome.horizon = 2;
    outcome.epsilon = .125;
    outcome.tried = {{1, DesignStatus::infeasible, "too short"}};
    outcome.nodes = 3;
    outcome.programs = 7;
    outcome.reason = says == "unknown" ? "the time is over" : "";
    outcome.stopped = says == "unknown";
    outcome.status = says == "infeasible" ? DesignStatus::infeasible
                     : says == "unknown"  ? DesignStatus::unknown
                                          : DesignStatus::feasible;
    if (outcome.status == DesignStatus::feasible) outcome.best = design(says);
    if (outcome.best) outcome.lower_bound = 4;
    if (says == "bounded")
      outcome.admissible_set = make_point(Vector::Constant(bank()[0].model.linear.states(), 100));
    return outcome;
  }

  InputDesign design(const std::string& says) const {
    InputDesign made;
    made.u = Matrix::Ones(3, bank()[0].model.linear.inputs());
    made.cost = 5;
    for (Index i = 0; i < bank().size(); ++i) {
      for (Index j = i + 1; j < bank().size(); ++j) {
        made.pairs.push_back(
            {i, j, .5, .25, Answer::yes, {Certificate::Kind::farkas, Vector::Ones(1), .125}});
      }
      made.empty.push_back(says == "empty" && i == 1 ? Answer::yes : Answer::no);
      made.outputs.push_back({-Vector::Ones(3), Vector::Ones(3)});
    }
    return made;
  }

  Params params_;
};

/// First outputs of the experiments that the diagnoser below has seen.
inline std::vector<Vector>& first_outputs() {
  static std::vector<Vector> seen;
  return seen;
}

/// Knows that experiments come in the order of three modes with two seeds each: `truth` isolates
/// the mode at k = 1, in every second run at k = 2; `lies` is wrong in the first run, and always
/// mode 0 later; `open` excludes the last mode only, `none` excludes all, `throws` breaks down in
/// the third run; `wavers` isolates the mode at k = 1 only, in every second run at all k but 1.
class Telling final : public Diagnoser {
 public:
  Telling(const DiagnoserContext& context, const Params& params)
      : Diagnoser(context.bank, context.backend), tells_(params.text("tells")) {}

 private:
  void do_start() override { ++runs_; }
  std::optional<Index> do_last_used_sample() const override { return 7; }
  Diagnosis do_step(const Sample*, const Sample& now) override {
    if (now.k == 0) first_outputs().push_back(now.y);
    if (tells_ == "throws" && runs_ == 3) throw Error(Errc::unsupported, "out of order");
    Diagnosis says;
    says.k = now.k;
    says.decision = Decision::isolating;
    says.modes.resize(static_cast<std::size_t>(bank().size()));
    if (tells_ == "wavers" ? (now.k == 1) == (runs_ % 2 == 0) : now.k == 0) return says;
    const Index mode =
        tells_ == "lies" ? (runs_ == 1 ? 1 : 0) : (runs_ - 1) / 2 % 3;  // two seeds, three modes
    if (tells_ == "open") {
      says.decision = Decision::ambiguous;
      exclude(says, 2);
    } else if (tells_ == "none") {
      says.decision = Decision::unknown_fault;
      for (Index j = 0; j < bank().size(); ++j) exclude(says, j);
    } else {
      if (tells_ != "wavers" && now.k == 1 && runs_ % 2 == 0)
        return says;  // every second run is isolated later
      says.decision = Decision::monitoring;
      says.mode = mode;
      for (Index j = 0; j < bank().size(); ++j) {
        if (j != mode) exclude(says, j);
      }
    }
    return says;
  }
  static void exclude(Diagnosis& says, Index mode) {
    ModeEvidence& evidence = says.modes[static_cast<std::size_t>(mode)];
    evidence.candidate = false;
    evidence.consistent = Answer::no;
  }

  std::string tells_;
  Index runs_ = 0;
};

inline void register_designing(Registrar& registrar) {
  ParamSchema outcome;
  outcome.choice("says", "what becomes of the search",
                 {"found", "empty", "bounded", "infeasible", "unknown", "throws", "waits"},
                 "found");
  registrar.add(DesignerEntry{
      {"designing", "designs what it is told", "", outcome},
      [](const DesignerContext&, const Params&) { return std::vector<Diagnostic>{}; },
      [](const DesignerContext& c, const Params& p) { return std::make_unique<Designing>(c, p); }});
  ParamSchema tells;
  tells.choice("tells", "how it ends", {"truth", "open", "none", "lies", "throws", "wavers"},
               "truth");
  tells.set("admissible_set", "an assumption");
  registrar.add(DiagnoserEntry{
      {"telling", "knows the order of experiments", "", tells},
      [](const DiagnoserContext&, const Params&) { return std::vector<Diagnostic>{}; },
      [](const DiagnoserContext& c, const Params& p) { return std::make_unique<Telling>(c, p); }});
}

inline PipelineSpec design(std::string name, std::string says = "found", std::string tells = {}) {
  DesignSpec design{{"designing", {}}};
  design.designer.params.set("says", std::move(says));
  if (!tells.empty()) {
    design.diagnoser = {"telling", {}};
    design.diagnoser->params.set("tells", std::move(tells));
  }
  return {{std::move(design)}, std::move(name), {"box", {}}};
}

}  // namespace fakes
