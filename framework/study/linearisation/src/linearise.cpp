// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/linearise.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/formulas/affine_deviation.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "error_frame.hpp"

namespace cordon {

namespace {

using formulas::BoxEnclosure;
using formulas::Deviation;
using formulas::Function;
using Variables = std::vector<Interval>;

constexpr std::size_t most_parts = 1000, fewest_parts = 50;
constexpr std::size_t most_steps = 3'000'000;  ///< of all parts together, where there are more

void append(Variables& variables, const Box& box) {
  for (Index i = 0; i < box.dim(); ++i) variables.push_back({box.lower[i], box.upper[i]});
}

void expect_bounded(const Box& box, Index size, const char* what) {
  if (box.dim() != size)
    throw Error(Errc::dimension, std::string("the ") + what + " of the region have another number");
  if (!box.is_bounded() || box.is_empty())
    throw Error(Errc::unsupported, std::string("the region needs bounds of all ") + what);
}

Box bounded_hull(const LineForm& set, const char* name) {
  Box hull = interval_hull(set);
  if (!hull.is_bounded())
    throw Error(Errc::unsupported, std::string(name) + " is unbounded, and formulas over it are");
  return hull;
}

/// F with derivatives by inputs, too, which stand behind x and the drawn variables.
std::shared_ptr<const Function> by_inputs(const Function& function, Index rows, Index inputs) {
  std::vector<int> nodes;
  for (Index row = 0; row < rows; ++row) {
    if (function.depends_on(row, function.variables() - 1)) {
      throw Error(Errc::unsupported,
                  "the formulas depend on the time k, and a linear model with constant matrices "
                  "does not");
    }
    nodes.push_back(function.node(row));
  }
  return std::make_shared<const Function>(function.shared_graph(), nodes,
                                          function.differentiated() + inputs, 2);
}

/// The rows of a function as slopes, and what these leave out.
struct LinearRows {
  Matrix slopes;
  std::vector<LinearisedRow> rows;
  Matrix columns;  ///< errors of the rows by those that are kept: coordinates that are not 0
  Box errors;      ///< of these
  std::vector<Index> kept;
  bool is_linear = true;  ///< what is left of all rows is a constant, and not in the box only
};

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
                  const Variables& box, const char* name) {
  const std::size_t parts =
      std::clamp(most_steps / enclosure.function().tape().size(), fewest_parts, most_parts);
  Deviation found = bound_deviation(enclosure, weights, slopes, box, parts);
  if (found.bounds.is_finite()) return found;
  enclosure.set_box(box);
  for (Index row = 0; row < weights.size(); ++row) {
    const std::string why = weights[row] != 0 ? enclosure.why_not_enclosed(row) : "";
    if (why.empty()) continue;
    throw Error(Errc::not_enclosed, std::string(name) + " has no bounds on the region, row " +
                                        std::to_string(row + 1) + ": " + why);
  }
  throw Error(Errc::not_enclosed, std::string(name) + " has no bounds on the region");
}

/// Slopes that are given by states and inputs.
struct GivenSlopes {
  const Matrix *by_states = nullptr, *by_inputs = nullptr;
};

LinearRows linear_rows(const std::shared_ptr<const Function>& function, Index states,
                       const Variables& box, const char* name, const GivenSlopes& given) {
  BoxEnclosure enclosure(function, states, formulas::AffineForm::convex_differences,
                         Rounding::outward);
  LinearRows made;
  const Index count = function->rows();
  made.slopes = slopes_at_center(enclosure, box);
  if (given.by_states) made.slopes.leftCols(states) = *given.by_states;
  if (given.by_inputs) made.slopes.rightCols(given.by_inputs->cols()) = *given.by_inputs;
  for (Index row = 0; row < count; ++row) {
    const Deviation found = bounded(enclosure, Vector::Unit(count, row), made.slopes, box, name);
    made.rows.push_back({found.bounds, found.attained});
    made.is_linear = made.is_linear && function->is_affine(row) && found.bounds.is_point();
  }
  const ErrorFrame frame = choose_error_frame(enclosure.evaluator(), made.slopes, box);
  std::vector<Interval> errors;
  for (Index row = 0; row < count; ++row) {
    const Interval error =
        frame.factors[row] == 0
            ? made.rows[as_size(row)].remainder
            : bounded(enclosure, frame.weights(row), made.slopes, box, name).bounds;
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

/// The set of the formulas, and a coordinate for each error that is kept.
LineForm with_errors(const LineForm& set, const LinearRows& rows) {
  return rows.kept.empty() ? set : cartesian_product(set, make_box(rows.errors));
}

Matrix beside(const Matrix& slopes, const Matrix& columns) {
  Matrix all(slopes.rows(), slopes.cols() + columns.cols());
  all << slopes, columns;
  return all;
}

}  // namespace

Linearised linearise(const Model& model, const Box& states, const Box& inputs,
                     const LinearModel* given) {
  if (!model.nonlinear) throw Error(Errc::unsupported, "the system is linear already");
  const NonlinearModel& formulas = *model.nonlinear;
  const Index n = formulas.states(), m = formulas.inputs, q = formulas.disturbances(),
              r = formulas.noises();
  expect_bounded(states, n, "states");
  expect_bounded(inputs, m, "inputs");
  const auto box_with = [&](const LineForm& set, const char* name) {
    Variables box;
    append(box, states);
    append(box, bounded_hull(set, name));
    append(box, inputs);
    box.push_back({0, 0});  // the time, of which nothing depends
    return box;
  };
  if (given && (given->states() != n || given->inputs() != m ||
                given->outputs() != formulas.outputs() || given->D.cols() != m))
    throw Error(Errc::dimension,
                "the linear model that is given has other sizes than the formulas");
  const LinearRows f = linear_rows(by_inputs(*formulas.f, n, m), n, box_with(model.W, "W"), "f",
                                   given ? GivenSlopes{&given->A, &given->B} : GivenSlopes{}),
                   g = linear_rows(by_inputs(*formulas.g, formulas.outputs(), m), n,
                                   box_with(model.V, "V"), "g",
                                   given ? GivenSlopes{&given->C, &given->D} : GivenSlopes{});
  Linearised made;
  LinearModel& linear = made.model.linear;
  linear.A = f.slopes.leftCols(n);
  linear.B = f.slopes.rightCols(m);
  linear.Bw = beside(f.slopes.middleCols(n, q), f.columns);
  linear.C = g.slopes.leftCols(n);
  linear.D = g.slopes.rightCols(m);
  linear.Dv = beside(g.slopes.middleCols(n, r), g.columns);
  made.model.X0 = model.X0;
  made.model.U = model.U;
  made.model.W = with_errors(model.W, f);
  made.model.V = with_errors(model.V, g);
  made.model.region = ValidRegion{states, inputs, !g.is_linear};
  made.f = f.rows;
  made.g = g.rows;
  made.in_W = f.kept;
  made.in_V = g.kept;
  return made;
}

}  // namespace cordon
