// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/design_check.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/tolerances.hpp"

namespace cordon::verification {

namespace {

constexpr double most_asked = 1e9;  ///< of κ: an infinite one shows as a very large bound
constexpr double touching = 1e-7;   ///< |κ| of tubes that touch up to rounding

class DesignCheck {
 public:
  void pair(std::size_t q, const PairSeparation& claim, const ExactPair& exact,
            const std::string& names) {
    if (claim.kappa < claim.kappa_lower - tolerances::reported * (1 + std::abs(claim.kappa_lower)))
      return refute(
          fmt::format("κ of {} is {}, below its bound {}", names, claim.kappa, claim.kappa_lower),
          "/design/pairs/", q);
    if (claim.disjoint == Answer::unknown) return;
    const std::string tubes = "the output tubes of " + names;
    if (exact.disjoint == Answer::unknown) return open(tubes + ": " + exact.reason);
    const bool apart = exact.disjoint == Answer::yes;
    if (claim.disjoint == Answer::yes) {
      const double asked = std::min(claim.kappa_lower, most_asked);
      if (!apart) return refute(tubes + " are called disjoint, and meet", "/design/pairs/", q);
      if (exact.kappa_lower >= asked - tolerances::reported * (1 + asked)) return holds();
      return open(fmt::format("{} are disjoint, and κ ≥ {} is proven in place of {}", tubes,
                              exact.kappa_lower, claim.kappa_lower));
    }
    if (apart && exact.kappa_lower > tolerances::reported)
      return refute(tubes + " are said to meet, and are disjoint", "/design/pairs/", q);
    if (claim.kappa_lower > tolerances::reported || exact.within == Answer::yes)
      return refute(fmt::format("κ ≥ {} is said of {}, which meet{}", claim.kappa_lower, tubes,
                                exact.within == Answer::yes ? " for a smaller κ" : ""),
                    "/design/pairs/", q);
    if (exact.within == Answer::unknown)
      return open(fmt::format("κ ≥ {} of {}, which meet", claim.kappa_lower, tubes));
    holds();
  }

  void tube(std::size_t i, Answer claim, Answer exact, const std::string& name) {
    if (claim == Answer::unknown) return;
    if (exact == Answer::unknown) return open("is the output tube of " + name + " empty?");
    if (claim == exact) return holds();
    refute(fmt::format("the output tube of {} is called {}empty, and is {}", name,
                       claim == Answer::yes ? "" : "not ", claim == Answer::yes ? "not" : "empty"),
           "/design/tubes/", i);
  }

  /// What the host once proved it proves again, to the last digit where modes are linear: formulas
  /// are enclosed in doubles, which another processor may add up in another order.
  void proven(const ModeBank& bank, const InputDesign& recorded, const ExactSeparation& exact) {
    for (std::size_t q = 0; q < exact.pairs.size(); ++q) {
      const PairSeparation& claim = recorded.pairs.at(q);
      const std::string what = fmt::format("what is called proven of pair {}", q + 1);
      if (!same(claim.disjoint, exact.pairs[q].disjoint, what, "/exact/pairs/", q)) continue;
      if (claim.disjoint == Answer::no && claim.kappa_lower > -1)
        refute(fmt::format("κ ≥ {} is called proven of a pair that meets", claim.kappa_lower),
               "/exact/pairs/", q);
      if (claim.disjoint != Answer::yes || claim.kappa_lower <= exact.pairs[q].kappa_lower)
        continue;
      std::string what_is = fmt::format("κ ≥ {} is called proven of pair {}, and κ ≥ {} is",
                                        claim.kappa_lower, q + 1, exact.pairs[q].kappa_lower);
      if (bank[exact.pairs[q].i].model.is_linear() && bank[exact.pairs[q].j].model.is_linear())
        refute(std::move(what_is), "/exact/pairs/", q);
      else if (claim.kappa_lower - exact.pairs[q].kappa_lower >
               tolerances::reported * (1 + std::min(claim.kappa_lower, most_asked)))
        open(std::move(what_is));
    }
    for (std::size_t i = 0; i < exact.empty.size(); ++i) {
      same(recorded.empty.at(i), exact.empty[i],
           fmt::format("what is called proven of tube {}", i + 1), "/exact/tubes/", i);
    }
  }
  /// A word about all pairs and tubes, beside what these say.
  void summary(Answer claim, Answer of_parts, const std::string& pointer) {
    if (claim == Answer::unknown || claim == of_parts) return;
    found.refuted.push_back({fmt::format("\"separates\" is \"{}\"; pairs and tubes make it \"{}\"",
                                         to_string(claim), to_string(of_parts)),
                             pointer});
  }

  /// An input that was found separates the modes, and costs no less than every one that does; that
  /// none is cheaper is not compared. With ε = 0 tubes may touch under it.
  void status(const DesignOutcome& claim, const ExactSeparation& proven) {
    const Answer exact = proven.separates();
    const bool found_one =
        claim.status == DesignStatus::optimal || claim.status == DesignStatus::feasible;
    if (!found_one && exact != Answer::yes) return;
    const double cost = claim.best->cost;
    if (exact == Answer::no && !(claim.epsilon <= 0 && touch(claim, proven)))
      found.refuted.push_back(
          {fmt::format("the input is called {}, and does not separate the modes",
                       to_string(claim.status)),
           "/design/status"});
    if (claim.lower_bound > cost + tolerances::reported * std::max(1.0, std::abs(cost)))
      found.refuted.push_back(
          {fmt::format("the input costs {}, less than the lower bound {}", cost, claim.lower_bound),
           "/design/lower_bound"});
  }

  DesignFindings found;

 private:
  /// Do pairs that meet do so by no more than rounding?
  static bool touch(const DesignOutcome& claim, const ExactSeparation& proven) {
    for (std::size_t q = 0; q < proven.pairs.size(); ++q) {
      const bool meets = proven.pairs[q].disjoint == Answer::no;
      if (meets && !(std::abs(claim.best->pairs.at(q).kappa) <= touching)) return false;
    }
    return true;
  }

  bool same(Answer claim, Answer exact, const std::string& what, const char* list,
            std::size_t index) {
    if (claim == Answer::unknown || claim == exact) return true;
    if (exact == Answer::unknown) return open(what + " is not proven again"), false;
    return refute(fmt::format("{} is false: \"{}\" is, not \"{}\"", what, to_string(exact),
                              to_string(claim)),
                  list, index),
           false;
  }

  void holds() { ++found.hold; }
  void open(std::string what) {
    if (++found.undecided == 1) found.first_undecided = std::move(what);
  }
  void refute(std::string what, const char* list, std::size_t index) {
    found.refuted.push_back({std::move(what), list + std::to_string(index)});
  }
};

void compare_claims(DesignCheck& check, const ModeBank& bank, const DesignOutcome& outcome,
                    const ExactSeparation& exact) {
  for (std::size_t q = 0; q < exact.pairs.size(); ++q) {
    const ExactPair& pair = exact.pairs[q];
    check.pair(q, outcome.best->pairs.at(q), pair, bank[pair.i].name + " and " + bank[pair.j].name);
  }
  for (std::size_t i = 0; i < exact.empty.size(); ++i) {
    check.tube(i, outcome.best->empty.at(i), exact.empty[i], bank.modes[i].name);
  }
}

}  // namespace

DesignFindings compare_design(const ModeBank& bank, const DesignOutcome& outcome,
                              const ExactSeparation& exact) {
  DesignCheck check;
  compare_claims(check, bank, outcome, exact);
  return std::move(check.found);
}

DesignFindings compare_recorded(const ModeBank& bank, const DesignOutcome& outcome,
                                const SeparationRecord& recorded, const ExactSeparation& exact) {
  DesignCheck check;
  compare_claims(check, bank, outcome, exact);
  check.summary(recorded.claimed, outcome.best->separates(), "/design/separates");
  check.status(outcome, exact);
  if (recorded.proven) {
    check.proven(bank, *recorded.proven, exact);
    check.summary(recorded.proven_separation, recorded.proven->separates(), "/exact/separates");
  }
  return std::move(check.found);
}

}  // namespace cordon::verification
