// SPDX-License-Identifier: GPL-3.0-or-later
// The search for dual matrices that prove infeasibility, and the check of them.
#include "sdp_infeasibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "sdp_products.hpp"
#include "sdp_proposal.hpp"

namespace cordon {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double inner_of_magnitudes(const Matrix& F, const Matrix& Y) {
  return F.cwiseAbs().cwiseProduct(Y.cwiseAbs()).sum();
}

/// Y ⪰ 0 proves that no x with |x_i| ≤ R_i is feasible, if Σ ⟨constant, Y⟩ + Σ R_i |⟨F_i, Y⟩| < 0:
/// for a feasible x, the sum of ⟨F(x), Y⟩ is not negative. Rounding errors are bounded; Y is
/// shifted until its smallest eigenvalue is certainly not negative.
bool proves_infeasible(const SemidefiniteProgram& program, std::vector<Matrix>& Y,
                       const Vector& R) {
  double rounding = 0, terms = 0;
  for (std::size_t j = 0; j < Y.size(); ++j) {
    const auto size = static_cast<double>(Y[j].rows());
    const double norm = Y[j].norm(), least = linalg::symmetric_eigen(Y[j]).values[0];
    if (Y[j].rows() == 1) {
      if (least < 0) Y[j].setZero();
    } else if (norm > 0) {
      Y[j].diagonal().array() += std::max(0., -least) + 16 * size * epsilon * norm;
    }
    const MatrixInequality& F = program.inequalities[j];
    const double unit = (size * size + static_cast<double>(program.cost.size()) + 8) * epsilon;
    terms += inner_of_magnitudes(F.constant, Y[j]);
    rounding += unit * inner_of_magnitudes(F.constant, Y[j]);
    for (const auto& [i, term] : F.terms) rounding += R[i] * unit * inner_of_magnitudes(term, Y[j]);
  }
  const double sum = inner_constant(program, Y) + R.dot(inner_products(program, Y).cwiseAbs());
  return terms > 0 && sum + 2 * rounding < -1e-10 * terms;
}

/// Y of the rank that eigenvalues above a share of the largest leave it, moved to ⟨F_i, Y⟩ = 0 for
/// all i: Gauss-Newton steps for the factors L_j of Y_j = L_j L_jᵀ, so that it stays semidefinite
/// and the face that it lies on may turn.
std::vector<Matrix> moved_to_zero(const SemidefiniteProgram& program, const std::vector<Matrix>& Y,
                                  double share) {
  std::vector<linalg::SymmetricEigen> eigen;
  double largest = 0;
  for (const Matrix& part : Y) {
    eigen.push_back(linalg::symmetric_eigen(part));
    largest = std::max(largest, eigen.back().values.maxCoeff());
  }
  std::vector<Matrix> L;
  Index unknowns = 0;
  for (const linalg::SymmetricEigen& one : eigen) {
    const Index rank = (one.values.array() > share * largest).count();
    L.push_back(one.vectors.rightCols(rank) * one.values.tail(rank).cwiseSqrt().asDiagonal());
    unknowns += L.back().size();
  }
  std::vector<Matrix> moved(Y.size());
  for (int step = 0;; ++step) {
    for (std::size_t j = 0; j < Y.size(); ++j) moved[j] = linalg::gram(L[j]);
    if (step == 4 || unknowns == 0) return moved;
    // Column by column of the factors: the change of ⟨F_i, L Lᵀ⟩ is 2 ⟨F_i L, change of L⟩.
    Matrix slope = Matrix::Zero(program.cost.size(), unknowns);
    Index at = 0;
    for (std::size_t j = 0; j < Y.size(); at += L[j++].size()) {
      for (const auto& [i, term] : program.inequalities[j].terms) {
        slope.row(i).segment(at, L[j].size()) =
            2 * linalg::product(term, L[j]).reshaped().transpose();
      }
    }
    const Vector change =
        linalg::product(linalg::pseudo_inverse(slope, 1e-9), inner_products(program, moved));
    at = 0;
    for (Matrix& factor : L) {
      factor -= change.segment(at, factor.size()).reshaped(factor.rows(), factor.cols());
      at += factor.size();
    }
  }
}

/// Entries of all inequalities' matrices for one variable (or the constants), one below the other,
/// so that inner products are those of the matrices.
Matrix stacked_terms(const SemidefiniteProgram& program) {
  Index entries = 0;
  for (const MatrixInequality& F : program.inequalities) entries += F.constant.size();
  Matrix stacked = Matrix::Zero(entries, program.cost.size());
  Index at = 0;
  for (const MatrixInequality& F : program.inequalities) {
    for (const auto& [i, term] : F.terms) stacked.col(i).segment(at, term.size()) = term.reshaped();
    at += F.constant.size();
  }
  return stacked;
}

/// The same set of matrices F(x) as an affine space with an orthonormal basis: terms that depend on
/// each other, exactly or nearly, leave the solver's linear systems singular, and nothing of a
/// proof needs them.
SemidefiniteProgram with_orthonormal_terms(const SemidefiniteProgram& program) {
  const Matrix basis = linalg::range_basis(stacked_terms(program), 1e-12);
  SemidefiniteProgram same;
  same.cost = Vector::Zero(basis.cols());
  Index at = 0;
  for (const MatrixInequality& F : program.inequalities) {
    const Index size = F.constant.rows();
    MatrixInequality G{F.constant, {}};
    for (Index k = 0; k < basis.cols(); ++k) {
      const Matrix term = basis.col(k).segment(at, size * size).reshaped(size, size);
      if (!term.isZero(0)) G.terms.emplace_back(k, (term + term.transpose()) / 2);
    }
    at += size * size;
    same.inequalities.push_back(std::move(G));
  }
  return same;
}

/// The least t with F(x) + t I ⪰ 0, |x_i| ≤ radius_i and t ≥ -1. Its dual matrices prove that t = 0
/// is out of reach, if they do.
SemidefiniteProgram feasibility_program(const SemidefiniteProgram& program, const Vector& radius) {
  const Index m = program.cost.size();
  SemidefiniteProgram phase;
  phase.cost = 1024 * Vector::Unit(m + 1, m);
  phase.inequalities = program.inequalities;
  for (MatrixInequality& F : phase.inequalities) {
    F.terms.emplace_back(m, Matrix::Identity(F.constant.rows(), F.constant.rows()));
  }
  const Matrix one = Matrix::Ones(1, 1);
  phase.inequalities.push_back({one, {{m, one}}});
  for (Index i = 0; i < m; ++i) {
    phase.inequalities.push_back({radius[i] * one, {{i, one}}});
    phase.inequalities.push_back({radius[i] * one, {{i, -one}}});
  }
  return phase;
}
}  // namespace

/// Proofs are checked in the scaled program, where rounding errors weigh least. Scaling is exact,
/// and so is the way back.
void prove_infeasible(const ScaledProgram& scaled, const SdpOptions& options, SdpSolution& s) {
  if (!scaled.exact) return;
  const SemidefiniteProgram orthonormal = with_orthonormal_terms(scaled.program);
  const SemidefiniteProgram phase =
      feasibility_program(orthonormal, Vector::Constant(orthonormal.cost.size(), 1e4));
  Vector largest_x(scaled.program.cost.size());
  for (Index i = 0; i < largest_x.size(); ++i) {
    largest_x[i] =
        options.largest_x / scaled.variable_scale[scaled.variables[static_cast<std::size_t>(i)]];
  }
  for (const SdpTuning& tuning : tunings) {
    SdpProposal proposal = run_sdpa(phase, options.accuracy, options.iterations, tuning);
    if (!proposal.x) continue;
    proposal.Y.resize(scaled.program.inequalities.size());
    // As it is, which serves where the bound of x matters; then without what an unlimited x must
    // not meet.
    for (const double share : {0., 1e-8, 1e-6, 1e-4, 1e-2}) {
      std::vector<Matrix> Y =
          share == 0 ? proposal.Y : moved_to_zero(orthonormal, proposal.Y, share);
      if (!proves_infeasible(scaled.program, Y, largest_x)) continue;
      s = {};
      s.status = SdpStatus::infeasible;
      s.solver_status = proposal.phase;
      s.proof = unscaled(scaled, std::move(Y), 1);
      return;
    }
  }
}

}  // namespace cordon
