// SPDX-License-Identifier: GPL-3.0-or-later
// The bank_parameters of diagnoser "observer_bank", and their problems.
#include <algorithm>
#include <cmath>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "diagnosers/observer_bank/interval_modes.hpp"
#include "diagnosers/observer_bank/observer_bank.hpp"
#include "diagnosers/observer_bank/region_check.hpp"
#include "gains/gain_certificate.hpp"
#include "observers/observer_gain.hpp"
#include "observers/observer_parameters.hpp"

namespace cordon::estimators {

namespace {

constexpr std::int64_t most_bank_steps = 100'000;

ParamSchema bank_parameters() {
  ParamSchema schema = common_parameters();
  add_widening_limit(schema);
  schema.integer("waiting_time",
                 "T: a mode lasts at least so many steps; decides between ambiguous and isolated, "
                 "switch and unknown fault; 1: nothing is assumed",
                 1, 1, most_bank_steps);
  add_gain_parameter(schema, "gain",
                     "L of all modes, a matrix with a row per state and a column per output, or a "
                     "designer, asked for each mode and "
                     "for the steady state; absent, and without gains: \"kalman\"");
  schema.matrices("gains", "L of each mode in place of gain, the nominal mode first");
  schema.set("error_set",
             "X̃, a set that holds the error x - x̂ of every observer whatever the modes have been; "
             "checked in advance; absent: computed");
  schema.matrix("strip_gain",
                "λ, a row per state and a column per output: X̃ is cut by (I - λ C) X̃ ⊕ λ (...); "
                "absent: the backend's intersection");
  schema.choice("invariant",
                "sets behind the FDI conditions: limits (mrpi), steps from an invariant set (rpi), "
                "or from start_set (iterate)",
                {"mrpi", "rpi", "iterate"}, "mrpi");
  schema.vector("iterations",
                "steps for rpi and iterate: one number, or one per observer; 30 if absent");
  schema.integer("max_columns", "most generators of these sets after each step; 0: no limit", 0, 0,
                 most_bank_steps);
  schema.real("accuracy", "relative accuracy of the limits", 1e-9, 1e-14, 1);
  schema.choice("input_copies",
                "the input in the error: one value for plant and observer (joint), or two "
                "independent ones (separate)",
                {"joint", "separate"}, "joint");
  schema.set("start_set", "first error set for iterate; absent: the origin");
  schema.set("state_set",
             "a set that holds the state at all times, needed where modes have different A; "
             "absent: computed if A is stable; interval matrices act on its hull");
  schema.integer("threads",
                 "threads for the observers; 0: one per core; decisions do not depend on it", 1, 0,
                 1024);
  return schema;
}

ComponentSpec default_gain() { return {"kalman", {}}; }

ObserverContext context_of(const DiagnoserContext& context, const Mode& mode) {
  return {mode.model, context.backend, context.make};
}

/// One per mode, as given or designed.
std::vector<Gain> gains_of(const DiagnoserContext& context, const Params& params) {
  std::vector<Gain> gains;
  for (const Mode& mode : context.bank.modes) {
    if (params.has("gains")) {
      gains.push_back({"gains", "given", params.matrices("gains")[gains.size()]});
    } else {
      gains.push_back(
          observer_gain(context_of(context, mode), params, "gain", default_gain()).gain);
    }
  }
  return gains;
}

std::vector<Matrix> matrices_of(const std::vector<Gain>& gains) {
  std::vector<Matrix> matrices;
  for (const Gain& gain : gains) matrices.push_back(gain.L);
  return matrices;
}

std::string of_mode(const Mode& mode) { return " (mode \"" + mode.name + "\")"; }

std::optional<LineForm> set_or_none(const Params& params, const char* name) {
  return params.has(name) ? std::optional(params.set_form(name)) : std::nullopt;
}

OfflineOptions offline_options(const Params& params) {
  OfflineOptions options;
  const std::string& invariant = params.text("invariant");
  options.invariant = invariant == "rpi"       ? OfflineOptions::Invariant::rpi
                      : invariant == "iterate" ? OfflineOptions::Invariant::iterate
                                               : OfflineOptions::Invariant::mrpi;
  options.iterations = {30};
  if (params.has("iterations")) {
    options.iterations.clear();
    for (const double steps : params.vector("iterations"))
      options.iterations.push_back(static_cast<Index>(steps));
  }
  options.max_columns = params.integer("max_columns");
  options.accuracy = params.real("accuracy");
  options.separate_inputs = params.text("input_copies") == "separate";
  options.start_set = set_or_none(params, "start_set");
  options.error_set = set_or_none(params, "error_set");
  options.state_set = set_or_none(params, "state_set");
  options.initial_set = set_or_none(params, "initial_set");
  return options;
}

ObserverBankOptions options_of(const DiagnoserContext& context, const Params& params) {
  const ModeBank& bank = context.bank;
  ObserverBankOptions options;
  options.described = gains_of(context, params);
  options.gains = matrices_of(options.described);
  options.budget = budget_from(params);
  options.widening_limit = params.real("widening_limit");
  for (const Mode& mode : bank.modes)
    options.initial_sets.push_back(initial_set_from(mode.model, params));
  options.waiting_time = params.integer("waiting_time");
  if (params.has("strip_gain")) options.strip_gain = params.matrix("strip_gain");
  options.offline = offline_options(params);
  options.threads = params.integer("threads");
  return options;
}

std::string shape_problem(const Matrix& A, Index rows, Index cols) {
  if (A.rows() == rows && A.cols() == cols) return "";
  return "is " + std::to_string(A.rows()) + " × " + std::to_string(A.cols()) + ", must be " +
         std::to_string(rows) + " × " + std::to_string(cols);
}

/// One per mode, in the order of the modes.
void check_list(const ModeBank& bank, const std::vector<Matrix>& gains,
                std::vector<Diagnostic>& problems) {
  if (static_cast<Index>(gains.size()) != bank.size()) {
    problems.push_back({"/gains",
                        "holds " + std::to_string(gains.size()) + " matrices, the bank has " +
                            std::to_string(bank.size()) + " modes",
                        "give one per mode, the nominal mode first"});
    return;
  }
  for (std::size_t j = 0; j < gains.size(); ++j) {
    const Mode& mode = bank.modes[j];
    const std::string problem = gain_problem(mode.model, gains[j]);
    if (problem.empty()) continue;
    problems.push_back({"/gains/" + std::to_string(j), problem + of_mode(mode),
                        "a row per state, a column per output, with A - L C stable"});
  }
}

void check_gains(const DiagnoserContext& context, const Params& params,
                 std::vector<Diagnostic>& problems) {
  const ModeBank& bank = context.bank;
  const bool listed = params.has("gains");
  if (listed && params.has("gain"))
    problems.push_back({"/gains", "stands beside \"gain\"", "remove one of the two"});
  if (listed) return check_list(bank, params.matrices("gains"), problems);
  std::vector<const LinearModel*> told;  // of which there is a problem
  for (const Mode& mode : bank.modes) {
    const LinearModel& m = mode.model.linear;
    const auto same_loop = [&](const LinearModel* other) {
      return m.A == other->A && m.C == other->C && m.sensor_center() == other->sensor_center();
    };
    if (std::any_of(told.begin(), told.end(), same_loop)) continue;
    const std::size_t before = problems.size();
    check_observer_gain(context_of(context, mode), params, "gain", default_gain(), problems);
    for (std::size_t i = before; i < problems.size(); ++i) problems[i].message += of_mode(mode);
    if (problems.size() > before) told.push_back(&m);
  }
}

void check_shapes(const ModeBank& bank, const Params& params, std::vector<Diagnostic>& problems) {
  const LinearModel& m = bank[bank.nominal].model.linear;
  if (params.has("strip_gain")) {
    if (const std::string wrong =
            shape_problem(params.matrix("strip_gain"), m.states(), m.outputs());
        !wrong.empty()) {
      problems.push_back({"/strip_gain", wrong, "a row per state, a column per output"});
    }
  }
  if (params.has("iterations")) {
    for (const double steps : params.vector("iterations")) {
      if (steps >= 1 && steps <= static_cast<double>(most_bank_steps) && steps == std::floor(steps))
        continue;
      problems.push_back({"/iterations", "must hold whole numbers from 1 to 100000", ""});
      break;
    }
  }
  for (const char* name : {"error_set", "start_set", "state_set"}) {
    if (params.has(name) && params.set_form(name).dim() != m.states()) {
      problems.push_back({std::string("/") + name,
                          "has dimension " + std::to_string(params.set_form(name).dim()) +
                              ", the state has " + std::to_string(m.states()),
                          ""});
    }
  }
}

/// Modes with an X0 of their own.
void check_own_starts(const DiagnoserContext& context, const Params& params,
                      std::vector<Diagnostic>& problems) {
  if (params.has("initial_set") || !problems.empty()) return;
  for (const Mode& mode : context.bank.modes) {
    for (Diagnostic& problem : check_common({mode.model, context.backend}, params)) {
      problem.message += of_mode(mode);
      problems.push_back(std::move(problem));
    }
  }
}

/// The modes without interval matrices.
ExactModes exact_modes(const ModeBank& bank, const Params& params) {
  OfflineOptions options;
  options.accuracy = params.real("accuracy");
  options.state_set = set_or_none(params, "state_set");
  options.initial_set = set_or_none(params, "initial_set");
  return with_exact_matrices(bank, options);
}

std::vector<Diagnostic> check_observer_bank(const DiagnoserContext& given, const Params& params) {
  std::vector<Diagnostic> problems;
  for (const Mode& mode : given.bank.modes) {
    if (!mode.model.linear.is_descriptor()) continue;
    problems.push_back(
        {"/type", "\"observer_bank\" takes modes of type \"lti\"; \"" + mode.name + "\" has an E",
         "use the diagnoser \"consistency_bank\" with the observer \"descriptor\""});
    return problems;
  }
  problems = check_common({given.bank[given.bank.nominal].model, given.backend}, params);
  check_own_starts(given, params, problems);
  check_shapes(given.bank, params, problems);
  ExactModes exact{given.bank};
  if (problems.empty()) exact = exact_modes(given.bank, params);
  problems.insert(problems.end(), exact.problems.begin(), exact.problems.end());
  const ModeBank& bank = exact.bank;
  const DiagnoserContext context{bank, given.backend, given.make};
  check_gains(context, params, problems);
  if (!problems.empty()) return problems;
  const std::vector<Matrix> gains = matrices_of(gains_of(context, params));
  problems = check_offline(bank, gains, offline_options(params));
  if (problems.empty()) problems = check_regions(bank, gains, offline_options(params));
  return problems;
}

}  // namespace

CORDON_COMPONENT(diagnoser, observer_bank) {
  registrar.add(DiagnoserEntry{
      {"observer_bank",
       "a bank of Luenberger observers on sets, with conditions checked in advance",
       "Xu2014; Xu2013", bank_parameters()},
      check_observer_bank,
      [](const DiagnoserContext& context, const Params& params) -> std::unique_ptr<Diagnoser> {
        if (auto problems = check_observer_bank(context, params); !problems.empty()) {
          throw InputError("diagnoser \"observer_bank\"", std::move(problems));
        }
        const ModeBank bank = exact_modes(context.bank, params).bank;
        const DiagnoserContext exact{bank, context.backend, context.make};
        return std::make_unique<ObserverBank>(bank, context.backend, options_of(exact, params));
      },
      true,
      true,
      false,
      true});
}

}  // namespace cordon::estimators
