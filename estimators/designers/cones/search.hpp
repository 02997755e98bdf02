// SPDX-License-Identifier: GPL-3.0-or-later
// The cheapest separating input by cones of directions, with bounds from all pairs at once.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "designers/cones/cone_program.hpp"
#include "designers/cones/forbidden_reach.hpp"
#include "designers/facets/node_program.hpp"
#include "designers/known_answer.hpp"
#include "designers/watch.hpp"

namespace cordon::designers {

/// Best first, with no facet enumerated [Tuy1964], [Horst1996, ch. V]. A node is a set of rays
/// from the input z that costs least: the axes at the root. A `ConeProgram` bounds it and proposes
/// v = Σ λ_j v_j. Where z + v does not separate a pair, it becomes a ray, as far as inputs do not
/// separate each pair there, and the cones that hold the rays S = {j : λ_j > 0} are divided at it:
/// an input with λ_k = 0 for a k in S needs no ray k; any other one is a sum with v in which one of
/// S has become 0. So
///   A_k: without ray k, with those of S before it;   B_k: with v, without ray k
/// cover them, each without the rays of other orthants than those it has. Children: |S| each, and S
/// has hardly more rays than there are pairs, whatever the number of inputs is.
///
/// What is proven: every bound, by multipliers; that points of rays do not separate, by repair;
/// rounding of v, which is a sum of rays of one orthant and therefore right in every entry to some
/// roundoffs, by `rounding_along` in the sums. Pairs that z separates, or does up to rounding, and
/// equations of the input set and of tubes are left out of bounds, which keeps them valid: the
/// search ends with the best bound of the rest then.
///
/// Inputs are found by descent: the facets by which a ray leaves each pair's set make a linear
/// program, whose solution is the next ray.
class ConeSearch {
 public:
  ConeSearch(const SeparationProblem& problem, NodeProgram& inputs, KnownAnswer& known, double gap,
             Watch& watch);

  /// Goes on for so many nodes, until the end, or until the time is over.
  void run(std::int64_t nodes);

  /// Is there nothing left that could raise the bound?
  bool ended() const { return ended_; }
  /// Proven: no input separates the pairs.
  bool impossible() const { return impossible_; }
  std::int64_t nodes() const { return nodes_; }
  std::int64_t programs() const { return programs_; }

 private:
  struct Node {
    std::vector<std::int32_t> rays;
    std::vector<bool> needed;  ///< λ > 0 there: what is left without this ray is in other nodes
    Vector lambda;
    bool exact = false;  ///< the bound of a quadratic cost does not grow by further tangents
  };

  void begin();
  void visit(const Node& node, double bound);
  void divide(const Node& node, double bound, const std::vector<std::size_t>& chosen, Ray ray);
  bool divide_by_sign(const Node& node, double bound, const std::vector<std::size_t>& chosen);
  Node without(const Node& node, std::size_t left_out, const std::vector<Vector>& beside) const;
  void keep(Node node, double parent_bound, bool exact = false);
  void settle(const Node& node, double bound);
  void close(double bound) { closed_ = std::min(closed_, bound); }
  Vector inverse_along(const Vector& v);
  double rounding() const;
  Vector rounding_along(const Vector& v) const;
  void forget_unseen_pairs();
  std::vector<std::size_t> support_of(const Node& node) const;
  void descend(Vector v);
  bool offer(const Vector& u, const std::vector<std::optional<SeparatingFacet>>& facets,
             const Vector& zeta);
  bool good_enough(double bound) const { return known_.is_met_by(bound, gap_); }
  void raise_bound();
  const Vector& direction(std::int32_t ray) const { return rays_[static_cast<std::size_t>(ray)].v; }

  const SeparationProblem& problem_;
  NodeProgram& inputs_;
  KnownAnswer& known_;
  double gap_;
  Watch& watch_;
  Star star_;
  std::vector<std::pair<std::size_t, ForbiddenReach>> pairs_;  ///< with their numbers
  std::vector<Ray> rays_;
  Matrix of_axes_;  ///< per pair: `inverse` of the axes per length, up and down in turn
  std::optional<ConeProgram> program_;
  std::multimap<double, Node> open_;  ///< by their bounds
  double closed_ = infinity;  ///< least bound of what was put aside without being proven impossible
  bool begun_ = false, ended_ = false, impossible_ = false;
  std::int64_t nodes_ = 0, programs_ = 0;
};

}  // namespace cordon::designers
