// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/interval_modes.hpp"

#include <algorithm>
#include <optional>

#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "diagnosers/observer_bank/state_bounds.hpp"

namespace cordon::estimators {

namespace {

constexpr double rounded_up = 1 + 1e-12;  ///< of sums of at most some hundred terms
constexpr double raised = 1 + 1e-4;       ///< X̄ over the states that it makes
constexpr int most_rounds = 300;

bool is_positive(const Matrix& radius) { return radius.size() != 0 && radius.maxCoeff() > 0; }

Vector magnitude_of(const Box& box) { return box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()); }

/// Adds a box of these half widths: a column and a generator for each that is positive.
void add_box(Matrix& T, LineForm& set, const Vector& half_widths) {
  std::vector<Index> rows;
  for (Index i = 0; i < half_widths.size(); ++i)
    if (half_widths[i] > 0) rows.push_back(i);
  if (rows.empty()) return;
  const auto count = static_cast<Index>(rows.size());
  const Matrix unit = Matrix::Identity(T.rows(), T.rows());
  T.conservativeResize(Eigen::NoChange, T.cols() + count);
  T.rightCols(count) = unit(Eigen::all, rows);
  const Vector widths = half_widths(rows);
  set = cartesian_product(set, make_zonotope(Vector::Zero(count), Matrix(widths.asDiagonal())));
}

/// With these bounds of |x|.
Model exact_model(Model model, const Vector& state) {
  LinearModel& m = model.linear;
  const Vector inputs =
      model.U.dim() == m.inputs() ? magnitude_of(interval_hull(model.U)) : Vector();
  Vector of_next = Vector::Zero(m.states()), of_outputs = Vector::Zero(m.outputs());
  if (is_positive(m.A_radius)) of_next += m.A_radius * state;
  if (is_positive(m.B_radius) && inputs.size() > 0 && inputs.allFinite())
    of_next += m.B_radius * inputs;
  if (is_positive(m.C_radius)) of_outputs += m.C_radius * state;
  m.A_radius = m.B_radius = m.C_radius = Matrix();
  add_box(m.Bw, model.W, rounded_up * of_next);
  add_box(m.Dv, model.V, rounded_up * of_outputs);
  return model;
}

ModeBank exact_bank(ModeBank bank, const Vector& state) {
  for (Mode& mode : bank.modes)
    if (mode.model.linear.is_uncertain()) mode.model = exact_model(std::move(mode.model), state);
  return bank;
}

/// X̄ that bounds the states of the modes made with it.
std::optional<Vector> invariant_bound(const ModeBank& bank, const OfflineOptions& options) {
  const LinearModel& first = bank.modes.front().model.linear;
  const Index n = first.states();
  const bool same = std::ranges::all_of(
      bank.modes, [&](const Mode& mode) { return mode.model.linear.A == first.A; });
  if (!same || invariant::is_schur(first.A) != Answer::yes) return std::nullopt;
  // Of the plant alone, as by observers without gains.
  const std::vector<Matrix> none(bank.modes.size(), Matrix::Zero(n, first.outputs()));
  Vector state = Vector::Zero(n);
  for (int round = 0; round < most_rounds; ++round) {
    const ModeBank made = exact_bank(bank, state);
    const StateBounds bounds(made, estimators::dynamics_of(made, none), options);
    if (!bounds.is_known()) return std::nullopt;
    const Vector reached = bounds.magnitude(Matrix::Identity(n, n));
    if (!reached.allFinite()) return std::nullopt;
    if ((reached.array() <= state.array()).all()) return state;
    state = raised * reached;
  }
  return std::nullopt;
}

}  // namespace

ExactModes with_exact_matrices(const ModeBank& bank, const OfflineOptions& options) {
  const Index n = bank[bank.nominal].model.linear.states();
  const auto any = [&](auto&& has) {
    return std::ranges::any_of(bank.modes,
                               [&](const Mode& mode) { return has(mode.model.linear); });
  };
  const bool with_state =
      any([](const LinearModel& m) { return is_positive(m.A_radius) || is_positive(m.C_radius); });
  std::optional<Vector> state = Vector::Zero(n);
  ExactModes made;
  try {
    const bool has_inputs = std::ranges::all_of(bank.modes, [](const Mode& mode) {
      return mode.model.U.dim() == mode.model.linear.inputs() &&
             interval_hull(mode.model.U).is_bounded();
    });
    if (with_state && options.state_set) {
      state = magnitude_of(
          sets::interval_hull(invariant::enclosing_zonotope(*options.state_set, "the state set")));
    } else if (with_state && has_inputs) {
      state = invariant_bound(bank, options);
    }
    if (state) {
      made.bank = exact_bank(bank, *state);
      return made;
    }
    made.problems.push_back(
        {"/state_set",
         "interval matrices act on the errors with the state, and no bounds of it were found: the "
         "modes differ in the centre of A, or some A of its interval may be unstable",
         "a set that contains the plant's state at all times"});
  } catch (const Error& error) {
    if (error.code() == Errc::internal || error.code() == Errc::solver) throw;
    made.problems.push_back({options.state_set ? "/state_set" : "", error.what(), ""});
  }
  made.bank = exact_bank(bank, Vector::Zero(n));
  return made;
}

}  // namespace cordon::estimators
