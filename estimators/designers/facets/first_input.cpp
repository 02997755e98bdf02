// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/first_input.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

namespace {

constexpr int chances = 8;           ///< directions by chance
constexpr int input_halvings = 6;    ///< of the way to an input that separates
constexpr Index most_singles = 200;  ///< inputs at one time that are tried

std::vector<Vector> directions(const SeparationProblem& problem) {
  const Index inputs = problem.inputs, times = problem.horizon + 1, n = problem.U.c.size();
  std::vector<Vector> all;
  const auto both = [&](const Vector& d) {
    all.push_back(d);
    all.push_back(-d);
  };
  const Vector alternating =
      Vector::NullaryExpr(times, [](Index k) { return k % 2 == 0 ? 1 : -1; });
  for (const Vector& in_time : {Vector(Vector::Ones(times)), alternating}) {
    both(linalg::product(Vector::Ones(inputs), in_time.transpose()).reshaped());
    for (Index i = 0; i < inputs && inputs > 1; ++i)
      both(linalg::product(Vector::Unit(inputs, i), in_time.transpose()).reshaped());
  }
  std::mt19937_64 engine(1);
  for (int k = 0; k < chances; ++k)
    all.push_back(Vector::NullaryExpr(n, [&] { return (engine() >> 32) % 2 == 0 ? -1 : 1; }));
  for (Index i = 0; i < std::min(n, most_singles); ++i) both(Vector::Unit(n, i));
  return all;
}

class Trial {
 public:
  Trial(const SeparationProblem& problem, const std::function<bool()>& over)
      : problem_(problem), over_(over) {
    for (const PairProgram& pair : problem.pairs) pairs_.push_back(&pair);
  }

  /// Takes the input if it is cheaper and separates.
  bool offer(const Vector& zeta) {
    return offer_input(problem_.U.c + linalg::product(problem_.U.G, zeta));
  }
  bool offer_input(const Vector& u) {
    const double cost = problem_.cost.at(u);
    if ((found_.u && cost >= found_.cost) || !separates(u)) return false;
    found_.offer(u, cost);
    return true;
  }

  bool is_cheaper(const Vector& zeta) const {
    return !found_.u ||
           problem_.cost.at(problem_.U.c + linalg::product(problem_.U.G, zeta)) < found_.cost;
  }

  KnownAnswer& found() { return found_; }

 private:
  /// The pair that fails is asked first the next time.
  bool separates(const Vector& u) {
    for (auto pair = pairs_.begin(); pair != pairs_.end(); ++pair) {
      if (over_()) return false;
      const PairSeparation apart = separation(**pair, u);
      if (apart.disjoint == Answer::yes && apart.kappa_lower >= problem_.epsilon) continue;
      std::rotate(pairs_.begin(), pair, pair + 1);
      return false;
    }
    return true;
  }

  const SeparationProblem& problem_;
  const std::function<bool()>& over_;
  std::vector<const PairProgram*> pairs_;
  KnownAnswer found_;
};

}  // namespace

KnownAnswer first_input(const SeparationProblem& problem, NodeProgram& program,
                        const std::function<bool()>& over) {
  Trial trial(problem, over);
  if (over()) return {};
  if (problem.start) trial.offer_input(*problem.start);
  const NodeProgram::Answer cheapest = program.solve({});
  trial.found().bound = cheapest.bound;
  if (cheapest.zeta && !trial.offer(*cheapest.zeta)) {
    for (const Vector& direction : directions(problem)) {
      if (over()) break;
      const std::optional<Vector> end = program.farthest(direction);
      if (!end) break;
      const auto along = [&](double share) {
        return Vector(*cheapest.zeta + share * (*end - *cheapest.zeta));
      };
      double near = 0, far = 1;
      for (int k = 0; k < input_halvings && !trial.is_cheaper(along(far)); ++k) far /= 2;
      if (!trial.offer(along(far))) continue;
      for (int k = 0; k < input_halvings; ++k) {
        const double middle = (near + far) / 2;
        (trial.offer(along(middle)) ? far : near) = middle;
      }
    }
  }
  return std::move(trial.found());
}

}  // namespace cordon::designers
