// SPDX-License-Identifier: GPL-3.0-or-later
// Several formulas compiled for evaluation, with the structure of their derivatives.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "cordon/formulas/expression.hpp"

namespace cordon::formulas {

/// F: Rᵐ → R^rows, by one tape of operations for all rows. What does not depend on the numbers is
/// found here, once: which variables a row depends on, and which derivatives are zero for all
/// points. Derivatives are by the first `differentiated` variables. Immutable.
class Function {
 public:
  /// More derivatives of all parts of the formulas are not kept: memory of some hundred megabytes.
  static constexpr std::size_t most_derivatives = 5'000'000;

  /// `rows`: nodes of the graph. Throws Errc::invalid for more derivatives than `most_derivatives`.
  /// `order`: 0, 1 or 2, of the highest derivative. Time and memory grow with the number of nodes
  /// times the derivatives of each.
  Function(std::shared_ptr<const Graph> graph, std::vector<int> rows, Index differentiated,
           int order);

  Index rows() const { return static_cast<Index>(rows_.size()); }
  Index variables() const { return graph_->variables(); }
  Index differentiated() const { return differentiated_; }
  int order() const { return order_; }
  const Graph& graph() const { return *graph_; }
  const std::shared_ptr<const Graph>& shared_graph() const { return graph_; }
  int node(Index row) const { return at(place(row)).source; }  ///< of the graph

  /// The variables that may change the derivatives of the row are none: it is affine in the
  /// variables that are differentiated, with coefficients that may depend on the others.
  bool is_affine(Index row) const;
  /// Of an affine part: no second derivative of the row has to do with the variable.
  bool is_affine_in(Index row, Index variable) const;
  bool depends_on(Index row, Index variable) const;

  // What evaluators run. Operands are places on the tape.
  struct Step {
    Node node;
    int source;             ///< the node of the graph
    int gradient, hessian;  ///< where its entries begin; they end where those of the next one begin
  };
  struct GradientEntry {
    int variable;
    int a, b;  ///< entries of the operands by the same variable; -1: zero
  };
  struct HessianEntry {
    int i, j;      ///< variables, i ≤ j
    int a, b;      ///< entries of the operands' Hessians
    int a_i, a_j;  ///< of the operands' gradients
    int b_i, b_j;
  };
  const std::vector<Step>& tape() const { return tape_; }
  int place(Index row) const { return rows_[as_size(row)]; }
  const std::vector<GradientEntry>& gradients() const { return gradients_; }
  const std::vector<HessianEntry>& hessians() const { return hessians_; }
  int gradient_end(int place) const { return end(place, &Step::gradient, gradients_.size()); }
  int hessian_end(int place) const { return end(place, &Step::hessian, hessians_.size()); }
  /// The places that a row is made of, ascending.
  const std::vector<int>& parts(Index row) const { return parts_[as_size(row)]; }

 private:
  int end(int place, int Step::*begin, std::size_t last) const {
    const auto next = static_cast<std::size_t>(place) + 1;
    return next < tape_.size() ? tape_[next].*begin : static_cast<int>(last);
  }
  void record(const std::vector<int>& rows);
  void find_gradient(int place);
  void find_hessian(int place);
  int gradient_of(int place, int variable) const;
  int hessian_of(int place, int i, int j) const;
  const Step& at(int place) const { return tape_[static_cast<std::size_t>(place)]; }

  std::shared_ptr<const Graph> graph_;
  Index differentiated_;
  int order_;
  std::vector<Step> tape_;
  std::vector<int> rows_;
  std::vector<std::vector<int>> parts_;
  std::vector<GradientEntry> gradients_;
  std::vector<HessianEntry> hessians_;
};

}  // namespace cordon::formulas
