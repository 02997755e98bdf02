// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "core/text.hpp"
#include "read/recorded_parts.hpp"

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;

/// A bound of κ: a number or "inf".
std::optional<double> read_kappa(const Cursor& at) {
  if (at.is(Kind::text)) {
    if (read_choice(at, {"inf"})) return infinity;
    return std::nullopt;
  }
  return read_number(at);
}

/// A number of the designer's, also "inf" or "-inf"; `missing` where it says none.
double read_claim(const Cursor& object, const char* key, double missing) {
  const auto at = object.find(key);
  if (!at || at->is(Kind::null)) return missing;
  if (!at->is(Kind::text)) return read_number(*at).value_or(missing);
  const auto word = read_choice(*at, {"inf", "-inf"});
  if (!word) return missing;
  return *word == "inf" ? infinity : -infinity;
}

void refuse_name(const Cursor& at, const std::string& name) {
  at.error("must be " + in_quotes(name) + ": pairs and tubes are in the order of the modes",
           not_as_written);
}

void expect_name(const Cursor& object, const char* key, const std::string& name) {
  const auto at = object.need(key, not_as_written);
  if (at && !(at->is(Kind::text) && at->value().text() == name)) refuse_name(*at, name);
}

void expect_pair(const Cursor& object, const std::string& first, const std::string& second) {
  const auto at = object.need("modes", not_as_written);
  if (!at || !at->expect(Kind::array, not_as_written)) return;
  if (at->size() != 2) return at->error("is no pair of modes", not_as_written);
  for (const std::size_t i : {0u, 1u}) {
    const std::string& name = i == 0 ? first : second;
    const Cursor item = at->item(i);
    if (!item.is(Kind::text) || item.value().text() != name) refuse_name(item, name);
  }
}

/// Of the bank: the nominal mode first.
std::vector<std::string> names_of_modes(const SystemPart& system) {
  std::vector<std::string> names{system.nominal};
  for (const Mode& mode : system.modes) names.push_back(mode.name);
  return names;
}

std::optional<DesignStatus> status_of(const Cursor& design) {
  using Status = DesignStatus;
  return read_word(
      design, "status",
      {Status::optimal, Status::feasible, Status::infeasible, Status::unknown, Status::given});
}
bool is_found(std::optional<DesignStatus> status) {
  return status == DesignStatus::optimal || status == DesignStatus::feasible;
}

/// Nothing is said of an input that is not there.
void expect_nothing_said(const Cursor& design) {
  if (is_found(status_of(design)))
    design.find("status")->error("says that there is an input, beside none", not_as_written);
  for (const char* key : {"cost", "separates", "pairs", "tubes"}) {
    const auto at = design.find(key);
    if (at && !at->is(Kind::null))
      at->error("says something of an input that is not there", not_as_written);
  }
}

/// "pairs" and "tubes" of a design, one after another.
void read_claims(const Cursor& at, InputDesign& design, const std::vector<std::string>& modes) {
  const auto pairs = at.need("pairs", not_as_written), tubes = at.need("tubes", not_as_written);
  if (!pairs || !tubes || !pairs->expect(Kind::array, not_as_written) ||
      !tubes->expect(Kind::array, not_as_written))
    return;
  const std::size_t count = modes.size();
  if (pairs->size() != count * (count - 1) / 2)
    pairs->error("does not hold every pair of modes", not_as_written);
  if (tubes->size() != count) tubes->error("does not hold every mode", not_as_written);
  std::size_t first = 0, second = 1;
  for (std::size_t q = 0; q < pairs->size(); ++q) {
    const Cursor item = pairs->item(q);
    if (!item.expect(Kind::object, not_as_written)) continue;
    if (first < count) expect_pair(item, modes[first], modes[std::min(second, count - 1)]);
    if (++second >= count) second = ++first + 1;
    PairSeparation& pair = design.pairs.emplace_back();
    pair.disjoint = read_word(item, "disjoint", {Answer::yes, Answer::no, Answer::unknown})
                        .value_or(Answer::unknown);
    const auto kappa = item.need("kappa_lower", not_as_written);
    const auto bound = kappa && !kappa->is(Kind::null) ? read_kappa(*kappa) : std::nullopt;
    if (bound && *bound > tolerances::reported && pair.disjoint == Answer::unknown)
      pair.disjoint = Answer::yes;  // says the same
    if (bound) pair.kappa_lower = *bound;
    pair.kappa = read_claim(item, "kappa", infinity);
  }
  for (std::size_t i = 0; i < tubes->size(); ++i) {
    const Cursor item = tubes->item(i);
    if (!item.expect(Kind::object, not_as_written)) continue;
    if (i < count) expect_name(item, "mode", modes[i]);
    design.empty.push_back(read_word(item, "empty", {Answer::yes, Answer::no, Answer::unknown})
                               .value_or(Answer::unknown));
  }
}

std::optional<DesignOutcome> read_design(const Cursor& at, const SystemPart& system) {
  if (at.is(Kind::null) || !at.expect(Kind::object, not_as_written)) return std::nullopt;
  const auto u = at.need("u", not_as_written), outputs = at.need("outputs", not_as_written),
             admissible = at.need("admissible_set", not_as_written);
  if (!u || !outputs || !admissible) return std::nullopt;
  if (u->is(Kind::null)) {
    expect_nothing_said(at);
    return std::nullopt;
  }
  const Model& m = system.model;
  DesignOutcome outcome;
  auto inputs = read_matrix(*u);
  if (inputs && (inputs->rows() == 0 || inputs->cols() != m.inputs())) {
    u->error("is " + shape(inputs->rows(), inputs->cols()) + ", must have " +
                 counted(m.inputs(), "column"),
             not_as_written);
  }
  const auto which = read_choice(*outputs, {"all", "last"});
  outcome.last_output_only = which && *which == "last";
  if (!admissible->is(Kind::null)) outcome.admissible_set = read_form(*admissible, m.states());
  if (!inputs) return std::nullopt;
  outcome.horizon = inputs->rows() - 1;
  const auto horizon = at.find("horizon");
  const auto length = horizon ? read_integer(*horizon, 0, max_integer) : std::nullopt;
  if (length && *length != outcome.horizon)
    horizon->error("does not fit \"u\", which has a row for every time from 0 to the horizon",
                   not_as_written);
  const auto status = status_of(at);
  if (status == DesignStatus::infeasible)
    at.find("status")->error("says that there is no input, beside one", not_as_written);
  outcome.status = status.value_or(DesignStatus::given);
  outcome.best.emplace().u = std::move(*inputs);
  outcome.best->cost = read_claim(at, "cost", infinity);
  outcome.lower_bound = read_claim(at, "lower_bound", -infinity);
  read_claims(at, *outcome.best, names_of_modes(system));
  return outcome;
}

/// What beside the input stands in "design" and "exact".
void read_separation(const Cursor& at, const std::vector<std::string>& modes,
                     RecordedDesign& found) {
  const auto word = [](const Cursor& object) {
    return read_word(object, "separates", {Answer::yes, Answer::no, Answer::unknown})
        .value_or(Answer::unknown);
  };
  if (const auto design = at.find("design"); found.design && design)
    found.claimed_separation = word(*design);
  const auto exact = at.find("exact");
  if (!exact || exact->is(Kind::null) || !exact->expect(Kind::object, not_as_written)) return;
  if (!found.design) exact->error("says something of an input that is not there", not_as_written);
  found.proven_separation = word(*exact);
  read_claims(*exact, found.proven.emplace(), modes);
}

}  // namespace

RecordedDesign read_designed(const Cursor& at, const SystemPart& system) {
  RecordedDesign found;
  if (const auto design = at.need("design", not_as_written))
    found.design = read_design(*design, system);
  read_separation(at, names_of_modes(system), found);
  return found;
}

}  // namespace cordon::verification
