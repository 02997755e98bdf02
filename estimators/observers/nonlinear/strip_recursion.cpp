// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/strip_recursion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "observers/nonlinear/least_volume_gain.hpp"

namespace cordon::estimators {

namespace {

double middle_of(Interval x) {
  return std::clamp(0.5 * x.lower + 0.5 * x.upper, x.lower, x.upper);  // halves may underflow
}
double radius_of(Interval x) { return 0.5 * x.upper - 0.5 * x.lower; }

Matrix beside(const Matrix& left, const Matrix& right) {
  Matrix both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

Matrix without_zero_columns(const Matrix& G) {
  Matrix kept(G.rows(), G.cols());
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j)
    if (!G.col(j).isZero(0)) kept.col(count++) = G.col(j);
  return kept.leftCols(count);
}

/// S with S M = B for symmetric M, which may be singular: any S serves.
Matrix divided(const Matrix& B, const Matrix& M) {
  if (const auto found = linalg::solve_spd(M, B.transpose())) return found->transpose();
  return B * linalg::pseudo_inverse(M);
}

/// Box of the set, the rounding of its centre and radii included.
void append_box(const Vector& center, const Vector& radius, std::vector<Interval>& variables) {
  for (Index i = 0; i < center.size(); ++i) {
    const double r = radius[i] + tolerances::product_noise * (radius[i] + std::abs(center[i]));
    variables.push_back({center[i] - r, center[i] + r});
  }
}

void append_known(VectorIn u, Index k, std::vector<Interval>& variables) {
  for (const double known : u) variables.push_back({known, known});
  const auto time = static_cast<double>(k);
  variables.push_back({time, time});
}

Vector radius_of_columns(const Matrix& G) { return G.cwiseAbs().rowwise().sum(); }

/// Columns of <c_e, G_e> but for the diagonal ones, of one function's second derivative.
void write_row(const Matrix& M, Index row, Vector& center, Matrix& columns) {
  center[row] += 0.25 * M.trace();
  Index at = 0;
  for (Index j = 0; j < M.cols(); ++j) columns(row, at++) = 0.25 * M(j, j);
  for (Index j = 0; j < M.cols(); ++j)
    for (Index l = j + 1; l < M.cols(); ++l) columns(row, at++) = 0.5 * (M(j, l) + M(l, j));
}

}  // namespace

Matrix reduced_by_components(const Matrix& given, Index most) {
  const Matrix G = without_zero_columns(given);
  const Index n = G.rows(), m = G.cols(), kept = most - n;
  if (m <= most) return G;
  std::vector<Index> order(as_size(m));
  std::iota(order.begin(), order.end(), Index{0});
  const auto size = [&](Index j) {
    return G.col(j).lpNorm<1>() - G.col(j).lpNorm<Eigen::Infinity>();
  };
  std::ranges::stable_sort(order, {}, size);
  Matrix smallest(n, m - kept), made(n, most);
  for (Index j = 0; j < m - kept; ++j) smallest.col(j) = G.col(order[as_size(j)]);
  for (Index j = 0; j < kept; ++j) made.col(j) = G.col(order[as_size(m - kept + j)]);
  const Matrix U = linalg::principal_axes(smallest).leftCols(n);
  const Vector radii = (U.transpose() * smallest).cwiseAbs().rowwise().sum();
  made.rightCols(n) = U * radii.asDiagonal();
  return made;
}

StripRecursion::StripRecursion(const Model& model, StripVariant variant, Index generators)
    : model_(model.nonlinear),
      variant_(variant),
      most_(generators),
      f_(model_->f, Rounding::nominal, model_->undefined),
      g_(model_->g, model_->states(), formulas::AffineForm::first_order, Rounding::nominal,
         model_->undefined),
      W_(model.W),
      V_(model.V) {}

void StripRecursion::start(const LineForm& X0) {
  c_ = X0.c;
  G_ = X0.G;
}

/// f at k over a box or at a point.
void StripRecursion::evaluate(const std::vector<Interval>& variables, Index k) {
  f_.evaluate(variables);
  for (Index row = 0; row < model_->states(); ++row) {
    if (f_.is_enclosed(row)) continue;
    const formulas::Violation* const why = f_.violation_of(row);
    throw Error(Errc::not_enclosed,
                "no bounded set encloses x_" + std::to_string(row + 1) +
                    " at k = " + std::to_string(k + 1) + ": " +
                    (why ? why->to_string(f_.function()) : "its bounds overflow"));
  }
}

StripRecursion::Linearised StripRecursion::linearised(VectorIn u, Index k) {
  const Index n = model_->states(), m = n + model_->disturbances();
  std::vector<Interval> box, point;
  append_box(c_, radius(), box);
  append_box(W_.c, radius_of_columns(W_.G), box);
  append_known(u, k, box);
  point = box;
  for (Index i = 0; i < m; ++i) {
    const double center = i < n ? c_[i] : W_.c[i - n];
    point[as_size(i)] = {center, center};
  }
  evaluate(box, k);
  f_.bound_rounding();
  f_.differentiate();
  f_.differentiate_twice();
  Linearised made{Vector::Zero(n), Matrix::Zero(n, n), Matrix::Zero(n, m - n), {}};
  Matrix columns = error_columns(made.value);
  evaluate(point, k);
  f_.differentiate();
  Vector reach(m);
  reach << radius(), radius_of_columns(W_.G);
  for (Index row = 0; row < n; ++row) {
    double& rest = columns(row, columns.cols() - n + row);
    made.value[row] += middle_of(f_.value(row));
    rest += radius_of(f_.value(row)) + f_.rounding_error(row);
    for (std::size_t e = 0; e < f_.partials(row); ++e) {
      const auto [variable, slope] = f_.partial(row, e);
      if (!slope.is_finite())
        throw Error(Errc::not_enclosed, "the derivative of x_" + std::to_string(row + 1) +
                                            " is not bounded at the centre of the estimate");
      (variable < n ? made.A(row, variable) : made.Bw(row, variable - n)) = middle_of(slope);
      rest += radius_of(slope) * reach[variable];
    }
  }
  made.errors = reduced_by_components(columns, most_);
  return made;
}

/// Of the second derivatives over the box of the last `differentiate_twice`; adds c_e.
Matrix StripRecursion::error_columns(Vector& center) const {
  const Index n = model_->states(), m = n + model_->disturbances();
  const Matrix X = reduced_by_components(G_, n);
  Matrix G = Matrix::Zero(m, X.cols() + W_.G.cols());
  G.topLeftCorner(n, X.cols()) = X;
  G.bottomRightCorner(m - n, W_.G.cols()) = W_.G;
  Vector reach(m);
  reach << radius(), radius_of_columns(W_.G);
  const Index count = G.cols(), pairs = count * (count - 1) / 2;
  Matrix columns = Matrix::Zero(n, count + pairs + n);
  for (Index row = 0; row < n; ++row) {
    Matrix H = Matrix::Zero(m, m);
    double rest = 0;
    for (std::size_t e = 0; e < f_.second_partials(row); ++e) {
      const auto [i, j, value] = f_.second_partial(row, e);
      if (!value.is_finite())
        throw Error(Errc::not_enclosed, "the second derivative of x_" + std::to_string(row + 1) +
                                            " is not bounded over the estimate");
      H(i, j) = H(j, i) = middle_of(value);
      rest += (i == j ? 0.5 : 1.0) * radius_of(value) * reach[i] * reach[j];
    }
    write_row(G.transpose() * H * G, row, center, columns);
    columns(row, count + pairs + row) = rest;
  }
  return columns;
}

/// The rows over the set's box as slope z ± radius, the values that they have taken off; rows that
/// are not enclosed are left out.
AffineRows StripRecursion::outputs(const Sample& now) {
  std::vector<Interval> variables;
  append_box(c_, radius(), variables);
  append_box(V_.c, radius_of_columns(V_.G), variables);
  append_known(now.u, now.k, variables);
  g_.set_box(variables);
  std::vector<Index> rows = present_outputs(now);
  for (Index i = 0; i < model_->invariants; ++i) rows.push_back(model_->outputs() + i);
  std::erase_if(rows, [&](Index row) { return !g_.is_enclosed(row); });
  AffineRows form = affine_rows(g_, rows);
  for (Index i = 0; i < std::ssize(rows); ++i) {
    const Index row = rows[as_size(i)];
    const double y = row < model_->outputs() ? now.y[row] : 0.0;
    form.radius[i] += g_.rounding_error(row) + tolerances::product_noise * std::abs(y);
    form.offset[i] = y - form.offset[i];
  }
  return form;
}

void StripRecursion::correct_prediction(const Sample& before, const Linearised& f, Vector& value,
                                        Matrix& A, Matrix& noise) {
  const AffineRows form = outputs(before);
  const Index n = model_->states();
  const Matrix C = form.slope.leftCols(n), D = form.slope.rightCols(model_->noises()),
               V = beside(D * V_.G, Matrix(form.radius.asDiagonal()));
  const Matrix spread = C * G_;
  const Matrix L =
      divided(f.A * G_ * spread.transpose(), spread * spread.transpose() + V * V.transpose());
  value += L * (form.offset - D * V_.c - C * c_);
  A -= L * C;
  noise = -L * V;
}

void StripRecursion::predict(const Sample& before) {
  const Linearised f = linearised(before.u, before.k);
  Vector value = f.value;
  Matrix A = f.A, noise(model_->states(), 0);
  if (variant_ == StripVariant::frad_c) correct_prediction(before, f, value, A, noise);
  const Matrix disturbed = f.Bw * W_.G;
  const Matrix moved = beside(beside(A * G_, noise), f.errors);
  G_ = variant_ == StripVariant::frad_c ? reduced_by_components(beside(moved, disturbed), most_)
                                        : beside(reduced_by_components(moved, most_), disturbed);
  c_ = value;
}

Vector StripRecursion::gain(const Eigen::RowVectorXd& C, double sigma) const {
  const Vector spread = (C * G_).transpose(), cross = G_ * spread;
  const double size = spread.squaredNorm() + sigma * sigma;
  if (!(size > 0)) return Vector::Zero(G_.rows());
  if (variant_ == StripVariant::vol_min_a)
    if (const auto found = least_volume_gain(G_, C, sigma)) return *found;
  return cross / size;
}

void StripRecursion::replace_column(double y, const Eigen::RowVectorXd& C, double sigma) {
  if (G_.cols() == 0) return;  // a point
  const Eigen::RowVectorXd spread = C * G_;
  const double least = 1e-6 * spread.cwiseAbs().maxCoeff();
  const auto with = [&](Index j) {
    Matrix made = G_ - G_.col(j) * (spread / spread[j]);
    made.col(j) = G_.col(j) * (sigma / spread[j]);
    return made;
  };
  const auto size = [](const Matrix& G) {
    const auto L = linalg::cholesky(G * G.transpose());
    return L ? L->diagonal().array().log().sum() : -infinity;
  };
  Index best = -1;
  double smallest = size(G_);
  for (Index j = 0; j < G_.cols(); ++j) {
    if (!(std::abs(spread[j]) > least)) continue;
    const double found = size(with(j));
    if (found < smallest) {
      best = j;
      smallest = found;
    }
  }
  if (best < 0) return;
  const Vector center = c_ + G_.col(best) * ((y - C.dot(c_)) / spread[best]);
  G_ = with(best);
  c_ = center;
}

bool StripRecursion::strip(double y, const Eigen::RowVectorXd& C, double sigma) {
  const double width = (C * G_).cwiseAbs().sum(), away = std::abs(y - C.dot(c_)),
               terms = std::abs(y) + C.cwiseAbs().dot(c_.cwiseAbs()) + width + sigma;
  if (away > width + sigma + tolerances::proof_margin * terms) return false;
  if (variant_ == StripVariant::vol_min_b) {
    replace_column(y, C, sigma);
    return true;
  }
  if (variant_ == StripVariant::vol_min_a) G_ = reduced_by_components(G_, most_);
  const Vector lambda = gain(C, sigma);
  c_ += lambda * (y - C.dot(c_));
  G_ = beside(G_ - lambda * (C * G_), sigma * lambda);
  return true;
}

/// One gain for all outputs.
bool StripRecursion::all_strips(const Sample& now, const AffineRows& form) {
  const Index n = model_->states();
  const Matrix C = form.slope.leftCols(n), D = form.slope.rightCols(model_->noises()),
               V = beside(D * V_.G, Matrix(form.radius.asDiagonal()));
  const Vector left = form.offset - D * V_.c - C * c_, sigma = radius_of_columns(V),
               width = radius_of_columns(C * G_);
  for (Index i = 0; i < left.size(); ++i) {
    const double terms =
        std::abs(form.offset[i]) + C.row(i).cwiseAbs().dot(c_.cwiseAbs()) + width[i] + sigma[i];
    if (std::abs(left[i]) > width[i] + sigma[i] + tolerances::proof_margin * terms) return false;
  }
  std::vector<Interval> point;
  for (const double x : c_) point.push_back({x, x});
  for (const double w : W_.c) point.push_back({w, w});
  append_known(now.u, now.k, point);
  f_.evaluate(point);
  f_.differentiate();
  Matrix A = Matrix::Zero(n, n), Bw = Matrix::Zero(n, model_->disturbances());
  for (Index row = 0; row < n; ++row) {
    for (std::size_t e = 0; e < f_.partials(row); ++e) {
      const auto [variable, slope] = f_.partial(row, e);
      if (slope.is_finite())
        (variable < n ? A(row, variable) : Bw(row, variable - n)) = middle_of(slope);
    }
  }
  const Matrix AG = A * G_, BG = Bw * W_.G, R = AG * AG.transpose() + BG * BG.transpose();
  const Matrix gain = divided(R * C.transpose(), C * R * C.transpose() + V * V.transpose());
  c_ += gain * left;
  G_ = beside(G_ - gain * (C * G_), gain * sigma.asDiagonal());
  return true;
}

bool StripRecursion::correct(const Sample& now) {
  if (variant_ == StripVariant::frad_c) return true;
  const AffineRows form = outputs(now);
  const Index n = model_->states(), count = form.offset.size();
  bool is_there = true;
  if (variant_ == StripVariant::frad_b && count > 0) is_there = all_strips(now, form);
  for (Index i = 0; i < count && is_there && variant_ != StripVariant::frad_b; ++i) {
    const Eigen::RowVectorXd C = form.slope.row(i).head(n),
                             D = form.slope.row(i).tail(model_->noises());
    const double sigma = (D * V_.G).cwiseAbs().sum() + form.radius[i];
    is_there = strip(form.offset[i] - D.dot(V_.c), C, sigma);
  }
  G_ = reduced_by_components(G_, most_);
  return is_there;
}

void StripRecursion::serialize(Archive& archive) {
  archive(c_, G_);
  const Index n = model_->states();
  if (c_.size() != n || G_.rows() != n || !c_.allFinite() || !G_.allFinite())
    archive.refuse("no zonotope of the states");
}

}  // namespace cordon::estimators
