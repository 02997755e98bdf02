// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/error_set_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;
using sets::Zonotope;

constexpr double box_margin = 1e-9;
constexpr double facet_margin = 1e-12;  // of factors: normals of facets are rounded

bool has_ranges(const ModeDynamics& mode) { return !mode.g_rad.isZero(0); }

/// max |T x| over the minimal set under one disturbance.
Vector largest(const invariant::Decay& decay, const Zonotope& drive, const Matrix& T,
               double accuracy) {
  Vector size(T.rows());
  for (Index a = 0; a < T.rows(); ++a) {
    const auto h = invariant::minimal_supports(decay, {drive}, T.row(a).transpose(), accuracy)[0];
    size[a] = std::max(h.plus.upper, h.minus.upper);
  }
  return size;
}

Matrix on_error(const Matrix& T, Index states) {
  Matrix all = Matrix::Zero(T.rows(), states);
  all.rightCols(T.cols()) = T;
  return all;
}

Zonotope sum(const Zonotope& X, const Zonotope& Y) {
  return sets::drop_zero_generators(sets::minkowski_sum(X, Y));
}

/// n columns of G that span a large parallelotope, by Gram-Schmidt; fewer if G has a smaller rank.
Matrix largest_columns(Matrix G) {
  const Index n = G.rows();
  const Matrix original = G;
  Matrix chosen(n, 0);
  const double scale = G.cols() ? G.colwise().norm().maxCoeff() : 0.0;
  while (chosen.cols() < n && G.cols() > 0) {
    Index best = 0;
    const double length = G.colwise().norm().maxCoeff(&best);
    if (!(length > 1e-12 * scale)) break;
    chosen.conservativeResize(Eigen::NoChange, chosen.cols() + 1);
    chosen.rightCols(1) = original.col(best);
    const Vector axis = G.col(best) / length;
    G -= axis * (axis.transpose() * G).eval();
    G.col(best).setZero();
  }
  return chosen;
}

/// Normals of the facets of {Gξ}, one of each pair; none if the set is flat. `shape` becomes the
/// parallelotope that replaces it.
Matrix facet_normals(Matrix& shape) {
  const Index n = shape.rows();
  if (n == 0) return Matrix(0, 0);
  const Matrix basis = largest_columns(shape);
  if (basis.cols() < n) return Matrix(0, n);
  const auto parallelotope = [&]() -> Matrix {
    const std::optional<Matrix> inverse = linalg::solve(basis, Matrix::Identity(n, n));
    return inverse ? *inverse : Matrix(0, n);
  };
  if (shape.cols() == n) return parallelotope();
  try {
    const Polytope::Inequalities facets =
        Polytope::from(make_zonotope(Vector::Zero(n), shape)).inequalities();
    if (facets.Q.rows() > 0) return Matrix(0, n);
    std::vector<Index> rows;
    for (Index k = 0; k < facets.H.rows(); ++k) {
      const bool opposite = std::any_of(
          rows.begin(), rows.end(), [&](Index r) { return facets.H.row(r) == -facets.H.row(k); });
      if (!opposite) rows.push_back(k);
    }
    return facets.H(rows, Eigen::all);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    shape = basis;
    return parallelotope();
  }
}

}  // namespace

std::string four_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

Vector drive_size(const std::vector<Zonotope>& drives, Index n) {
  Vector size = Vector::Zero(n);
  for (const Zonotope& D : drives)
    size = size.cwiseMax(D.c.cwiseAbs() + D.G.cwiseAbs().rowwise().sum());
  return size;
}

SensorSlack steady_slack(const ModeDynamics& plant, const ModeDynamics& observer,
                         const OfflineOptions& options) {
  SensorSlack slack;
  if (!has_ranges(plant) && !has_ranges(observer)) return slack;
  const Zonotope drive = plant_drive(plant);
  const invariant::Decay decay(
      plant.A, drive_size({drive}, drive.dim()),
      "A of mode \"" + plant.name + "\" (ranges of sensors need a stable plant)");
  const auto state = [&](const ModeDynamics& of) {
    return largest(decay, drive, of.C_raw, options.accuracy);
  };
  if (has_ranges(plant))
    slack.plant = plant.g_rad.cwiseProduct(plant.feedthrough + state(plant)) * (1 + facet_margin);
  if (has_ranges(observer)) {
    const PairDynamics pair = pair_dynamics(plant, observer, options.separate_inputs, slack);
    const invariant::Decay errors(pair.A, drive_size({pair.drive}, pair.drive.dim()),
                                  "the joint system");
    const Vector error =
        largest(errors, pair.drive, on_error(observer.C_raw, pair.A.rows()), options.accuracy);
    const invariant::Decay own(observer.Ao, observer.L.cwiseAbs().rowwise().sum(),
                               "A - L C of mode \"" + observer.name + "\"");
    slack.observer = observer_slack(observer, own, state(observer), error, options.accuracy);
  }
  return slack;
}

PairDynamics steady_pair(const ModeDynamics& plant, const ModeDynamics& observer,
                         const OfflineOptions& options) {
  if (is_coupled(plant, observer)) {
    invariant::require_schur(plant.A,
                             "A of mode \"" + plant.name +
                                 "\", whose state acts on the error of the observer of mode \"" +
                                 observer.name + "\",");
  }
  return pair_dynamics(plant, observer, options.separate_inputs,
                       steady_slack(plant, observer, options));
}

ErrorBounds::ErrorBounds(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
                         const OfflineOptions& options)
    : modes_(modes), options_(options) {
  const Index n = modes.front().A.rows();
  bool needs_state = false;
  for (const ModeDynamics& mode : modes)
    needs_state = needs_state || has_ranges(mode) || is_coupled(mode, modes.front());
  std::optional<StateBounds> state;
  if (needs_state) state.emplace(bank, modes, options);
  const std::vector<Zonotope> plant = plant_starts(bank, options);
  for (const ModeDynamics& observer : modes) {
    std::vector<Zonotope> drives, starts, direct;
    for (const ModeDynamics& mode : modes) {
      SensorSlack slack;
      if (has_ranges(mode))
        slack.plant = mode.g_rad.cwiseProduct(mode.feedthrough + state->magnitude(mode.C_raw)) *
                      (1 + facet_margin);
      Zonotope drive = error_drive(mode, observer, options.separate_inputs, slack);
      direct.push_back(direct_part(mode, observer, options.separate_inputs, slack));
      if (is_coupled(mode, observer)) {
        const Zonotope outputs = state->image(mode.C - observer.C);
        direct.back() = sum(direct.back(), outputs);
        if (mode.A == observer.A) {
          drive = sum(drive, sets::affine_map(outputs, -observer.L, Vector::Zero(n)));
        } else {
          drive = sum(drive, state->image(state_to_error(mode, observer)));
        }
      }
      drives.push_back(std::move(drive));
    }
    const auto own = static_cast<std::size_t>(&observer - modes.data());
    const Vector center =
        options.initial_set ? plant[0].c
                            : invariant::enclosing_zonotope(bank.modes[own].model.X0,
                                                            "X0 of mode \"" + observer.name + "\"")
                                  .c;
    for (const Zonotope& start : plant) starts.push_back({start.c - center, start.G});
    decays_.emplace_back(observer.Ao, drive_size(drives, n),
                         "A - L C of mode \"" + observer.name + "\"");
    if (has_ranges(observer)) {
      Vector error(observer.C.rows());
      for (Index a = 0; a < error.size(); ++a) {
        const Vector d = observer.C_raw.row(a).transpose();
        const auto h =
            invariant::switched_supports(decays_.back(), drives, starts, d, options.accuracy);
        error[a] = std::max(h.plus, h.minus);
      }
      const Vector slack = observer_slack(
          observer, decays_.back(), state->magnitude(observer.C_raw), error, options.accuracy);
      const Zonotope open{Vector::Zero(n), observer.L * slack.asDiagonal()};
      for (Zonotope& drive : drives) drive = sum(drive, open);
      const Zonotope shown{Vector::Zero(slack.size()), slack.asDiagonal().toDenseMatrix()};
      for (Zonotope& part : direct) part = sum(part, shown);
    }
    direct_.push_back(std::move(direct));
    drives_.push_back(std::move(drives));
    starts_.push_back(std::move(starts));
  }
}

ErrorBounds::Supports ErrorBounds::along(const Matrix& directions) const {
  const Index modes = static_cast<Index>(modes_.size()), m = directions.rows(),
              n = directions.cols();
  const auto all = static_cast<std::size_t>(m);
  Supports result{Vector::Constant(m, -infinity),
                  Vector::Constant(m, -infinity),
                  {all, Matrix(modes, modes)},
                  {all, Matrix(modes, modes)}};
  for (Index j = 0; j < modes; ++j) {
    const auto o = static_cast<std::size_t>(j);
    for (Index k = 0; k < m; ++k) {
      const auto h = invariant::switched_supports(decays_[o], drives_[o], starts_[o],
                                                  directions.row(k).transpose(), options_.accuracy);
      result.plus[k] = std::max(result.plus[k], h.plus);
      result.minus[k] = std::max(result.minus[k], h.minus);
      for (Index i = 0; i < modes; ++i) {
        result.steady_plus[static_cast<std::size_t>(k)](i, j) =
            h.minimal[static_cast<std::size_t>(i)].plus.upper;
        result.steady_minus[static_cast<std::size_t>(k)](i, j) =
            h.minimal[static_cast<std::size_t>(i)].minus.upper;
      }
    }
    for (Index i = 0; i < modes;
         ++i) {  // the invariant set of (x, e) is smaller than one with a bound of x
      const ModeDynamics &mode = modes_[static_cast<std::size_t>(i)], &observer = modes_[o];
      if (!is_coupled(mode, observer) && !has_ranges(mode) && !has_ranges(observer)) continue;
      const PairDynamics pair = steady_pair(mode, observer, options_);
      const invariant::Decay decay(pair.A, drive_size({pair.drive}, pair.drive.dim()),
                                   "the plant of mode \"" + mode.name +
                                       "\" with the observer of mode \"" + observer.name + "\"");
      for (Index k = 0; k < m; ++k) {
        Vector d = Vector::Zero(pair.A.rows());
        d.tail(n) = directions.row(k).transpose();
        const auto h = invariant::minimal_supports(decay, {pair.drive}, d, options_.accuracy)[0];
        result.steady_plus[static_cast<std::size_t>(k)](i, j) = h.plus.upper;
        result.steady_minus[static_cast<std::size_t>(k)](i, j) = h.minus.upper;
      }
    }
  }
  return result;
}

Box ErrorBounds::residuals(Index j) const {
  const auto o = static_cast<std::size_t>(j);
  const Matrix& C = modes_[o].C;
  Vector plus(C.rows()), minus(C.rows());
  for (Index a = 0; a < C.rows(); ++a) {
    const auto h = invariant::switched_supports(decays_[o], drives_[o], starts_[o],
                                                C.row(a).transpose(), options_.accuracy);
    double upper = -infinity, lower = infinity;
    for (const Zonotope& part : direct_[o]) {
      const double radius = part.G.row(a).cwiseAbs().sum() * (1 + box_margin);
      upper = std::max(upper, part.c[a] + radius);
      lower = std::min(lower, part.c[a] - radius);
    }
    plus[a] = h.plus + upper;
    minus[a] = h.minus - lower;
  }
  const Vector center = 0.5 * (plus - minus),
               radius = (plus - center).cwiseMax(minus + center) * (1 + box_margin) +
                        box_margin * center.cwiseAbs();
  return {center - radius, center + radius};
}

namespace {

/// Factors from supports along normals, for a set with this centre and these half widths along
/// them.
void compare(const ErrorBounds::Supports& h, const Vector& centers, const Vector& widths,
             ErrorSetCheck& check) {
  check.factor = check.steady_factor = 0;
  for (Index k = 0; k < widths.size(); ++k) {
    const auto factor = [&](double plus, double minus) {
      const double reach = std::max(plus - centers[k], minus + centers[k]);
      return reach <= 0 ? 0.0 : reach / widths[k];
    };
    check.factor = std::max(check.factor, factor(h.plus[k], h.minus[k]));
    const Matrix &plus = h.steady_plus[static_cast<std::size_t>(k)],
                 &minus = h.steady_minus[static_cast<std::size_t>(k)];
    for (Index j = 0; j < plus.cols(); ++j) {
      for (Index i = 0; i < plus.rows(); ++i) {
        const double steady = factor(plus(i, j), minus(i, j));
        if (steady <= check.steady_factor && check.mode >= 0) continue;
        check.steady_factor = steady;
        check.mode = i;
        check.observer = j;
      }
    }
  }
}

std::string box_text(const LineForm& box) {
  std::string lower, upper;
  for (Index k = 0; k < box.dim(); ++k) {
    const double radius = box.G.row(k).cwiseAbs().sum();
    const std::string separator = k > 0 ? ", " : "";
    // three digits, rounded outward
    const double unit = radius > 0 ? std::pow(10.0, std::floor(std::log10(radius)) - 2) : 1.0;
    lower += separator + four_digits(std::floor((box.c[k] - radius) / unit) * unit);
    upper += separator + four_digits(std::ceil((box.c[k] + radius) / unit) * unit);
  }
  return R"({"type": "box", "lower": [)" + lower + R"(], "upper": [)" + upper + "]}";
}

}  // namespace

ErrorSetCheck compare_error_set(const ErrorBounds& bounds, const LineForm& set) {
  if (set.lines() > 0 || set.constraints() > 0)
    throw Error(Errc::invalid, "the error set must be a zonotope: bounded, without constraints");
  ErrorSetCheck check;
  check.set = set;
  Matrix shape = sets::drop_zero_generators({set.c, set.G}).G;
  const Matrix normals = facet_normals(shape);
  if (normals.rows() == 0) {
    check.factor = check.steady_factor = set.dim() == 0 ? 0.0 : infinity;
    return check;
  }
  const Vector widths = product(normals, shape).cwiseAbs().rowwise().sum() / (1 + facet_margin);
  compare(bounds.along(normals), product(normals, set.c), widths, check);
  return check;
}

ErrorSetCheck compute_error_set(const ErrorBounds& bounds, Index n) {
  const ErrorBounds::Supports h = bounds.along(Matrix::Identity(n, n));
  const Vector center = 0.5 * (h.plus - h.minus);
  const Vector radius = (h.plus - center).cwiseMax(h.minus + center) * (1 + box_margin);
  ErrorSetCheck check;
  check.set = make_zonotope(center, radius.asDiagonal().toDenseMatrix());
  check.computed = true;
  compare(h, center, radius, check);
  return check;
}

void check_given_error_set(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
                           const OfflineOptions& options, std::vector<Diagnostic>& problems) {
  if (options.error_set &&
      (options.error_set->lines() > 0 || options.error_set->constraints() > 0)) {
    problems.push_back({"/error_set", "must be a zonotope or a box: bounded, without constraints",
                        "leave it out to have one computed"});
    return;
  }
  const ErrorBounds bounds(bank, modes, options);
  if (!options.error_set) return;
  const ErrorSetCheck check = compare_error_set(bounds, *options.error_set);
  if (check.factor <= 1) return;
  std::string text =
      "does not contain x - x̂ for every point x̂ of the sets of all observers, whose disturbances "
      "count beside those of the plant: ";
  if (std::isinf(check.factor)) {
    text += "it is flat";
  } else {
    text += "it would have to be larger by the factor " + four_digits(check.factor);
    if (check.steady_factor > 1) {
      text += ", by " + four_digits(check.steady_factor) +
              " already for the invariant set of mode \"" + bank[check.mode].name +
              "\" with the observer of mode \"" + bank[check.observer].name + "\"";
    } else {
      text += " (" + four_digits(check.steady_factor) +
              " for the invariant sets alone): initial errors and switching modes go beyond it";
    }
  }
  problems.push_back({"/error_set", text,
                      "use " + box_text(compute_error_set(bounds, modes.front().A.rows()).set) +
                          ", or leave it out to have a box computed"});
}

}  // namespace cordon::estimators
