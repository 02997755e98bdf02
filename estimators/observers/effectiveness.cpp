// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/effectiveness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "observers/interval_spread.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

std::vector<Index> positive(const Vector& radii) {
  std::vector<Index> found;
  for (Index i = 0; i < radii.size(); ++i) {
    if (radii[i] > 0) found.push_back(i);
  }
  return found;
}

Enclosure unit_box(const SetBackend& backend, std::size_t n) {
  const Vector ones = Vector::Ones(static_cast<Index>(n));
  return backend.box({-ones, ones});
}

double upwards(double value, Index terms) {
  return rounding::up(value * (1 + rounding::gamma(2 * terms + 4)));
}

}  // namespace

Effectiveness::Effectiveness(const Model& model, const SetBackend& backend)
    : model_(model),
      backend_(backend),
      V_(backend.import(model.V)),
      noise_thickness_(model.linear.D.isZero(0) ? Thickness()
                                                : Thickness(model.V, model.linear.Dv)),
      f_(model.linear.actuator_center()),
      f_radius_(model.linear.actuator_radius()),
      g_(model.linear.sensor_center()),
      g_radius_(model.linear.sensor_radius()),
      ranged_inputs_(positive(f_radius_)),
      ranged_outputs_(positive(g_radius_)) {
  const LinearModel& m = model.linear;
  bool by_input = false;
  for (const Index j : ranged_inputs_) by_input = by_input || !m.D.col(j).isZero(0);
  for (Index i = 0; i < m.C_radius.rows(); ++i) {
    if (m.C_radius.row(i).maxCoeff() > 0) interval_outputs_.push_back(i);
  }
  open_states_ = has_spread(m.A_radius) || has_spread(m.B_radius);
  plain_outputs_ = m.sensor.dim() == 0 && !by_input && interval_outputs_.empty();
  input_factors_ = unit_box(backend, ranged_inputs_.size());
  output_factors_ = unit_box(backend, ranged_outputs_.size());
  if (plain_outputs_) return;
  noise_ = backend.product(backend.product(backend.product(V_, input_factors_), output_factors_),
                           unit_box(backend, interval_outputs_.size()));
  noise_hull_ = backend.affine_map(V_, m.Dv, Vector::Zero(m.outputs()))->interval_hull();
}

Vector Effectiveness::input(MatrixIn B, VectorIn u) const {
  Vector image(B.rows());
  input(B, u, image);
  return image;
}

void Effectiveness::input(MatrixIn B, VectorIn u, Vector& image) const {
  if (model_.linear.actuator.dim() == 0) {
    linalg::product(B, u, image);
  } else {
    linalg::product(B, f_.cwiseProduct(u), image);
  }
}

Vector Effectiveness::input_terms(MatrixIn B, VectorIn u) const {
  return B.cwiseAbs().lazyProduct(f_.cwiseProduct(u).cwiseAbs());
}

bool Effectiveness::inputs_enter_as_sets() const {
  return backend_.info().rounding != Rounding::nominal && model_.linear.actuator.dim() == 0;
}

Matrix Effectiveness::input_spread(MatrixIn B, VectorIn u) const {
  Matrix spread(B.rows(), static_cast<Index>(ranged_inputs_.size()));
  for (Index column = 0; column < spread.cols(); ++column) {
    const Index j = ranged_inputs_[static_cast<std::size_t>(column)];
    spread.col(column) = B.col(j) * (f_radius_[j] * u[j]);
  }
  return spread;
}

Enclosure Effectiveness::open_states(const Enclosure& X, VectorIn u) const {
  const LinearModel& m = model_.linear;
  const Vector s = has_spread(m.A_radius) ? magnitudes(X) : Vector(Vector::Zero(m.states()));
  const Vector widths =
      interval_spread(m.A_radius, s, m.states()) +
      interval_spread(m.B_radius, (f_ + f_radius_).cwiseProduct(u.cwiseAbs()), m.states());
  return backend_.box({-widths, widths});
}

Vector Effectiveness::output_bound(const Sample& now, const Box* reach) const {
  const LinearModel& m = model_.linear;
  Vector zeta = Vector::Zero(m.outputs());
  if (ranged_outputs_.empty()) return zeta;
  const Vector through = input(m.D, now.u);
  const Vector spread = input_spread(m.D, now.u).cwiseAbs().rowwise().sum();
  const Vector terms = linalg::product(
      m.D.cwiseAbs(), now.u.cwiseAbs());  // at least the size of those of D diag(f) u
  for (const Index i : ranged_outputs_) {
    double bound = infinity;
    if (reach && !reach->is_empty()) {
      const double size =
          std::max(std::abs(reach->lower[i] + through[i]), std::abs(reach->upper[i] + through[i])) +
          spread[i];
      bound = upwards(size, m.inputs()) + rounding::gamma(2 * m.inputs() + 4) * terms[i];
    }
    const double least = m.sensor.lower[i];
    if (least > 0 && !noise_hull_.is_empty()) {
      const double size = std::max(std::abs(now.y[i] - noise_hull_.lower[i]),
                                   std::abs(now.y[i] - noise_hull_.upper[i]));
      bound = std::min(bound, upwards(size / least, 2));
    }
    zeta[i] = std::isnan(bound) ? infinity : bound;
  }
  return zeta;
}

Matrix Effectiveness::output_spread(VectorIn zeta) const {
  Matrix spread = Matrix::Zero(zeta.size(), static_cast<Index>(ranged_outputs_.size()));
  for (Index column = 0; column < spread.cols(); ++column) {
    const Index i = ranged_outputs_[static_cast<std::size_t>(column)];
    if (std::isfinite(zeta[i])) spread(i, column) = g_radius_[i] * zeta[i];
  }
  return spread;
}

Matrix Effectiveness::interval_columns(const Vector& open) const {
  Matrix columns = Matrix::Zero(open.size(), static_cast<Index>(interval_outputs_.size()));
  for (Index column = 0; column < columns.cols(); ++column) {
    const Index i = interval_outputs_[static_cast<std::size_t>(column)];
    if (std::isfinite(open[i])) columns(i, column) = g_[i] * open[i];
  }
  return columns;
}

Enclosure Effectiveness::correct(const Enclosure& X, MatrixIn C, const Sample& now) const {
  const LinearModel& m = model_.linear;
  if (m.outputs() == 0) return X;
  if (!now.is_complete()) {
    const std::vector<Index> present = present_outputs(now);
    const Model others = with_outputs(model_, present);
    return Effectiveness(others, backend_).correct(X, C(present, Eigen::all), without_missing(now));
  }
  if (plain_outputs_ && inputs_enter_as_sets() && !m.D.isZero(0)) {
    Matrix T(m.outputs(), m.noises() + m.inputs());
    T << m.Dv, m.D;
    return backend_.correct(X, {C, now.y, {T, backend_.product(V_, backend_.point(now.u))}});
  }
  const bool has_inputs = !m.D.isZero(0);
  if (plain_outputs_ && !has_inputs) return backend_.correct(X, {C, now.y, {m.Dv, V_}});
  const Vector through = input(m.D, now.u);
  const Vector terms = has_inputs
                           ? Vector(now.y.cwiseAbs() + g_.cwiseProduct(input_terms(m.D, now.u)))
                           : Vector(now.y.cwiseAbs());
  const bool as_set = has_inputs && inputs_enter_as_sets();  // g D u, which is rounded otherwise
  const Vector z = as_set ? Vector(now.y) : Vector(now.y - g_.cwiseProduct(through));
  if (plain_outputs_)
    return RoundingRoom(backend_, z, terms, noise_thickness_).correct(X, {C, z, {m.Dv, V_}});

  Vector open = Vector::Zero(m.outputs()), zeta = open;
  if (!interval_outputs_.empty()) open = interval_spread(m.C_radius, magnitudes(X), m.outputs());
  if (has_output_ranges()) {
    const Matrix rows = C(ranged_outputs_, Eigen::all);
    const Box ranged = backend_.affine_map(X, rows, Vector::Zero(rows.rows()))->interval_hull();
    Box reach = Box::space(m.outputs());
    reach.lower(ranged_outputs_) = ranged.lower - open(ranged_outputs_);
    reach.upper(ranged_outputs_) = ranged.upper + open(ranged_outputs_);
    zeta = output_bound(now, &reach);
  }
  std::vector<Index> used;
  for (Index i = 0; i < m.outputs(); ++i) {
    if (std::isfinite(zeta[i]) && std::isfinite(open[i])) used.push_back(i);
  }
  if (used.empty()) return {X.set, Tightness::outer};  // what the outputs say is left out
  const Index inputs = as_set ? m.inputs() : 0;
  const Enclosure noise = as_set ? backend_.product(noise_, backend_.point(now.u)) : noise_;
  Matrix T(m.outputs(), noise->dim());
  T << m.Dv, g_.asDiagonal() * input_spread(m.D, now.u), output_spread(zeta),
      interval_columns(open), g_.asDiagonal() * m.D.leftCols(inputs);
  const Matrix scaled = g_.asDiagonal() * C;
  const RoundingRoom room(backend_, z(used), terms(used), noise_thickness_.of_rows(used));
  Enclosure corrected =
      room.correct(X, {scaled(used, Eigen::all), z(used), {T(used, Eigen::all), noise}});
  if (has_output_ranges() || !interval_outputs_.empty()) corrected.tightness = Tightness::outer;
  return corrected;
}

Tightness Effectiveness::recursion(std::initializer_list<const Matrix*> entries) const {
  for (const Index j : ranged_inputs_) {
    Index places = 0;
    for (const Matrix* entry : entries) places += entry->rows() > 0 && !entry->col(j).isZero(0);
    if (places > 1) return Tightness::outer;
  }
  return Tightness::exact;
}

bool Effectiveness::is_bounded_by_measurement(const LinearModel& model, Index i) {
  return model.sensor.dim() == 0 || model.sensor.lower[i] > 0 ||
         model.sensor.upper[i] == model.sensor.lower[i];
}

}  // namespace cordon::estimators
