// SPDX-License-Identifier: GPL-3.0-or-later
// cddlib over the rationals of GMP as an engine for exact polyhedra.
#pragma once

#include <string>

#include "solvers/exact_engine.hpp"

namespace cordon::cdd {

/// cddlib keeps global state: calls from several threads wait for each other. A call cannot be
/// interrupted and knows no limit of time or memory, so that the caller has to look at the size of
/// the question (second_opinion.hpp). Throws Errc::solver where cddlib gives no answer.
class Cddlib : public ExactEngine {
 public:
  Description generators_of(const Description& inequalities) override;
  Description inequalities_of(const Description& generators) override;
  Optimum maximum(const ExactProgram& program) override;
};

/// Of the headers that this was compiled with, e.g. "0.94m": the library itself does not tell.
std::string version();

}  // namespace cordon::cdd
