// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/search.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "cordon/core/linalg.hpp"
#include "designers/facets/facet_dual.hpp"
#include "designers/facets/node_program.hpp"

namespace cordon::designers {

namespace {

constexpr double met_tolerance = 1e-9;  ///< by which a solver's point may miss a chosen facet; the
                                        ///< factors of inputs are of size 1
constexpr int most_refinements = 60;    ///< of a node; each divides the error of the tangents by 4
constexpr const char* more_facets =
    "a larger max_facets, a shorter horizon, or the designer \"milp\"";
constexpr const char* more_room = "a larger input set, a longer horizon, or a smaller epsilon";

/// A pair that some inputs separate and others do not.
struct OpenPair {
  const PairProgram* pair;
  ForbiddenSet set;
};

/// A node's children that wait for their turn, one for each facet of a pair, the cheapest first.
struct Children {
  std::size_t pair;
  std::vector<std::pair<double, Index>> bound_and_facet;
};

struct Node {
  std::vector<Index> facet;  ///< per open pair: the chosen facet, -1 none
  double bound = 0;
  bool solved = false;  ///< its program was; else the bound is its parent's, or follows from its
                        ///< parent's multipliers
  Vector zeta = {};
  FacetDual::Parent multipliers = {};
  std::vector<Vector> touched = {};  ///< input sequences with tangents of a quadratic cost
  std::shared_ptr<const Children> siblings =
      {};  ///< if set: the node stands for itself, at `place`, and for all behind it
  std::size_t place = 0;
};

bool is_beyond(const SeparatingFacet& facet, const Vector& zeta, double tolerance) {
  return facet.a.dot(zeta) >= facet.out - tolerance;
}

class FacetSearch {
 public:
  FacetSearch(const SeparationProblem& problem, const FacetLimits& limits, const KnownAnswer& known,
              DesignControl& control)
      : problem_(problem),
        limits_(limits),
        watch_(control, problem.horizon, limits.time_limit),
        program_(problem),
        dual_(problem),
        known_(known) {}

  SearchResult run() {
    watch_.progress(best_cost(), known_.bound);
    if (find_facets()) branch_and_bound();
    result_.programs += program_.programs();
    return std::move(result_);
  }

 private:
  bool find_facets();
  bool keep_pair(const PairProgram& pair, ForbiddenSet set);
  void branch_and_bound();
  void visit(Node node);
  void branch(const Node& node, Children children);
  Node child(const Node& like, std::shared_ptr<const Children> children, std::size_t place) const;
  bool evaluate(Node& node);
  std::optional<Node> take();
  void keep(Node node) { open_.emplace(node.bound, std::move(node)); }
  void close(double bound) { closed_ = std::min(closed_, bound); }
  std::optional<Children> violated(const Node& node) const;
  double lower_bound() const;
  bool good_enough(double bound) const {
    const double best = best_cost();
    return best < infinity && std::max(bound, known_.bound) >= best - limits_.gap * best;
  }
  double best_cost() const;
  bool separates_left_out(const Vector& u) const;
  void conclude();
  void conclude_without_input();
  bool is_hopeless(const OpenPair& open);
  std::string with_margin() const;  ///< what every input is searched to reach

  const SeparationProblem& problem_;
  FacetLimits limits_;
  Watch watch_;
  NodeProgram program_;
  FacetDual dual_;
  KnownAnswer known_;
  SearchResult result_;
  std::vector<OpenPair> pairs_;
  std::vector<const PairProgram*> left_out_;  ///< pairs whose facets are not known
  std::string why_left_out_;                  ///< the first of them

  std::multimap<double, Node> open_;  ///< by their bounds
  std::optional<Node> next_;  ///< goes before those until an input is known: some input early
  double closed_ = infinity;  ///< least bound of what was put aside without being proven impossible
};

/// False if the answer is known without a search.
bool FacetSearch::find_facets() {
  for (const PairProgram& pair : problem_.pairs) {
    ForbiddenSet set =
        forbidden_set(pair, problem_.U, problem_.epsilon, limits_.max_facets, watch_);
    result_.programs += set.programs;
    result_.facets += static_cast<std::int64_t>(set.facets.size());
    if (set.kind == ForbiddenSet::Kind::unknown && watch_.ended()) {
      result_.stopped = true;
      close(known_.bound);
      conclude();
      return false;
    }
    if (!keep_pair(pair, std::move(set))) return false;
    watch_.progress(best_cost(), known_.bound);
  }
  return true;
}

bool FacetSearch::keep_pair(const PairProgram& pair, ForbiddenSet set) {
  std::erase_if(set.facets, [](const SeparatingFacet& facet) {
    return facet.a.lpNorm<1>() < facet.in - 1e-9 * std::abs(facet.in);
  });
  switch (set.kind) {
    case ForbiddenSet::Kind::never:
      result_.status = DesignStatus::infeasible;
      result_.reason = fmt::format("{}: {}", modes_of(problem_, pair), set.reason);
      result_.suggestion = "a longer horizon, more outputs, or inputs that may be chosen";
      return false;
    case ForbiddenSet::Kind::unknown:
      if (left_out_.empty())
        why_left_out_ = fmt::format("{}: {}", modes_of(problem_, pair), set.reason);
      left_out_.push_back(&pair);
      break;
    case ForbiddenSet::Kind::facets:
      if (set.facets.empty()) {
        result_.status = DesignStatus::infeasible;
        result_.reason =
            "no input of the input set separates " + modes_of(problem_, pair) + with_margin();
        result_.suggestion = more_room;
        return false;
      }
      pairs_.push_back({&pair, std::move(set)});
      break;
    case ForbiddenSet::Kind::separated:
      break;
  }
  return true;
}

double FacetSearch::best_cost() const {
  return std::min(known_.cost, result_.u ? result_.cost : infinity);
}

bool FacetSearch::separates_left_out(const Vector& u) const {
  return std::all_of(left_out_.begin(), left_out_.end(), [&](const PairProgram* pair) {
    const PairSeparation apart = separation(*pair, u);
    return apart.disjoint == Answer::yes && apart.kappa_lower >= problem_.epsilon;
  });
}

void FacetSearch::branch_and_bound() {
  Node root;
  root.facet.assign(pairs_.size(), -1);
  keep(std::move(root));
  while (std::optional<Node> node = take()) {
    if (node->bound >= closed_ &&
        !left_out_.empty()) {  // the least cost of what is known, which the rest cannot raise
      keep(std::move(*node));
      break;
    }
    if (watch_.over() || good_enough(node->bound)) {
      result_.stopped = !good_enough(node->bound);
      keep(std::move(*node));
      break;
    }
    visit(std::move(*node));
    watch_.progress(best_cost(), std::min(lower_bound(), best_cost()));
  }
  conclude();
}

double FacetSearch::lower_bound() const {
  double bound = closed_;
  if (!open_.empty()) bound = std::min(bound, open_.begin()->first);
  if (next_) bound = std::min(bound, next_->bound);
  return bound;
}

std::optional<Node> FacetSearch::take() {
  if (next_ && (best_cost() < infinity || (!left_out_.empty() && closed_ < infinity)))
    keep(std::move(*std::exchange(next_, std::nullopt)));
  if (!next_ && open_.empty()) return std::nullopt;
  Node node = next_ ? std::move(*std::exchange(next_, std::nullopt))
                    : std::move(open_.extract(open_.begin()).mapped());
  if (const auto siblings = std::exchange(node.siblings, nullptr);
      siblings && node.place + 1 < siblings->bound_and_facet.size()) {
    keep(child(node, siblings, node.place + 1));
  }
  return node;
}

Node FacetSearch::child(const Node& like, std::shared_ptr<const Children> children,
                        std::size_t place) const {
  const auto& [bound, facet] = children->bound_and_facet[place];
  Node child{like.facet, bound};
  child.facet[children->pair] = facet;
  child.touched = like.touched;
  child.siblings = std::move(children);
  child.place = place;
  return child;
}

void FacetSearch::visit(Node node) {
  if (!node.solved) {
    if (!evaluate(node)) return;
    if (best_cost() < infinity && !open_.empty() && node.bound > open_.begin()->first)
      return keep(std::move(node));
  }
  ++result_.nodes;
  const Vector u = problem_.U.c + linalg::product(problem_.U.G, node.zeta);
  const double cost = problem_.cost.at(u);
  if (std::optional<Children> children = violated(node)) return branch(node, std::move(*children));
  if (!separates_left_out(u)) return close(node.bound);
  if (!result_.u || cost < result_.cost) {
    result_.u = u;
    result_.cost = cost;
  }
  const bool loose = cost - node.bound > limits_.gap * cost;
  if (loose && problem_.cost.kind == Cost::Kind::quadratic &&
      static_cast<int>(node.touched.size()) < most_refinements) {
    node.touched.push_back(u);
    node.solved = false;
    return keep(std::move(node));
  }
  close(node.bound);
}

/// Of the pairs that the input of the node does not separate, the one whose cheapest child costs
/// most by what the parent's multipliers say; of equal ones that with the fewest facets.
std::optional<Children> FacetSearch::violated(const Node& node) const {
  std::optional<Children> best;
  double most = 0;
  for (std::size_t q = 0; q < pairs_.size(); ++q) {
    const auto& facets = pairs_[q].set.facets;
    if (node.facet[q] >= 0) continue;
    if (std::any_of(facets.begin(), facets.end(),
                    [&](const auto& facet) { return is_beyond(facet, node.zeta, 0); }))
      continue;
    Children here{q, {}};
    double least = infinity;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const double bound = dual_.usable()
                               ? std::max(node.bound, dual_.bound(node.multipliers, facets[f]))
                               : node.bound;
      here.bound_and_facet.emplace_back(bound, static_cast<Index>(f));
      least = std::min(least, bound);
    }
    if (best && (least < most || (least == most && facets.size() >= best->bound_and_facet.size())))
      continue;
    best = std::move(here);
    most = least;
  }
  return best;
}

void FacetSearch::branch(const Node& node, Children children) {
  std::sort(children.bound_and_facet.begin(), children.bound_and_facet.end());
  next_ = child(node, std::make_shared<const Children>(std::move(children)), 0);
}

/// The bound and the input of a node; false: proven impossible, or put aside.
bool FacetSearch::evaluate(Node& node) {
  std::vector<const SeparatingFacet*> chosen;
  for (std::size_t q = 0; q < pairs_.size(); ++q) {
    if (node.facet[q] >= 0)
      chosen.push_back(&pairs_[q].set.facets[static_cast<std::size_t>(node.facet[q])]);
  }
  NodeProgram::Answer answer = program_.solve(chosen, node.touched);
  if (answer.impossible) return false;
  node.bound = std::max(node.bound, answer.bound);
  node.solved = true;
  const auto met = [&](const SeparatingFacet* facet) {
    return is_beyond(*facet, *answer.zeta, met_tolerance);
  };
  if (!answer.zeta || !std::all_of(chosen.begin(), chosen.end(), met)) {
    close(node.bound);
    return false;
  }
  node.zeta = std::move(*answer.zeta);
  if (dual_.usable()) node.multipliers = dual_.parent(chosen, answer.multipliers);
  return true;
}

void FacetSearch::conclude() {
  const bool complete = !result_.stopped && left_out_.empty() && (result_.u || closed_ == infinity);
  if (known_.u && (!result_.u || (!complete && known_.cost < result_.cost))) {
    result_.u = known_.u;
    result_.cost = known_.cost;
  }
  if (!result_.u) return conclude_without_input();
  result_.lower_bound = std::min(std::max(lower_bound(), known_.bound), result_.cost);
  if (good_enough(result_.lower_bound)) {
    result_.status = DesignStatus::optimal;
    result_.stopped = false;
    return;
  }
  result_.status = DesignStatus::feasible;
  const auto is_flat = [](const OpenPair& open) { return open.set.flat; };
  if (result_.stopped) {
    result_.reason = "the search was stopped before the cheapest input was proven";
    result_.suggestion = "a larger time_limit or gap";
  } else if (!left_out_.empty()) {
    result_.reason = why_left_out_;
    result_.suggestion = more_facets;
  } else if (std::any_of(pairs_.begin(), pairs_.end(), is_flat)) {
    result_.reason =
        "the inputs that do not separate a pair form a set without width, from which a small "
        "distance is kept: there is no cheapest input, but cheaper ones the nearer they come";
    result_.suggestion = "a larger gap";
  } else {
    result_.reason = "the facets are known up to rounding only, and so is the cheapest cost";
    result_.suggestion = "a larger gap";
  }
}

void FacetSearch::conclude_without_input() {
  if (result_.stopped) {
    result_.lower_bound = lower_bound();
    result_.reason = "no input was found before the search was stopped";
    result_.suggestion = "a larger time_limit, a shorter horizon, or the designer \"milp\"";
    return;
  }
  if (!left_out_.empty() && lower_bound() < infinity) {
    result_.lower_bound = lower_bound();
    result_.reason = why_left_out_;
    result_.suggestion = more_facets;
    return;
  }
  if (closed_ < infinity) {
    result_.lower_bound = closed_;
    result_.reason = "a linear program could not be decided";
    result_.suggestion = "numbers of similar size in the models, or a slightly larger input set";
    return;
  }
  result_.status = DesignStatus::infeasible;
  result_.suggestion = more_room;
  result_.reason =
      result_.nodes == 0  ? "every input of the input set leaves the output tube of a mode empty"
      : left_out_.empty() ? "every pair alone can be separated, but not all of them at once"
                          : "not all of the pairs can be separated at once";
  std::string hopeless;
  for (const OpenPair& open : pairs_) {
    if (result_.nodes > 0 && is_hopeless(open))
      hopeless += (hopeless.empty() ? "" : "; ") + modes_of(problem_, *open.pair);
  }
  if (!hopeless.empty())
    result_.reason = "no input of the input set separates " + hopeless + with_margin();
}

std::string FacetSearch::with_margin() const {
  return problem_.epsilon > 0 ? fmt::format(" with κ ≥ {:.6g}", problem_.epsilon) : "";
}

/// Is no input beyond any of the facets?
bool FacetSearch::is_hopeless(const OpenPair& open) {
  return std::all_of(
      open.set.facets.begin(), open.set.facets.end(),
      [&](const SeparatingFacet& facet) { return program_.solve({&facet}).impossible; });
}

}  // namespace

SearchResult search_facets(const SeparationProblem& problem, const FacetLimits& limits,
                           const KnownAnswer& known, DesignControl& control) {
  return FacetSearch(problem, limits, known, control).run();
}

}  // namespace cordon::designers
