// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear_rows.hpp"

#include <algorithm>
#include <optional>

#include "cordon/core/error.hpp"
#include "cordon/formulas/affine_deviation.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "error_frame.hpp"

namespace cordon {

namespace {

using formulas::BoxEnclosure;
using formulas::Deviation;
using formulas::Function;

/// The row's derivatives at a point, nearest doubles of their bounds; nothing where they have none.
std::optional<Eigen::RowVectorXd> derivative_at(formulas::Evaluator& evaluator, Index row,
                                                const Vector& center, const Variables& box) {
  Variables point = box;
  for (Index i = 0; i < center.size(); ++i) point[as_size(i)] = {center[i], center[i]};
  evaluator.evaluate(point);
  evaluator.differentiate();
  Eigen::RowVectorXd slope = Eigen::RowVectorXd::Zero(center.size());
  for (std::size_t e = 0; e < evaluator.partials(row); ++e) {
    const auto [variable, value] = evaluator.partial(row, e);
    if (!value.is_finite()) return std::nullopt;
    slope[variable] = 0.5 * value.lower + 0.5 * value.upper;
  }
  return slope;
}

Matrix slopes_at_center(BoxEnclosure& enclosure, const Variables& box) {
  const Function& function = enclosure.function();
  enclosure.set_box(box);
  Matrix slopes(function.rows(), function.differentiated());
  Eigen::RowVectorXd slope(function.differentiated());
  for (Index row = 0; row < function.rows(); ++row) {
    enclosure.affine(row, slope);
    slopes.row(row) = slope;
  }
  for (Index row = 0; row < function.rows(); ++row) {
    if (const auto derivative = derivative_at(enclosure.evaluator(), row, enclosure.center(), box))
      slopes.row(row) = *derivative;
  }
  return slopes;
}

Deviation bounded(BoxEnclosure& enclosure, const Vector& weights, const Matrix& slopes,
                  const Variables& box, const char* name, const LinearisationEffort& effort) {
  const std::size_t parts = std::clamp(effort.most_steps / enclosure.function().tape().size(),
                                       effort.fewest_parts, effort.most_parts);
  Deviation found = bound_deviation(enclosure, weights, slopes, box, parts);
  if (found.bounds.is_finite()) return found;
  enclosure.set_box(box);
  const std::string without_bounds = std::string(name) + " has no bounds " + effort.where;
  for (Index row = 0; row < weights.size(); ++row) {
    const std::string why = weights[row] != 0 ? enclosure.why_not_enclosed(row) : "";
    if (why.empty()) continue;
    throw Error(Errc::not_enclosed,
                without_bounds + ", row " + std::to_string(row + 1) + ": " + why);
  }
  throw Error(Errc::not_enclosed, without_bounds);
}

}  // namespace

void add_bounds(Variables& variables, const Box& box) {
  for (Index i = 0; i < box.dim(); ++i) variables.push_back({box.lower[i], box.upper[i]});
}

std::shared_ptr<const Function> by_inputs(const Function& function, Index rows, Index inputs) {
  std::vector<int> nodes;
  for (Index row = 0; row < rows; ++row) {
    nodes.push_back(function.node(row));
  }
  return std::make_shared<const Function>(function.shared_graph(), nodes,
                                          function.differentiated() + inputs, 2);
}

Box bounded_hull(const LineForm& set, const char* name) {
  Box hull = interval_hull(set);
  if (!hull.is_bounded())
    throw Error(Errc::unsupported, std::string(name) + " is unbounded, and formulas over it are");
  return hull;
}

LinearRows linear_rows(const std::shared_ptr<const Function>& function, Index states,
                       const Variables& box, const char* name, const GivenSlopes& given,
                       const LinearisationEffort& effort) {
  BoxEnclosure enclosure(function, states, effort.form, Rounding::outward);
  LinearRows made;
  const Index count = function->rows();
  made.slopes = slopes_at_center(enclosure, box);
  if (given.by_states) made.slopes.leftCols(states) = *given.by_states;
  if (given.by_inputs) made.slopes.rightCols(given.by_inputs->cols()) = *given.by_inputs;
  for (Index row = 0; row < count; ++row) {
    const Deviation found =
        bounded(enclosure, Vector::Unit(count, row), made.slopes, box, name, effort);
    made.rows.push_back({found.bounds, found.attained});
    made.is_linear = made.is_linear && function->is_affine(row) && found.bounds.is_point();
  }
  const ErrorFrame frame =
      choose_error_frame(enclosure.evaluator(), made.slopes, box, effort.points);
  std::vector<Interval> errors;
  for (Index row = 0; row < count; ++row) {
    const Interval error =
        frame.factors[row] == 0
            ? made.rows[as_size(row)].remainder
            : bounded(enclosure, frame.weights(row), made.slopes, box, name, effort).bounds;
    if (error == Interval{0, 0}) continue;
    made.kept.push_back(row);
    errors.push_back(error);
  }
  const auto kept = std::ssize(errors);
  made.columns = Matrix(count, kept);
  made.errors = {Vector(kept), Vector(kept)};
  for (Index i = 0; i < kept; ++i) {
    made.columns.col(i) = frame.column(made.kept[as_size(i)]);
    made.errors.lower[i] = errors[as_size(i)].lower;
    made.errors.upper[i] = errors[as_size(i)].upper;
  }
  return made;
}

LineForm with_errors(const LineForm& set, const LinearRows& rows) {
  return rows.kept.empty() ? set : cartesian_product(set, make_box(rows.errors));
}

Matrix beside(const Matrix& slopes, const Matrix& columns) {
  Matrix all(slopes.rows(), slopes.cols() + columns.cols());
  all << slopes, columns;
  return all;
}

}  // namespace cordon
