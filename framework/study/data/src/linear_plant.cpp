// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/linear_plant.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::detail {

namespace {

Matrix beside(const Matrix& A, const Matrix& B) {
  if (B.cols() == 0) return A;
  Matrix both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

/// What `make` returns; numbers beyond the range of doubles are an error of the study.
template <class Make>
auto in_doubles(const std::string& file, const std::string& pointer, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.code() != Errc::not_finite) throw;
    throw InputError(file, {{pointer, error.what(), "write the equations in other units"}});
  }
}

SemiExplicitForm form_of(const LinearModel& model, const std::string& file,
                         const std::string& pointer) {
  if (!model.is_descriptor()) return SemiExplicitForm(model.states());
  return in_doubles(file, pointer, [&] { return SemiExplicitForm(model.E); });
}

}  // namespace

LinearPlant::LinearPlant(const LinearModel& model, const std::string& file,
                         const std::string& pointer)
    : model_(model),
      file_(file),
      pointer_(pointer),
      form_(form_of(model, file, pointer)),
      z_(Vector::Zero(form_.rank())) {
  model_.B = beside(model.B, model.F);
  model_.D = beside(model.D, Matrix::Zero(model.outputs(), model.faults()));
  split_rows();
}

void LinearPlant::split_rows() {
  in_doubles(file_, pointer_, [&] {
    dynamic_A_ = form_.dynamic_part(model_.A).rows;
    dynamic_B_ = form_.dynamic_part(model_.B).rows;
    dynamic_Bw_ = form_.dynamic_part(model_.Bw).rows;
    static_A_ = form_.static_part(model_.A).rows;
    static_B_ = form_.static_part(model_.B).rows;
    static_Bw_ = form_.static_part(model_.Bw).rows;
  });
  if (form_.static_rows() == 0) return;
  const Vector units = linalg::row_scales(static_A_);
  for (Matrix* part : {&static_A_, &static_B_, &static_Bw_}) *part = units.asDiagonal() * *part;
  const Matrix block = linalg::product(static_A_, form_.T().rightCols(form_.static_rows()));
  const Vector rows = linalg::row_scales(block),
               cols = linalg::row_scales(block.transpose());  // the index has no units
  const Matrix scaled = rows.asDiagonal() * block * cols.asDiagonal();
  const Vector sizes = linalg::svd(scaled).sigma;
  if (sizes[sizes.size() - 1] <= tolerances::rank * sizes[0]) {
    throw InputError(file_, {{pointer_,
                              "the descriptor system has an index above 1: its static rows do not "
                              "determine the static states, "
                              "so that x_k would depend on later inputs and disturbances",
                              "use recorded data, or a model of index 1"}});
  }
  solve_ = -(cols.asDiagonal() * linalg::pseudo_inverse(scaled) * rows.asDiagonal());
}

void LinearPlant::exchange(const Matrix& A, const Matrix& B, const Matrix& C) {
  model_.A = A;
  model_.B = beside(B, model_.F);
  model_.C = C;
  split_rows();
}

void LinearPlant::start(VectorIn x0) {
  z_ = linalg::product(form_.T_inverse().topRows(z_.size()), x0);
}

Vector LinearPlant::state(VectorIn u, VectorIn w) const {
  const Index r = z_.size(), n = form_.states();
  if (!model_.is_descriptor()) return z_;
  Vector x = linalg::product(form_.T().leftCols(r), z_);
  if (r == n) return x;
  const Vector inputs = linalg::product(static_B_, u) + linalg::product(static_Bw_, w);
  for (int i = 0; i < 2; ++i) {  // the second time for the digits that cancelled in the first
    const Vector rest = linalg::product(static_A_, x) + inputs;
    x += linalg::product(form_.T().rightCols(n - r), linalg::product(solve_, rest));
    x += linalg::product(form_.T().leftCols(r),
                         z_ - linalg::product(form_.T_inverse().topRows(r), x));
  }
  return x;
}

void LinearPlant::keep_in_bounds(Vector& x) const {
  const Vector inside = x.cwiseMax(first_in_->lower).cwiseMin(first_in_->upper);
  const double rounding = tolerances::elimination_noise * x.cwiseAbs().maxCoeff();
  x = ((inside - x).array().abs() <= rounding).select(inside, x);
}

LinearPlant::Output LinearPlant::step(VectorIn u, VectorIn w, VectorIn v, VectorIn sensor) {
  Output now;
  now.x = state(u, w);
  if (first_in_ && solve_.size() > 0) keep_in_bounds(now.x);
  first_in_.reset();
  const Vector shown = linalg::product(model_.C, now.x) + linalg::product(model_.D, u);
  now.y = shown.cwiseProduct(sensor) + linalg::product(model_.Dv, v);
  z_ = linalg::product(dynamic_A_, now.x) + linalg::product(dynamic_B_, u) +
       linalg::product(dynamic_Bw_, w);
  return now;
}

bool same_descriptor(const LinearModel& a, const LinearModel& b) {
  return a.E.rows() == b.E.rows() && a.E.cols() == b.E.cols() && a.E == b.E;
}

}  // namespace cordon::detail
