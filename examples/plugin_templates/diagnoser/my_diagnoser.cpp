// SPDX-License-Identifier: GPL-3.0-or-later
// A diagnoser as a plugin: an observer per mode, a mode is excluded when its estimate is proven
// empty. Start from here and replace the decision by your own.
#include <cordon/interfaces/archive.hpp>
#include <cordon/registry/plugin.hpp>

namespace {

using namespace cordon;

class MyDiagnoser final : public Diagnoser {
 public:
  MyDiagnoser(const DiagnoserContext& context, const Params& params)
      : Diagnoser(context.bank, context.backend), excluded_(context.bank.modes.size(), false) {
    for (const Mode& mode : bank().modes)
      observers_.push_back(
          context.make->make_observer(params.component("observer"), {mode.model, context.backend}));
  }

 private:
  void do_start() override {
    for (const auto& observer : observers_) observer->start();
    excluded_.assign(excluded_.size(), false);
    since_.reset();
  }

  /// An exclusion is made on a proof only, and stays: nothing is said of modes that change.
  Diagnosis do_step(const Sample*, const Sample& now) override {
    if (!since_) since_ = now.k;
    Diagnosis diagnosis;
    diagnosis.k = now.k;
    diagnosis.since = *since_;
    std::vector<Index> left;
    for (Index j = 0; j < bank().size(); ++j) {
      ModeEvidence evidence;
      Estimate estimate = observers_[as_size(j)]->step(now);
      evidence.consistent = estimate.consistent;
      evidence.why = estimate.why;
      if (estimate.consistent == Answer::no) excluded_[as_size(j)] = true;
      evidence.candidate = !excluded_[as_size(j)];
      if (evidence.candidate) {
        left.push_back(j);
        diagnosis.estimate = estimate.set;
      }
      diagnosis.modes.push_back(std::move(evidence));
    }
    if (left.size() == 1) {
      diagnosis.mode = left.front();
      return diagnosis;  // monitoring
    }
    diagnosis.estimate.reset();
    diagnosis.decision = left.empty() ? Decision::unknown_fault : Decision::isolating;
    return diagnosis;
  }

  /// What later steps depend on, to go on from after a restart of the program.
  void do_serialize(Archive& archive) override {
    archive(since_);
    for (std::size_t j = 0; j < observers_.size(); ++j) {
      bool excluded = excluded_[j];
      archive(*observers_[j], excluded);
      excluded_[j] = excluded;
    }
  }

  std::vector<std::shared_ptr<Observer>> observers_;
  std::vector<bool> excluded_;
  std::optional<Index> since_;
};

/// What the observer would refuse is told with its place.
std::vector<Diagnostic> problems_of(const DiagnoserContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  for (const Mode& mode : context.bank.modes) {
    for (Diagnostic& problem : context.make->check_observer(params.component("observer"),
                                                            {mode.model, context.backend})) {
      problem.pointer = "/observer" + problem.pointer;
      problem.message = "mode \"" + mode.name + "\": " + problem.message;
      problems.push_back(std::move(problem));
    }
  }
  return problems;
}

void register_components(Registrar& registrar) {
  ParamSchema schema;
  schema.component("observer", "observer of every mode", "observer").required();
  registrar.add(DiagnoserEntry{
      {"my_diagnoser", "an observer per mode", "", schema},
      problems_of,
      [](const DiagnoserContext& context, const Params& params) -> std::unique_ptr<Diagnoser> {
        return std::make_unique<MyDiagnoser>(context, params);
      }});
}

}  // namespace

CORDON_PLUGIN("my_diagnoser", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "a diagnoser of my own",
              register_components)
