// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/mode_enclosure.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/interval.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/outward_questions.hpp"

namespace cordon::verification {

namespace {

constexpr int sweeps = 10;

Interval side(const Box& box, Index i) { return {box.lower[i], box.upper[i]}; }

Interval intersected(Interval a, Interval b) {
  return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)};
}

/// coefficient ± radius, a radius of no size being 0, times the effectiveness.
Interval entry(const Matrix& center, const Matrix& radius, Index i, Index j) {
  const double c = center(i, j), r = radius.size() ? radius(i, j) : 0;
  return Interval{c, c} + Interval{-r, r};
}
Interval effectiveness(const Box& range, Index i) {
  return range.dim() ? side(range, i) : Interval{1, 1};
}

Interval point(double x) { return {x, x}; }

/// B diag(f) u of one row, of one input.
Interval driven(const Matrix& B, const Matrix& radius, const Box& actuator, VectorIn u, Index i,
                Index j) {
  return u[j] * (entry(B, radius, i, j) * effectiveness(actuator, j));
}
/// Of all of them.
Interval driven(const Matrix& B, const Matrix& radius, const Box& actuator, VectorIn u, Index i) {
  Interval sum = point(0);
  for (Index j = 0; j < u.size(); ++j) sum = sum + driven(B, radius, actuator, u, i, j);
  return sum;
}

bool has_range(const Box& actuator, Index j) {
  return actuator.dim() > 0 && actuator.lower[j] < actuator.upper[j];
}

/// [b] u f - slope f over a range, and the slope.
Interval spread(Interval b, double u, Interval range, double& slope) {
  const Interval by = u * b;
  slope = by.is_point() ? by.lower : 0.5 * by.lower + 0.5 * by.upper;
  if (!std::isfinite(slope)) slope = 0;  // beyond the numbers: all of it is the rest
  return (by + point(-slope)) * range;
}

/// [row] x - slopes x over the box, and the slopes: the middles.
Interval spread(const std::vector<Interval>& row, const Box& x, Eigen::Ref<Matrix> slopes,
                Index i) {
  Interval rest = point(0);
  for (Index j = 0; j < x.dim(); ++j) {
    const Interval one = row[as_size(j)];
    slopes(i, j) = one.is_point() ? one.lower : 0.5 * one.lower + 0.5 * one.upper;
    const Interval left = one + point(-slopes(i, j));
    if (left != point(0)) rest = rest + left * side(x, j);
  }
  return rest;
}

/// slopes (x, noise) without one variable, of one row.
Interval others(const Matrix& slopes, Index i, const Box& x, const Box& noise, Index without) {
  Interval sum = point(0);
  for (Index j = 0; j < slopes.cols(); ++j) {
    if (j == without || slopes(i, j) == 0) continue;
    sum = sum + slopes(i, j) * (j < x.dim() ? side(x, j) : side(noise, j - x.dim()));
  }
  return sum;
}

/// Both, one after the other.
Box product_of(const Box& X, const Box& Y) {
  Box both{Vector(X.dim() + Y.dim()), Vector(X.dim() + Y.dim())};
  both.lower << X.lower, Y.lower;
  both.upper << X.upper, Y.upper;
  return both;
}

bool is_defined(Interval x) { return x.lower > -infinity || x.upper < infinity; }

}  // namespace

ModeEnclosure::ModeEnclosure(const Model& model)
    : model_(model), W_(outward::interval_hull(model.W)), V_(outward::interval_hull(model.V)) {
  const Box& actuator = model.linear.actuator;
  std::vector<Index> ranged;
  for (Index j = 0; model.is_linear() && j < actuator.dim(); ++j)
    if (has_range(actuator, j)) ranged.push_back(j);
  driving_ = product_of(W_, {actuator.lower(ranged), actuator.upper(ranged)});
  if (model.is_linear()) return;
  const NonlinearModel& own = *model.nonlinear;
  constexpr auto form = formulas::AffineForm::convex_differences;
  formulas_.emplace(Formulas{{own.f, own.states(), form, Rounding::outward, own.undefined},
                             {own.g, own.states(), form, Rounding::outward, own.undefined},
                             {own.g, Rounding::outward, own.undefined}});
}

namespace {

std::vector<Interval> variables_of(const Box& x, const Box& noise, VectorIn u, Index k) {
  std::vector<Interval> all;
  for (const Box* box : {&x, &noise})
    for (Index i = 0; i < box->dim(); ++i) all.push_back(side(*box, i));
  for (const double known : u) all.push_back(point(known));
  all.push_back(point(static_cast<double>(k)));
  return all;
}

bool is_bounded(const Box& box) { return box.lower.allFinite() && box.upper.allFinite(); }

/// Slopes of the row, and what they leave out; false where it has no bounded enclosure.
bool enclose_row(formulas::BoxEnclosure& function, Index row, EnclosedRows& to, Index at) {
  if (!function.is_enclosed(row)) return false;
  Matrix slopes = Matrix::Zero(function.function().rows(), function.function().differentiated());
  Eigen::RowVectorXd slope = slopes.row(row);
  function.affine(row, slope);
  slopes.row(row) = slope;
  Vector weights = Vector::Zero(slopes.rows());
  weights[row] = 1;
  const Interval rest = function.deviation(weights, slopes);
  to.slopes.row(at) = slope;
  to.rest[as_size(at)] = rest;
  return rest.is_finite();
}

EnclosedRows rows_of_size(Index rows, Index left, Index states, Index noises) {
  return {Matrix::Zero(rows, left), Matrix::Zero(rows, states + noises),
          std::vector<Interval>(as_size(rows), point(0)), states};
}

}  // namespace

EnclosedRows ModeEnclosure::linear_successors(const Box& x, const Sample& now) const {
  const LinearModel& m = model_.linear;
  const Index n = m.states();
  EnclosedRows made = rows_of_size(n, n, n, driving_.dim());
  made.left = m.is_descriptor() ? m.E : Matrix(Matrix::Identity(n, n));
  made.slopes.middleCols(n, m.disturbances()) = m.Bw;
  std::vector<Interval> row(as_size(n));
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) row[as_size(j)] = entry(m.A, m.A_radius, i, j);
    Interval rest = spread(row, x, made.slopes, i);
    Index column = n + m.disturbances();
    for (Index j = 0; j < now.u.size(); ++j) {
      rest =
          rest + (has_range(m.actuator, j) ? spread(entry(m.B, m.B_radius, i, j), now.u[j],
                                                    side(m.actuator, j), made.slopes(i, column++))
                                           : driven(m.B, m.B_radius, m.actuator, now.u, i, j));
    }
    made.rest[as_size(i)] = rest;
  }
  return made;
}

EnclosedRows ModeEnclosure::linear_outputs(const Box& x, const Sample& now) const {
  const LinearModel& m = model_.linear;
  const std::vector<Index> present = present_outputs(now);
  const Index n = m.states();
  EnclosedRows made = rows_of_size(std::ssize(present), 0, n, m.noises());
  std::vector<Interval> row(as_size(n));
  for (std::size_t at = 0; at < present.size(); ++at) {
    const Index i = present[at];
    const Interval sensor = effectiveness(m.sensor, i);
    for (Index j = 0; j < n; ++j) row[as_size(j)] = sensor * entry(m.C, m.C_radius, i, j);
    const Interval known = sensor * driven(m.D, Matrix(), m.actuator, now.u, i);
    const auto to = static_cast<Index>(at);
    made.rest[at] = point(now.y[i]) - (spread(row, x, made.slopes, to) + known);
    made.slopes.row(to).tail(m.noises()) = m.Dv.row(i);
  }
  for (Interval& rest : made.rest) rest = -rest;  // 0 - slopes (x, v) ∈ rest
  return made;
}

std::vector<Index> ModeEnclosure::rows_of(const Sample& now) const {
  std::vector<Index> rows = present_outputs(now);
  for (Index i = 0; i < model_.nonlinear->invariants; ++i)
    rows.push_back(model_.nonlinear->outputs() + i);
  return rows;
}

std::optional<EnclosedRows> ModeEnclosure::successors(const Box& x, const Sample& now) {
  if (model_.is_linear()) return linear_successors(x, now);
  if (!is_bounded(x)) return std::nullopt;
  const Index n = x.dim();
  EnclosedRows made = rows_of_size(n, n, n, W_.dim());
  made.left.setIdentity();
  formulas_->f.set_box(variables_of(x, W_, now.u, now.k));
  for (Index i = 0; i < n; ++i)
    if (!enclose_row(formulas_->f, i, made, i)) return std::nullopt;
  return made;
}

Box ModeEnclosure::reached(const EnclosedRows& rows, const Box& x) const {
  const Index n = x.dim();
  Box hull = Box::space(n);
  if (model_.is_linear() && model_.linear.is_descriptor()) return hull;
  for (Index i = 0; i < n; ++i) {
    Interval sum = others(rows.slopes, i, x, driving_, -1) + rows.rest[as_size(i)];
    if (!model_.is_linear()) sum = intersected(sum, formulas_->f.range(i));
    hull.lower[i] = sum.lower;
    hull.upper[i] = sum.upper;
  }
  return hull;
}

EnclosedRows ModeEnclosure::outputs(const Box& x, const Sample& now) {
  if (model_.is_linear()) return linear_outputs(x, now);
  const std::vector<Index> rows = rows_of(now);
  EnclosedRows made = rows_of_size(std::ssize(rows), 0, x.dim(), V_.dim());
  if (!is_bounded(x)) return rows_of_size(0, 0, x.dim(), V_.dim());
  formulas_->g.set_box(variables_of(x, V_, now.u, now.k));
  Index kept = 0;
  for (const Index row : rows) {
    made.slopes.row(kept).setZero();
    if (!enclose_row(formulas_->g, row, made, kept)) continue;
    const double value = row < model_.nonlinear->outputs() ? now.y[row] : 0;
    Interval& rest = made.rest[as_size(kept++)];
    rest = rest - point(value);
  }
  made.slopes.conservativeResize(kept, Eigen::NoChange);
  made.left.resize(kept, 0);
  made.rest.resize(as_size(kept));
  return made;
}

bool ModeEnclosure::contract_by_formulas(Box& x, const Sample& now) {
  const Index n = x.dim();
  std::vector<Interval> variables = variables_of(x, V_, now.u, now.k);
  for (const Index row : rows_of(now)) {
    const double value = row < model_.nonlinear->outputs() ? now.y[row] : 0;
    if (!formulas_->contracting.contract(variables, row, point(value))) return false;
  }
  for (Index i = 0; i < n; ++i) {
    x.lower[i] = variables[as_size(i)].lower;
    x.upper[i] = variables[as_size(i)].upper;
  }
  return true;
}

bool ModeEnclosure::contract(Box& x, const Sample& now) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Box before = x;
    if (!model_.is_linear() && !contract_by_formulas(x, now)) return false;
    const EnclosedRows rows = outputs(x, now);
    for (Index i = 0; i < rows.slopes.rows(); ++i) {
      for (Index j = 0; j < x.dim(); ++j) {  // slope_j x_j ∈ -rest - others
        const double slope = rows.slopes(i, j);
        if (slope == 0) continue;
        const Interval rest = -(rows.rest[as_size(i)] + others(rows.slopes, i, x, V_, j));
        if (!is_defined(rest)) continue;
        const Interval now_in = intersected(side(x, j), rest / slope);
        if (now_in.is_empty()) return false;
        x.lower[j] = now_in.lower;
        x.upper[j] = now_in.upper;
      }
      const Interval sum = others(rows.slopes, i, x, V_, -1) + rows.rest[as_size(i)];
      if (!sum.contains(0)) return false;
    }
    if (x.lower == before.lower && x.upper == before.upper) break;
  }
  return true;
}

}  // namespace cordon::verification
