// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/successive_linearisation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::designers {

namespace {

constexpr double smallest_region = 1e-3;  ///< of the input set
constexpr double worth_it = 1e-2;         ///< of the cost
constexpr int most_rounds = 60;
constexpr int most_without_answer = 12;  ///< proposals in a row, none of which separates
constexpr double least_margin = 1e-3;    ///< of κ, asked for beyond ε where a proposal was none
/// Other points where modes are linearised at first, by shares of the half widths from the middle
/// of the input set: at one where derivatives vanish no linear model tells modes apart.
constexpr double begin_at[] = {0.5, -0.5, 1, -1};
constexpr double enough_left = 0.75;   ///< of the time, for another descent where an input is known
constexpr double seconds_each = 0.05;  ///< of what is left, for one linear problem

class Successive {
 public:
  Successive(const FormulaProblem& problem, const LinearSearch& search, const Watch& watch)
      : problem_(problem),
        search_(search),
        watch_(watch),
        epsilon_(problem.params.real("epsilon")),
        seconds_(watch.left()),
        half_width_(problem.U.G.cwiseAbs().rowwise().sum()) {}

  FormulaDesign run() {
    for (const Vector& start : problem_.starts) descend_from(start);
    for (const double share : begin_at) {
      if (problem_.U.b.size() > 0) break;  // no box, where such points may not be allowed
      if (found_.best && watch_.left() < enough_left * seconds_) break;
      descend_from(problem_.U.c + share * half_width_);
    }
    return conclude();
  }

 private:
  /// Keeps what it finds if that is cheaper than what is known.
  void descend_from(const Vector& start) {
    if (watch_.over() || found_.is_optimal) return;
    best_.reset();
    about_ = start;
    radius_ = 2;
    margin_ = 0;
    without_answer_ = 0;
    descend();
    if (best_ && (!found_.best || best_->cost < found_.best->cost)) found_.best = std::move(best_);
    found_.is_optimal = found_.best && !(found_.best->cost > 0);
    found_.stopped = watch_.over();
  }

  void descend() {
    std::optional<SeparationProblem> about = linear_problem(about_);
    if (!about) return;
    if (auto first = judged(about_); first && is_answer(*first)) accept(std::move(*first), about_);
    for (int round = 0; round < most_rounds && about && goes_on(); ++round) {
      const std::optional<Vector> proposal = propose(*about);
      if (proposal) take(*proposal);
      if (!proposal && !shrink()) break;
      if (linear_about_ != about_) about = linear_problem(about_);
    }
  }

  bool goes_on() {
    return !watch_.over() && radius_ >= smallest_region && !(best_ && !(best_->cost > 0)) &&
           without_answer_ < most_without_answer;
  }

  /// The modes about an input; nothing, with the reason, where they are not enclosed.
  std::optional<SeparationProblem> linear_problem(const Vector& u) {
    linear_about_ = u;
    try {
      const LinearBank bank(problem_.bank, by_time(u, problem_.bank[0].model.inputs()));
      return problem_at(bank, problem_.backend, problem_.params, problem_.horizon,
                        [&] { return watch_.over(); });
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      found_.reason = error.what();
      return std::nullopt;
    }
  }

  std::optional<Vector> propose(SeparationProblem problem) {
    problem.U = within(problem_.U, about_, radius_ * half_width_);
    problem.epsilon = epsilon_ + margin_;
    problem.start = about_;
    const double seconds = std::max(seconds_each * watch_.left(), 0.01);
    SearchResult result = search_(problem, seconds);
    found_.nodes += result.nodes;
    found_.programs += result.programs;
    found_.facets += result.facets;
    if (!result.u && !best_) found_.reason = result.reason;
    return std::move(result.u);
  }

  /// What the input does to the formulas; nothing where they are not enclosed under it.
  std::optional<InputDesign> judged(const Vector& u) {
    try {
      const LinearBank bank(problem_.bank, by_time(u, problem_.bank[0].model.inputs()));
      const auto never = [] { return false; };
      const auto linear =
          problem_at(bank, problem_.backend, problem_.params, problem_.horizon, never);
      return judge(bank, problem_.backend, problem_.params, *linear, u, never);
    } catch (const Error& error) {
      if (error.code() != Errc::not_enclosed) throw;
      return std::nullopt;
    }
  }

  bool is_answer(const InputDesign& design) const {
    return design.separates() == Answer::yes &&
           std::ranges::all_of(design.pairs, [&](const PairSeparation& pair) {
             return pair.kappa >= epsilon_ - 1e-9 * (1 + epsilon_);
           });
  }

  void accept(InputDesign design, const Vector& u) {
    best_ = std::move(design);
    about_ = u;
    margin_ /= 2;
    without_answer_ = 0;
  }

  void take(const Vector& u) {
    std::optional<InputDesign> design = judged(u);
    const bool answers = design && is_answer(*design);
    if (answers && (!best_ || design->cost < best_->cost)) {
      const bool much = !best_ || design->cost < best_->cost * (1 - worth_it);
      accept(std::move(*design), u);
      if (!much) radius_ /= 4;
    } else if (answers) {
      radius_ /= 4;
    } else {
      margin_ = std::max(2 * margin_, least_margin);
      ++without_answer_;
      if (best_ || !design) {
        radius_ /= 2;
      } else {
        about_ = u;
      }
    }
  }

  /// Where the linear problem has no answer: less margin, then a smaller region. False: no use.
  bool shrink() {
    if (margin_ > 0) {
      margin_ = 0;
      return ++without_answer_ < most_without_answer;
    }
    radius_ /= 2;
    return best_.has_value();
  }

  FormulaDesign conclude() {
    if (found_.is_optimal) return std::move(found_);
    if (found_.best) {
      found_.reason =
          "the modes are formulas: the search looked about inputs that it had found, "
          "and elsewhere one may cost less";
      found_.suggestion = "";
    } else {
      const std::string why = std::exchange(found_.reason, {});
      found_.reason = "no input was found that separates the formulas" +
                      (why.empty() ? std::string() : ": " + why);
      found_.suggestion =
          "a longer horizon, smaller W and V, or another \"reference\", about "
          "which the search begins";
    }
    return std::move(found_);
  }

  const FormulaProblem& problem_;
  const LinearSearch& search_;
  const Watch& watch_;
  double epsilon_, margin_ = 0, radius_ = 2;  ///< of the half widths: all of the input set
  double seconds_;                            ///< at the beginning
  Vector half_width_, about_, linear_about_;
  int without_answer_ = 0;
  std::optional<InputDesign> best_;  ///< of this descent
  FormulaDesign found_;              ///< of all
};

}  // namespace

InputSequences within(const InputSequences& U, VectorIn center, VectorIn radius) {
  const Index size = U.c.size(), g = U.G.cols(), m = U.b.size();
  const bool box = m == 0 && (U.G.array() != 0).rowwise().count().maxCoeff() <= 1;
  if (box) {
    const Vector reach = U.G.cwiseAbs().rowwise().sum();
    const Vector lower = (U.c - reach).cwiseMax(center - radius).cwiseMin(U.c + reach),
                 upper = (U.c + reach).cwiseMin(center + radius).cwiseMax(lower);
    InputSequences cut{0.5 * lower + 0.5 * upper, Matrix(size, 0), Matrix(0, 0), Vector(0)};
    const Vector half = 0.5 * (upper - lower);
    std::vector<Index> varying;
    for (Index i = 0; i < size; ++i) {
      if (half[i] > 0) varying.push_back(i);
    }
    cut.G = Matrix(half.asDiagonal())(Eigen::all, varying);
    cut.A = Matrix(0, cut.G.cols());
    return cut;
  }
  InputSequences cut{U.c, Matrix::Zero(size, g + size), Matrix::Zero(m + size, g + size),
                     Vector(m + size)};
  cut.G.leftCols(g) = U.G;
  cut.A.topLeftCorner(m, g) = U.A;
  cut.A.bottomLeftCorner(size, g) = U.G;
  cut.A.bottomRightCorner(size, size).diagonal() = -radius;
  cut.b << U.b, center - U.c;
  return cut;
}

FormulaDesign linearise_successively(const FormulaProblem& problem, const LinearSearch& search,
                                     const Watch& watch) {
  return Successive(problem, search, watch).run();
}

}  // namespace cordon::designers
