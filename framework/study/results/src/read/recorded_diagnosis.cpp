// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "read/recorded_parts.hpp"

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;
using Step = RecordedDiagnosis::Step;

std::vector<std::string> names_of(const SystemPart& system) {
  std::vector<std::string> names{system.nominal};
  for (const Mode& each : system.modes) names.push_back(each.name);
  return names;
}

std::optional<Index> read_mode_name(const Cursor& at, const std::vector<std::string>& names) {
  const auto name = read_choice(at, names);
  if (!name) return std::nullopt;
  return static_cast<Index>(std::find(names.begin(), names.end(), *name) - names.begin());
}

std::optional<ModeAssumptions> read_mode_assumptions(const Cursor& at, Index n) {
  if (!at.expect(Kind::object, not_as_written)) return std::nullopt;
  const auto initial = at.need("initial_set", not_as_written);
  auto form = initial ? read_form(*initial, n) : std::nullopt;
  if (!form) return std::nullopt;
  ModeAssumptions assumed{std::move(*form)};
  if (const auto set = at.find("restart_set")) assumed.restart_set = read_form(*set, n);
  if (const auto set = at.find("admissible_set")) assumed.admissible_set = read_form(*set, n);
  return assumed;
}

std::optional<DiagnosisAssumptions> read_assumptions(const Cursor& at, const SystemPart& system,
                                                     const std::vector<std::string>& names) {
  if (at.is(Kind::null) || !at.expect(Kind::object, not_as_written)) return std::nullopt;
  DiagnosisAssumptions assumed;
  const auto known = at.need("known_mode", not_as_written),
             modes = at.need("modes", not_as_written);
  if (!known || !modes || !modes->expect(Kind::array, not_as_written)) return std::nullopt;
  if (!known->is(Kind::null)) assumed.known_mode = read_mode_name(*known, names);
  if (modes->size() != names.size()) {
    modes->error("has " + std::to_string(modes->size()) + " modes, the study has " +
                     std::to_string(names.size()),
                 not_as_written);
    return std::nullopt;
  }
  for (std::size_t i = 0; i < modes->size(); ++i) {
    auto mode = read_mode_assumptions(modes->item(i), system.model.states());
    if (!mode) return std::nullopt;
    assumed.modes.push_back(std::move(*mode));
  }
  return assumed;
}

/// A box of the state; nothing, untold, where the diagnoser tells no state.
std::optional<Box> read_box(const Cursor& at, Index n) {
  if (!at.expect(Kind::object, not_as_written)) return std::nullopt;
  const auto lower_at = at.need("lower", not_as_written),
             upper_at = at.need("upper", not_as_written);
  auto lower = lower_at ? read_bounds(*lower_at) : std::nullopt,
       upper = upper_at ? read_bounds(*upper_at) : std::nullopt;
  if (!lower || !upper) return std::nullopt;
  if (lower->size() == n && upper->size() == n) return Box{std::move(*lower), std::move(*upper)};
  at.error("is no box of the state, which has dimension " + std::to_string(n), not_as_written);
  return std::nullopt;
}

void read_estimate(const Cursor& at, const char* key, Index n,
                   const std::vector<std::string>& names, RecordedDiagnosis& to) {
  const auto box = at.find(key), k_at = at.need("k", not_as_written),
             mode_at = at.need("mode", not_as_written);
  if (!box || !k_at || !mode_at) return;
  const auto k = read_integer(*k_at, 0, max_integer);
  const auto mode = read_mode_name(*mode_at, names);
  auto hull = read_box(*box, n);
  if (k && mode && hull) to.estimates.push_back({*k, *mode, std::move(*hull), box->pointer()});
}

void read_event(const Cursor& event, const std::vector<std::string>& names, RecordedDiagnosis& to) {
  const auto what_at = event.need("what", not_as_written);
  const auto what = what_at ? read_text(*what_at, 100) : std::nullopt;
  const bool isolates = what && (*what == "isolated" || *what == "resumed");
  if (!isolates && !(what && (*what == "excluded" || *what == "detected"))) return;
  const auto k_at = event.need("k", not_as_written), mode_at = event.need("mode", not_as_written);
  const auto k = k_at ? read_integer(*k_at, 0, max_integer) : std::nullopt;
  const auto mode = mode_at ? read_mode_name(*mode_at, names) : std::nullopt;
  if (k && mode) to.events.push_back({*k, *mode, isolates, event.pointer()});
}

void read_estimates(const Cursor& pipeline, Index n, const std::vector<std::string>& names,
                    RecordedDiagnosis& to) {
  const auto summary = pipeline.find("summary");
  if (!summary || !summary->is(Kind::object)) return;
  const auto events = summary->find("events"), last = summary->find("last_state");
  for (std::size_t i = 0; events && events->is(Kind::array) && i < events->size(); ++i) {
    const Cursor event = events->item(i);
    if (!event.expect(Kind::object, not_as_written)) continue;
    read_event(event, names, to);
    if (event.find("estimate")) read_estimate(event, "estimate", n, names, to);
  }
  if (last && last->is(Kind::object)) read_estimate(*last, "hull", n, names, to);
}

}  // namespace

std::optional<Step> read_diagnosed_step(const Cursor& at) {
  const auto k = at.need("k", not_as_written), since = at.need("since", not_as_written),
             reset = at.need("reset", not_as_written), mode = at.need("mode", not_as_written),
             modes = at.need("modes", not_as_written);
  if (!k || !since || !reset || !mode || !modes || !modes->expect(Kind::array, not_as_written))
    return std::nullopt;
  const auto now = read_integer(*k, 0, max_integer), from = read_integer(*since, 0, max_integer);
  const auto anew = read_flag(*reset);
  const auto name = mode->is(Kind::null) ? std::optional<std::string>("") : read_text(*mode, 1000);
  if (!now || !from || !anew || !name) return std::nullopt;
  Step step{*now, *from, *anew, *name, {}, {}, at.value().line, {}};
  for (std::size_t j = 0; j < modes->size(); ++j) {
    const Cursor one = modes->item(j);
    if (!one.expect(Kind::object, not_as_written)) return std::nullopt;
    const auto candidate = one.need("candidate", not_as_written);
    const auto left = candidate ? read_flag(*candidate) : std::nullopt;
    const auto answer = read_word(one, "consistent", {Answer::yes, Answer::no, Answer::unknown});
    if (!left || !answer) return std::nullopt;
    step.candidate.push_back(*left);
    step.excluded.push_back(*answer == Answer::no);
  }
  const auto restarts = at.find("restarts");
  if (!restarts) return step;
  if (!restarts->expect(Kind::array, not_as_written)) return std::nullopt;
  if (restarts->size() != modes->size()) {
    restarts->error("has " + std::to_string(restarts->size()) + " sets, there are " +
                        std::to_string(modes->size()) + " modes",
                    not_as_written);
    return std::nullopt;
  }
  for (std::size_t j = 0; j < restarts->size(); ++j) {
    auto set = read_form(restarts->item(j), std::nullopt);
    if (!set) return std::nullopt;
    step.restarts.push_back(std::move(*set));
  }
  return step;
}

RecordedDiagnosis read_diagnosed(const Cursor& pipeline, const SystemPart& system,
                                 std::vector<Step> steps) {
  RecordedDiagnosis made;
  const std::vector<std::string> names = names_of(system);
  if (const auto assumed = pipeline.find("assumptions"))
    made.assumptions = read_assumptions(*assumed, system, names);
  if (!made.assumptions) return made;
  made.steps = std::move(steps);
  for (std::size_t i = 0; i < made.steps.size(); ++i) {
    const Step& step = made.steps[i];
    const bool is_of_bank =
        step.candidate.size() == names.size() &&
        (step.mode.empty() || std::find(names.begin(), names.end(), step.mode) != names.end());
    const bool is_of_state = std::ranges::all_of(
        step.restarts, [&](const LineForm& set) { return set.dim() == system.model.states(); });
    if (is_of_bank && is_of_state && (i == 0 || step.k > made.steps[i - 1].k) &&
        step.since <= step.k)
      continue;
    pipeline.problems().add(
        child(child(pipeline.pointer(), "steps"), i), step.line,
        "does not fit the modes or the states of the study, or its time the step before",
        not_as_written);
  }
  read_estimates(pipeline, system.model.states(), names, made);
  return made;
}

}  // namespace cordon::verification
