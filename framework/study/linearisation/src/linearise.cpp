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

namespace cordon {

namespace {

using formulas::BoxEnclosure;
using formulas::Deviation;
using formulas::Function;
using Variables = std::vector<Interval>;

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

/// The rows of a function as slopes and remainders.
struct LinearRows {
  Matrix slopes;
  std::vector<LinearisedRow> rows;
  std::vector<Index> kept;  ///< rows whose remainder is not zero
  bool is_linear = true;    ///< what is left of all rows is a constant
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

LinearRows linear_rows(const std::shared_ptr<const Function>& function, Index states,
                       const Variables& box, const char* name) {
  LinearRows made{Matrix::Zero(function->rows(), function->differentiated()), {}, {}, true};
  BoxEnclosure enclosure(function, states, formulas::AffineForm::convex_differences,
                         Rounding::outward);
  for (Index row = 0; row < function->rows(); ++row) {
    enclosure.set_box(box);
    Eigen::RowVectorXd slope(function->differentiated());
    enclosure.affine(row, slope);
    slope = derivative_at(enclosure.evaluator(), row, enclosure.center(), box).value_or(slope);
    const Deviation found = bound_deviation(enclosure, row, slope, box);
    if (!found.bounds.is_finite()) {
      enclosure.set_box(box);
      const std::string why = enclosure.why_not_enclosed(row);
      throw Error(Errc::not_enclosed, std::string(name) + " has no bounds on the region, row " +
                                          std::to_string(row + 1) +
                                          (why.empty() ? "" : ": " + why));
    }
    made.slopes.row(row) = slope;
    made.rows.push_back({found.bounds, found.attained});
    made.is_linear = made.is_linear && found.bounds.is_point();
    if (found.bounds != Interval{0, 0}) made.kept.push_back(row);
  }
  return made;
}

/// The set of the formulas, and a coordinate for each remainder that is kept.
LineForm with_remainders(const LineForm& set, const LinearRows& rows) {
  const auto count = static_cast<Index>(rows.kept.size());
  if (count == 0) return set;
  Box box{Vector(count), Vector(count)};
  for (Index i = 0; i < count; ++i) {
    const Interval& remainder = rows.rows[as_size(rows.kept[as_size(i)])].remainder;
    box.lower[i] = remainder.lower;
    box.upper[i] = remainder.upper;
  }
  return cartesian_product(set, make_box(box));
}

/// The slopes by the drawn variables, and columns of the identity for what is kept.
Matrix with_remainders(const Matrix& slopes, const LinearRows& rows) {
  Matrix all = Matrix::Zero(slopes.rows(), slopes.cols() + std::ssize(rows.kept));
  all.leftCols(slopes.cols()) = slopes;
  for (std::size_t i = 0; i < rows.kept.size(); ++i)
    all(rows.kept[i], slopes.cols() + static_cast<Index>(i)) = 1;
  return all;
}

}  // namespace

Linearised linearise(const Model& model, const Box& states, const Box& inputs) {
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
  const LinearRows f = linear_rows(by_inputs(*formulas.f, n, m), n, box_with(model.W, "W"), "f"),
                   g = linear_rows(by_inputs(*formulas.g, formulas.outputs(), m), n,
                                   box_with(model.V, "V"), "g");
  Linearised made;
  LinearModel& linear = made.model.linear;
  linear.A = f.slopes.leftCols(n);
  linear.B = f.slopes.rightCols(m);
  linear.Bw = with_remainders(f.slopes.middleCols(n, q), f);
  linear.C = g.slopes.leftCols(n);
  linear.D = g.slopes.rightCols(m);
  linear.Dv = with_remainders(g.slopes.middleCols(n, r), g);
  made.model.X0 = model.X0;
  made.model.U = model.U;
  made.model.W = with_remainders(model.W, f);
  made.model.V = with_remainders(model.V, g);
  made.model.region = ValidRegion{states, inputs, !g.is_linear};
  made.f = f.rows;
  made.g = g.rows;
  made.in_W = f.kept;
  made.in_V = g.kept;
  return made;
}

}  // namespace cordon
