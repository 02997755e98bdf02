// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/fault_estimation_filter/filter_rounding.hpp"

#include <algorithm>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

using linalg::product;

namespace {

constexpr Index most_own_steps = 64;  // whose rounding is carried in generators of its own
constexpr double contraction = 0.25;  // of their box, until it is made

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

/// A bound of every n with n ≤ b + K n, for K ≥ 0 and b ≥ 0: where x' = b + 4 K x is at most 2 x, K
/// x' ≤ 2 K x ≤ x' / 2, so that powers of K die out, and x' ≥ b + K x'. Infinite if there is none.
Vector fixed_point(const Matrix& K, const Vector& b) {
  constexpr int rounds = 100;
  constexpr double positive = 1e-300;
  const Vector least = (b.array() + positive).matrix();
  Vector x = least;
  for (int round = 0; round < rounds; ++round) {
    const Vector next = least + 4 * product(K, x);
    if ((next.array() <= 2 * x.array()).all()) return next;
    x = next;
  }
  return Vector::Constant(b.size(), infinity);
}

/// After how many steps of this map a box comes back smaller: the least N, or the most that is
/// tried, with ρ(|Fᴺ|) ≤ 1/4, by max_i (|Fᴺ| v)_i / v_i for a v > 0 [Feingold1962].
Index steps_to_contract(const Matrix& F) {
  constexpr int rounds = 20;
  constexpr double positive = 1e-6;
  const Index n = F.rows();
  Matrix power = F;
  for (Index steps = 1; steps < most_own_steps; ++steps, power = product(F, power)) {
    const Matrix size = power.cwiseAbs();
    Vector v = Vector::Ones(n);
    for (int round = 0; round < rounds; ++round) {
      const Vector next = product(size, v);
      const double largest = next.maxCoeff();
      if (!(largest > 0)) return steps;
      v = (next.array() / largest + positive).matrix();
    }
    if ((product(size, v).array() <= contraction * v.array()).all()) return steps;
  }
  return most_own_steps;
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
  mixing_ = (Matrix::Identity(q, q) - product(design.M, Upsilon_)).cwiseAbs() +
            tolerances::product_noise * product(M_size_, Upsilon_.cwiseAbs());
  by_faults_ = mixing_ + product(MC_.cwiseAbs(), product(defect_, fault_state_));
}

void FilterRounding::start(const Input& first, const FilterRecursion& recursion) {
  size_ = first.x.cwiseAbs();
  steps_ = 1;
  settle(first, recursion, Matrix(size_.size(), 0), Vector::Zero(size_.size()));
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
  size_ = step_size(recursion, u_size, constant) + product(N_size_, next.output + Dv_size_);
  const Matrix faults = (TA_Psi_ - product(recursion.gain(), Upsilon_)).cwiseAbs();
  const Vector left = tolerances::product_noise * size_ + product(faults, now_.fault_size);
  const Matrix map = recursion.error_map();
  if (generators_.cols() >= steps_ * generators_.rows()) {
    generators_ = row_sums(generators_).asDiagonal().toDenseMatrix();
    steps_ = steps_to_contract(map) + 1;
  }
  settle(next, recursion, product(map, generators_), left);
}

/// The faults that are seen now, and with them the errors of this step.
void FilterRounding::settle(Input input, const FilterRecursion& recursion, const Matrix& old,
                            const Vector& left) {
  const Index n = size_.size();
  const Vector known = row_sums(recursion.errors()) + row_sums(old) + left;
  const Vector of_step = left + product(defect_, input.x.cwiseAbs() + known);
  const Vector terms = input.output + Dv_size_ + product(C_size_, size_);
  const Vector own = tolerances::proof_margin * product(M_size_, terms) +
                     row_sums(product(MC_, old)) + product(MC_.cwiseAbs(), of_step);
  input.fault_size = fixed_point(by_faults_, input.fault_size + own);
  slack_ = own + product(by_faults_, input.fault_size);
  if (own.allFinite() && !slack_.allFinite()) {
    throw Error(Errc::not_finite,
                "rounding decides how large a fault is, whose response is small beside other "
                "faults or states: scale states, outputs and faults to like sizes");
  }
  error_size_ = known + product(fault_state_, input.fault_size);
  Matrix kept(n, old.cols() + n);
  kept << old,
      (left + product(defect_, input.x.cwiseAbs() + error_size_)).asDiagonal().toDenseMatrix();
  generators_ = std::move(kept);
  now_ = std::move(input);
}

void FilterRounding::serialize(Archive& archive) {
  const Index n = A_size_.rows(), p = C_size_.rows(), q = by_faults_.rows();
  archive(generators_, now_.x, now_.output, now_.fault_size, error_size_, slack_);
  serialize_within(archive, steps_, 1, most_own_steps + 1);
  const bool fits = generators_.rows() == n && now_.x.size() == n && now_.output.size() == p &&
                    now_.fault_size.size() == q && error_size_.size() == n && slack_.size() == q;
  if (!fits) archive.refuse("rounding errors of another dimension");
}

}  // namespace cordon::estimators
