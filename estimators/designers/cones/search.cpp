// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/cones/search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

namespace {

constexpr double met_by = 1e-9;             ///< by which a solver's point may miss a chosen facet
constexpr double met_kappa = 1e-6;          ///< likewise, of κ then
constexpr double separates_by = 1e-11;      ///< a ray's end by this much nearer does as well
constexpr double smallest_share = 1e-7;     ///< of the largest λ: smaller ones are 0
constexpr int most_generations = 100;       ///< of rays, for which `slack` has room
constexpr std::size_t most_open = 2000000;  ///< nodes that wait, for memory
constexpr int most_descents = 6;
constexpr std::int64_t early_nodes = 50, nodes_between = 20;  ///< from which inputs are looked for

bool same_orthant(const Vector& a, const Vector& b) { return (a.array() * b.array() >= 0).all(); }

}  // namespace

ConeSearch::ConeSearch(const SeparationProblem& problem, NodeProgram& inputs, KnownAnswer& known,
                       double gap, Watch& watch)
    : problem_(problem), inputs_(inputs), known_(known), gap_(gap), watch_(watch), star_(problem) {}

void ConeSearch::begin() {
  begun_ = true;
  if (star_.size() == 0 || !(star_.most > 0)) {
    ended_ = true;  // nothing varies, or nothing costs
    return;
  }
  for (std::size_t q = 0; q < problem_.pairs.size() && !watch_.over(); ++q) {
    ++programs_;
    if (auto reach = ForbiddenReach::of(problem_, problem_.pairs[q], star_))
      pairs_.emplace_back(q, std::move(*reach));
  }
  Node root;
  of_axes_ = Matrix::Zero(static_cast<Index>(pairs_.size()), 2 * star_.size());
  for (Index i = 0; i < star_.size(); ++i) {
    for (const double end : {star_.up[i], -star_.down[i]}) {
      if (end == 0 || watch_.over()) continue;
      root.rays.push_back(static_cast<std::int32_t>(rays_.size()));
      rays_.push_back({end * Vector::Unit(star_.size(), i), {}});
      rays_.back().inverse = inverse_along(rays_.back().v);
      of_axes_.col(2 * i + (end < 0)) = rays_.back().inverse / std::abs(end);
    }
  }
  forget_unseen_pairs();
  if (watch_.over() || pairs_.empty()) {
    ended_ = true;
    return;
  }
  for (Ray& ray : rays_) ray.inverse += rounding_along(ray.v);
  Vector slack(static_cast<Index>(pairs_.size()));
  for (Index q = 0; q < slack.size(); ++q)
    slack[q] = pairs_[static_cast<std::size_t>(q)].second.inverse_within(star_.neglected);
  program_.emplace(star_, problem_.cost.kind, std::move(slack), rounding());
  root.needed.assign(root.rays.size(), false);
  keep(std::move(root), 0);
  if (!open_.empty()) {
    const Node& first = open_.begin()->second;
    for (const std::int32_t ray : first.rays) descend(direction(ray));
  }
}

/// A pair that is not seen along an axis bounds nothing.
void ConeSearch::forget_unseen_pairs() {
  std::vector<Index> seen;
  std::vector<std::pair<std::size_t, ForbiddenReach>> pairs;
  for (Index q = 0; q < of_axes_.rows(); ++q) {
    if (!(of_axes_.row(q).maxCoeff() < infinity)) continue;
    seen.push_back(q);
    pairs.push_back(std::move(pairs_[static_cast<std::size_t>(q)]));
  }
  pairs_ = std::move(pairs);
  of_axes_ = Matrix(of_axes_(seen, Eigen::all));
  for (Ray& ray : rays_) ray.inverse = Vector(ray.inverse(seen));
}

/// The share of an entry that a ray is wrong by at most: of sums of up to n + pairs rays of one
/// orthant, generation by generation.
double ConeSearch::rounding() const {
  return most_generations * static_cast<double>(star_.size() + std::ssize(pairs_) + 3) *
         std::numeric_limits<double>::epsilon();
}

/// By how much less than 1 the sums of an input in a cone may be because of the rounding of rays,
/// per length of v: an error of a share η of every entry, followed along the axes.
Vector ConeSearch::rounding_along(const Vector& v) const {
  Vector both(2 * v.size());
  for (Index i = 0; i < v.size(); ++i) {
    both[2 * i] = std::max(v[i], 0.0);
    both[2 * i + 1] = std::max(-v[i], 0.0);
  }
  return rounding() * linalg::product(of_axes_, both);
}

void ConeSearch::run(std::int64_t nodes) {
  if (!begun_) begin();
  for (std::int64_t n = 0; !ended_ && n < nodes; ++n) {
    raise_bound();
    watch_.progress(known_.cost, known_.bound);
    if (open_.empty()) break;
    const double bound = open_.begin()->first;
    if (good_enough(known_.bound) || bound >= closed_ || open_.size() > most_open) {
      ended_ = true;
      break;
    }
    if (watch_.over()) break;
    const Node node = std::move(open_.extract(open_.begin()).mapped());
    ++nodes_;
    visit(node, bound);
  }
  if (program_ && open_.empty()) {
    ended_ = true;
    impossible_ = closed_ == infinity && !known_.u;
  }
  raise_bound();
}

void ConeSearch::raise_bound() {
  if (!program_) return;
  const double open = open_.empty() ? infinity : open_.begin()->first;
  known_.raise(std::min(open, closed_));
}

Vector ConeSearch::inverse_along(const Vector& v) {
  Vector inverse(static_cast<Index>(pairs_.size()));
  for (std::size_t q = 0; q < pairs_.size(); ++q)
    inverse[static_cast<Index>(q)] = pairs_[q].second.along(v).inverse;
  programs_ += static_cast<std::int64_t>(pairs_.size());
  return inverse;
}

std::vector<std::size_t> ConeSearch::support_of(const Node& node) const {
  std::vector<std::size_t> chosen;
  if (node.lambda.size() == 0) return chosen;
  const double least = smallest_share * node.lambda.maxCoeff();
  for (Index j = 0; j < node.lambda.size(); ++j) {
    if (node.lambda[j] > least) chosen.push_back(static_cast<std::size_t>(j));
  }
  return chosen;
}

void ConeSearch::visit(const Node& node, double bound) {
  const std::vector<std::size_t> chosen = support_of(node);
  if (divide_by_sign(node, bound, chosen)) return;
  Vector v = Vector::Zero(star_.size()), inverse = Vector::Zero(static_cast<Index>(pairs_.size()));
  int generation = 0;
  for (const std::size_t j : chosen) {
    const Ray& ray = rays_[static_cast<std::size_t>(node.rays[j])];
    v += node.lambda[static_cast<Index>(j)] * ray.v;
    generation = std::max(generation, ray.generation + 1);
  }
  const bool leads = chosen.size() > 1 && generation <= most_generations;
  if (!leads || nodes_ < early_nodes || nodes_ % nodes_between == 0) descend(v);
  if (!leads) return settle(node, bound);
  const Vector end = star_.stretched(v);
  const double times = end.lpNorm<Eigen::Infinity>() / v.lpNorm<Eigen::Infinity>();
  // Sums of points that do not separate a pair do not either.
  for (const std::size_t j : chosen) {
    inverse +=
        node.lambda[static_cast<Index>(j)] * rays_[static_cast<std::size_t>(node.rays[j])].inverse;
  }
  inverse = inverse_along(end).cwiseMin(times * (1 + 1e-14) * inverse) + rounding_along(end);
  const bool separates = (inverse.array() >= times * (1 - separates_by)).all();
  if (separates) {
    descend(v);
    return settle(node, bound);
  }
  divide(node, bound, chosen, {end, std::move(inverse), generation});
}

/// A node that leads to no other one, once its bound is as good as it gets.
void ConeSearch::settle(const Node& node, double bound) {
  if (node.exact || problem_.cost.kind != Cost::Kind::quadratic) return close(bound);
  keep(node, bound, true);
}

/// Where rays of opposite signs in an entry were chosen: one child for each sign of it.
bool ConeSearch::divide_by_sign(const Node& node, double bound,
                                const std::vector<std::size_t>& chosen) {
  Vector up = Vector::Zero(star_.size()), down = up;
  for (const std::size_t j : chosen) {
    const Vector part = node.lambda[static_cast<Index>(j)] * direction(node.rays[j]);
    up += part.cwiseMax(0.0);
    down -= part.cwiseMin(0.0);
  }
  Index entry = 0;
  const Vector both = up.cwiseMin(down).cwiseQuotient((star_.up + star_.down).cwiseMax(1e-300));
  if (both.size() == 0 || !(both.maxCoeff(&entry) > 0)) return false;
  for (const double sign : {1.0, -1.0})
    keep(without(node, node.rays.size(), {sign * Vector::Unit(star_.size(), entry)}), bound);
  return true;
}

/// The rays of the node but this one (none if it is their number), and but those that are in
/// another orthant than one of these directions.
ConeSearch::Node ConeSearch::without(const Node& node, std::size_t left_out,
                                     const std::vector<Vector>& beside) const {
  Node child;
  for (std::size_t j = 0; j < node.rays.size(); ++j) {
    const auto together = [&](const Vector& other) {
      return same_orthant(direction(node.rays[j]), other);
    };
    if (j == left_out || !std::all_of(beside.begin(), beside.end(), together)) continue;
    child.rays.push_back(node.rays[j]);
    child.needed.push_back(node.needed[j]);
  }
  return child;
}

void ConeSearch::divide(const Node& node, double bound, const std::vector<std::size_t>& chosen,
                        Ray ray) {
  const auto number = static_cast<std::int32_t>(rays_.size());
  rays_.push_back(std::move(ray));
  const Vector v = rays_.back().v;
  Node marked = node;  // the rays of `chosen` before k are needed in its children
  for (const std::size_t k : chosen) marked.needed[k] = false;
  std::vector<Vector> before;
  for (const std::size_t k : chosen) {
    if (!node.needed[k]) {
      Node a = marked;
      for (const std::size_t j : chosen) a.needed[j] = a.needed[j] || node.needed[j];
      keep(without(a, k, before), bound);
    }
    Node b = without(marked, k, {v});
    b.rays.push_back(number);
    b.needed.push_back(true);
    keep(std::move(b), bound);
    marked.needed[k] = true;
    before.push_back(direction(node.rays[k]));
  }
}

void ConeSearch::keep(Node node, double parent_bound, bool exact) {
  std::vector<const Ray*> rays;
  for (const std::int32_t ray : node.rays) rays.push_back(&rays_[static_cast<std::size_t>(ray)]);
  ++programs_;
  ConeProgram::Answer answer = program_->solve(rays, known_.cost, exact);
  if (answer.impossible) return;
  if (!answer.solved) return close(parent_bound);
  const double bound = std::max(parent_bound, answer.bound);
  if (good_enough(bound)) return close(bound);
  node.lambda = std::move(answer.lambda);
  node.exact = exact;
  open_.emplace(bound, std::move(node));
}

/// Cheaper inputs from a direction on, as long as there are.
void ConeSearch::descend(Vector v) {
  for (int step = 0; step < most_descents; ++step) {
    std::vector<std::optional<SeparatingFacet>> facets(problem_.pairs.size());
    std::vector<const SeparatingFacet*> chosen;
    for (const auto& [number, reach] : pairs_) {
      ++programs_;
      facets[number] = reach.along(star_.stretched(v)).facet;
      if (facets[number]) chosen.push_back(&*facets[number]);
    }
    const NodeProgram::Answer cheapest = inputs_.solve(chosen);
    if (!cheapest.zeta) return;
    const Vector u = problem_.U.c + linalg::product(problem_.U.G, *cheapest.zeta);
    if (!offer(u, facets, *cheapest.zeta)) return;
    v = star_.way(u);
  }
}

bool ConeSearch::offer(const Vector& u, const std::vector<std::optional<SeparatingFacet>>& facets,
                       const Vector& zeta) {
  const double cost = problem_.cost.at(u);
  if (known_.u && !(cost < known_.cost)) return false;
  for (std::size_t q = 0; q < facets.size(); ++q) {
    const bool is_met = facets[q] && facets[q]->a.dot(zeta) >= facets[q]->out - met_by;
    if (is_met && problem_.epsilon == 0) continue;  // they may touch
    if (watch_.over()) return false;
    const PairSeparation apart = separation(problem_.pairs[q], u);
    const double least = problem_.epsilon - (is_met ? met_kappa : 0);
    if (apart.disjoint != Answer::yes || !(apart.kappa_lower >= least)) return false;
  }
  known_.offer(u, cost);
  return true;
}

}  // namespace cordon::designers
