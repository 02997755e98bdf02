// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/fault_estimation_filter/filter_recursion.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/invariant/minimal.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/sets/generator_reduction.hpp"

namespace cordon::estimators {

using linalg::product;

namespace {

/// S̃ is kept so far from singular, relative to the terms of its diagonal: Ḡ is free, and must not
/// be rounding noise.
constexpr double regularisation = 1e-13;
/// Squares below this have no digits left.
constexpr double smallest_square = 1e-280;
/// Ω annihilates what its outputs have in common up to this: the rest is rounding, and no gain may
/// rest on it.
constexpr double annihilated = 1e-13;

Matrix joined(const Matrix& left, const Matrix& right) {
  Matrix both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

/// A B without the entries that have cancelled.
Matrix without_noise(const Matrix& A, const Matrix& B) {
  const Matrix C = product(A, B);
  return (C.array().abs() <= annihilated * product(A.cwiseAbs(), B.cwiseAbs()).array())
      .select(0.0, C);
}

}  // namespace

FilterRecursion::FilterRecursion(const FilterDesign& design, const LinearModel& model,
                                 FilterNoise noise, Index max_columns, NoiseCoupling coupling)
    : max_columns_(max_columns),
      coupling_(coupling),
      C_(model.C),
      N_(design.N),
      Dv_(std::move(noise.Dv)),
      Omega_(design.Omega) {
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
  steps_ = 0;
  find_half_widths();
}

void FilterRecursion::reduce(Matrix& columns) const {
  if (max_columns_ == 0) return;
  columns = sets::reduce_generators(columns, max_columns_, sets::GeneratorReduction::combastel);
}

void FilterRecursion::find_gain() {
  image_ = product(base_, R_);
  seen_ = product(Omega_C_, R_);
  if (has_last_gain()) return;
  Matrix S = product(seen_, seen_.transpose()) + rest_noise_;
  const Vector states = R_.rowwise().squaredNorm();
  const Vector terms = product(Omega_C_.cwiseAbs2(), states) + rest_noise_.diagonal();
  for (Index i = 0; i < S.rows(); ++i)
    S(i, i) += terms[i] > smallest_square ? regularisation * terms[i] : 1.0;
  const auto solved =
      linalg::solve_spd(S, product(seen_, image_.transpose()) - gain_noise_.transpose());
  if (!solved)
    throw Error(Errc::not_finite,
                "the error bounds of the fault estimation filter have outgrown the numbers");
  reduced_gain_ = solved->transpose();
  G_ = base_gain_ + product(reduced_gain_, Omega_);
}

void FilterRecursion::advance() {
  find_gain();
  if (coupling_ == NoiseCoupling::shared) {
    A_ = joined(product(error_map(), A_), shared_noise());
    reduce(A_);
  }
  R_ = joined(image_ - product(reduced_gain_, seen_), independent_noise());
  reduce(R_);
  ++steps_;
  find_half_widths();
}

Matrix FilterRecursion::independent_noise() const {
  Matrix noise(TDw_.rows(), TDw_.cols() + 2 * Dv_.cols());
  noise << TDw_, -product(G_, Dv_), -NDv_;
  return noise;
}

Matrix FilterRecursion::shared_noise() const {
  Matrix own = product(G_, Dv_);
  if (steps_ > 0) own += product(error_map(), NDv_);
  return joined(TDw_, -own);
}

Matrix FilterRecursion::noise() const {
  return coupling_ == NoiseCoupling::shared ? shared_noise() : independent_noise();
}

bool FilterRecursion::is_same(const FilterRecursion& other) const {
  const auto same = [](const Matrix& X, const Matrix& Y) {
    return X.rows() == Y.rows() && X.cols() == Y.cols() && X == Y;
  };
  return (steps_ == 0) == (other.steps_ == 0) && same(R_, other.R_) &&
         (coupling_ != NoiseCoupling::shared || same(A_, other.A_));
}

Vector FilterRecursion::seen(const Matrix& errors) const {
  return product(MC_, errors).cwiseAbs().rowwise().sum();
}

Matrix FilterRecursion::error_map() const { return base_ - product(reduced_gain_, Omega_C_); }

void FilterRecursion::find_half_widths() {
  half_width_ = own_noise_ + seen(seen_errors());
  if (!half_width_.allFinite()) {
    throw Error(Errc::not_finite,
                "the error bounds of the fault estimation filter have outgrown the numbers");
  }
}

namespace {

/// Do errors of any direction die out under this map? `size` as for Decay. Proven, or no.
std::optional<invariant::Decay> decay_of(const Matrix& map, const Vector& size) {
  try {
    return invariant::Decay(map, size, "TA - G C");
  } catch (const Error& error) {
    if (error.code() != Errc::invalid && error.code() != Errc::unsupported &&
        error.code() != Errc::not_finite)
      throw;
    return std::nullopt;
  }
}

/// The largest half widths of the circle that the recursion ends in; nothing if none has closed, or
/// if errors that its columns do not have, rounding among them, are not shown to die out from round
/// to round. After Brent: the state is kept at powers of two, and every later one is compared with
/// it.
std::optional<Vector> largest_of_circle(FilterRecursion recursion) {
  constexpr Index most_steps = 50'000;
  const Index n = recursion.errors().rows();
  FilterRecursion kept = recursion;
  Index until = 64, length = 0;
  for (Index k = 0; k < most_steps; ++k, ++length) {
    recursion.advance();
    if (recursion.is_same(kept)) {
      Vector largest = recursion.half_widths();
      Matrix round = Matrix::Identity(n, n), error = Matrix::Zero(n, n);
      for (Index j = 0; j <= length; ++j) {
        recursion.advance();
        largest = largest.cwiseMax(recursion.half_widths());
        const Matrix map = recursion.error_map();
        error = (product(map.cwiseAbs(), error) + rounding::product_error(map, round)) *
                (1 + 2 * rounding::gamma(n + 8));
        round = product(map, round);
      }
      if (!round.allFinite() || !error.allFinite()) return std::nullopt;
      return invariant::radius_bounds(round, error).upper < 1 ? std::optional(largest)
                                                              : std::nullopt;
    }
    if (length < until) continue;
    kept = recursion;
    until *= 2;
    length = -1;
  }
  return std::nullopt;
}

/// Of a recursion whose gain stays, at all times from now on.
std::optional<Vector> bounds_of_powers(const FilterRecursion& recursion) {
  constexpr double accuracy = 1e-10;
  const Vector zero = Vector::Zero(recursion.errors().rows());
  const sets::Zonotope noise{zero, recursion.noise()}, now{zero, recursion.seen_errors()};
  const Vector size = noise.G.cwiseAbs().rowwise().sum() + now.G.cwiseAbs().rowwise().sum();
  const auto decay = decay_of(recursion.error_map(), size);
  if (!decay) return std::nullopt;
  Vector widths = recursion.own_noise();
  for (Index i = 0; i < widths.size(); ++i) {
    const Vector row = recursion.output_map().row(i).transpose();
    widths[i] += invariant::switched_supports(*decay, {noise}, {now}, row, accuracy).plus;
  }
  return widths;
}

}  // namespace

Vector lasting_half_widths(FilterRecursion recursion, const Matrix& H) {
  recursion.start(H);
  const Vector none = Vector::Constant(recursion.half_widths().size(), infinity);
  try {
    if (recursion.is_reduced()) return largest_of_circle(std::move(recursion)).value_or(none);
    while (!recursion.has_last_gain()) recursion.advance();
    return bounds_of_powers(recursion).value_or(none);
  } catch (const Error& error) {
    if (error.code() != Errc::not_finite && error.code() != Errc::unsupported) throw;
    return none;  // the numbers end, and so would the filter; or too many powers
  }
}

void FilterRecursion::serialize(Archive& archive) {
  const Index n = C_.cols();
  archive(R_, A_, steps_, half_width_);
  if (R_.rows() != n || A_.rows() != n || half_width_.size() != MC_.rows())
    archive.refuse("error sets of another dimension");
  if (steps_ < 0) archive.refuse("a step before the first one");
  if (!R_.allFinite() || !A_.allFinite()) archive.refuse("error sets that are not finite");
  if (steps_ == 0) return;  // no gain yet
  if (archive.is_reading()) {
    G_.resize(base_gain_.rows(), base_gain_.cols());
    reduced_gain_.resize(base_gain_.rows(), Omega_.rows());
  }
  archive.same_shape(G_);
  archive.same_shape(reduced_gain_);
}

}  // namespace cordon::estimators
