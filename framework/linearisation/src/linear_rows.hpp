// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a function as affine ones, and bounds of what these leave out.
#pragma once

#include <memory>
#include <vector>

#include "cordon/formulas/box_enclosure.hpp"
#include "cordon/linearisation/linearise.hpp"

namespace cordon {

using Variables = std::vector<Interval>;

/// F by its first rows with derivatives by inputs, too, which stand behind x and the drawn
/// variables.
std::shared_ptr<const formulas::Function> by_inputs(const formulas::Function& function, Index rows,
                                                    Index inputs);

/// What bounds of errors may cost.
struct LinearisationEffort {
  std::size_t most_parts = 1000, fewest_parts = 50;  ///< of the box
  std::size_t most_steps = 3'000'000;  ///< of all parts together, where there are more
  Index points = 1000;                 ///< by which coordinates of the errors are chosen
  formulas::AffineForm form = formulas::AffineForm::convex_differences;
  const char* where = "on the region";  ///< the box, for errors
};

/// Slopes that are given by states and inputs.
struct GivenSlopes {
  const Matrix *by_states = nullptr, *by_inputs = nullptr;
};

/// For all z of the box F(z) ∈ slopes z + columns errors.
struct LinearRows {
  Matrix slopes;                    ///< derivatives at the centre of the box, or as given
  std::vector<LinearisedRow> rows;  ///< errors row by row
  Matrix columns;                   ///< errors of the rows by those that are kept
  Box errors;                       ///< of these, coordinates that are not 0
  std::vector<Index> kept;          ///< the rows that they belong to
  bool is_linear = true;  ///< what is left of all rows is a constant, and not in the box only
};

/// `box`: of all variables, the first `states` are x. `name`: of the function, for errors. Throws
/// Errc::not_enclosed.
LinearRows linear_rows(const std::shared_ptr<const formulas::Function>& function, Index states,
                       const Variables& box, const char* name, const GivenSlopes& given,
                       const LinearisationEffort& effort);

/// set × errors of the rows.
LineForm with_errors(const LineForm& set, const LinearRows& rows);

/// [slopes columns]
Matrix beside(const Matrix& slopes, const Matrix& columns);

/// Errc::unsupported unless bounded.
Box bounded_hull(const LineForm& set, const char* name);

void add_bounds(Variables& variables, const Box& box);

}  // namespace cordon
