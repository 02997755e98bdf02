// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/fault_estimation_filter/filter_recursion.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/generator_reduction.hpp"

namespace cordon::estimators {

using linalg::product;

namespace {

/// S̃ is kept so far from singular, relative to the terms of its diagonal: Ḡ is free, and must not be rounding noise.
constexpr double regularisation = 1e-13;
/// Squares below this have no digits left.
constexpr double smallest_square = 1e-280;
/// Ω annihilates what its outputs have in common up to this: the rest is rounding, and no gain may rest on it.
constexpr double annihilated = 1e-13;

/// A B without the entries that have cancelled.
Matrix without_noise(const Matrix& A, const Matrix& B) {
  const Matrix C = product(A, B);
  return (C.array().abs() <= annihilated * product(A.cwiseAbs(), B.cwiseAbs()).array()).select(0.0, C);
}

}  // namespace

FilterRecursion::FilterRecursion(const FilterDesign& design, const LinearModel& model, FilterNoise noise, Index max_columns,
                                 NoiseCoupling coupling)
    : max_columns_(max_columns), coupling_(coupling), C_(model.C), N_(design.N), Dv_(std::move(noise.Dv)), Omega_(design.Omega) {
  base_gain_ = product(design.Phi, design.M);
  base_ = product(design.T, model.A) - product(base_gain_, C_);
  Omega_C_ = without_noise(Omega_, C_);
  TDw_ = product(design.T, noise.Dw);
  NDv_ = product(N_, Dv_);
  const Matrix rest = without_noise(Omega_, Dv_);
  gain_noise_ = product(product(base_gain_, Dv_), rest.transpose());
  rest_noise_ = product(rest, rest.transpose());
  MC_ = product(design.M, C_);
  Matrix own = product(design.M, Dv_);
  if (coupling_ == NoiseCoupling::shared) own -= product(MC_, NDv_);
  own_noise_ = own.cwiseAbs().rowwise().sum();
}

void FilterRecursion::start(const Matrix& H) {
  R_ = H;
  reduce(R_);
  A_ = R_;
  first_ = true;
  find_half_widths();
}

void FilterRecursion::reduce(Matrix& columns) const {
  if (max_columns_ == 0) return;
  columns = sets::reduce_generators(columns, max_columns_, sets::GeneratorReduction::combastel);
}

void FilterRecursion::find_gain() {
  image_ = product(base_, R_);
  seen_ = product(Omega_C_, R_);
  Matrix S = product(seen_, seen_.transpose()) + rest_noise_;
  const Vector states = R_.rowwise().squaredNorm();
  const Vector terms = product(Omega_C_.cwiseAbs2(), states) + rest_noise_.diagonal();
  for (Index i = 0; i < S.rows(); ++i) S(i, i) += terms[i] > smallest_square ? regularisation * terms[i] : 1.0;
  const auto solved = linalg::solve_spd(S, product(seen_, image_.transpose()) - gain_noise_.transpose());
  if (!solved) throw Error(Errc::not_finite, "the error bounds of the fault estimation filter have outgrown the numbers");
  reduced_gain_ = solved->transpose();
  G_ = base_gain_ + product(reduced_gain_, Omega_);
}

void FilterRecursion::advance() {
  find_gain();
  if (coupling_ == NoiseCoupling::shared) advance_shared();
  const Index old = R_.cols(), w = TDw_.cols(), v = Dv_.cols();
  Matrix next(R_.rows(), old + w + 2 * v);
  next << image_ - product(reduced_gain_, seen_), TDw_, -product(G_, Dv_), -NDv_;
  R_ = std::move(next);
  reduce(R_);
  first_ = false;
  find_half_widths();
}

Vector FilterRecursion::seen(const Matrix& errors) const { return product(MC_, errors).cwiseAbs().rowwise().sum(); }

Matrix FilterRecursion::error_map() const { return base_ - product(reduced_gain_, Omega_C_); }

void FilterRecursion::advance_shared() {
  const Matrix map = error_map();
  Matrix own = product(G_, Dv_);
  if (!first_) own += product(map, NDv_);
  Matrix next(A_.rows(), A_.cols() + TDw_.cols() + own.cols());
  next << product(map, A_), TDw_, -own;
  A_ = std::move(next);
  reduce(A_);
}

void FilterRecursion::find_half_widths() {
  const Matrix& errors = coupling_ == NoiseCoupling::shared ? A_ : R_;
  half_width_ = own_noise_ + seen(errors);
  if (!half_width_.allFinite()) {
    throw Error(Errc::not_finite, "the error bounds of the fault estimation filter have outgrown the numbers");
  }
}

namespace {

/// For each fault: does what an error of any direction adds to it die out, from here on? Compared are two stretches of 200 steps.
std::vector<bool> forgets_errors(FilterRecursion recursion) {
  constexpr double least_decay = 1e-6;
  const Index n = recursion.error_map().rows();
  Matrix errors = Matrix::Identity(n, n);
  Vector largest[2];
  for (Vector& stretch : largest) {
    stretch = Vector::Zero(recursion.half_widths().size());
    for (int k = 0; k < 200; ++k) {
      recursion.advance();
      errors = product(recursion.error_map(), errors);
      stretch = stretch.cwiseMax(recursion.seen(errors));
    }
  }
  std::vector<bool> forgets;
  for (Index i = 0; i < largest[0].size(); ++i) forgets.push_back(largest[1][i] <= (1 - least_decay) * largest[0][i]);
  return forgets;
}

}  // namespace

Vector lasting_half_widths(FilterRecursion recursion, const Matrix& H) {
  constexpr double infinity = std::numeric_limits<double>::infinity(), same = 1e-9, grown = .01;
  recursion.start(H);
  Vector largest = Vector::Constant(recursion.half_widths().size(), infinity), before;
  const Index last = recursion.is_reduced() ? 12'800 : 400;
  for (Index steps = 50; steps <= last; steps *= 2) {
    before = std::exchange(largest, Vector::Zero(largest.size()));
    try {
      for (Index k = 0; k < steps; ++k) {
        recursion.advance();
        largest = largest.cwiseMax(recursion.half_widths());
      }
    } catch (const Error& error) {
      if (error.code() != Errc::not_finite) throw;
      return Vector::Constant(largest.size(), infinity);  // so would the filter end
    }
    if (((largest - before).cwiseAbs().array() <= same * largest.array()).all()) break;
  }
  largest = (largest.array() <= (1 + grown) * before.array()).select(largest, infinity);
  const std::vector<bool> forgets = forgets_errors(std::move(recursion));
  for (Index i = 0; i < largest.size(); ++i) {
    if (!forgets[static_cast<std::size_t>(i)]) largest[i] = infinity;
  }
  return largest;
}

}  // namespace cordon::estimators
