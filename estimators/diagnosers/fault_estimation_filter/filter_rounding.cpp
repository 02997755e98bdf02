// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/fault_estimation_filter/filter_rounding.hpp"

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/sets/generator_reduction.hpp"

namespace cordon::estimators {

using linalg::product;

namespace {

constexpr Index columns_per_state = 4;

Vector row_sums(const Matrix& A) { return A.cwiseAbs().rowwise().sum(); }

/// Sum of |TA|ʲ |T F_i| for j < ρ_i.
Matrix fault_states(const FilterDesign& design, const LinearModel& model) {
  const Matrix T = design.T.cwiseAbs(), TA = product(T, model.A.cwiseAbs());
  Matrix sizes = Matrix::Zero(model.states(), model.faults());
  for (Index i = 0; i < sizes.cols(); ++i) {
    Vector state = product(T, model.F.col(i).cwiseAbs());
    for (Index j = 0; j < design.delays[static_cast<std::size_t>(i)]; ++j) {
      sizes.col(i) += state;
      state = product(TA, state);
    }
  }
  return sizes;
}

}  // namespace

FilterRounding::FilterRounding(const FilterDesign& design, const LinearModel& model,
                               const FilterNoise& noise)
    : T_size_(design.T.cwiseAbs()),
      A_size_(model.A.cwiseAbs()),
      B_size_(model.B.cwiseAbs()),
      C_size_(model.C.cwiseAbs()),
      N_size_(design.N.cwiseAbs()),
      M_size_(design.M.cwiseAbs()),
      MC_(product(design.M, model.C)),
      Dw_size_(row_sums(noise.Dw)),
      Dv_size_(row_sums(noise.Dv)),
      fault_state_(fault_states(design, model)),
      TA_Psi_(product(product(design.T, model.A), design.Psi)),
      Upsilon_(design.Upsilon) {
  const Index n = model.states();
  const Matrix I = Matrix::Identity(n, n), E = model.is_descriptor() ? model.E : I;
  defect_ =
      (I - product(design.T, E) - product(design.N, model.C)).cwiseAbs() +
      tolerances::product_noise * (product(T_size_, E.cwiseAbs()) + product(N_size_, C_size_));
  const Index q = model.faults();
  mixing_ = (Matrix::Identity(q, q) - product(design.M, Upsilon_)).cwiseAbs();
}

void FilterRounding::start(const Input& first, const FilterRecursion& recursion) {
  now_ = first;
  size_ = first.x.cwiseAbs();
  generators_ = Matrix(size_.size(), 0);
  error_size_ = row_sums(recursion.errors()) + product(fault_state_, first.fault_size);
}

Vector FilterRounding::step_size(const FilterRecursion& recursion, VectorIn u_size,
                                 VectorIn constant) const {
  const Vector state = now_.x.cwiseAbs() + error_size_;
  const Vector right = product(A_size_, state) + product(B_size_, u_size) + constant + Dw_size_;
  return product(T_size_, right) +
         product(recursion.gain().cwiseAbs(), now_.output + Dv_size_ + product(C_size_, state));
}

void FilterRounding::advance(const Input& next, const FilterRecursion& recursion, VectorIn u_size,
                             VectorIn constant) {
  const Index n = size_.size(), old = generators_.cols();
  size_ = step_size(recursion, u_size, constant) + product(N_size_, next.output + Dv_size_);
  const Matrix faults = (TA_Psi_ - product(recursion.gain(), Upsilon_)).cwiseAbs();
  const Vector left = tolerances::product_noise * size_ + product(faults, now_.fault_size);
  Matrix kept(n, old + n);
  kept.leftCols(old) = product(recursion.error_map(), generators_);
  error_size_ = row_sums(recursion.errors()) + row_sums(kept.leftCols(old)) + left +
                product(fault_state_, next.fault_size);
  kept.rightCols(n) =
      (left + product(defect_, next.x.cwiseAbs() + error_size_)).asDiagonal().toDenseMatrix();
  generators_ =
      sets::reduce_generators(kept, columns_per_state * n, sets::GeneratorReduction::combastel);
  now_ = next;
}

Vector FilterRounding::slack() const {
  const Vector terms = now_.output + Dv_size_ + product(C_size_, size_);
  return tolerances::proof_margin * product(M_size_, terms) + product(mixing_, now_.fault_size) +
         row_sums(product(MC_, generators_));
}

}  // namespace cordon::estimators
