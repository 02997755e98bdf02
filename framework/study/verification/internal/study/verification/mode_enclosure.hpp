// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of a mode over boxes, each row an affine one with an interval for the rest.
#pragma once

#include <optional>
#include <vector>

#include "cordon/formulas/box_enclosure.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::verification {

/// left z - slopes (x, noise) ∈ rest, for all states and noises that two boxes hold; z is the next
/// state, or none. Every entry is a double, every rest is rounded outward.
struct EnclosedRows {
  Matrix left, slopes;
  std::vector<Interval> rest;
  Index states = 0;  ///< of the columns of `slopes`, the first ones

  Index noises() const { return slopes.cols() - states; }
};

/// Of linear models with E, intervals and effectiveness, and of models by formulas. Natural
/// extensions, mean values and second derivatives over one box: coarser than what observers
/// carry, and computed by none of their code.
class ModeEnclosure {
 public:
  explicit ModeEnclosure(const Model& model);

  /// The equations of x_{k+1}. Nothing where a formula has no bounded enclosure.
  std::optional<EnclosedRows> successors(const Box& x, const Sample& now);
  /// Where x_{k+1} is, by its rows alone; the whole space where E is given.
  Box reached(const EnclosedRows& rows, const Box& x) const;
  /// Those of the outputs that are there, and of the invariants. Rows without a bounded enclosure
  /// are left out, for they say nothing.
  EnclosedRows outputs(const Box& x, const Sample& now);
  /// Narrows the box by these rows, and by those of formulas forward and backward. False: no state
  /// of it explains the sample, which is proven.
  bool contract(Box& x, const Sample& now);

  /// Of w, and of the effectiveness of each actuator that has a range: one number in all rows.
  const Box& disturbances() const { return driving_; }
  const Box& noises() const { return V_; }

 private:
  struct Formulas {
    formulas::BoxEnclosure f, g;
    formulas::Evaluator contracting;
  };

  EnclosedRows linear_successors(const Box& x, const Sample& now) const;
  EnclosedRows linear_outputs(const Box& x, const Sample& now) const;
  bool contract_by_formulas(Box& x, const Sample& now);
  std::vector<Index> rows_of(const Sample& now) const;

  const Model& model_;
  Box W_, V_;    ///< hulls
  Box driving_;  ///< W_, and the ranges of actuators
  std::optional<Formulas> formulas_;
};

}  // namespace cordon::verification
