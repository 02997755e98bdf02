// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/identification/fewest_left_out.hpp"

#include <algorithm>

namespace cordon::identification {

namespace {

class HittingSets {
 public:
  HittingSets(const std::function<BoundFactors(const std::set<Index>&)>& factors, double wanted,
              Index most_programs, const std::function<bool()>& stop)
      : factors_(factors), wanted_(wanted), left_(most_programs), stop_(stop) {}

  enum class Answer { found, none, open };
  /// Do so many samples beside those chosen suffice, without the ones that are kept? `none` is
  /// proven.
  Answer search(std::set<Index>& chosen, std::set<Index>& kept, Index more) {
    const std::vector<Index>* conflict = missed(chosen);
    if (!conflict) {
      if (left_-- <= 0 || (stop_ && stop_())) return Answer::open;
      const BoundFactors factors = factors_(chosen);
      if (factors.status != BoundFactors::Status::found) return Answer::open;
      if (factors.cost <= wanted_) return Answer::found;
      if (!(factors.proven > wanted_)) return Answer::open;
      conflicts_.push_back(factors.required_by);
      conflict = &conflicts_.back();
    }
    if (more == 0) return Answer::none;
    Answer answer = Answer::none;
    std::vector<Index> tried;
    for (const Index k : std::vector<Index>(*conflict)) {
      if (kept.contains(k)) continue;
      chosen.insert(k);
      const Answer here = search(chosen, kept, more - 1);
      if (here == Answer::found) return here;
      if (here == Answer::open) answer = here;
      chosen.erase(k);
      kept.insert(k);
      tried.push_back(k);
    }
    for (const Index k : tried) kept.erase(k);
    return answer;
  }

 private:
  /// A known set that none of the chosen samples belongs to.
  const std::vector<Index>* missed(const std::set<Index>& chosen) const {
    const auto is_missed = [&](const std::vector<Index>& conflict) {
      return std::ranges::none_of(conflict, [&](Index k) { return chosen.contains(k); });
    };
    const std::vector<Index>* shortest = nullptr;
    for (const auto& conflict : conflicts_) {
      if (is_missed(conflict) && (!shortest || conflict.size() < shortest->size()))
        shortest = &conflict;
    }
    return shortest;
  }

  const std::function<BoundFactors(const std::set<Index>&)>& factors_;
  double wanted_;
  Index left_;
  const std::function<bool()>& stop_;
  std::vector<std::vector<Index>> conflicts_;
};

}  // namespace

FewestLeftOut fewest_left_out(const std::function<BoundFactors(const std::set<Index>&)>& factors,
                              double wanted, Index known, Index at_least, Index most_programs,
                              const std::function<bool()>& stop) {
  HittingSets sets(factors, wanted, most_programs, stop);
  FewestLeftOut fewest{std::nullopt, at_least};
  for (Index count = at_least; count < known; ++count) {
    std::set<Index> chosen, kept;
    const auto answer = sets.search(chosen, kept, count);
    if (answer == HittingSets::Answer::found) fewest.samples = chosen;
    if (answer != HittingSets::Answer::none) break;
    fewest.at_least = count + 1;
  }
  return fewest;
}

}  // namespace cordon::identification
