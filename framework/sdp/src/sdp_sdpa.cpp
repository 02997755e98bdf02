// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that sees SDPA. Its form: minimise Σ c_i x_i subject to X = Σ F_i x_i - F_0 ⪰ 0; so
// F_0 is minus our constant. Facts it lives with: the library keeps state in static variables, so
// that one solve runs at a time; it writes remarks to std::cout; where it finds a defect it ends
// the process, with status 0, and where memory runs out it aborts. The linker sends all three to
// this file (wrap options in cmake/Dependencies.cmake): the stream to nowhere, the ends of the
// process to an exception.
#include <cstddef>
#include <limits>
#include <mutex>
#include <new>
#include <ostream>
#include <sdpa_call.h>

#include "sdp_proposal.hpp"

namespace {

struct GaveUp {};

}  // namespace

// Names that the linker makes of `exit`, `abort` and the symbol of std::cout.
extern "C" {
[[noreturn, gnu::visibility("hidden")]] void __wrap_exit(int) { throw GaveUp{}; }
[[noreturn, gnu::visibility("hidden")]] void __wrap_abort() { throw GaveUp{}; }
[[gnu::visibility("hidden")]] std::ostream __wrap__ZSt4cout(nullptr);
[[noreturn, gnu::visibility("hidden")]] void xerbla_(const char*, const int*, std::size_t) {
  throw GaveUp{};
}
// SDPA asks MUMPS, for more than 100 variables, what a sparse factorisation of its linear systems
// costs. The answer is: more than a dense one, which the programs here fill anyway. It never asks
// for more then, and MUMPS (CeCILL-C) need not be linked.
[[gnu::visibility("hidden")]] void dmumps_c(DMUMPS_STRUC_C* question) {
  question->infog[0] = 0;
  question->infog[19] = -std::numeric_limits<int>::max();  // millions of entries
  question->rinfog[0] = std::numeric_limits<double>::max();
}
}

namespace cordon {

namespace {

void input_matrix(SDPA& problem, int k, int block, const Matrix& F, double sign) {
  for (Index j = 0; j < F.cols(); ++j) {
    for (Index i = 0; i <= j; ++i) {
      if (F(i, j) == 0) continue;
      problem.inputElement(k, block, static_cast<int>(i) + 1, static_cast<int>(j) + 1,
                           sign * F(i, j));
    }
  }
}

void input(SDPA& problem, const SemidefiniteProgram& program) {
  const auto blocks = static_cast<int>(program.inequalities.size());
  problem.inputConstraintNumber(static_cast<int>(program.cost.size()));
  problem.inputBlockNumber(blocks);
  for (int l = 1; l <= blocks; ++l) {
    const auto size =
        static_cast<int>(program.inequalities[static_cast<std::size_t>(l) - 1].constant.rows());
    problem.inputBlockSize(l, size == 1 ? -1 : size);
    problem.inputBlockType(l, size == 1 ? SDPA::LP : SDPA::SDP);
  }
  problem.initializeUpperTriangleSpace();
  for (Index i = 0; i < program.cost.size(); ++i)
    problem.inputCVec(static_cast<int>(i) + 1, program.cost[i]);
  for (int l = 1; l <= blocks; ++l) {
    const MatrixInequality& F = program.inequalities[static_cast<std::size_t>(l) - 1];
    input_matrix(problem, 0, l, F.constant, -1);
    for (const auto& [i, term] : F.terms)
      input_matrix(problem, static_cast<int>(i) + 1, l, term, 1);
  }
  problem.initializeUpperTriangle();
}

SdpProposal output(SDPA& problem, const SemidefiniteProgram& program) {
  SdpProposal proposal;
  char phase[30] = "";
  problem.getPhaseString(phase);
  proposal.phase = phase;
  proposal.phase.resize(proposal.phase.find_last_not_of(' ') + 1);
  Vector x = Eigen::Map<const Vector>(problem.getResultXVec(), program.cost.size());
  bool finite = x.allFinite();
  for (std::size_t l = 0; l < program.inequalities.size(); ++l) {
    const Index size = program.inequalities[l].constant.rows();
    const Matrix Y =
        Eigen::Map<const Matrix>(problem.getResultYMat(static_cast<int>(l) + 1), size, size);
    proposal.Y.push_back((Y + Y.transpose()) / 2);
    finite = finite && proposal.Y.back().allFinite();
  }
  if (finite) {
    proposal.x = std::move(x);
  } else {
    proposal.phase += ", not finite";
  }
  return proposal;
}

}  // namespace

SdpProposal run_sdpa(const SemidefiniteProgram& program, double accuracy, int iterations,
                     const SdpTuning& tuning) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  try {
    SDPA problem;
    problem.setDisplay(nullptr);
    problem.setResultFile(nullptr);
    problem.setNumThreads(1);
    problem.setParameterType(SDPA::PARAMETER_DEFAULT);
    problem.setParameterMaxIteration(iterations);
    problem.setParameterEpsilonStar(accuracy);
    problem.setParameterEpsilonDash(accuracy);
    problem.setParameterLambdaStar(tuning.start);
    problem.setParameterBetaStar(tuning.centring);
    problem.setParameterBetaBar(2 * tuning.centring);
    problem.setParameterGammaStar(tuning.step);
    // It stops where the value leaves these bounds.
    problem.setParameterLowerBound(-1e15);
    problem.setParameterUpperBound(1e15);
    input(problem, program);
    problem.initializeSolve();
    problem.solve();
    SdpProposal proposal = output(problem, program);
    problem.terminate();
    return proposal;
  } catch (const GaveUp&) {
    return {"gave up: no memory or thread, or a defect of its own", {}, {}};
  }
}

}  // namespace cordon
