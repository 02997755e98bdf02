// SPDX-License-Identifier: GPL-3.0-or-later
// The iterations of the dual simplex method: pricing, bound flipping and the exchange of variables.
#include "solvers/box_simplex.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/solvers/limits.hpp"

namespace cordon {

using vectors::add_multiple;
using vectors::dot;
using vectors::load;
using vectors::Pair;
using vectors::store;

namespace {

constexpr double feasible = 1e-9;  ///< a bound may be exceeded by this
constexpr double smallest_pivot =
    1e-12;  ///< of a row of the tableau, relative to the norm of the inverse's row
constexpr double agreement = 1e-7;  ///< of a pivot computed by row and by column
constexpr Index fresh_enough =
    30;  ///< updates after which basic values are computed anew before they are believed
constexpr double no_step = 1e-12;      ///< of the multipliers: the bound stays where it is
constexpr Index patience = 6;          ///< with as many such steps in a row
constexpr double perturbation = 1e-6;  ///< of the costs, after that

}  // namespace

BoxSimplex::BoxSimplex(const Matrix& A, VectorIn b)
    : m_(A.rows()),
      g_(A.cols()),
      height_(vectors::padded(m_)),
      columns_(Matrix::Zero(height_, g_)),
      inverse_(height_, m_),
      panels_(A),
      sums_(static_cast<std::size_t>(m_ * Panels<double>::width)),
      b_(Vector::Zero(height_)),
      y_(b_),
      basic_value_(b_),
      norms_(b_),
      rho_(b_),
      image_(b_),
      change_(b_),
      change_image_(b_),
      basic_(static_cast<std::size_t>(m_)),
      order_(static_cast<std::size_t>(g_)),
      candidates_(static_cast<std::size_t>(panels_.padded_cols())),
      steps_(candidates_.size() + vectors::block),
      cost_(Vector::Zero(panels_.padded_cols())),
      side_(cost_),
      reduced_(cost_),
      decrease_(cost_) {
  columns_.topRows(m_) = A;
  b_.head(m_) = b;
}

BoxSimplex::Status BoxSimplex::maximize(VectorIn g, VectorIn scores, double enough, Index most) {
  cost_.head(g_) = g;
  objective_ = g;
  perturbed_ = false;
  order_by(scores);
  build_basis();
  return solve(enough, most);
}

/// Makes all reduced costs positive, by amounts that differ: where many vanish, as under an
/// objective of few entries, the method would go around in circles among bases of one bound. The
/// multipliers stay.
void BoxSimplex::perturb_costs() {
  for (Index j = 0; j < g_; ++j) {
    const double place = static_cast<double>(j + 1) * 0.6180339887498949;
    const double amount = perturbation * (1 + place - std::floor(place));
    cost_[j] += side_[j] * amount;
    if (side_[j] != 0) reduced_[j] += amount;
  }
  perturbed_ = true;
}

/// The objective as it was given. Variables whose reduced costs vanish stay where they are, as do
/// the basic values then.
bool BoxSimplex::take_back_perturbations() {
  cost_.head(g_) = objective_;
  perturbed_ = false;
  find_multipliers();
  panels_.transpose_times(y_.data(), decrease_.data());
  for (Index j = 0; j < g_; ++j) {
    const double d = cost_[j] - decrease_[j];
    if (side_[j] * d < -no_step) side_[j] = -side_[j];
    reduced_[j] = std::max(side_[j] * d, 0.0);
  }
  solve_basics();
  return basic_value_.allFinite() && y_.allFinite();
}

/// The bound that the multipliers of the basis show.
double BoxSimplex::objective() const {
  double sum = dot(cost_.size(), cost_.data(), side_.data());
  for (Index i = 0; i < m_; ++i) {
    if (!is_artificial(basic(i))) sum += cost_[basic(i)] * basic_value_[i];
  }
  return sum;
}

/// What the present basis shows, with its multipliers.
BoxSimplex::Status BoxSimplex::concluded(Status status) {
  find_multipliers();
  refine_multipliers();
  return status;
}

constexpr Index look_at_clock = 16;  // iterations

BoxSimplex::Status BoxSimplex::solve(double enough, Index most) {
  iterations_ = 0;
  if (!LimitedSolvers::may_begin() || !take_objective()) return Status::unsolved;
  bool rebuilt = false;
  Index idle = 0;
  for (const Index limit = std::min(most, 200 + 20 * (m_ + g_)); iterations_ < limit;
       ++iterations_) {
    if (iterations_ % look_at_clock == 0 && LimitedSolvers::is_over()) return Status::unsolved;
    const bool is_below = enough > any && objective() < enough;
    const Index row = is_below ? none : leaving_row();
    if (row == none && perturbed_) {
      if (!take_back_perturbations()) return Status::unsolved;
      continue;
    }
    if (is_below) return concluded(Status::below);
    if (row == none && updates_ >= fresh_enough) {
      solve_basics();
      continue;
    }
    if (row == none) return concluded(Status::optimal);
    direction_ = basic_value_[row] < 0 ? 1 : -1;
    price(row);
    const Index entering = entering_variable(std::abs(basic_value_[row]) - room(row));
    if (entering == none) {
      y_ = -direction_ * rho_;
      return Status::infeasible;
    }
    idle = steps_[passed_] > no_step ? 0 : idle + 1;
    if (idle > patience && !perturbed_) {
      perturb_costs();
      idle = 0;
      continue;
    }
    if (exchange(row, entering)) continue;
    if (rebuilt && updates_ == 0) return Status::unsolved;
    rebuilt = true;
    if (!rebuild()) return Status::unsolved;
  }
  return Status::unsolved;
}

/// The largest violation of a bound beside the norm of its row, or none.
Index BoxSimplex::leaving_row() const {
  Index best = none;
  double steepest = 0;
  for (Index i = 0; i < m_; ++i) {
    const double violation = std::abs(basic_value_[i]) - room(i);
    if (!(violation > feasible) || violation * violation <= steepest * norms_[i]) continue;
    steepest = violation * violation / norms_[i];
    best = i;
  }
  return best;
}

/// The row of the tableau: how fast each reduced cost falls, and where those that fall vanish.
void BoxSimplex::price(Index row) {
  const double* const from = &inverse_(row, 0);
  for (Index k = 0; k < m_; ++k) rho_[k] = from[k * height_];
  panels_.transpose_times(rho_.data(), decrease_.data());
  double* const decrease = decrease_.data();
  const double* const side = side_.data();
  for (Index j = 0; j < decrease_.size(); ++j) decrease[j] *= direction_ * side[j];
  const double least = smallest_pivot * std::sqrt(norms_[row]);
  Index* const candidates = candidates_.data();
  double* const steps = steps_.data();
  std::size_t count = 0;
  for (Index j = 0; j < g_; ++j) {
    candidates[count] = j;
    count += decrease[j] > least;
  }
  for (std::size_t k = 0; k < count; ++k)
    steps[k] = reduced_[candidates[k]] / decrease[candidates[k]];
  for (std::size_t k = count; k < count + vectors::block; ++k) steps[k] = infinity;
  candidate_count_ = count;
}

/// Passes breakpoints while the bound still falls; the last one enters. None if the bound falls
/// without end, beyond what the tolerance of bounds explains.
Index BoxSimplex::entering_variable(double infeasibility) {
  double slope = infeasibility, largest = 0;
  for (passed_ = 0; slope > feasible / 2; ++passed_) {
    if (passed_ == candidate_count_) return none;
    select(passed_);
    const double pivot = decrease_[candidates_[passed_]];
    slope -= 2 * pivot;
    largest = std::max(largest, pivot);
  }
  // A tiny pivot makes a bad basis: any breakpoint before it will do as well.
  do {
    --passed_;
  } while (decrease_[candidates_[passed_]] < 1e-5 * largest);
  return candidates_[passed_];
}

/// Brings the candidate with the first breakpoint among those from `place` on to that place.
void BoxSimplex::select(std::size_t place) {
  double* const steps = steps_.data();
  Pair low = load(steps + place), high = load(steps + place + 2);
  for (std::size_t k = place + vectors::block; k < candidate_count_; k += vectors::block) {
    const Pair first = load(steps + k), second = load(steps + k + 2);
    low = first < low ? first : low;
    high = second < high ? second : high;
  }
  low = high < low ? high : low;
  const double least = low[0] < low[1] ? low[0] : low[1];
  std::size_t best = place;
  while (best + 1 < candidate_count_ && steps[best] != least) ++best;
  std::swap(steps[place], steps[best]);
  std::swap(candidates_[place], candidates_[best]);
}

/// Variables whose breakpoints were passed go to their other bounds.
void BoxSimplex::flip_passed() {
  if (passed_ == 0) return;
  change_.setZero();
  for (std::size_t k = 0; k < passed_; ++k) {
    const Index j = candidates_[k];
    add_multiple(height_, -2 * side_[j], &columns_(0, j), change_.data());
    side_[j] = -side_[j];
    reduced_[j] = -reduced_[j];
  }
  transform(change_.data(), change_image_);
  basic_value_ -= change_image_;
}

/// False, with nothing changed, if the pivot is not known well enough.
bool BoxSimplex::exchange(Index row, Index entering) {
  transform(&columns_(0, entering), image_);
  const double pivot = image_[row], step = steps_[passed_], side = side_[entering],
               size = decrease_[entering];
  if (!(std::abs(pivot * direction_ * side - size) <= agreement * size)) return false;

  reduced_ -= step * decrease_;
  flip_passed();
  reduced_ = reduced_.cwiseMax(0.0);
  const Index leaving = basic(row);
  const double move = (basic_value_[row] + direction_ * room(row)) / pivot;
  add_multiple(height_, -move, image_.data(), basic_value_.data());
  basic_value_[row] = side + move;
  update_inverse(row);
  basic_[static_cast<std::size_t>(row)] = entering;
  side_[entering] = 0;
  reduced_[entering] = 0;
  if (!is_artificial(leaving)) {
    side_[leaving] = -direction_;
    reduced_[leaving] = step;
  }
  ++updates_;
  return true;
}

}  // namespace cordon
