// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse program on its way to GLPK, which aborts the process for one that is broken.
#pragma once

#include <vector>

#include "cordon/solvers/sparse_program.hpp"
#include "glpk_environment.hpp"

namespace cordon::glpk {

/// Throws Errc::dimension, Errc::not_finite, Errc::invalid; `what` begins the message.
void check(const SparseProgram& program, const char* what);

/// The entries that are not 0, indices from 1.
struct Entries {
  explicit Entries(const SparseProgram& program);

  std::vector<int> row{0}, col{0};
  std::vector<double> value{0};
};

/// Fills a new problem. Plain C calls, for `guarded`.
void load(glp_prob* problem, const SparseProgram& program, const Entries& entries);

}  // namespace cordon::glpk
