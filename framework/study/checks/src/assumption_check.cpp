// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/assumption_check.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "formula_equations.hpp"
#include "rounded_data.hpp"
#include "study/checks/outside.hpp"

namespace cordon::detail {

namespace {

using What = FailedAssumption::What;

constexpr double row_rounding = 1e-12, of_formulas = 1e-12;
constexpr std::size_t most_kept = 10'000;

bool is_by_plant(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  return simulate && (simulate->plant || simulate->made_plant || simulate->formulas);
}

void collect(const ComponentSpec& spec, Index from, PipelineAssumptions& found) {
  for (const auto& [name, value] : spec.params.values()) {
    if (const auto* set = std::get_if<LineForm>(&value)) {
      if (name == "admissible_set") found.admissible_sets.push_back({*set, from});
      if (name == "restart_set") found.restart_set = *set;
    }
    const auto* nested = std::get_if<std::shared_ptr<const ComponentSpec>>(&value);
    if (nested && *nested) collect(**nested, 0, found);
  }
}

Vector product_of_sizes(const Matrix& A, const Vector& x) {
  return linalg::product(A.cwiseAbs(), x.cwiseAbs());
}

/// |Δ| |x| of an interval matrix, 0 without a radius.
Vector spread(const Matrix& radius, const Vector& x, Index rows) {
  return radius.size() == 0 ? Vector(Vector::Zero(rows)) : product_of_sizes(radius, x);
}

/// value ∈ image of `set` by T, but for a box of this radius?
bool is_missing(const LineForm& set, const Matrix& T, const Vector& value, const Vector& radius,
                const Vector& terms) {
  LineForm image = affine_map(set, T, Vector::Zero(value.size()));
  if (!radius.isZero(0)) image = minkowski_sum(image, make_box({-radius, radius}));
  return clearly_outside(image, value, row_rounding * (terms + radius));
}

/// w, what leads from one record to the next, is none of W, by more than rounding.
bool leaves_W(const Model& model, const Record& before, const Record& now) {
  if (model.nonlinear) return no_disturbance_leads(model, before, now, of_formulas);
  const LinearModel& m = model.linear;
  const Vector &x = *before.truth, &u = before.sample.u, &next = *now.truth;
  const Vector pushed = m.actuator_center().cwiseProduct(u);
  const Vector left = m.is_descriptor() ? Vector(linalg::product(m.E, next)) : next;
  const Vector w = left - linalg::product(m.A, x) - linalg::product(m.B, pushed);
  const Vector radius = spread(m.A_radius, x, m.states()) + spread(m.B_radius, u, m.states()) +
                        product_of_sizes(m.B, m.actuator_radius().cwiseProduct(u));
  const Vector terms = (m.is_descriptor() ? product_of_sizes(m.E, next) : Vector(next.cwiseAbs())) +
                       product_of_sizes(m.A, x) + product_of_sizes(m.B, pushed);
  return is_missing(model.W, m.Bw, w, radius, terms);
}

/// The same of v, by the outputs that there are.
bool leaves_V(const Model& model, const Record& now) {
  if (model.nonlinear) return no_noise_shows(model, now, of_formulas);
  const LinearModel m = with_outputs(model.linear, present_outputs(now.sample));
  const Vector &x = *now.truth, &u = now.sample.u, y = without_missing(now.sample).y,
               g = m.sensor_center(), ranges = m.sensor_radius();
  const Vector pushed = m.actuator_center().cwiseProduct(u);
  const Vector shown = linalg::product(m.C, x) + linalg::product(m.D, pushed);
  const Vector shown_radius = spread(m.C_radius, x, m.outputs()) +
                              product_of_sizes(m.D, m.actuator_radius().cwiseProduct(u));
  const Vector v = y - g.cwiseProduct(shown);
  const Vector radius =
      (g + ranges).cwiseProduct(shown_radius) + ranges.cwiseProduct(shown.cwiseAbs());
  const Vector terms =
      y.cwiseAbs() + g.cwiseProduct(product_of_sizes(m.C, x) + product_of_sizes(m.D, pushed));
  return is_missing(model.V, m.Dv, v, radius, terms);
}

/// By more than rounding of x, though it may be next to nothing beside a set of any size: where the
/// solver does not tell, rational arithmetic does.
bool is_proven_outside(const LineForm& set, const Vector& x) {
  if (contains(set, x) == Answer::yes) return false;
  const double margin = tolerances::reported * (x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0);
  const Vector room = Vector::Constant(x.size(), margin);
  const LineForm common =
      intersection(set, Matrix::Identity(x.size(), x.size()), make_box({x - room, x + room}));
  try {
    return exact::is_empty(common) == Answer::yes;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return false;
  }
}

bool earlier(const FailedAssumption& a, const std::optional<FailedAssumption>& b) {
  return !b || a.from() < b->from();
}

/// Parameters that are states are those of the mode that begins: no disturbance leads to them.
bool has_new_parameters(const Model& model, bool begins) {
  return begins && model.nonlinear && model.nonlinear->parameters > 0;
}

}  // namespace

PipelineAssumptions assumptions_of(const ComponentSpec& diagnoser,
                                   std::optional<Rounding> rounding) {
  PipelineAssumptions found;
  collect(diagnoser, 1, found);
  found.inputs = true;
  found.exact_data = rounding && *rounding != Rounding::nominal;
  return found;
}

AssumptionCheck::AssumptionCheck(const Study& study, PipelineAssumptions assumed)
    : study_(study),
      bank_(bank_of(study)),
      assumed_(std::move(assumed)),
      by_plant_(is_by_plant(study)) {}

void AssumptionCheck::begin_run(std::int64_t seed_offset) {
  seed_offset_ = seed_offset;
  last_.reset();
  kept_.clear();
  start_.reset();
  other_.reset();
  slight_.reset();
}

void AssumptionCheck::step(const Record& record) {
  if (!last_) check_start(record);
  if (!other_ && leaves_modes(record)) fail(What::modes, record.sample.k);
  const auto is_used = [&](Index output) {
    const std::vector<Index>& missing = record.sample.missing;
    return std::find(missing.begin(), missing.end(), output) == missing.end();
  };
  if (!other_ && record.truth && mode_of(record) >= 0 &&
      std::any_of(record.outliers.begin(), record.outliers.end(), is_used) &&
      leaves_V(bank_[mode_of(record)].model, record))
    fail(What::V, record.sample.k, mode_of(record));
  if (!other_) {
    check_sets(record);
    if (by_plant_) check_plant(record);
  }
  if (!by_plant_ && record.truth) {
    kept_.push_back(record);
    if (kept_.size() > most_kept) kept_.pop_front();
  }
  last_ = record;
}

void AssumptionCheck::restarted() {
  if (assumed_.restart_set) restarted_from(*assumed_.restart_set);
}

void AssumptionCheck::restarted_from(const LineForm& set) {
  if (other_ || !last_ || !last_->truth) return;
  if (is_empty(set) == Answer::yes || clearly_outside(set, *last_->truth))
    fail(What::restart_set, last_->sample.k);
}

void AssumptionCheck::begun_anew_from(const LineForm& set) {
  if (last_ && last_->truth && is_left(set, *last_->truth, What::initial_set, last_->sample.k))
    fail(What::initial_set, last_->sample.k);
}

bool AssumptionCheck::excuses(Index k, Index since) const {
  return (start_ && since <= start_->k && start_->from() <= k) || (other_ && other_->from() <= k);
}

bool AssumptionCheck::excuses_by_rounding(Index k, bool barely, Index since) {
  const bool rests_on_start = slight_ && since <= slight_->k;
  if (slight_ && slight_->k <= k && (rests_on_start || slight_->what != What::initial_set)) {
    fail(slight_->what, slight_->k, slight_->mode);
    return true;
  }
  if (!assumed_.exact_data && !barely) return false;
  const Record* before = nullptr;
  for (const Record& now : kept_) {
    const Index time = now.sample.k;
    if (time > k || (other_ && other_->from() <= k)) break;
    const Index from = before ? mode_of(*before) : -1, shown = mode_of(now);
    const bool follows = from >= 0 && !has_new_parameters(bank_[from].model, from != shown);
    if (follows && contradicts_dynamics(bank_[from].model, *before, now)) {
      if (leaves_W(bank_[from].model, *before, now)) return false;  // that is no rounding
      fail(What::W_exactly, time - 1, from);
    } else if (shown >= 0 && contradicts_outputs(bank_[shown].model, now)) {
      if (leaves_V(bank_[shown].model, now)) return false;
      fail(What::V_exactly, time, shown);
    }
    before = &now;
  }
  return other_ && other_->from() <= k;
}

/// X0 is that of the mode that makes the first sample; outside the bank nothing is assumed.
void AssumptionCheck::check_start(const Record& record) {
  if (!record.truth) return;
  const Index k = record.sample.k, mode = record.mode.value_or(bank_.nominal);
  if (assumed_.initial_set) {
    if (is_left(*assumed_.initial_set, *record.truth, What::initial_set, k))
      fail(What::initial_set, k);
  } else if (mode >= 0 && k == 0 &&
             is_left(bank_[mode].model.X0, *record.truth, What::initial_set, k, mode)) {
    fail(What::initial_set, k, mode);
  }
}

/// Outside by more than rounding; by less is remembered.
bool AssumptionCheck::is_left(const LineForm& set, const Vector& x, What what, Index k,
                              Index mode) {
  if (set.dim() != x.size()) return false;
  if (clearly_outside(set, x)) return true;
  if (!slight_ && is_proven_outside(set, x))
    slight_ = FailedAssumption{what, k, mode, seed_offset_};
  return false;
}

bool AssumptionCheck::leaves_modes(const Record& record) const {
  using Modes = PipelineAssumptions::Modes;
  if (!record.mode || assumed_.modes == Modes::any) return false;
  if (assumed_.modes == Modes::of_the_bank) return *record.mode < 0;
  if (record.mode_without_fault) return *record.mode_without_fault != bank_.nominal;
  const bool has_fault = record.fault && !record.fault->isZero(0);
  return *record.mode != bank_.nominal && !(*record.mode < 0 && has_fault);
}

/// Of the true mode, with bounds of its parameters.
const LineForm* AssumptionCheck::admissible_by_formulas(const Record& record) const {
  const Index mode = record.truth ? mode_of(record) : -1;
  if (mode < 0 || !bank_[mode].model.nonlinear) return nullptr;
  const auto& set = bank_[mode].model.nonlinear->admissible;
  return set ? &*set : nullptr;
}

void AssumptionCheck::check_sets(const Record& record) {
  const Index k = record.sample.k;
  for (const auto& [set, from] : assumed_.admissible_sets) {
    if (other_ || !record.truth) break;
    if (k >= from && is_left(set, *record.truth, What::admissible_set, k))
      fail(What::admissible_set, k);
  }
  if (const LineForm* const set = admissible_by_formulas(record);
      set && !other_ && is_left(*set, *record.truth, What::admissible_set, k))
    fail(What::admissible_set, k);
  if (!other_ && record.truth && study_.model.nonlinear && misses_invariants(study_.model, record))
    fail(What::invariants, k);
  if (!other_ && assumed_.inputs && clearly_outside(study_.model.U, record.sample.u))
    fail(What::U, k);
}

void AssumptionCheck::check_plant(const Record& now) {
  if (!now.truth) return;
  const Index k = now.sample.k;
  if (const Index mode = last_ ? mode_of(*last_) : -1;
      !other_ && mode >= 0 && last_->sample.k + 1 == k) {
    if (leaves_W(bank_[mode].model, *last_, now)) fail(What::W, k - 1, mode);
  }
  if (const Index mode = mode_of(now); !other_ && mode >= 0 && leaves_V(bank_[mode].model, now))
    fail(What::V, k, mode);
}

void AssumptionCheck::fail(What what, Index k, Index mode) {
  const FailedAssumption failed{what, k, mode, seed_offset_};
  (what == What::initial_set ? start_ : other_) = failed;
  if (earlier(failed, earliest_)) earliest_ = failed;
}

void tell(const std::optional<FailedAssumption>& failed, PipelineOutcome& outcome) {
  outcome.failed_assumption = failed;
  outcome.assumptions_until = failed ? failed->from() : -1;
}

}  // namespace cordon::detail

namespace cordon {

std::string_view to_string(FailedAssumption::What what) noexcept {
  switch (what) {
    case FailedAssumption::What::initial_set:
      return "initial_set";
    case FailedAssumption::What::restart_set:
      return "restart_set";
    case FailedAssumption::What::admissible_set:
      return "admissible_set";
    case FailedAssumption::What::U:
      return "U";
    case FailedAssumption::What::modes:
      return "modes";
    case FailedAssumption::What::W:
      return "W";
    case FailedAssumption::What::V:
      return "V";
    case FailedAssumption::What::W_exactly:
      return "W_exactly";
    case FailedAssumption::What::V_exactly:
      return "V_exactly";
    case FailedAssumption::What::invariants:
      return "invariants";
  }
  return "initial_set";
}

std::string text_of(const FailedAssumption& failed, const std::vector<std::string>& modes) {
  const bool named = failed.mode >= 0 && static_cast<std::size_t>(failed.mode) < modes.size();
  const std::string of =
      named ? fmt::format(" of mode \"{}\"", modes[static_cast<std::size_t>(failed.mode)]) : "";
  const Index k = failed.k;
  switch (failed.what) {
    case FailedAssumption::What::initial_set:
      return fmt::format("x_{} lies outside {}{}", k,
                         named   ? "X0"
                         : k > 0 ? "the restart set, from which estimates begin anew there"
                                 : "the initial set",
                         of);
    case FailedAssumption::What::restart_set:
      return fmt::format(
          "x_{} lies outside the restart set, from which all modes begin anew at k = {}", k, k);
    case FailedAssumption::What::admissible_set:
      return fmt::format("x_{} lies outside an admissible set of the pipeline", k);
    case FailedAssumption::What::U:
      return fmt::format(
          "u_{} lies outside the input set U, on which statements made in advance rest", k);
    case FailedAssumption::What::modes:
      return fmt::format(
          "the plant at k = {} follows no mode that the diagnoser knows, and what it does then "
          "lasts in the state",
          k);
    case FailedAssumption::What::W:
      return fmt::format("no w in W{} leads from x_{} to x_{}, the states of the simulated plant",
                         of, k, k + 1);
    case FailedAssumption::What::V:
      return fmt::format("no v in V{} leads from x_{} to y_{}, the output of the simulated plant",
                         of, k, k);
    case FailedAssumption::What::W_exactly:
      return fmt::format(
          "no w in W{} leads from x_{} to the very numbers of x_{}, which the simulation has "
          "rounded",
          of, k, k + 1);
    case FailedAssumption::What::V_exactly:
      return fmt::format(
          "no v in V{} leads from x_{} to the very numbers of y_{}, which the simulation has "
          "rounded",
          of, k, k);
    case FailedAssumption::What::invariants:
      return fmt::format("x_{} does not meet the invariants of the system", k);
  }
  return "";
}

}  // namespace cordon
