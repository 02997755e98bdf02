// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_frame.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "cordon/formulas/affine_deviation.hpp"

namespace cordon {

namespace {

constexpr double worth_it = 0.5;  ///< of the volume

double width(const Eigen::RowVectorXd& values) { return values.maxCoeff() - values.minCoeff(); }

/// A column for each point at which all rows are defined.
Matrix errors_at_points(formulas::Evaluator& evaluator, MatrixIn slopes,
                        std::span<const Interval> box, Index points) {
  std::mt19937_64 random(1);
  Matrix errors(slopes.rows(), points);
  Index count = 0;
  std::vector<Interval> point(box.begin(), box.end());
  for (Index p = 0; p < points; ++p) {
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double share = static_cast<double>(random() >> 11) * 0x1p-53;
      const double z = box[i].lower + share * (box[i].upper - box[i].lower);
      point[i] = {z, z};
    }
    for (Index row = 0; row < slopes.rows(); ++row)
      errors(row, count) = deviation_at(evaluator, Vector::Unit(slopes.rows(), row), slopes, point);
    if (errors.col(count).allFinite()) ++count;
  }
  return errors.leftCols(count);
}

/// Least squares.
double factor_of(const Eigen::RowVectorXd& errors, const Eigen::RowVectorXd& main) {
  const Eigen::RowVectorXd from_mean = main.array() - main.mean();
  const double square = from_mean.squaredNorm();
  return square > 0 ? errors.dot(from_mean) / square : 0;
}

}  // namespace

Vector ErrorFrame::weights(Index i) const {
  Vector weights = Vector::Unit(factors.size(), i);
  if (main >= 0 && i != main) weights[main] = -factors[i];
  return weights;
}

Vector ErrorFrame::column(Index i) const {
  return i == main ? Vector(factors + Vector::Unit(factors.size(), i))
                   : Vector(Vector::Unit(factors.size(), i));
}

ErrorFrame choose_error_frame(formulas::Evaluator& evaluator, MatrixIn slopes,
                              std::span<const Interval> box, Index points) {
  const Index rows = slopes.rows();
  ErrorFrame best{-1, Vector::Zero(rows)};
  const Matrix errors = errors_at_points(evaluator, slopes, box, points);
  if (errors.cols() < 2) return best;
  double least = worth_it;
  for (Index main = 0; main < rows; ++main) {
    ErrorFrame frame{main, Vector::Zero(rows)};
    double volume = 1;
    for (Index i = 0; i < rows; ++i) {
      const double alone = width(errors.row(i));
      if (i == main || !(alone > 0)) continue;
      const double factor = factor_of(errors.row(i), errors.row(main));
      const double share = width(errors.row(i) - factor * errors.row(main)) / alone;
      if (!(share < 1)) continue;
      frame.factors[i] = factor;
      volume *= share;
    }
    if (volume < least) {
      least = volume;
      best = std::move(frame);
    }
  }
  return best;
}

}  // namespace cordon
