// SPDX-License-Identifier: GPL-3.0-or-later
// Residual sets of all pairs of modes and observers, and what follows from them.
#include "diagnosers/observer_bank/fdi_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "cordon/core/linalg.hpp"
#include "cordon/invariant/rpi.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "diagnosers/observer_bank/error_set_check.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;
using sets::Zonotope;
using Invariant = OfflineOptions::Invariant;

constexpr Index separation_columns =
    200;  // generators of the sets that a linear program separates from 0
constexpr double separation_accuracy = 1e-6;
constexpr double inner_margin =
    1e-9;  // of generators, so that rounding of their numbers does not matter

/// The limit of the residual sets of a pair along the axes: `outer` contains it, and it reaches the
/// bounds of `inner`.
struct Limit {
  Box outer, inner;
};

/// A pair with its system and limit.
struct Pair {
  Index mode = 0, observer = 0;
  PairDynamics dynamics;
  Limit limit;
};

Answer zero_in_box(const Box& box) {
  return box.contains(Vector::Zero(box.dim())) ? Answer::unknown : Answer::no;
}

/// C h ⊕ direct, axis by axis, from supports along the rows of C.
Limit limit_from(const std::vector<invariant::SupportPair>& rows, const Zonotope& direct) {
  const auto q = static_cast<Index>(rows.size());
  Limit limit{{Vector(q), Vector(q)}, {Vector(q), Vector(q)}};
  for (Index a = 0; a < q; ++a) {
    const invariant::SupportPair& h = rows[static_cast<std::size_t>(a)];
    const Interval width = rounding::norm_1(direct.G.row(a).transpose()),
                   center{direct.c[a], direct.c[a]};
    const Interval plus = rounding::add(rounding::add(h.plus, width), center);
    const Interval minus = rounding::subtract(rounding::add(h.minus, width), center);
    limit.outer.upper[a] = plus.upper;
    limit.outer.lower[a] = -minus.upper;
    limit.inner.upper[a] = plus.lower;
    limit.inner.lower[a] = -minus.lower;
  }
  return limit;
}

/// 0 ∈ the limit? By symmetry, by axes, and in more than one dimension by a separating direction or
/// a point of a finite part.
Answer zero_in_limit(const Pair& pair, double accuracy) {
  const PairDynamics& p = pair.dynamics;
  if (p.drive.c.isZero(0) && p.direct.c.isZero(0)) return Answer::yes;
  const Index q = p.C.rows();
  if (zero_in_box(pair.limit.outer) == Answer::no) return Answer::no;
  if (q == 1) return pair.limit.inner.contains(Vector::Zero(1)) ? Answer::yes : Answer::unknown;
  const invariant::Decay decay(p.A, drive_size({p.drive}, p.A.rows()));
  invariant::PartialSum sum = invariant::partial_sum(
      decay, p.drive, p.C, std::max(accuracy, separation_accuracy), separation_columns);
  const Zonotope part = sets::minkowski_sum(sum.part, p.direct);
  const Zonotope outer = sets::minkowski_sum(part, {Vector::Zero(q), sum.rest.asDiagonal()});
  const Vector zero = Vector::Zero(q);
  if (contains(make_zonotope(outer.c, outer.G), zero) == Answer::no) return Answer::no;
  // what the centre may be off is given back by the factors
  const double given = (linalg::pseudo_inverse(part.G).cwiseAbs() * sum.rest).size() == 0
                           ? 0.0
                           : (linalg::pseudo_inverse(part.G).cwiseAbs() * sum.rest).maxCoeff();
  const double left = 1 - inner_margin - given;
  const bool full = linalg::rank(part.G) == q || sum.rest.isZero(0);
  if (full && left > 0 && contains(make_zonotope(part.c, left * part.G), zero) == Answer::yes)
    return Answer::yes;
  return Answer::unknown;
}

/// Limits of all modes with one observer. Modes in which only the disturbance differs share all
/// powers of Ao.
std::vector<Pair> pairs_of(const std::vector<ModeDynamics>& modes, Index j,
                           const OfflineOptions& options) {
  const ModeDynamics& observer = modes[static_cast<std::size_t>(j)];
  const Index n = observer.A.rows(), q = observer.C.rows();
  std::vector<Pair> pairs;
  std::vector<Zonotope> drives;
  std::vector<std::size_t> uncoupled;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    pairs.push_back({static_cast<Index>(i), j, steady_pair(modes[i], observer, options), {}});
    const PairDynamics& p = pairs.back().dynamics;
    if (!is_coupled(modes[i], observer)) {
      uncoupled.push_back(i);
      drives.push_back(p.drive);
      continue;
    }
    const invariant::Decay decay(p.A, drive_size({p.drive}, 2 * n),
                                 "the plant of mode \"" + modes[i].name +
                                     "\" with the observer of mode \"" + observer.name + "\"");
    std::vector<invariant::SupportPair> rows;
    for (Index a = 0; a < q; ++a) {
      rows.push_back(invariant::minimal_supports(decay, {p.drive}, p.C.row(a).transpose(),
                                                 options.accuracy)[0]);
    }
    pairs.back().limit = limit_from(rows, p.direct);
  }
  const invariant::Decay decay(observer.Ao, drive_size(drives, n),
                               "A - L C of mode \"" + observer.name + "\"");
  std::vector<std::vector<invariant::SupportPair>> rows(uncoupled.size());
  for (Index a = 0; a < q; ++a) {
    const auto supports =
        invariant::minimal_supports(decay, drives, observer.C.row(a).transpose(), options.accuracy);
    for (std::size_t k = 0; k < uncoupled.size(); ++k) rows[k].push_back(supports[k]);
  }
  for (std::size_t k = 0; k < uncoupled.size(); ++k) {
    Pair& pair = pairs[uncoupled[k]];
    pair.limit = limit_from(rows[k], pair.dynamics.direct);
  }
  return pairs;
}

Index iterations_of(const OfflineOptions& options, Index j) {
  if (options.iterations.empty()) return 0;
  return options.iterations.size() == 1 ? options.iterations[0]
                                        : options.iterations[static_cast<std::size_t>(j)];
}

/// Where iterations of (x, e) begin: bounds of x in the steady state, and the given set of e.
Zonotope iteration_start(const PairDynamics& pair, const OfflineOptions& options, Index n) {
  const Zonotope error = options.start_set
                             ? invariant::enclosing_zonotope(*options.start_set, "the start set")
                             : Zonotope{Vector::Zero(n), Matrix(n, 0)};
  if (pair.A.rows() == n) return error;
  const Matrix plant = pair.A.topLeftCorner(n, n);
  const Zonotope drive{pair.drive.c.head(n), pair.drive.G.topRows(n)};
  const invariant::Decay decay(plant, drive_size({drive}, n), "A");
  Vector center(n), radius(n);
  for (Index k = 0; k < n; ++k) {
    const auto h =
        invariant::minimal_supports(decay, {drive}, Vector::Unit(n, k), options.accuracy)[0];
    center[k] = 0.5 * (h.plus.upper - h.minus.upper);
    radius[k] = std::max(h.plus.upper - center[k], h.minus.upper + center[k]);
  }
  return sets::cartesian_product({center, radius.asDiagonal()}, error);
}

/// R̊_ij by iterations; nothing if the closed form of a joint system does not exist.
std::optional<Zonotope> iterated_residual(const PairDynamics& pair, const OfflineOptions& options,
                                          Index j, Index n) {
  Zonotope start;
  if (options.invariant == Invariant::iterate) {
    start = iteration_start(pair, options, n);
  } else {
    try {
      start = invariant::rpi_set(pair.A, pair.drive);
    } catch (const Error& error) {
      if (pair.A.rows() == n || error.code() != Errc::invalid) throw;
      return std::nullopt;
    }
  }
  const Zonotope X =
      invariant::iterate(pair.A, pair.drive, start, iterations_of(options, j), options.max_columns);
  return sets::minkowski_sum(sets::affine_map(X, pair.C, Vector::Zero(pair.C.rows())), pair.direct);
}

/// What iterations promise. From a closed form they contain the limit; from another start the limit
/// has to agree.
PairGuarantee judge(const Pair& pair, const Zonotope& residual, const OfflineOptions& options) {
  const Box iterated = sets::interval_hull(residual);
  PairGuarantee result{pair.mode, pair.observer, iterated};
  if (options.invariant ==
      Invariant::iterate) {  // an iteration may not have come near its limit yet
    result.iterated = iterated;
    result.residual = {iterated.lower.cwiseMin(pair.limit.outer.lower),
                       iterated.upper.cwiseMax(pair.limit.outer.upper)};
  }
  const Vector zero = Vector::Zero(residual.dim());
  const Answer zero_inside = zero_in_box(iterated) == Answer::no
                                 ? Answer::no
                                 : contains(make_zonotope(residual.c, residual.G), zero);
  if (pair.mode == pair.observer) {
    result.holds = zero_in_limit(pair, options.accuracy);
    return result;
  }
  const bool contains_limit = options.invariant == Invariant::rpi;
  const Answer limit = zero_inside == Answer::no && contains_limit
                           ? Answer::no
                           : zero_in_limit(pair, options.accuracy);
  if (limit == Answer::yes) {
    result.holds = Answer::no;
  } else if (zero_inside == Answer::no && limit == Answer::no) {
    result.holds = Answer::yes;
  }
  return result;
}

PairGuarantee judge(const Pair& pair, const OfflineOptions& options) {
  const Answer inside = zero_in_limit(pair, options.accuracy);
  return {pair.mode, pair.observer, pair.limit.outer,
          pair.mode == pair.observer ? inside : negate(inside)};
}

std::string describe(const OfflineOptions& options, Index fallbacks) {
  if (options.invariant == Invariant::mrpi) {
    return "minimal invariant sets by their support functions, relative accuracy " +
           four_digits(options.accuracy);
  }
  std::string steps;
  for (const Index count : options.iterations)
    steps += (steps.empty() ? "" : ", ") + std::to_string(count);
  if (options.iterations.empty()) steps = "0";
  if (options.iterations.size() > 1) steps.append(" (by observer)");
  std::string text =
      options.invariant == Invariant::rpi
          ? "closed-form invariant sets and " + steps + " iterations"
          : steps + " iterations from " + (options.start_set ? "the start set" : "0");
  if (options.max_columns > 0)
    text += ", reduced to " + std::to_string(options.max_columns) + " columns";
  if (options.separate_inputs) text += ", inputs of plant and observer taken as independent";
  if (fallbacks > 0) {
    text += "; for " + std::to_string(fallbacks) +
            " pairs, whose joint matrix has no closed form, minimal invariant sets";
  }
  return text;
}

ErrorSetCheck check_error_set(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
                              const OfflineOptions& options) {
  const ErrorBounds bounds(bank, modes, options);
  return options.error_set ? compare_error_set(bounds, *options.error_set)
                           : compute_error_set(bounds, modes.front().A.rows());
}

/// Problems of the options alone.
std::vector<Diagnostic> check_options(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
                                      const OfflineOptions& options) {
  std::vector<Diagnostic> problems;
  const Index n = modes.front().A.rows();
  const auto count = static_cast<Index>(options.iterations.size());
  const bool iterates = options.invariant != Invariant::mrpi;
  if (iterates && (count > 1 || options.invariant == Invariant::iterate) && count != 1 &&
      count != bank.size()) {
    problems.push_back({"/iterations",
                        "has " + std::to_string(count) + " entries for " +
                            std::to_string(bank.size()) + " observers",
                        "give one number for all observers, or one each"});
  }
  if (std::any_of(options.iterations.begin(), options.iterations.end(),
                  [](Index k) { return k < 0; })) {
    problems.push_back({"/iterations", "must not be negative", ""});
  }
  bool coupled = false;
  for (const ModeDynamics& mode : modes) coupled = coupled || is_coupled(mode, modes.front());
  const Index least = coupled ? 2 * n : n;
  if (options.max_columns < 0 || (options.max_columns > 0 && options.max_columns < least)) {
    problems.push_back(
        {"/max_columns",
         "must be 0 (no reduction) or at least " + std::to_string(least) + ", one per dimension",
         ""});
  }
  if (!(options.accuracy > 0 && options.accuracy < 1))
    problems.push_back({"/accuracy", "must lie between 0 and 1", ""});
  const auto check_dim = [&](const std::optional<LineForm>& set, const char* pointer) {
    if (set && set->dim() != n) {
      problems.push_back({pointer,
                          "has " + std::to_string(set->dim()) + " dimensions, the models have " +
                              std::to_string(n) + " states",
                          ""});
    }
  };
  check_dim(options.start_set, "/start_set");
  check_dim(options.error_set, "/error_set");
  check_dim(options.state_set, "/state_set");
  check_dim(options.initial_set, "/initial_set");
  return problems;
}

}  // namespace

Box input_bounds(const ModeBank& bank) {
  Box bounds;
  for (Index j = 0; j < bank.size(); ++j) {
    const Model& model = bank[j].model;
    const Index inputs = model.linear.inputs();
    const Box own = model.U.dim() == inputs ? interval_hull(model.U) : Box::space(inputs);
    if (j == 0) {
      bounds = own;
    } else if (own.dim() != bounds.dim()) {
      throw Error(Errc::dimension, "the modes have different numbers of inputs");
    } else {
      bounds.lower = bounds.lower.cwiseMax(own.lower);
      bounds.upper = bounds.upper.cwiseMin(own.upper);
    }
  }
  return bounds;
}

Guarantees fdi_guarantees(const ModeBank& bank, const std::vector<Matrix>& gains,
                          const OfflineOptions& options) {
  const std::vector<ModeDynamics> modes = dynamics_of(bank, gains);
  const Index n = modes.front().A.rows();
  Guarantees result;
  Index fallbacks = 0;
  for (Index j = 0; j < bank.size(); ++j) {
    for (const Pair& pair : pairs_of(modes, j, options)) {
      std::optional<Zonotope> residual;
      if (options.invariant != Invariant::mrpi) {
        residual = iterated_residual(pair.dynamics, options, j, n);
        if (!residual) ++fallbacks;
      }
      result.pairs.push_back(residual ? judge(pair, *residual, options) : judge(pair, options));
    }
  }
  const auto any = [&](Answer answer) {
    return std::any_of(result.pairs.begin(), result.pairs.end(),
                       [&](const PairGuarantee& pair) { return pair.holds == answer; });
  };
  result.all = any(Answer::no) ? Answer::no : any(Answer::unknown) ? Answer::unknown : Answer::yes;
  result.method = describe(options, fallbacks);
  result.error_set = check_error_set(bank, modes, options);
  return result;
}

ErrorSetCheck check_error_set(const ModeBank& bank, const std::vector<Matrix>& gains,
                              const OfflineOptions& options) {
  return check_error_set(bank, dynamics_of(bank, gains), options);
}

std::vector<Box> residual_bounds(const ModeBank& bank, const std::vector<Matrix>& gains,
                                 const OfflineOptions& options) {
  const std::vector<ModeDynamics> modes = dynamics_of(bank, gains);
  const ErrorBounds bounds(bank, modes, options);
  std::vector<Box> all;
  for (Index j = 0; j < bank.size(); ++j) all.push_back(bounds.residuals(j));
  return all;
}

std::vector<Diagnostic> check_offline(const ModeBank& bank, const std::vector<Matrix>& gains,
                                      const OfflineOptions& options) {
  for (const Mode& mode : bank.modes) {
    const Model& model = mode.model;
    if (model.U.dim() == model.linear.inputs() && interval_hull(model.U).is_bounded()) continue;
    return {{"", "what the bank promises in advance rests on bounded inputs, and nothing bounds u",
             "give the set of the inputs in /system/U"}};
  }
  std::vector<Diagnostic> problems;
  try {
    const std::vector<ModeDynamics> modes = dynamics_of(bank, gains);
    problems = check_options(bank, modes, options);
    if (!problems.empty()) return problems;
    check_given_error_set(bank, modes, options, problems);
    if (problems.empty() && options.invariant == Invariant::rpi) {
      for (const ModeDynamics& mode : modes)
        invariant::rpi_set(mode.Ao, error_drive(mode, mode, options.separate_inputs, {}));
    }
    for (Index j = 0; problems.empty() && j < bank.size(); ++j) {
      for (const ModeDynamics& mode : modes)
        steady_pair(mode, modes[static_cast<std::size_t>(j)], options);
    }
  } catch (const Error& error) {
    if (error.code() == Errc::internal || error.code() == Errc::solver) throw;
    const std::string text = error.what();
    const bool about_state = text.find("\"state_set\"") != std::string::npos;
    problems.push_back({about_state ? "/state_set" : "", text,
                        about_state ? "a set that contains the plant's state at all times" : ""});
  }
  return problems;
}

}  // namespace cordon::estimators
