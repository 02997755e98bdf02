// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/tubes/separation.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/lp.hpp"
#include "cordon/tubes/line_proof.hpp"

namespace cordon {

/// S δ + A ξ + U u = b.
struct PairRows {
  Matrix S, A, U;
  Vector b, terms;     ///< of b and A, ‖ξ‖∞ ≤ 1
  Matrix input_terms;  ///< of U
  LinesEliminated rest;
};

namespace {

constexpr double most_tau = 1e9;

/// What the program of κ proposes: κ, and multipliers y with κ = yᵀd / ‖Gᵀy‖₁ - 1.
struct Proposal {
  double kappa = 0;
  Vector y;
};

/// max{τ : Gξ = τ s d, ‖ξ‖∞ ≤ 1, 0 ≤ τ ≤ 10⁹}, rows scaled: τ, and multipliers of the rows.
std::optional<std::pair<double, Vector>> solve_for_tau(const Matrix& G, const Vector& d, double s) {
  const Index g = G.cols(), m = d.size();
  Matrix rows(m, g + 1);
  rows << G, -s * d;
  const Vector scale = linalg::row_scales(rows);
  rows = scale.asDiagonal() * rows;
  Vector lower = Vector::Constant(g + 1, -1.0), upper = Vector::Ones(g + 1),
         objective = Vector::Zero(g + 1);
  lower[g] = 0;
  upper[g] = most_tau;
  objective[g] = 1;
  LinearProgram::Solution solution =
      LinearProgram(rows, Vector::Zero(m), lower, upper).maximize(objective);
  if (solution.status != LinearProgram::Status::optimal) return std::nullopt;
  return std::pair(std::max(0.0, solution.x[g]), Vector(scale.asDiagonal() * solution.y));
}

/// κ = 1/(τ s) - 1 with s such that τ is of ordinary size: a solver's τ is right up to some 1e-9
/// only.
std::optional<Proposal> propose(const Matrix& G, const Vector& d) {
  double s = 1;
  for (int trial = 0; trial < 5; ++trial, s *= 1e-6) {
    auto solution = solve_for_tau(G, d, s);
    if (!solution) return std::nullopt;
    const auto& [tau, y] = *solution;
    if (tau >= 1e-3) return Proposal{1 / (tau * s) - 1, y};
  }
  auto solution = solve_for_tau(G, d, 1);
  return Proposal{infinity, solution ? solution->second : Vector::Zero(d.size())};
}

/// κ ≥ this by y: (yᵀd - ‖Gᵀy‖₁) / ‖Gᵀy‖₁, the numerator proven for every right-hand side within
/// `error` of d; -1, which always holds, if y proves nothing.
double proven_kappa(const Matrix& G, const Vector& d, const Vector& error, const Vector& y) {
  if (!y.allFinite()) return -1;
  const double norm = linalg::transposed_product(G, y).cwiseAbs().sum();
  const double margin = farkas_margin(G, d, y, error);
  if (norm == 0) return margin > 0 ? infinity : -1;
  const double slack = 1 + 1e-12;  // of the norm's own rounding
  return std::max(-1.0, margin > 0 ? margin / (norm * slack) : margin / norm * slack);
}

/// Are all differences of entries free of rounding?
bool is_exact_difference(MatrixIn A, MatrixIn B) {
  for (Index j = 0; j < A.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) {
      const double a = A(i, j), b = -B(i, j), sum = a + b, added = sum - a;
      if ((a - (sum - added)) + (b - added) != 0) return false;
    }
  }
  return true;
}

/// Do multipliers of the rows that are left prove that the tubes are disjoint under u?
bool stands(const PairProgram& pair, VectorIn u, const Vector& multipliers) {
  if (!pair.whole) return true;
  const auto& [S, A, U, b, terms, input_terms, rest] = *pair.whole;
  const Index factors = A.cols(), lines = S.cols();
  const LineForm rows{Matrix(0, lines),         Matrix(0, factors), Vector(0), S, A,
                      b - linalg::product(U, u)};
  const Matrix& by = rest.lines_by_factors;  // and by inputs, behind them
  const Vector offset = rest.lines_offset + linalg::product(by.rightCols(U.cols()), u);
  const LinesReached reached{offset.cwiseAbs() + by.leftCols(factors).cwiseAbs().rowwise().sum(),
                             rest.free_lines};
  return proves_empty_through_lines(rows, terms + linalg::product(input_terms, u.cwiseAbs()),
                                    linalg::transposed_product(rest.rows, multipliers), reached);
}

}  // namespace

PairProgram pair_program(Index i, const OutputTube& Yi, Index j, const OutputTube& Yj) {
  const Index outputs = Yi.outputs(), inputs = Yi.inputs(), rows_i = Yi.b.size(),
              rows_j = Yj.b.size();
  const Index lines_i = Yi.S.cols(), lines_j = Yj.S.cols(), g_i = Yi.A.cols(), g_j = Yj.A.cols();
  Matrix S(outputs + rows_i + rows_j, lines_i + lines_j), A(S.rows(), g_i + g_j + inputs);
  S << Yi.M, -Yj.M, linalg::block_diagonal(Yi.S, Yj.S);
  A.leftCols(g_i + g_j) << Yi.G, -Yj.G, linalg::block_diagonal(Yi.A, Yj.A);
  A.rightCols(inputs) << Yi.H - Yj.H, -Yi.Omega, -Yj.Omega;
  Vector b(S.rows());
  b << Yj.c - Yi.c, Yi.b, Yj.b;
  Vector magnitude(b.size());
  magnitude << Yi.c_size + Yj.c_size, Yi.b_size, Yj.b_size;
  const bool is_exact = Yi.is_exact && Yj.is_exact && is_exact_difference(Yi.H, Yj.H) &&
                        is_exact_difference(Yj.c, Yi.c);
  const Index lines = S.cols(), columns = A.cols();
  const Vector factor_terms = A.leftCols(g_i + g_j).cwiseAbs().rowwise().sum();
  Matrix input_terms = A.rightCols(inputs).cwiseAbs();
  input_terms.topRows(outputs) = Yi.H.cwiseAbs() + Yj.H.cwiseAbs();
  const auto whole = std::make_shared<PairRows>();
  whole->rest =
      eliminate_lines_traced({Matrix(0, lines), Matrix(0, columns), Vector(0), S, A, b}, magnitude);
  const LinesEliminated& rest = whole->rest;
  const Matrix shares = rest.rows.cwiseAbs();
  const TermsOfLines of_lines(S, rest, inputs);
  whole->S = std::move(S);
  whole->A = A.leftCols(g_i + g_j);
  whole->U = A.rightCols(inputs);
  whole->b = std::move(b);
  whole->terms = magnitude + factor_terms;
  whole->input_terms = input_terms;
  return {i,
          j,
          rest.set.A.leftCols(g_i + g_j),
          -rest.set.b,
          -rest.set.A.rightCols(inputs),
          linalg::product(shares, whole->terms + of_lines.terms),
          linalg::product(shares, input_terms + of_lines.input_terms),
          rest.follow && is_exact ? 0 : rest.vanished,
          whole};
}

Vector PairProgram::terms(VectorIn reach) const {
  const Vector seen =
      c.cwiseAbs() + G.cwiseAbs().rowwise().sum() + linalg::product(N.cwiseAbs(), reach);
  if (N_magnitude.size() == 0) return seen.cwiseMax(magnitude);
  return seen.cwiseMax(linalg::product(N_magnitude, reach) + magnitude);
}

std::vector<PairProgram> pair_programs(const std::vector<OutputTube>& tubes) {
  std::vector<PairProgram> pairs;
  const auto modes = static_cast<Index>(tubes.size());
  for (Index i = 0; i < modes; ++i) {
    for (Index j = i + 1; j < modes; ++j) {
      pairs.push_back(pair_program(i, tubes[static_cast<std::size_t>(i)], j,
                                   tubes[static_cast<std::size_t>(j)]));
    }
  }
  return pairs;
}

PairSeparation separation(const PairProgram& pair, VectorIn u) {
  PairSeparation result{pair.i, pair.j, -1, -1, Answer::no, {Certificate::Kind::structure, {}, 0}};
  if (pair.rows() == 0 && pair.vanished == 0) return result;  // nothing to violate
  if (pair.rows() == 0) {  // what the equations that vanished would say is not known
    result.kappa = std::numeric_limits<double>::quiet_NaN();
    result.disjoint = Answer::unknown;
    result.why = {};
    return result;
  }
  const Vector d = linalg::product(pair.N, u) - pair.c;
  const Vector terms = pair.terms(u.cwiseAbs()), error = tube_row_noise * terms;
  result.disjoint = BoxedProgram(pair.G, d, {terms, error}).is_empty(&result.why);
  if (result.disjoint == Answer::no && pair.vanished > 0) {
    result.disjoint = Answer::unknown;
    result.why = {};
  }
  const bool falls = result.disjoint == Answer::yes && !stands(pair, u, result.why.data);
  if (falls) {
    result.disjoint = Answer::unknown;
    result.why = {};
  }
  result.kappa = std::numeric_limits<double>::quiet_NaN();
  std::optional<Proposal> proposal = propose(pair.G, d);
  if (proposal) {
    result.kappa = proposal->kappa;
    const Vector& y = proposal->y;
    result.kappa_lower =
        std::max(proven_kappa(pair.G, d, error, y), proven_kappa(pair.G, d, error, -y));
  }
  if (result.why.kind == Certificate::Kind::farkas) {
    result.kappa_lower =
        std::max(result.kappa_lower, proven_kappa(pair.G, d, error, result.why.data));
  }
  if (falls) result.kappa_lower = -1;
  // the solver's κ is right to its tolerance; it does not contradict what is proven
  if (result.kappa < result.kappa_lower) result.kappa = result.kappa_lower;
  if (result.disjoint == Answer::yes && result.kappa < 0) result.kappa = 0;
  if (result.disjoint == Answer::no && result.kappa > 0) result.kappa = 0;
  return result;
}

}  // namespace cordon
