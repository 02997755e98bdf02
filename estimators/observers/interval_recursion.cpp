// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/interval_recursion.hpp"

#include <algorithm>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;

constexpr double underflow = 1e-290;  // a share of it covers what underflows

Vector row_sums(const Matrix& A) { return A.cwiseAbs().rowwise().sum(); }

}  // namespace

IntervalRecursion::IntervalRecursion(const Model& model, const Matrix& L) : L_(L) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs(), inputs = m.inputs();
  if (m.is_descriptor())
    throw Error(Errc::unsupported, "an interval observer takes systems without E");
  if (L.rows() != n || L.cols() != p)
    throw Error(Errc::dimension, "the gain must have a row per state and a column per output");
  const sets::Zonotope W = invariant::enclosing_zonotope(model.W, "W"),
                       V = invariant::enclosing_zonotope(model.V, "V");
  const Vector f = m.actuator_center(), f_radius = m.actuator_radius(), most_f = f + f_radius;
  const Vector g = m.sensor_center(), g_radius = m.sensor_radius(), most_g = g + g_radius;
  const Matrix C = g.asDiagonal() * m.C, D = g.asDiagonal() * m.D, B = m.B - product(L, D),
               LDv = product(L, m.Dv);
  L_abs_ = L.cwiseAbs();
  Ao_ = m.A - product(L, C);
  input_ = B * f.asDiagonal();
  drift_ = product(m.Bw, W.c) - product(LDv, V.c);
  spread_ = Ao_.cwiseAbs();
  inputs_ = B.cwiseAbs() * f_radius.asDiagonal();
  noise_ = row_sums(product(m.Bw, W.G)) + row_sums(product(LDv, V.G));

  state_size_ = m.A.cwiseAbs() + product(L_abs_, C.cwiseAbs());
  input_size_ = (m.B.cwiseAbs() + product(L_abs_, D.cwiseAbs())) * most_f.asDiagonal();
  const Matrix Bw = m.Bw.cwiseAbs(), Dv = product(L_abs_, m.Dv.cwiseAbs());
  noise_size_ =
      product(Bw, W.c.cwiseAbs() + row_sums(W.G)) + product(Dv, V.c.cwiseAbs() + row_sums(V.G));

  if (m.is_uncertain()) {
    parameters_ = Matrix::Zero(n, n);
    if (m.A_radius.size() != 0) parameters_ += m.A_radius;
    if (m.C_radius.size() != 0) parameters_ += product(L_abs_, most_g.asDiagonal() * m.C_radius);
    if (m.B_radius.size() != 0) inputs_ += m.B_radius * most_f.asDiagonal();
    state_size_ += parameters_;
  }
  if (m.sensor.dim() != 0) {
    C_ = m.C;
    D_ = m.D * f.asDiagonal();
    sensors_ = L_abs_ * g_radius.asDiagonal();
    const Matrix states = product(sensors_, m.C.cwiseAbs()),
                 through = product(sensors_, m.D.cwiseAbs());
    spread_ += states;
    inputs_ += through * f_radius.asDiagonal();
    state_size_ += states;
    input_size_ += through * most_f.asDiagonal();
  }
  input_size_ += inputs_;
  noise_size_.array() += underflow;
  // operations one after the other in any entry: products made in advance, then the sum of all
  // products of a step, and c ± r
  const Index noises = std::max(m.disturbances() + W.generators(), m.noises() + V.generators());
  rounding_ = rounding::gamma(2 * n + inputs + 4 * p + noises + 14);
  x_size_.resize(n);
  u_size_.resize(inputs);
  y_size_.resize(p);
  size_.resize(n);
  outputs_.resize(p);
}

void IntervalRecursion::next(const Vector& c, const Vector& r, const Sample& now, Vector& c_next,
                             Vector& r_next) {
  x_size_ = c.cwiseAbs() + r;
  u_size_ = now.u.cwiseAbs();
  y_size_ = now.y.cwiseAbs();
  c_next = drift_;
  c_next.noalias() += Ao_ * c;
  c_next.noalias() += input_ * now.u;
  c_next.noalias() += L_ * now.y;
  r_next = noise_;
  r_next.noalias() += spread_ * r;
  r_next.noalias() += inputs_ * u_size_;
  if (parameters_.size() != 0) r_next.noalias() += parameters_ * x_size_;
  if (sensors_.size() != 0) {
    outputs_.noalias() = C_ * c;
    outputs_.noalias() += D_ * now.u;
    outputs_ = outputs_.cwiseAbs();
    r_next.noalias() += sensors_ * outputs_;
  }
  size_ = noise_size_;
  size_.noalias() += state_size_ * x_size_;
  size_.noalias() += input_size_ * u_size_;
  size_.noalias() += L_abs_ * y_size_;
  r_next += rounding_ * size_;
  if (!r_next.allFinite() || !c_next.allFinite())
    throw Error(Errc::not_finite,
                "the bounds have grown beyond all numbers: |A - L C| and the radii make them grow "
                "at every step");
}

std::pair<Vector, Vector> around(const Box& box) {
  const Vector c = box.center();
  Vector r(c.size());
  for (Index i = 0; i < c.size(); ++i)
    r[i] = rounding::up(std::max(box.upper[i] - c[i], c[i] - box.lower[i]));
  return {c, r};
}

}  // namespace cordon::estimators
