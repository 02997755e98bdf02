// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_simplex.hpp"

#include <algorithm>
#include <cmath>

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
constexpr double first_pivot =
    1e-3;  ///< of the columns that a basis is built from, relative to their size
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

/// The m best come first and in order, of equal ones the first; one that is no number comes last.
/// The others follow in any order.
void BoxSimplex::order_by(VectorIn scores) {
  reduced_.head(g_) = scores.array().isNaN().select(infinity,
                                                    scores);  // not in use yet
  const double* const score = reduced_.data();
  const Index best = std::min(g_, m_);
  Index* const order = order_.data();
  Index made = 0, rest = g_;
  for (Index j = 0; j < g_; ++j) {
    const double here = score[j];
    if (made == best) {
      if (best == 0 || !(here < score[order[best - 1]])) {
        order[--rest] = j;
        continue;
      }
      order[--rest] = order[best - 1];
    } else {
      ++made;
    }
    Index place = made - 1;
    for (; place > 0 && here < score[order[place - 1]]; --place) order[place] = order[place - 1];
    order[place] = j;
  }
}

/// From artificials alone, by the columns in `order_` as far as they are independent.
void BoxSimplex::build_basis() {
  inverse_.setZero();
  for (Index i = 0; i < m_; ++i) {
    basic_[static_cast<std::size_t>(i)] = g_ + i;
    inverse_(i, i) = 1;
  }
  side_.head(g_).setOnes();
  Index made = 0;
  for (std::size_t k = 0; k < order_.size() && k < static_cast<std::size_t>(2 * m_) && made < m_;
       ++k) {
    if (!bring_in(order_[k])) continue;
    side_[order_[k]] = 0;
    ++made;
  }
  norms_.setZero();
  for (Index k = 0; k < m_; ++k) norms_ += inverse_.col(k).cwiseAbs2();
}

/// In place of the artificial with the largest pivot, if that is large enough. The inverse's
/// columns of rows whose artificials are basic are unit vectors still.
bool BoxSimplex::bring_in(Index variable) {
  const double* const column = &columns_(0, variable);
  for (Index i = 0; i < height_; ++i) image_[i] = 0;
  double size = 0, best = 0;
  for (Index k = 0; k < m_; ++k) {
    size = std::max(size, std::abs(column[k]));
    if (is_artificial(basic(k))) {
      image_[k] += column[k];
    } else {
      add_multiple(height_, column[k], &inverse_(0, k), image_.data());
    }
  }
  Index row = none;
  best = first_pivot * size;
  for (Index i = 0; i < m_; ++i) {
    if (!is_artificial(basic(i)) || !(std::abs(image_[i]) > best)) continue;
    best = std::abs(image_[i]);
    row = i;
  }
  if (row == none) return false;
  const double pivot = image_[row];
  image_[row] = 0;
  for (Index k = 0; k < m_; ++k) {
    const double factor = inverse_(row, k) / pivot;
    if (factor == 0) continue;
    add_multiple(height_, -factor, image_.data(), &inverse_(0, k));
    inverse_(row, k) = factor;
  }
  basic_[static_cast<std::size_t>(row)] = variable;
  return true;
}

/// image = B⁻¹v, four rows at a time.
void BoxSimplex::transform(const double* v, Vector& image) const {
  for (Index i = 0; i < height_; i += vectors::block) {
    const double* from = inverse_.data() + i;
    Pair low{0, 0}, high{0, 0};
    for (Index k = 0; k < m_; ++k, from += height_) {
      low += v[k] * load(from);
      high += v[k] * load(from + 2);
    }
    store(&image[i], low);
    store(&image[i + 2], high);
  }
}

/// After the column with this `image_` took the place of the basic variable of a row; `rho_` is
/// that row of the inverse, and is divided by the pivot.
void BoxSimplex::update_inverse(Index row) {
  const double pivot = image_[row];
  rho_ /= pivot;
  for (Index k = 0; k < m_; ++k) inverse_(row, k) = 0;
  image_[row] = -1;  // so that the row itself becomes rho
  for (Index i = 0; i < height_; i += vectors::block) {
    const Pair low = load(&image_[i]), high = load(&image_[i + 2]);
    Pair low_norms{0, 0}, high_norms{0, 0};
    double* place = inverse_.data() + i;
    for (Index k = 0; k < m_; ++k, place += height_) {
      const Pair first = load(place) - rho_[k] * low, second = load(place + 2) - rho_[k] * high;
      store(place, first);
      store(place + 2, second);
      low_norms += first * first;
      high_norms += second * second;
    }
    store(&norms_[i], low_norms);
    store(&norms_[i + 2], high_norms);
  }
  image_[row] = pivot;
}

/// Sides, reduced costs and basic values of the present basis.
bool BoxSimplex::take_objective() {
  find_multipliers();
  panels_.transpose_times(y_.data(), decrease_.data());
  for (Index j = 0; j < g_; ++j) {
    const double d = cost_[j] - decrease_[j];
    side_[j] = side_[j] == 0 ? 0 : d < 0 ? -1 : 1;
    reduced_[j] = side_[j] * d;
  }
  solve_basics();
  return basic_value_.allFinite() && y_.allFinite();
}

/// x_B = B⁻¹(b - N x_N).
void BoxSimplex::solve_basics() {
  constexpr Index width = Panels<double>::width;
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (Index p = 0; p < panels_.panels(); ++p)
    panels_.add_times(p, Line<double>::load(&side_[p * width]), sums_.data());
  for (Index i = 0; i < m_; ++i)
    change_[i] = b_[i] - Line<double>::load(&sums_[static_cast<std::size_t>(i * width)]).total();
  transform(change_.data(), basic_value_);
  updates_ = 0;
}

/// By what is left of the rows; after `solve_basics`.
void BoxSimplex::refine_basics() {
  for (Index i = 0; i < m_; ++i) {
    if (is_artificial(basic(i))) {
      change_[basic(i) - g_] -= basic_value_[i];
    } else {
      add_multiple(height_, -basic_value_[i], &columns_(0, basic(i)), change_.data());
    }
  }
  transform(change_.data(), change_image_);
  basic_value_ += change_image_;
}

/// y = B⁻ᵀ g_B.
void BoxSimplex::find_multipliers() {
  for (Index i = 0; i < m_; ++i) rho_[i] = is_artificial(basic(i)) ? 0 : cost_[basic(i)];
  for (Index k = 0; k < m_; ++k) y_[k] = dot(height_, rho_.data(), &inverse_(0, k));
}

/// By the reduced costs of basic variables, which should vanish.
void BoxSimplex::refine_multipliers() {
  for (Index i = 0; i < m_; ++i) {
    rho_[i] = is_artificial(basic(i))
                  ? -y_[basic(i) - g_]
                  : cost_[basic(i)] - dot(height_, y_.data(), &columns_(0, basic(i)));
  }
  for (Index k = 0; k < m_; ++k) y_[k] += dot(height_, rho_.data(), &inverse_(0, k));
}

/// The inverse, and all that follows from it, anew.
bool BoxSimplex::rebuild() {
  std::size_t first = 0;
  for (Index i = 0; i < m_; ++i) {
    if (!is_artificial(basic(i))) order_[first++] = basic(i);
  }
  for (Index j = 0; j < g_; ++j) {
    if (side_[j] != 0) order_[first++] = j;
  }
  build_basis();
  return take_objective();
}

void BoxSimplex::take_point(Vector& xi) {
  solve_basics();
  refine_basics();
  xi = side_.head(g_);
  for (Index i = 0; i < m_; ++i) {
    if (!is_artificial(basic(i))) xi[basic(i)] = basic_value_[i];
  }
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
bool BoxSimplex::take_back_nudges() {
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

BoxSimplex::Status BoxSimplex::solve(double enough, Index most) {
  iterations_ = 0;
  if (!take_objective()) return Status::unsolved;
  bool rebuilt = false;
  Index idle = 0;
  for (const Index limit = std::min(most, 200 + 20 * (m_ + g_)); iterations_ < limit;
       ++iterations_) {
    const bool is_below = enough > any && objective() < enough;
    const Index row = is_below ? none : leaving_row();
    if (row == none && perturbed_) {
      if (!take_back_nudges()) return Status::unsolved;
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
