// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/basis_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cordon {

namespace {

constexpr Index lanes = Panels<float>::width;
constexpr float relaxation = 1.6F;
constexpr float dependent =
    1e-4F;  ///< a row is taken for dependent when less than this share of it is left

}  // namespace

BasisGuess::BasisGuess(const Matrix& A, VectorIn b)
    : rounds_(1 + A.rows() / 4),
      rows_(A),
      right_(static_cast<std::size_t>(A.rows())),
      w_(right_.size()),
      sums_(static_cast<std::size_t>(A.rows() * lanes)),
      g_(static_cast<std::size_t>(rows_.padded_cols())),
      split_(g_.size()),
      dual_(g_.size()),
      scores_(A.cols()) {
  for (Index i = 0; i < A.rows(); ++i)
    right_[static_cast<std::size_t>(i)] = static_cast<float>(std::clamp(b[i], -1e30, 1e30));
  orthonormalise();
}

/// Modified Gram-Schmidt.
void BasisGuess::orthonormalise() {
  const auto product = [this](Index i, Index k) {
    Line<float> sum;
    for (Index p = 0; p < rows_.panels(); ++p)
      sum.add(Line<float>::load(rows_.line(p, i)), Line<float>::load(rows_.line(p, k)));
    return sum.total();
  };
  const auto add = [this](Index i, float factor, Index k) {
    for (Index p = 0; p < rows_.panels(); ++p) {
      Line<float> line = Line<float>::load(rows_.line(p, i));
      line.add(factor, Line<float>::load(rows_.line(p, k)));
      line.store(rows_.line(p, i));
    }
    right_[static_cast<std::size_t>(i)] += factor * right_[static_cast<std::size_t>(k)];
  };
  for (Index i = 0; i < rows_.rows(); ++i) {
    const float before = product(i, i);
    for (Index k = 0; k < i; ++k) add(i, -product(i, k), k);
    const float after = product(i, i);
    add(i, after > dependent * dependent * before ? 1 / std::sqrt(after) - 1 : -1.0F, i);
  }
}

const Vector& BasisGuess::scores(VectorIn g) {
  for (Index j = 0; j < g.size(); ++j) g_[static_cast<std::size_t>(j)] = static_cast<float>(g[j]);
  least_squares();
  for (Index k = 0; k < rounds_; ++k) round(k == 0 ? 1.0F : relaxation);
  for (Index p = 0; p < rows_.panels(); ++p) {
    float value[lanes];
    rows_.transpose_times(p, w_.data()).store(value);
    const Index first = p * lanes;
    for (Index k = 0; k < std::min(lanes, g.size() - first); ++k) {
      const std::size_t j = static_cast<std::size_t>(first + k);
      scores_[first + k] = std::abs(g_[j] - value[k] - dual_[j]);
    }
  }
  return scores_;
}

/// w = Q g; the size of g - Qᵀw tells what counts as small.
void BasisGuess::least_squares() {
  std::fill(sums_.begin(), sums_.end(), 0.0F);
  Line<float> squares;
  for (Index p = 0; p < rows_.panels(); ++p) {
    const Line<float> g = Line<float>::load(&g_[static_cast<std::size_t>(p * lanes)]);
    rows_.add_times(p, g, sums_.data());
    squares.add(g, g);
  }
  total(0);
  const float all = squares.total();
  const float part = std::inner_product(w_.begin(), w_.end(), w_.begin(), 0.0F);
  threshold_ = std::sqrt(std::max(all - part, 1e-6F * all) / static_cast<float>(scores_.size()));
  std::fill(dual_.begin(), dual_.end(), 0.0F);
}

void BasisGuess::round(float relax) {
  using Part = Line<float>::Part;
  std::fill(sums_.begin(), sums_.end(), 0.0F);
  const Part zero{}, threshold = zero + threshold_;
  for (Index p = 0; p < rows_.panels(); ++p) {
    const std::size_t first = static_cast<std::size_t>(p * lanes);
    Line<float> value = rows_.transpose_times(p, w_.data());
    const Line<float> g = Line<float>::load(&g_[first]);
    Line<float> split = Line<float>::load(&split_[first]), dual = Line<float>::load(&dual_[first]);
    for (int k = 0; k < 4; ++k) {
      const Part v = g.part[k] -
                     (relax * value.part[k] + (1 - relax) * (g.part[k] - split.part[k])) -
                     dual.part[k];
      const Part above = v - threshold, below = v + threshold;
      split.part[k] = (above > zero ? above : zero) + (below < zero ? below : zero);
      dual.part[k] = split.part[k] - v;
      value.part[k] = g.part[k] - split.part[k] - dual.part[k];
    }
    split.store(&split_[first]);
    dual.store(&dual_[first]);
    rows_.add_times(p, value, sums_.data());
  }
  total(threshold_);
}

/// w = totals - threshold q.
void BasisGuess::total(float threshold) {
  for (std::size_t i = 0; i < w_.size(); ++i)
    w_[i] = Line<float>::load(&sums_[i * lanes]).total() - threshold * right_[i];
}

}  // namespace cordon
