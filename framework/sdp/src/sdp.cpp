// SPDX-License-Identifier: GPL-3.0-or-later
// Semidefinite programs: scaling, what the solver is asked, and what its answers are worth. Every
// number of an answer comes from the program as it was given, x, and dual matrices that are
// positive semidefinite up to the shift that is accounted for.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "sdp_proposal.hpp"

namespace cordon {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

void check_matrix(const Matrix& F, Index size, const std::string& what) {
  if (F.rows() != size || F.cols() != size)
    throw Error(Errc::dimension, "semidefinite program: " + what + " has the wrong size");
  if (!F.allFinite())
    throw Error(Errc::not_finite, "semidefinite program: " + what + " has a NaN or infinite entry");
  if (F != F.transpose())
    throw Error(Errc::invalid, "semidefinite program: " + what + " is not symmetric");
}

void check(const SemidefiniteProgram& program, const SdpOptions& options) {
  if (!(options.accuracy > 0) || !(options.largest_x > 0) || options.iterations < 1) {
    throw Error(Errc::invalid,
                "semidefinite program: accuracy, largest x and iterations must be positive");
  }
  if (program.cost.size() == 0) throw Error(Errc::dimension, "semidefinite program: no variables");
  if (program.inequalities.empty())
    throw Error(Errc::dimension, "semidefinite program: no inequalities");
  if (!program.cost.allFinite())
    throw Error(Errc::not_finite, "semidefinite program: a NaN or infinite cost");
  for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
    const MatrixInequality& F = program.inequalities[j];
    const std::string name = "inequality " + std::to_string(j + 1);
    if (F.constant.rows() == 0)
      throw Error(Errc::dimension, "semidefinite program: " + name + " is empty");
    check_matrix(F.constant, F.constant.rows(), "the constant of " + name);
    std::vector<Index> seen;
    for (const auto& [i, term] : F.terms) {
      if (i < 0 || i >= program.cost.size())
        throw Error(Errc::dimension, "semidefinite program: no such variable in " + name);
      check_matrix(term, F.constant.rows(), "term " + std::to_string(i) + " of " + name);
      seen.push_back(i);
    }
    std::sort(seen.begin(), seen.end());
    if (std::adjacent_find(seen.begin(), seen.end()) != seen.end()) {
      throw Error(Errc::invalid, "semidefinite program: a variable twice in " + name);
    }
  }
}

double inner(const Matrix& F, const Matrix& Y) { return F.cwiseProduct(Y).sum(); }
double inner_of_magnitudes(const Matrix& F, const Matrix& Y) {
  return F.cwiseAbs().cwiseProduct(Y.cwiseAbs()).sum();
}

/// Σ over the inequalities of ⟨F_i, Y⟩ for every i.
Vector inner_products(const SemidefiniteProgram& program, const std::vector<Matrix>& Y) {
  Vector sums = Vector::Zero(program.cost.size());
  for (std::size_t j = 0; j < Y.size(); ++j) {
    for (const auto& [i, term] : program.inequalities[j].terms) sums[i] += inner(term, Y[j]);
  }
  return sums;
}

double inner_constant(const SemidefiniteProgram& program, const std::vector<Matrix>& Y) {
  double sum = 0;
  for (std::size_t j = 0; j < Y.size(); ++j) sum += inner(program.inequalities[j].constant, Y[j]);
  return sum;
}

/// The same program in other units: row and column r of inequality j times row_scale[j][r], x_i =
/// variable_scale[i] x̃_i, cost times cost_scale; all powers of two, so that nothing is rounded.
/// Variables that appear nowhere are left out. The largest cost is made about 1000, since SDPA
/// stops when its two objective values have come within 1e-6.
struct ScaledProgram {
  SemidefiniteProgram program;
  std::vector<Vector> row_scale;
  Vector variable_scale;
  double cost_scale = 1;
  std::vector<Index> variables;  ///< that are there
  bool without_bound = false;    ///< one that is not has a cost
  bool exact = true;  ///< no coefficient has left the range of numbers: a proof of one program is
                      ///< one of the other
};

double power_of_two(double value) { return std::exp2(std::round(std::log2(value))); }

/// Largest entries of every variable's matrices and of every row become 1, nearly: alternating, as
/// in an equilibration.
void equilibrate(const SemidefiniteProgram& program, ScaledProgram& scaled) {
  scaled.variable_scale = Vector::Ones(program.cost.size());
  for (const MatrixInequality& F : program.inequalities)
    scaled.row_scale.push_back(Vector::Ones(F.constant.rows()));
  for (int round = 0; round < 6; ++round) {
    Vector largest = Vector::Zero(program.cost.size());
    for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
      const Vector& d = scaled.row_scale[j];
      for (const auto& [i, term] : program.inequalities[j].terms) {
        largest[i] =
            std::max(largest[i], (d.asDiagonal() * term * d.asDiagonal()).cwiseAbs().maxCoeff());
      }
    }
    for (Index i = 0; i < largest.size(); ++i)
      scaled.variable_scale[i] = largest[i] > 0 ? 1 / largest[i] : 1;
    for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
      const MatrixInequality& F = program.inequalities[j];
      Vector& d = scaled.row_scale[j];
      Matrix magnitude = F.constant.cwiseAbs();
      for (const auto& [i, term] : F.terms)
        magnitude = magnitude.cwiseMax(scaled.variable_scale[i] * term.cwiseAbs());
      const Vector row = (d.asDiagonal() * magnitude * d.asDiagonal()).rowwise().maxCoeff();
      for (Index r = 0; r < d.size(); ++r) d[r] /= row[r] > 0 ? std::sqrt(row[r]) : 1;
    }
  }
  for (Vector& d : scaled.row_scale) d = d.unaryExpr([](double v) { return power_of_two(v); });
  scaled.variable_scale = scaled.variable_scale.unaryExpr([](double v) { return power_of_two(v); });
}

ScaledProgram scale(const SemidefiniteProgram& program) {
  ScaledProgram scaled;
  equilibrate(program, scaled);
  Eigen::Matrix<Index, Eigen::Dynamic, 1> place =
      Eigen::Matrix<Index, Eigen::Dynamic, 1>::Constant(program.cost.size(), -1);
  for (const MatrixInequality& F : program.inequalities) {
    for (const auto& [i, term] : F.terms) {
      if (place[i] >= 0 || term.isZero(0)) continue;
      place[i] = static_cast<Index>(scaled.variables.size());
      scaled.variables.push_back(i);
    }
  }
  for (Index i = 0; i < place.size(); ++i)
    scaled.without_bound = scaled.without_bound || (place[i] < 0 && program.cost[i] != 0);
  scaled.program.cost.resize(static_cast<Index>(scaled.variables.size()));
  for (std::size_t i = 0; i < scaled.variables.size(); ++i) {
    const Index original = scaled.variables[i];
    scaled.program.cost[static_cast<Index>(i)] =
        program.cost[original] * scaled.variable_scale[original];
  }
  const double largest =
      scaled.program.cost.size() == 0 ? 0 : scaled.program.cost.cwiseAbs().maxCoeff();
  if (largest > 0) scaled.cost_scale = 1024 * power_of_two(1 / largest);
  scaled.program.cost *= scaled.cost_scale;
  for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
    const auto d = scaled.row_scale[j].asDiagonal();
    const auto scaled_by = [&](const Matrix& F, double factor) {
      Matrix other = factor * (d * F * d);
      scaled.exact = scaled.exact && (d.inverse() * other * d.inverse()) / factor == F;
      return other;
    };
    MatrixInequality F{scaled_by(program.inequalities[j].constant, 1), {}};
    for (const auto& [i, term] : program.inequalities[j].terms) {
      if (place[i] >= 0) F.terms.emplace_back(place[i], scaled_by(term, scaled.variable_scale[i]));
    }
    scaled.program.inequalities.push_back(std::move(F));
  }
  return scaled;
}

/// Dual matrices of the given program from those of the scaled one.
std::vector<Matrix> unscaled(const ScaledProgram& scaled, std::vector<Matrix> Y, double factor) {
  for (std::size_t j = 0; j < scaled.row_scale.size(); ++j) {
    const auto d = scaled.row_scale[j].asDiagonal();
    Y[j] = factor * (d * Y[j] * d);
  }
  return Y;
}

/// Y without the negative part that the solver may have left.
Matrix semidefinite_part(const Matrix& Y) {
  const linalg::SymmetricEigen eigen = linalg::symmetric_eigen(Y);
  if (eigen.values[0] >= 0) return Y;
  const Matrix part =
      eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
  return (part + part.transpose()) / 2;
}

/// An answer in the given program's own numbers: `solved` or `unknown`. `feasible` if its point
/// meets the inequalities.
SdpSolution assess(const SemidefiniteProgram& program, const ScaledProgram& scaled,
                   const SdpProposal& proposal, const SdpOptions& options, bool& feasible) {
  SdpSolution s;
  s.solver_status = proposal.phase;
  s.why = "the solver stopped without a solution (" + proposal.phase + ")";
  if (!proposal.x) return s;
  Vector x = Vector::Zero(program.cost.size());
  for (std::size_t i = 0; i < scaled.variables.size(); ++i) {
    x[scaled.variables[i]] =
        scaled.variable_scale[scaled.variables[i]] * (*proposal.x)[static_cast<Index>(i)];
  }
  std::vector<Matrix> Y = unscaled(scaled, proposal.Y, 1 / scaled.cost_scale);
  for (Matrix& part : Y) part = semidefinite_part(part);
  double violation = 0;
  for (const MatrixInequality& F : program.inequalities) {
    Matrix value = F.constant;
    double size = F.constant.cwiseAbs().maxCoeff();
    for (const auto& [i, term] : F.terms) {
      value += x[i] * term;
      size = std::max(size, std::abs(x[i]) * term.cwiseAbs().maxCoeff());
    }
    if (!value.allFinite()) return s;
    s.least_eigenvalue.push_back(linalg::symmetric_eigen(value).values[0]);
    if (s.least_eigenvalue.back() < 0)
      violation = std::max(violation, -s.least_eigenvalue.back() / size);
  }
  const Vector residual = inner_products(program, Y) - program.cost;
  s.value = program.cost.dot(x);
  s.bound = -inner_constant(program, Y);
  s.dual_residual = residual.cwiseAbs().maxCoeff();
  // costᵀx' ≥ bound - |residual|ᵀ|x'| for every feasible x'.
  const double gap = std::abs(s.value - s.bound) + residual.cwiseAbs().dot(x.cwiseAbs());
  const double taken = 100 * options.accuracy;
  const bool inside = x.cwiseAbs().maxCoeff() <= options.largest_x;
  feasible = inside && violation <= taken;
  if (!inside) {
    s.why = "the solver's point lies beyond the bound of |x| (" + proposal.phase + ")";
  } else if (scaled.without_bound) {
    s.why = "a variable that no inequality depends on lowers the cost without end";
  } else if (!feasible) {
    s.why = "the solver's point violates the inequalities (" + proposal.phase + ")";
  } else if (!(gap <= taken * (1 + program.cost.cwiseAbs().dot(x.cwiseAbs())))) {
    s.why = fmt::format(
        "value {:.10g} and bound {:.10g} differ, or the dual residual {:.2g} is too large ({})",
        s.value, s.bound, s.dual_residual, proposal.phase);
  } else {
    s.status = SdpStatus::solved;
    s.x = std::move(x);
    s.why.clear();
  }
  return s;
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

constexpr SdpTuning tunings[] = {{1e4, .1, .9}, {1e2, .1, .9}, {1e6, .2, .7}};

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

/// Constants alone: there is nothing to ask for.
SdpProposal constant_proposal(const SemidefiniteProgram& program) {
  SdpProposal proposal{"constant", Vector(), {}};
  for (const MatrixInequality& F : program.inequalities) proposal.Y.push_back(0 * F.constant);
  return proposal;
}

}  // namespace

SdpSolution solve(const SemidefiniteProgram& program, const SdpOptions& options) {
  check(program, options);
  const ScaledProgram scaled = scale(program);
  SdpSolution answer;
  bool any_feasible = false;
  for (const SdpTuning& tuning : tunings) {
    bool feasible = false;
    const SdpProposal proposal =
        scaled.variables.empty()
            ? constant_proposal(program)
            : run_sdpa(scaled.program, options.accuracy, options.iterations, tuning);
    answer = assess(program, scaled, proposal, options, feasible);
    if (answer.status == SdpStatus::solved) return answer;
    any_feasible = any_feasible || feasible;
  }
  prove_infeasible(scaled, options, answer);
  return answer;
}

}  // namespace cordon
