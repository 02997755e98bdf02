// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/rounding_margin.hpp"

#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/semi_explicit.hpp"

namespace cordon::detail {

namespace {

constexpr double of_operations = 1e-13, of_observers = 1e-14, of_outward_data = 1e-15,
                 of_all = 1e-9, shown_at_all = 1e-10;

Vector reach_of(const LineForm& X) { return X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum(); }

/// Lines of X as far out as it reaches without them; of length 1 if that is nowhere.
Vector along_lines(const LineForm& X, const Vector& terms) {
  if (X.lines() == 0) return Vector::Zero(terms.size());
  const Vector lines = X.M.cwiseAbs().rowwise().maxCoeff();
  double length = 0;
  for (Index i = 0; i < lines.size(); ++i) {
    if (lines[i] > 0) length = std::max(length, terms[i] / lines[i]);
  }
  return (length > 0 ? length : 1) * lines;
}

}  // namespace

RoundingMargin::RoundingMargin(const Model& model, const LineForm& initial_set, Rounding rounding)
    : model_(model.linear),
      is_linear_(model.is_linear()),
      of_a_step_(rounding == Rounding::nominal ? of_operations : of_observers),
      of_the_data_(rounding == Rounding::nominal ? of_operations : of_outward_data),
      initial_(reach_of(initial_set)),
      dynamic_(Matrix::Identity(model.linear.states(), model.linear.states())),
      static_(Matrix::Zero(model.linear.states(), model.linear.states())),
      mixed_(dynamic_),
      error_(Vector::Zero(model.linear.states())),
      largest_(Vector::Zero(model.states())) {
  if (!is_linear_) return;
  disturbance_ = model_.Bw.cwiseAbs() * reach_of(model.W);
  noise_ = model_.Dv.cwiseAbs() * reach_of(model.V);
  if (!model_.is_descriptor()) {
    take_paths();
    return;
  }
  const Index n = model_.states();
  const SemiExplicitForm form(model_.E);
  const Index r = form.rank();
  const Matrix to_dynamic = form.dynamic_part(Matrix::Identity(n, n)).rows,
               to_static = form.static_part(Matrix::Identity(n, n)).rows;
  mixed_ = form.T().cwiseAbs() * form.T_inverse().cwiseAbs();
  Matrix rows(n, n);
  rows << form.T_inverse().topRows(r), form.static_part(model_.A).rows;
  const Vector of_rows = linalg::row_scales(rows), of_cols = linalg::row_scales(rows.transpose());
  const Matrix solved =
      of_cols.asDiagonal() *
      linalg::pseudo_inverse(of_rows.asDiagonal() * rows * of_cols.asDiagonal(), 1e-14) *
      of_rows.asDiagonal();
  dynamic_ = (solved.leftCols(r) * to_dynamic).cwiseAbs();
  static_ = (solved.rightCols(n - r) * to_static).cwiseAbs();
  take_paths();
}

void RoundingMargin::take_paths() {
  const Index n = model_.states();
  const Matrix step = dynamic_ * model_.A.cwiseAbs();
  Matrix power = Matrix::Identity(n, n);
  paths_ = power;
  for (Index k = 1; k < n; ++k) {
    power = step * power;
    paths_ += power;
  }
}

Vector RoundingMargin::forces(VectorIn u) const {
  return model_.B.cwiseAbs() * u.cwiseAbs() + disturbance_;
}

/// What the outputs leave of the lines of the set before, one step on: y_k = C A M t + … is solved
/// for their lengths t, in units of its largest entries.
Vector RoundingMargin::cut_lines(const Vector& data, const Sample& now) const {
  const Matrix moved = model_.A * lines_;
  Matrix shown = model_.C * moved;
  shown(now.missing, Eigen::all).setZero();
  const Vector rows = linalg::row_scales(shown), cols = linalg::row_scales(shown.transpose());
  const Matrix solved =
      linalg::pseudo_inverse(rows.asDiagonal() * shown * cols.asDiagonal(), shown_at_all);
  const Vector lengths = cols.asDiagonal() * (solved.cwiseAbs() * rows.cwiseProduct(data));
  const auto operations =
      static_cast<double>(1 + lines_.cols());  // a line each, and the correction
  return operations * (dynamic_ * (moved.cwiseAbs() * lengths));
}

/// What rounding of an output leaves open of each state, were it a share of 1 of the data: falls on
/// the state that the output shows most of, and on others as far as the set leaves them open, for
/// the first may be known by other means.
Vector RoundingMargin::left_open_by(const Vector& data, const LineForm& X) const {
  const Index n = model_.C.cols();
  Vector sizes = Vector::Zero(n), widths = X.G.cwiseAbs().rowwise().sum();
  for (Index i = 0; i < n && X.lines() > 0; ++i) {
    if (!X.M.row(i).isZero(0)) widths[i] = infinity;
  }
  for (Index j = 0; j < data.size(); ++j) {
    Index most = 0;
    if (!(model_.C.row(j).cwiseAbs().maxCoeff(&most) > 0)) continue;
    for (Index i = 0; i < n; ++i) {
      const double coefficient = std::abs(model_.C(j, i));
      if (!(coefficient > 0)) continue;
      const double size = data[j] / coefficient;
      sizes[i] = std::max(sizes[i], i == most ? size : std::min(size, widths[i] / of_the_data_));
    }
  }
  return sizes;
}

Vector RoundingMargin::next(const LineForm& X, const Sample* before, const Sample& now) {
  if (!is_linear_) {
    largest_ = largest_.cwiseMax(reach_of(X));
    of_outputs_ = of_operations * now.y.cwiseAbs();
    of_outputs_(now.missing).setZero();
    return of_all * largest_;
  }
  const Matrix A = model_.A.cwiseAbs();
  Vector terms = reach_of(X);
  if (before && reach_.size() > 0) {
    terms = terms.cwiseMax(dynamic_ * (A * reach_ + forces(before->u)) + static_ * forces(now.u));
    error_ = dynamic_ * (A * error_);
  } else {
    error_.setZero();
    terms = terms.cwiseMax(initial_);
  }
  terms = mixed_ * terms;
  Vector data = now.y.cwiseAbs() + model_.D.cwiseAbs() * now.u.cwiseAbs() + noise_;
  data(now.missing).setZero();
  if (before && lines_.cols() > 0) terms += cut_lines(data, now);
  lines_ = X.M;
  reach_ = reach_of(X);
  largest_ = largest_.cwiseMax(terms);
  error_ += of_a_step_ * terms;
  of_outputs_ = of_operations * (data + model_.C.cwiseAbs() * (terms + along_lines(X, terms)));
  const Vector from_outputs = left_open_by(data, X);
  error_ += of_the_data_ * from_outputs;
  largest_ = largest_.cwiseMax(from_outputs);
  return error_.cwiseMin(of_all * (paths_ * largest_)).unaryExpr([](double x) {
    return std::isfinite(x) ? x : 0.0;
  });
}

}  // namespace cordon::detail
