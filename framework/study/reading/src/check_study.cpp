// SPDX-License-Identifier: GPL-3.0-or-later
// What can be told only of a study as a whole, and only if all its sections are right.
#include "cordon/solvers/set_questions.hpp"
#include "study/data/linear_plant.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

/// The parameters that hold a set to start from, of the component or of one inside it; null: it
/// starts from X0.
const Params* starting_params(const ComponentSpec& spec) {
  if (spec.params.has("initial_set")) return &spec.params;
  for (const auto& [name, value] : spec.params.values()) {
    const auto* inner = std::get_if<std::shared_ptr<const ComponentSpec>>(&value);
    if (const Params* found = inner ? starting_params(**inner) : nullptr) return found;
  }
  return nullptr;
}

const Params* starting_params(const PipelineSpec& pipeline) {
  for (const auto& [kind, component] : algorithms_of(pipeline)) {
    if (kind != "designer") return starting_params(*component);
  }
  return nullptr;
}

bool same_blocks(const LineForm& X, const LineForm& Y) {
  const auto same = [](const auto& A, const auto& B) {
    return A.rows() == B.rows() && A.cols() == B.cols() && A == B;
  };
  return same(X.M, Y.M) && same(X.G, Y.G) && same(X.c, Y.c) && same(X.S, Y.S) && same(X.A, Y.A) &&
         same(X.b, Y.b);
}

/// Where simulations start: a state, which must not be proven outside, or a set, which must be
/// proven inside.
class Start {
 public:
  Start(const Cursor& at, const SimulateSpec& spec) : at_(at), spec_(spec) {}

  /// True: inside `X` as far as is asked for; else it is reported.
  bool expect_inside(const LineForm& X, const std::string& name,
                     const std::string& suggestion) const {
    if (spec_.x0) {
      if (X.dim() != spec_.x0->size() || contains(X, *spec_.x0) != Answer::no) return true;
      at_.error("lies outside " + name, "choose x0 inside" + suggestion);
      return false;
    }
    if (X.dim() != spec_.x0_set->dim()) return true;
    const Answer inside = same_blocks(*spec_.x0_set, X) ? Answer::yes : is_subset(*spec_.x0_set, X);
    if (inside == Answer::no)
      at_.error("does not lie inside " + name, "choose a set inside" + suggestion);
    if (inside == Answer::unknown)
      at_.error("could not be proven to lie inside " + name, "give a smaller or a simpler set");
    return inside == Answer::yes;
  }

 private:
  const Cursor& at_;
  const SimulateSpec& spec_;
};

/// Designed inputs are tried on every mode, from the X0 of each.
void check_start_of_modes(const Start& start, const Study& study) {
  for (const Mode& mode : study.modes) {
    start.expect_inside(
        mode.model.X0,
        "X0 of mode " + in_quotes(mode.name) + ", which designed inputs are tried on",
        ", or widen that set");
  }
}

/// A simulation that starts outside the set an observer starts from would break its guarantee by
/// construction.
void check_start(const Cursor& root, const Study& study, std::optional<std::size_t> only) {
  const auto* spec = std::get_if<SimulateSpec>(&study.data);
  if (!spec || (!spec->x0 && !spec->x0_set)) return;
  const Cursor at = *root.find("data")->find("simulate")->find("x0");
  const Start start(at, *spec);
  bool own = false, designed = false;  // does a pipeline start from the system's X0?
  for (std::size_t i = 0; i < study.pipelines.size(); ++i) {
    if (only && *only != i) continue;
    const PipelineSpec& pipeline = study.pipelines[i];
    const Params* params = starting_params(pipeline);
    designed = designed || pipeline.design();
    own = own || !params || pipeline.design();
    if (params) {
      start.expect_inside(params->set_form("initial_set"),
                          "the initial_set of pipeline " + in_quotes(pipeline.name),
                          ", or widen the set");
    }
  }
  if (own && !start.expect_inside(study.model.X0, "X0", " /system/X0, or widen that set")) return;
  if (!spec->faults.empty() && spec->faults.front().from == 0) {
    const FaultSpec& fault = spec->faults.front();
    start.expect_inside(fault.model.X0,
                        "X0 of the fault that acts from the beginning: " + in_quotes(fault.name),
                        ", or widen that set");
  }
  if (designed) check_start_of_modes(start, study);
}

/// Can the mode be simulated, whatever its inputs are? Else the reason.
std::string obstacle(const Mode& mode, const std::string& file) {
  const std::string of = " of mode " + in_quotes(mode.name);
  if (is_bounded(mode.model.W) != Answer::yes) return "W" + of + " is unbounded";
  if (is_bounded(mode.model.V) != Answer::yes) return "V" + of + " is unbounded";
  try {
    const detail::LinearPlant plant(mode.model.linear, file);
  } catch (const InputError& error) {
    return "E" + of + ": " + error.diagnostics().front().message;
  }
  return "";
}

/// A diagnoser beside a designer sees experiments with every mode.
void check_experiments(const Cursor& root, const Study& study, std::optional<std::size_t> only) {
  const Cursor pipelines = *root.find("pipelines");
  for (std::size_t i = 0; i < study.pipelines.size(); ++i) {
    if (only && *only != i) continue;
    const DesignSpec* const design = study.pipelines[i].design();
    if (!design || !design->diagnoser) continue;
    const Cursor at = *pipelines.item(i).find("diagnoser");
    for (const Mode& mode : bank_of(study).modes) {
      if (const std::string reason = obstacle(mode, study.file.string()); !reason.empty())
        at.error("its experiments cannot be simulated: " + reason,
                 "change that mode, or remove the diagnoser");
    }
  }
}

}  // namespace

void check_study(const Cursor& root, const Study& study, std::optional<std::size_t> only) {
  check_start(root, study, only);
  check_experiments(root, study, only);
}

}  // namespace cordon::json
