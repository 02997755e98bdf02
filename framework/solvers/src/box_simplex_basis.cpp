// SPDX-License-Identifier: GPL-3.0-or-later
// The basis of the dual simplex method: chosen from columns, with its inverse, the basic values and
// the multipliers.
#include <algorithm>
#include <cmath>

#include "solvers/box_simplex.hpp"

namespace cordon {

using vectors::add_multiple;
using vectors::dot;
using vectors::load;
using vectors::Pair;
using vectors::store;

namespace {

constexpr double first_pivot =
    1e-3;  ///< of the columns that a basis is built from, relative to their size

}  // namespace

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

}  // namespace cordon
