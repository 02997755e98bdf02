// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/invariant/minimal.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"

namespace cordon::invariant {

namespace {

using linalg::product;
using sets::Zonotope;

constexpr Index block_terms = 16;  // powers that are multiplied at once
constexpr Index most_terms = 1'000'000;

void check_arguments(const Decay& decay, const std::vector<Zonotope>& D, const char* what,
                     double accuracy) {
  if (!(accuracy > 0 && accuracy < 1))
    throw Error(Errc::invalid, "the accuracy of a support must lie between 0 and 1");
  for (const Zonotope& Z : D) {
    sets::check(Z, what);
    if (Z.dim() != decay.dim())
      throw Error(Errc::dimension, std::string(what) + " has another dimension than the matrix");
  }
}

void check_direction(const Decay& decay, VectorIn d) {
  if (d.size() != decay.dim())
    throw Error(Errc::dimension, "the direction has another dimension than the matrix");
  if (!d.allFinite())
    throw Error(Errc::not_finite, "the direction has entries that are not finite");
}

/// Several zonotopes side by side, so that one product serves all.
struct Stack {
  Stack(const Decay& decay, const std::vector<Zonotope>& D)
      : centers(decay.dim(), size(D)), sizes(decay.dim(), size(D)) {
    Index columns = 0;
    for (const Zonotope& Z : D) columns += Z.G.cols();
    generators.resize(decay.dim(), columns);
    columns = 0;
    for (std::size_t i = 0; i < D.size(); ++i) {
      const Zonotope& Z = D[i];
      const Index k = static_cast<Index>(i);
      first.push_back(columns);
      generators.middleCols(columns, Z.G.cols()) = Z.G;
      columns += Z.G.cols();
      centers.col(k) = Z.c;
      sizes.col(k) = Z.c.cwiseAbs() + Z.G.cwiseAbs().rowwise().sum();
      largest = std::max(largest, Z.G.cols());
      shares.push_back(decay.share(Z));
    }
    first.push_back(columns);
  }
  static Index size(const std::vector<Zonotope>& D) { return static_cast<Index>(D.size()); }
  Index size() const { return centers.cols(); }
  double share() const {
    return shares.empty() ? 0.0 : *std::max_element(shares.begin(), shares.end());
  }

  Matrix centers, sizes, generators;
  std::vector<Index> first;
  std::vector<double> shares;
  Index largest = 0;  // number of generators
};

/// rᵀc, ‖rᵀG‖₁ and |r|ᵀ(|c| + |G| 1) of the rows r of R, a column per set.
struct Terms {
  Terms(const Matrix& R, const Stack& stack)
      : centers(product(R, stack.centers)),
        radii(R.rows(), stack.size()),
        magnitudes(product(R.cwiseAbs(), stack.sizes)) {
    const Matrix all = product(R, stack.generators).cwiseAbs();
    for (Index i = 0; i < stack.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Index columns = stack.first[k + 1] - stack.first[k];
      if (columns == 0) {
        radii.col(i).setZero();
      } else {
        radii.col(i) = all.middleCols(stack.first[k], columns).rowwise().sum();
      }
    }
  }
  Matrix centers, radii, magnitudes;
};

/// Sums over the powers in one direction.
class Series {
 public:
  Series(const Decay& decay, const Stack& D, const Stack& starts, VectorIn d, double accuracy)
      : decay_(decay),
        D_(D),
        starts_(starts),
        accuracy_(accuracy),
        row_(d.transpose()),
        first_norm_(decay.norm(d)) {
    center_ = radius_ = magnitude_ = Vector::Zero(D.size());
  }

  void run() {
    norm_ = first_norm_;
    for (terms_ = 0; !is_finished(); terms_ += block_terms) {
      if (terms_ >= most_terms) {
        throw Error(
            Errc::unsupported,
            "a support needs more than " + std::to_string(most_terms) +
                " powers of the matrix: its largest eigenvalue is too near to the unit circle");
      }
      add_block();
    }
  }

  SupportPair pair(Index i) const {
    const auto k = static_cast<std::size_t>(i);
    const double slack =
        raised(rounding_of(magnitude_[i]) + D_.shares[k] * (decay_.sum() * (errors_ + norm_)));
    const double up = center_[i] + radius_[i], down = radius_[i] - center_[i];
    return {{rounding::down(up - slack), rounding::up(up + slack)},
            {rounding::down(down - slack), rounding::up(down + slack)}};
  }

  double reachable(bool positive) const {
    const double rest = decay_.sum() * (errors_ + norm_);
    const double slack = raised(rounding_of(switched_magnitude_ + start_magnitude_) +
                                (D_.share() + starts_.share()) * rest);
    const double limit = positive ? plus_ : minus_;
    return rounding::up(std::max(limit, positive ? largest_plus_ : largest_minus_) + slack);
  }

 private:
  /// A few more operations on nonnegative numbers cannot bring the value below the exact one.
  static double raised(double value) { return value * (1 + 16 * rounding::unit); }

  double rounding_of(double magnitude) const {
    const Index operations = block_terms * (std::max(D_.largest, starts_.largest) + 2) +
                             terms_ / block_terms + 2 * decay_.dim();
    return 2 * rounding::gamma(2 * operations + 16) * magnitude +
           rounding::tiny * static_cast<double>(terms_ * operations + 1);
  }

  bool is_finished() const {
    const double left = decay_.sum() * norm_;
    const auto small = [&](double share, double sum) {
      return share * left <= accuracy_ * std::max(sum, accuracy_ * share * first_norm_);
    };
    for (Index i = 0; i < D_.size(); ++i) {
      if (!small(D_.shares[static_cast<std::size_t>(i)], radius_[i] + std::abs(center_[i])))
        return false;
    }
    return small(starts_.share(),
                 terms_ == 0 ? 0.0 : std::max(std::abs(largest_plus_), std::abs(largest_minus_)));
  }

  void add_block() {
    Matrix R(block_terms, decay_.dim());
    for (Index k = 0; k < block_terms; ++k) {
      R.row(k) = row_;
      errors_ = raised(errors_ + decay_.product_error(row_.transpose()));
      row_ = product(row_, decay_.matrix());
    }
    norm_ = decay_.norm(row_.transpose());
    if (!std::isfinite(norm_))
      throw Error(Errc::not_finite, "the powers of the matrix overflow; scale the problem");
    const Terms terms(R, D_), starts(R, starts_);
    center_ += terms.centers.colwise().sum().transpose();
    radius_ += terms.radii.colwise().sum().transpose();
    magnitude_ += terms.magnitudes.colwise().sum().transpose();
    double plus = 0, minus = 0, magnitude = 0;
    for (Index k = 0; k < block_terms; ++k) {
      double start_plus = 0, start_minus = 0;
      if (starts_.size() > 0) {
        start_plus = (starts.radii.row(k) + starts.centers.row(k)).maxCoeff();
        start_minus = (starts.radii.row(k) - starts.centers.row(k)).maxCoeff();
        start_magnitude_ = std::max(start_magnitude_, starts.magnitudes.row(k).maxCoeff());
      }
      largest_plus_ = std::max(largest_plus_, start_plus + (plus_ + plus));
      largest_minus_ = std::max(largest_minus_, start_minus + (minus_ + minus));
      if (D_.size() == 0) continue;
      plus += (terms.radii.row(k) + terms.centers.row(k)).maxCoeff();
      minus += (terms.radii.row(k) - terms.centers.row(k)).maxCoeff();
      magnitude += terms.magnitudes.row(k).maxCoeff();
    }
    plus_ += plus;
    minus_ += minus;
    switched_magnitude_ += magnitude;
  }

  const Decay& decay_;
  const Stack& D_;
  const Stack& starts_;
  double accuracy_;
  Matrix row_;  // dᵀ Aᵏ of the next term, computed
  double first_norm_, norm_ = 0;
  Index terms_ = 0;
  double errors_ = 0;  // Σ ‖r̃_k A - r̃_{k+1}‖
  Vector center_, radius_, magnitude_;
  double plus_ = 0, minus_ = 0, switched_magnitude_ = 0,
         start_magnitude_ = 0;  // Σ max_i; at most one start counts
  double largest_plus_ = -infinity, largest_minus_ = -infinity;
};

}  // namespace

SwitchedSupports switched_supports(const Decay& decay, const std::vector<Zonotope>& D,
                                   const std::vector<Zonotope>& starts, VectorIn d,
                                   double accuracy) {
  check_arguments(decay, D, "the disturbance", accuracy);
  check_arguments(decay, starts, "the start", accuracy);
  check_direction(decay, d);
  const Stack disturbances(decay, D), initial(decay, starts);
  Series series(decay, disturbances, initial, d, accuracy);
  series.run();
  SwitchedSupports result;
  for (Index i = 0; i < disturbances.size(); ++i) result.minimal.push_back(series.pair(i));
  result.plus = series.reachable(true);
  result.minus = series.reachable(false);
  return result;
}

std::vector<SupportPair> minimal_supports(const Decay& decay, const std::vector<Zonotope>& D,
                                          VectorIn d, double accuracy) {
  return switched_supports(decay, D, {}, d, accuracy).minimal;
}

SupportPair minimal_support(MatrixIn A, const Zonotope& D, VectorIn d, double accuracy) {
  sets::check(D, "the disturbance");
  if (D.dim() != A.rows())
    throw Error(Errc::dimension, "the disturbance has another dimension than the matrix");
  const Decay decay(A, D.c.cwiseAbs() + D.G.cwiseAbs().rowwise().sum());
  return minimal_supports(decay, {D}, d, accuracy)[0];
}

PartialSum partial_sum(const Decay& decay, const Zonotope& D, MatrixIn T_out, double accuracy,
                       Index max_columns) {
  check_arguments(decay, {D}, "the disturbance", accuracy);
  const Index q = T_out.rows(), n = decay.dim(), g = D.G.cols();
  if (T_out.cols() != n)
    throw Error(Errc::dimension, "the map has another dimension than the matrix");
  const double share = decay.share(D);
  Vector center = Vector::Zero(q), widths = Vector::Zero(q), rest(q), first(q),
         errors = Vector::Zero(q);
  std::vector<Matrix> parts;
  Matrix rows = T_out;
  for (Index i = 0; i < q; ++i) first[i] = decay.norm(rows.row(i).transpose());
  for (Index k = 0;; ++k) {
    bool finished = true;
    for (Index i = 0; i < q; ++i) {
      rest[i] = share * decay.sum() * (errors[i] + decay.norm(rows.row(i).transpose()));
      finished = finished && rest[i] <= accuracy * std::max(widths[i] + std::abs(center[i]),
                                                            accuracy * share * first[i]);
    }
    if (finished) break;
    if (k * std::max<Index>(g, 1) > most_terms)
      throw Error(Errc::unsupported,
                  "the errors decay so slowly that a sum of them has too many generators: a larger "
                  "\"accuracy\" takes fewer");
    parts.push_back(product(rows, D.G));
    widths += parts.back().cwiseAbs().rowwise().sum();
    center += product(rows, D.c);
    for (Index i = 0; i < q; ++i) errors[i] += decay.product_error(rows.row(i).transpose());
    rows = product(rows, decay.matrix());
  }
  Matrix G(q, static_cast<Index>(parts.size()) * g);
  for (std::size_t k = 0; k < parts.size(); ++k)
    G.middleCols(static_cast<Index>(k) * g, g) = parts[k];
  // sizes relative to the set's own, largest first
  const Vector unit = widths.unaryExpr([](double w) { return w > 0 ? 1 / w : 0.0; });
  const Vector size = (unit.asDiagonal() * G).colwise().norm().transpose();
  std::vector<Index> order(static_cast<std::size_t>(G.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size[a] > size[b]; });
  const Index kept = std::min(max_columns, G.cols());
  PartialSum result{{center, Matrix(q, kept)}, rest};
  for (Index k = 0; k < G.cols(); ++k) {
    const auto column = G.col(order[static_cast<std::size_t>(k)]);
    if (k < kept) {
      result.part.G.col(k) = column;
    } else {
      result.rest += column.cwiseAbs();
    }
  }
  const double operations =
      static_cast<double>(parts.size() + static_cast<std::size_t>(2 * n + g + 16));
  result.rest += 4 * rounding::unit * operations * (widths + center.cwiseAbs());
  result.part = sets::drop_zero_generators(result.part);
  return result;
}

}  // namespace cordon::invariant
