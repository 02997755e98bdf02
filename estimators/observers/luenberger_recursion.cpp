// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/luenberger_recursion.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;

LineForm moved(const LineForm& X, const Vector& t) {
  LineForm Y = X;
  Y.c += t;
  return Y;
}

}  // namespace

LuenbergerRecursion::LuenbergerRecursion(const Model& model, Matrix L, std::shared_ptr<const SetBackend> backend, Budget budget)
    : backend_(std::move(backend)), budget_(budget), L_(std::move(L)) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  if (m.is_descriptor()) throw Error(Errc::unsupported, "a Luenberger observer takes systems without E");
  if (L_.rows() != n || L_.cols() != p)
    throw Error(Errc::dimension, "the gain must have a row per state and a column per output");
  const Vector g = m.sensor_center(), f = m.actuator_center(), rad = m.actuator_radius();
  C_ = g.asDiagonal() * m.C;
  minus_C_ = -C_;
  Ao_ = m.A - product(L_, C_);
  const Matrix D = g.asDiagonal() * m.D, B = m.B - product(L_, D);
  input_ = B * f.asDiagonal();
  output_input_ = D * f.asDiagonal();
  for (Index i = 0; i < rad.size(); ++i) {
    if (rad[i] > 0) ranged_.push_back(i);
  }
  ranges_ = Matrix(n, static_cast<Index>(ranged_.size()));
  output_ranges_ = Matrix(p, ranges_.cols());
  for (Index i = 0; i < ranges_.cols(); ++i) {
    const Index input = ranged_[static_cast<std::size_t>(i)];
    ranges_.col(i) = rad[input] * B.col(input);
    output_ranges_.col(i) = rad[input] * D.col(input);
  }
  Bw_ = m.Bw;
  minus_Bw_ = -Bw_;
  Dv_ = m.Dv;
  minus_Dv_ = -Dv_;
  LDv_ = product(L_, Dv_);
  minus_LDv_ = -LDv_;
  minus_L_ = -L_;
  unit_map_ = Matrix::Identity(p, p);
  const Vector w = invariant::enclosing_zonotope(model.W).c, v = invariant::enclosing_zonotope(model.V).c;
  W_ = backend_->import(model.W);
  V_ = backend_->import(model.V);
  W0_ = backend_->import(moved(model.W, -w));
  V0_ = backend_->import(moved(model.V, -v));
  const Vector ones = Vector::Ones(ranges_.cols());
  unit_ = backend_->box({-ones, ones});
  w_ = product(Bw_, w) - product(LDv_, v);
  v_ = product(Dv_, v);
  if (m.sensor.dim() != 0) {
    sensor_radius_ = m.sensor_radius();
    raw_C_ = m.C;
    raw_D_ = m.D.cwiseAbs() * (f + rad).asDiagonal();
  }
}

/// Δ.
Enclosure LuenbergerRecursion::sensor_box(const Enclosure& X, VectorIn u) const {
  const Box outputs = backend_->affine_map(X, raw_C_, Vector::Zero(raw_C_.rows()))->interval_hull();
  const Vector largest = outputs.lower.cwiseAbs().cwiseMax(outputs.upper.cwiseAbs());
  const Vector widths = sensor_radius_.array() * (largest + product(raw_D_, u.cwiseAbs())).array();
  if (!widths.allFinite()) {
    throw Error(Errc::unsupported, "a range of sensor effectiveness needs a bounded set of states: give a bounded initial set");
  }
  return backend_->box({-widths, widths});
}

void LuenbergerRecursion::add_ranges(Summands& to, const Matrix& ranges, const Matrix& sensors, const Enclosure& X, VectorIn u,
                                     bool twice) const {
  if (!ranged_.empty()) {
    to.inputs = ranges;
    for (Index i = 0; i < ranges.cols(); ++i) to.inputs.col(i) *= u[ranged_[static_cast<std::size_t>(i)]];
    to.terms.push_back({to.inputs, unit_});
    if (twice) to.terms.push_back({to.inputs, unit_});
  }
  if (sensor_radius_.size() != 0) {
    to.sensors = sensor_box(X, u);
    to.terms.push_back({sensors, to.sensors});
    if (twice) to.terms.push_back({sensors, to.sensors});
  }
}

Enclosure LuenbergerRecursion::next(const Enclosure& X, const Sample& now) const {
  Summands summands;
  summands.terms.reserve(4);
  summands.terms.push_back({minus_LDv_, V_});
  summands.terms.push_back({Bw_, W_});
  add_ranges(summands, ranges_, minus_L_, X, now.u, false);
  return backend_->predict(X, {Ao_, product(L_, now.y) + product(input_, now.u), summands.terms});
}

Enclosure LuenbergerRecursion::residual(const Enclosure& X, const Sample& now) const {
  Summands summands;
  summands.terms.reserve(3);
  summands.terms.push_back({minus_Dv_, V_});
  add_ranges(summands, output_ranges_, unit_map_, X, now.u, false);
  return backend_->predict(X, {minus_C_, now.y - product(output_input_, now.u), summands.terms});
}

Vector LuenbergerRecursion::next(VectorIn x, const Sample& now) const {
  return product(Ao_, x) + product(L_, now.y) + product(input_, now.u) + w_;
}

Vector LuenbergerRecursion::residual(VectorIn x, const Sample& now) const {
  return now.y - product(output_input_, now.u) - product(C_, x) - v_;
}

Vector LuenbergerRecursion::next_size(VectorIn x, const Sample& now) const {
  return Ao_.cwiseAbs() * x.cwiseAbs() + L_.cwiseAbs() * now.y.cwiseAbs() + input_.cwiseAbs() * now.u.cwiseAbs() + w_.cwiseAbs();
}

Vector LuenbergerRecursion::residual_size(VectorIn s, const Sample& now) const {
  return now.y.cwiseAbs() + output_input_.cwiseAbs() * now.u.cwiseAbs() + C_.cwiseAbs() * s + v_.cwiseAbs();
}

Enclosure LuenbergerRecursion::explained_outputs(const Enclosure& E, VectorIn x, const Sample& now) const {
  Summands summands;
  summands.terms.reserve(2);
  const Enclosure X = sensor_radius_.size() == 0 ? E : backend_->affine_map(E, Matrix::Identity(E->dim(), E->dim()), x);
  add_ranges(summands, output_ranges_, unit_map_, X, now.u, false);
  return backend_->predict(V0_, {minus_Dv_, residual(x, now), summands.terms});
}

Enclosure LuenbergerRecursion::errors_within(const Enclosure& E, const Enclosure& outputs, const Matrix* strip_gain) const {
  const Index n = C_.cols(), p = C_.rows();
  if (!strip_gain) {
    const Matrix minus = -Matrix::Identity(p, p);
    return backend_->correct(E, {C_, Vector::Zero(p), {minus, outputs}});
  }
  const Matrix rest = Matrix::Identity(n, n) - product(*strip_gain, C_);
  const Term term{*strip_gain, outputs};
  return backend_->predict(E, {rest, Vector::Zero(n), {&term, 1}});
}

Enclosure LuenbergerRecursion::next_bound(const Enclosure& E, const Enclosure& X, const Sample& now) const {
  Summands summands;
  summands.terms.reserve(8);
  for (const Matrix* T : {&LDv_, &minus_LDv_}) summands.terms.push_back({*T, V0_});
  for (const Matrix* T : {&Bw_, &minus_Bw_}) summands.terms.push_back({*T, W0_});
  add_ranges(summands, ranges_, minus_L_, X, now.u, true);
  return backend_->predict(E, {Ao_, Vector::Zero(Ao_.rows()), summands.terms});
}

Enclosure LuenbergerRecursion::residual_bound(const Enclosure& E, const Enclosure& X, const Sample& now) const {
  Summands summands;
  summands.terms.reserve(6);
  for (const Matrix* T : {&Dv_, &minus_Dv_}) summands.terms.push_back({*T, V0_});
  add_ranges(summands, output_ranges_, unit_map_, X, now.u, true);
  return backend_->predict(E, {C_, Vector::Zero(C_.rows()), summands.terms});
}

}  // namespace cordon::estimators
