// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices by rows. The steps of an observer have some dozens of numbers in each: for these a plain
// loop is faster than preparing for large ones. Large ones go the usual way.
#pragma once

#include "cordon/core/vectors.hpp"
#include "cordon/core/workspace.hpp"

namespace cordon::sets {

/// Rows filled with zeros up to whole vectors: cols() is the padded number.
using Rows = Workspace::Rows;

Rows padded_rows(MatrixIn A);
void take_padded_rows(MatrixIn A, Rows& rows);

/// A Aᵀ.
Matrix row_gram(const Rows& A);
void take_row_gram(const Rows& A, Matrix& K);

}  // namespace cordon::sets
