// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of an exchange form, written as equations of a model.
#pragma once

#include <vector>

#include "cordon/core/line_form.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"

namespace cordon::verification {

/// Equations, block by block. All variables but the sets' factors are lines, so that every
/// coefficient is a number of a model or of a set as it stands: nothing is multiplied, and nothing
/// is rounded.
class Equations {
 public:
  /// A vector of lines.
  struct Line {
    Index first, size;
  };

  Line line(Index size);
  /// Lines that keep to the set.
  Line element(const LineForm& X);
  Line constant(VectorIn value);

  struct Term {
    Line variable;
    Matrix coefficient;
  };
  /// Σ coefficient · variable = 0.
  void add(Index rows, const std::vector<Term>& terms);
  /// E x, with lines and rows of its own where E is not used as it is written.
  Term product(const DescriptorMatrix& E, const Line& x);

  /// The set of all values of `x`; of a line of size 0: the rows alone.
  LineForm project(const Line& x) const;

 private:
  struct Entry {
    Index row, col;
    bool factor;
    double value;
  };

  Index add_rows(VectorIn b);
  void put(Index row, const Line& variable, const Matrix& block) {
    put(row, variable.first, block, false);
  }
  void put(Index row, Index col, const Matrix& block, bool factor);

  Index lines_ = 0, factors_ = 0, rows_ = 0;
  Vector b_;
  std::vector<Entry> entries_;
};

}  // namespace cordon::verification
