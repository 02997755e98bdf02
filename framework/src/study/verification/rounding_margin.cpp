// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/rounding_margin.hpp"

#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"

namespace cordon::verification {

namespace {

constexpr double of_operations = 1e-13, of_observers = 1e-14, of_the_data = 1e-15, of_all = 1e-9;

Vector reach_of(const LineForm& X) { return X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum(); }

}  // namespace

RoundingMargin::RoundingMargin(const Model& model, const LineForm& initial_set, Rounding rounding)
    : model_(model.linear),
      of_a_step_(rounding == Rounding::nominal ? of_operations : of_observers),
      initial_(reach_of(initial_set)),
      dynamic_(Matrix::Identity(model.linear.states(), model.linear.states())),
      static_(Matrix::Zero(model.linear.states(), model.linear.states())),
      mixed_(dynamic_),
      disturbance_(model.linear.Bw.cwiseAbs() * reach_of(model.W)),
      noise_(model.linear.Dv.cwiseAbs() * reach_of(model.V)),
      error_(Vector::Zero(model.linear.states())),
      largest_(Vector::Zero(model.linear.states())) {
  if (!model_.is_descriptor()) return;
  const Index n = model_.states();
  const Matrix units = linalg::row_scales(model_.E).asDiagonal();
  const Index r = descriptor_rank(model_.E);
  const linalg::Svd parts = linalg::svd(units * model_.E);
  const Matrix left = parts.U.transpose() * units;
  const Matrix V = (parts.V.array().abs() <= 1e-15).select(0.0, parts.V.array().abs());
  mixed_ = V * V.transpose();
  Matrix rows(n, n);
  rows << linalg::product(left.topRows(r), model_.E), linalg::product(left.bottomRows(n - r), model_.A);
  const Matrix solved = linalg::pseudo_inverse(rows, 1e-14);
  dynamic_ = (solved.leftCols(r) * left.topRows(r)).cwiseAbs();
  static_ = (solved.rightCols(n - r) * left.bottomRows(n - r)).cwiseAbs();
}

Vector RoundingMargin::forces(VectorIn u) const { return model_.B.cwiseAbs() * u.cwiseAbs() + disturbance_; }

Vector RoundingMargin::next(const LineForm& X, const Sample* before, const Sample& now) {
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
  reach_ = reach_of(X);
  largest_ = largest_.cwiseMax(terms);
  error_ += of_a_step_ * terms;
  const Vector data = now.y.cwiseAbs() + model_.D.cwiseAbs() * now.u.cwiseAbs() + noise_;
  of_outputs_ = of_operations * (data + model_.C.cwiseAbs() * terms);
  Vector from_outputs = Vector::Zero(terms.size());
  for (Index j = 0; j < data.size(); ++j) {
    Index i = 0;
    const double coefficient = model_.C.row(j).cwiseAbs().maxCoeff(&i);
    if (coefficient > 0) from_outputs[i] = std::max(from_outputs[i], data[j] / coefficient);
  }
  error_ += of_the_data * from_outputs;
  return error_.cwiseMin(of_all * largest_).unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

}  // namespace cordon::verification
