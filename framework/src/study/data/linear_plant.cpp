// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/linear_plant.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"

namespace cordon::detail {

namespace {

constexpr double rank_tolerance = 1e-10;

Matrix beside(const Matrix& A, const Matrix& B) {
  if (B.cols() == 0) return A;
  Matrix both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

}  // namespace

LinearPlant::LinearPlant(const LinearModel& model, const std::string& file, const std::string& pointer)
    : model_(model), file_(file), pointer_(pointer) {
  const Index n = model.states();
  model_.B = beside(model.B, model.F);
  model_.D = beside(model.D, Matrix::Zero(model.outputs(), model.faults()));
  if (model.is_descriptor()) {
    split_E();
  } else {
    V_ = Matrix::Identity(n, n);
    static_A_ = Matrix(0, n);
    static_B_ = Matrix(0, model_.inputs());
    static_Bw_ = Matrix(0, model.disturbances());
  }
  split_rows();
  z_ = Vector::Zero(dynamic_A_.rows());
}

void LinearPlant::split_E() {
  Vector units = linalg::row_scales(model_.E);  // the rank of E must not depend on the units of its rows
  const Vector of_A = linalg::row_scales(model_.A);
  for (Index i = 0; i < units.size(); ++i) {
    if (model_.E.row(i).isZero(0)) units[i] = of_A[i];
  }
  const linalg::Svd svd = linalg::svd(units.asDiagonal() * model_.E);
  const Index r = descriptor_rank(model_.E);
  V_ = (svd.V.array().abs() <= 1e-15).select(0.0, svd.V);
  const Matrix rows = svd.U.transpose() * units.asDiagonal();
  dynamic_ = rows.topRows(r);
  for (Index i = 0; i < r; ++i) dynamic_.row(i) /= svd.sigma[i];
  static_ = rows.bottomRows(model_.states() - r);
}

void LinearPlant::split_rows() {
  if (!model_.is_descriptor()) {
    dynamic_A_ = model_.A;
    dynamic_B_ = model_.B;
    dynamic_Bw_ = model_.Bw;
    return;
  }
  dynamic_A_ = linalg::product(dynamic_, model_.A);
  dynamic_B_ = linalg::product(dynamic_, model_.B);
  dynamic_Bw_ = linalg::product(dynamic_, model_.Bw);
  static_A_ = linalg::product(static_, model_.A);
  static_B_ = linalg::product(static_, model_.B);
  static_Bw_ = linalg::product(static_, model_.Bw);
  if (static_.rows() == 0) return;
  const Matrix block = linalg::product(static_A_, V_.rightCols(static_.rows()));
  const Vector sizes = linalg::svd(block).sigma;
  const double scale = linalg::svd(static_A_).sigma[0];
  if (sizes[sizes.size() - 1] <= rank_tolerance * scale) {
    throw InputError(file_, {{pointer_,
                              "the descriptor system has an index above 1: its static rows do not determine the static states, "
                              "so that x_k would depend on later inputs and disturbances",
                              "use recorded data, or a model of index 1"}});
  }
  solve_ = -linalg::pseudo_inverse(block);
}

void LinearPlant::exchange(const Matrix& A, const Matrix& B, const Matrix& C) {
  model_.A = A;
  model_.B = beside(B, model_.F);
  model_.C = C;
  split_rows();
}

void LinearPlant::start(VectorIn x0) { z_ = linalg::product(V_.leftCols(z_.size()).transpose(), x0); }

Vector LinearPlant::state(VectorIn u, VectorIn w) const {
  const Index r = z_.size(), n = V_.rows();
  if (!model_.is_descriptor()) return z_;
  Vector x = linalg::product(V_.leftCols(r), z_);
  if (r == n) return x;
  const Vector inputs = linalg::product(static_B_, u) + linalg::product(static_Bw_, w);
  const auto solve_static_rows = [&] {
    const Vector rest = linalg::product(static_A_, x) + inputs;
    x += linalg::product(V_.rightCols(n - r), linalg::product(solve_, rest));
  };
  solve_static_rows();
  // coordinates of unlike sizes lose digits to each other: what is missing is added
  x += linalg::product(V_.leftCols(r), z_ - linalg::product(V_.leftCols(r).transpose(), x));
  solve_static_rows();
  return x;
}

LinearPlant::Output LinearPlant::step(VectorIn u, VectorIn w, VectorIn v, VectorIn sensor) {
  Output now;
  now.x = state(u, w);
  const Vector shown = linalg::product(model_.C, now.x) + linalg::product(model_.D, u);
  now.y = shown.cwiseProduct(sensor) + linalg::product(model_.Dv, v);
  z_ = linalg::product(dynamic_A_, now.x) + linalg::product(dynamic_B_, u) + linalg::product(dynamic_Bw_, w);
  return now;
}

bool same_descriptor(const LinearModel& a, const LinearModel& b) {
  return a.E.rows() == b.E.rows() && a.E.cols() == b.E.cols() && a.E == b.E;
}

}  // namespace cordon::detail
