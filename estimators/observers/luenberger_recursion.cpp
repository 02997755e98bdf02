// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/luenberger_recursion.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/interval.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "observers/interval_spread.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;

constexpr double most_moved = 0.5;

LineForm moved(const LineForm& X, const Vector& t) {
  LineForm Y = X;
  Y.c += t;
  return Y;
}

/// The hull of X with what X takes up apart from its lines in place of sides without an end: the
/// numbers that are computed with.
Box without_lines(const Set& X, Box hull) {
  if (hull.is_bounded() || hull.is_empty()) return hull;
  const LineForm form = X.line_form();
  const Vector widths = form.G.cwiseAbs().rowwise().sum();
  for (Index i = 0; i < hull.dim(); ++i) {
    if (std::isfinite(hull.lower[i]) && std::isfinite(hull.upper[i])) continue;
    hull.lower[i] = form.c[i] - widths[i];
    hull.upper[i] = form.c[i] + widths[i];
  }
  return hull;
}

Vector largest_entries(const Box& box) {
  return box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs());
}

}  // namespace

LuenbergerRecursion::LuenbergerRecursion(const Model& model, Matrix L,
                                         std::shared_ptr<const SetBackend> backend, Budget budget,
                                         Matrix held)
    : backend_(std::move(backend)), budget_(budget), held_(std::move(held)) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  if (m.is_descriptor())
    throw Error(Errc::unsupported, "a Luenberger observer takes systems without E");
  const Vector g = m.sensor_center(), rad = m.actuator_radius();
  f_ = m.actuator_center();
  A_ = m.A;
  B_ = m.B;
  C_ = g.asDiagonal() * m.C;
  minus_C_ = -C_;
  D_ = g.asDiagonal() * m.D;
  output_input_ = D_ * f_.asDiagonal();
  for (Index i = 0; i < rad.size(); ++i) {
    if (rad[i] > 0) ranged_.push_back(i);
  }
  ranged_radius_ = rad(ranged_);
  output_ranges_ = D_(Eigen::all, ranged_) * ranged_radius_.asDiagonal();
  Bw_ = m.Bw;
  minus_Bw_ = -Bw_;
  Dv_ = m.Dv;
  minus_Dv_ = -Dv_;
  state_unit_ = Matrix::Identity(n, n);
  output_unit_ = Matrix::Identity(p, p);
  const sets::Zonotope around_W = invariant::enclosing_zonotope(model.W),
                       around_V = invariant::enclosing_zonotope(model.V);
  const Vector &w = around_W.c, &v = around_V.c;
  W_generators_ = around_W.G;
  V_generators_ = around_V.G;
  disturbance_terms_ = Bw_.cwiseAbs() * (w.cwiseAbs() + W_generators_.cwiseAbs().rowwise().sum());
  noise_terms_ = Dv_.cwiseAbs() * (v.cwiseAbs() + V_generators_.cwiseAbs().rowwise().sum());
  state_drift_ = product(Bw_, w);
  v_ = product(Dv_, v);
  W_ = backend_->import(model.W);
  V_ = backend_->import(model.V);
  W0_ = backend_->import(moved(model.W, -w));
  V0_ = backend_->import(moved(model.V, -v));
  const Vector ones = Vector::Ones(ranged_radius_.size());
  unit_ = backend_->box({-ones, ones});
  most_f_ = f_ + rad;
  if (has_spread(m.sensor_radius())) {
    sensor_radius_ = m.sensor_radius();
    raw_C_ = m.C;
    raw_D_ = m.D.cwiseAbs() * most_f_.asDiagonal();
  }
  if (has_spread(m.A_radius)) A_radius_ = m.A_radius;
  if (has_spread(m.B_radius)) B_radius_ = m.B_radius;
  if (has_spread(m.C_radius)) C_radius_ = (g + m.sensor_radius()).asDiagonal() * m.C_radius;
  W_thickness_ = Thickness(model.W, Bw_);
  if (held_.cols() > 0) {
    output_size_ = product(C_, held_).cwiseAbs().rowwise().sum() +
                   product(Dv_, V_generators_).cwiseAbs().rowwise().sum();
  }
  use_gain(std::move(L));
  if (held_.cols() == 0 && model.W.constraints() + model.V.constraints() == 0)
    thickness_ = Thickness(error_noise());
}

void LuenbergerRecursion::use_gain(Matrix L) {
  if (L.rows() != A_.rows() || L.cols() != C_.rows())
    throw Error(Errc::dimension, "the gain must have a row per state and a column per output");
  L_ = std::move(L);
  Ao_ = A_ - product(L_, C_);
  const Matrix B = B_ - product(L_, D_);
  input_ = B * f_.asDiagonal();
  ranges_ = B(Eigen::all, ranged_) * ranged_radius_.asDiagonal();
  minus_LDv_ = -product(L_, Dv_);
  minus_L_ = -L_;
  w_ = state_drift_ - product(L_, v_);
  take_sizes();
}

/// Magnitudes of what A - L C̄, L Dv and the sums of X̂⁺ are made of, and their largest.
void LuenbergerRecursion::take_sizes() {
  y_terms_ = L_.cwiseAbs();
  x_terms_ = A_.cwiseAbs();
  x_terms_ += y_terms_.lazyProduct(C_.cwiseAbs());
  u_terms_ = B_.cwiseAbs();
  u_terms_ += y_terms_.lazyProduct(D_.cwiseAbs());
  u_terms_ *= f_.cwiseAbs().asDiagonal();
  constant_terms_ = disturbance_terms_;
  constant_terms_ += y_terms_.lazyProduct(noise_terms_);
  x_norm_ = row_norm(x_terms_);
  y_norm_ = row_norm(y_terms_);
  u_norm_ = row_norm(u_terms_);
  constant_norm_ = row_norm(constant_terms_);
  if (held_.cols() > 0) return take_thickness();
  thickness_ = W_thickness_;  // that of both costs more than a step, and is no thinner
}

/// Of [(A - L C̄) held, Bw G_W, -L Dv G_V]. While L moves these columns by no more than a half of
/// what they span, the set holds a half of what it held.
void LuenbergerRecursion::take_thickness() {
  if (thick_L_.size() > 0 &&
      thickness_.share_of((L_ - thick_L_).cwiseAbs() * output_size_) <= most_moved)
    return;
  const Matrix noise = error_noise();
  Matrix columns(noise.rows(), held_.cols() + noise.cols());
  columns << product(Ao_, held_), noise;
  thickness_ = Thickness(columns);
  thick_L_ = L_;
}

void LuenbergerRecursion::start(Matrix L) {
  thick_L_.resize(0, 0);
  use_gain(std::move(L));
}

void LuenbergerRecursion::serialize(Archive& archive) {
  if (held_.cols() == 0) return;
  archive.same_shape(thick_L_);
  if (!thick_L_.allFinite()) archive.refuse("a gain that is not finite");
  if (archive.is_reading()) start(Matrix(thick_L_));  // finds the thickness again
}

/// ∞ in rows of A - L C̄ that were rounded in a column along which X̂ has no end: what that does to
/// them has no bound. 0 in others.
Vector LuenbergerRecursion::lost_rows(const Box& reach) const {
  Vector lost = Vector::Zero(A_.rows());
  for (Index j = 0; j < A_.cols(); ++j) {
    if (std::isfinite(reach.lower[j]) && std::isfinite(reach.upper[j])) continue;
    for (Index i = 0; i < A_.rows(); ++i) {
      Interval entry{A_(i, j), A_(i, j)};
      for (Index k = 0; k < C_.rows(); ++k) entry = entry - directed::times(L_(i, k), C_(k, j));
      if (!(entry.is_point() && entry.lower == Ao_(i, j))) lost[i] = infinity;
    }
  }
  return lost;
}

std::optional<RoundingRoom> LuenbergerRecursion::room_of(const Enclosure& X, VectorIn shift,
                                                         const Sample& now, const Box* hull) const {
  const bool outward = backend_->info().rounding == Rounding::outward;
  Box own = hull ? Box{} : reach_of(*X);
  Vector lost;
  if (!(hull ? *hull : own).is_bounded()) {
    own = X->interval_hull();
    if (outward) lost = lost_rows(own);
    own = without_lines(*X, std::move(own));
    hull = nullptr;
  }
  const Box& reach = hull ? *hull : own;
  const auto largest = [](VectorIn v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; };
  const double most_x = std::max(largest(reach.lower), largest(reach.upper));
  if (!std::isfinite(most_x) || reach.is_empty()) return std::nullopt;
  const double most =
      x_norm_ * most_x + y_norm_ * largest(now.y) + u_norm_ * largest(now.u) + constant_norm_;
  if (!outward && !RoundingRoom::may_be_needed(most, thickness_)) return std::nullopt;
  Vector terms = x_terms_ * largest_entries(reach) + y_terms_ * now.y.cwiseAbs() +
                 u_terms_ * now.u.cwiseAbs() + constant_terms_;
  if (lost.size() > 0) terms += lost;
  if (outward) return std::optional<RoundingRoom>(std::in_place, *backend_, terms);
  if (!RoundingRoom::may_be_needed(terms, thickness_)) return std::nullopt;
  const Vector sum = shift + w_ + product(Ao_, reach.center());
  return std::optional<RoundingRoom>(std::in_place, *backend_, sum, terms, thickness_);
}

Matrix LuenbergerRecursion::error_noise() const {
  Matrix N(Ao_.rows(), W_generators_.cols() + V_generators_.cols());
  N << product(Bw_, W_generators_), product(minus_LDv_, V_generators_);
  return N;
}

/// Half widths of Δ, the part of y that ranges of sensors and the radii of C leave open.
Vector LuenbergerRecursion::output_widths(const Enclosure& X, const Vector& largest,
                                          VectorIn u) const {
  Vector widths = interval_spread(C_radius_, largest, C_.rows());
  if (sensor_radius_.size() != 0) {
    const Vector outputs = largest_entries(
        backend_->affine_map(X, raw_C_, Vector::Zero(raw_C_.rows()))->interval_hull());
    const Vector reach = outputs + product(raw_D_, u.cwiseAbs());
    widths += (sensor_radius_.array() > 0).select(sensor_radius_.cwiseProduct(reach), 0.0).matrix();
  }
  return widths;
}

Vector LuenbergerRecursion::open_outputs(const Enclosure& X, VectorIn u) const {
  const bool by_C = C_radius_.size() != 0;
  if (!by_C && sensor_radius_.size() == 0) return {};
  return output_widths(X, by_C ? largest_entries(X->interval_hull()) : Vector(X->dim()), u);
}

void LuenbergerRecursion::add_open(Summands& to, Target target, const Enclosure& X, VectorIn u,
                                   bool twice) const {
  const bool state = target == Target::state;
  const auto add = [&](const Matrix& T, const Enclosure& set, const Vector& widths) {
    to.terms.push_back({T, set});
    if (twice) to.terms.push_back({T, set});
    if (to.half_widths.size() == 0) to.half_widths = Vector::Zero(T.rows());
    to.half_widths += T.cwiseAbs() * widths;
  };
  if (!ranged_.empty()) {
    to.inputs = (state ? ranges_ : output_ranges_) * u(ranged_).asDiagonal();
    add(to.inputs, unit_, Vector::Ones(to.inputs.cols()));
  }
  const bool by_A = state && A_radius_.size() != 0, by_B = state && B_radius_.size() != 0,
             by_C = C_radius_.size() != 0;
  const Vector largest = by_A || by_C ? largest_entries(X->interval_hull()) : Vector(X->dim());
  if (by_A || by_B) {
    const Vector inputs = most_f_.cwiseProduct(u.cwiseAbs());
    const Vector widths = interval_spread(A_radius_, largest, A_.rows()) +
                          interval_spread(B_radius_, inputs, A_.rows());
    to.parameters = backend_->box({-widths, widths});
    add(state_unit_, to.parameters, widths);
  }
  if (by_C || sensor_radius_.size() != 0) {
    const Vector widths = output_widths(X, largest, u);
    to.outputs = backend_->box({-widths, widths});
    add(state ? minus_L_ : output_unit_, to.outputs, widths);
  }
}

Enclosure LuenbergerRecursion::next(const Enclosure& X, const Sample& now, Vector* open,
                                    const Box* hull) const {
  Summands summands;
  summands.terms.reserve(6);
  summands.terms.push_back({minus_LDv_, V_});
  summands.terms.push_back({Bw_, W_});
  add_open(summands, Target::state, X, now.u, false);
  Vector shift = L_.lazyProduct(now.y);
  shift += input_.lazyProduct(now.u);
  const std::optional<RoundingRoom> room = room_of(X, shift, now, hull);
  if (room && room->is_needed()) {
    summands.terms.push_back(room->term());
    if (summands.half_widths.size() == 0) summands.half_widths = Vector::Zero(shift.size());
    summands.half_widths += room->half_widths();
  }
  if (open) *open = std::move(summands.half_widths);
  return backend_->predict(X, {Ao_, shift, summands.terms});
}

Enclosure LuenbergerRecursion::residual(const Enclosure& X, const Sample& now) const {
  Summands summands;
  summands.terms.reserve(3);
  summands.terms.push_back({minus_Dv_, V_});
  add_open(summands, Target::output, X, now.u, false);
  return backend_->predict(X, {minus_C_, now.y - product(output_input_, now.u), summands.terms});
}

Vector LuenbergerRecursion::next(VectorIn x, const Sample& now) const {
  return product(Ao_, x) + product(L_, now.y) + product(input_, now.u) + w_;
}

Vector LuenbergerRecursion::residual(VectorIn x, const Sample& now) const {
  Vector rest = now.y;
  rest -= output_input_.lazyProduct(now.u);
  rest -= C_.lazyProduct(x);
  rest -= v_;
  return rest;
}

Vector LuenbergerRecursion::next_size(VectorIn x, const Sample& now) const {
  return x_terms_ * x.cwiseAbs() + y_terms_ * now.y.cwiseAbs() + u_terms_ * now.u.cwiseAbs() +
         w_.cwiseAbs();
}

Vector LuenbergerRecursion::residual_size(VectorIn s, const Sample& now) const {
  return now.y.cwiseAbs() + output_input_.cwiseAbs() * now.u.cwiseAbs() + C_.cwiseAbs() * s +
         noise_terms_;
}

Enclosure LuenbergerRecursion::explained_outputs(const Enclosure& E, VectorIn x,
                                                 const Sample& now) const {
  Summands summands;
  summands.terms.reserve(2);
  const bool needs_X = sensor_radius_.size() != 0 || C_radius_.size() != 0;
  const Enclosure X = needs_X ? backend_->affine_map(E, state_unit_, x) : E;
  add_open(summands, Target::output, X, now.u, false);
  const RoundingRoom room(*backend_, residual_size(x, now));  // of y - D u - C x
  if (room.is_needed()) summands.terms.push_back(room.term());
  return backend_->predict(V0_, {minus_Dv_, residual(x, now), summands.terms});
}

Enclosure LuenbergerRecursion::errors_within(const Enclosure& E, const Enclosure& outputs,
                                             const Matrix* strip_gain) const {
  const Index n = C_.cols(), p = C_.rows();
  if (!strip_gain) {
    const Matrix minus = -Matrix::Identity(p, p);
    return backend_->correct(E, {C_, Vector::Zero(p), {minus, outputs}});
  }
  const Matrix rest = Matrix::Identity(n, n) - product(*strip_gain, C_);
  const Term term{*strip_gain, outputs};
  return backend_->predict(E, {rest, Vector::Zero(n), {&term, 1}});
}

Enclosure LuenbergerRecursion::next_bound(const Enclosure& E, const Enclosure& X,
                                          const Sample& now) const {
  Summands summands;
  summands.terms.reserve(10);
  const Matrix LDv = -minus_LDv_;
  for (const Matrix* T : {&LDv, &minus_LDv_}) summands.terms.push_back({*T, V0_});
  for (const Matrix* T : {&Bw_, &minus_Bw_}) summands.terms.push_back({*T, W0_});
  add_open(summands, Target::state, X, now.u, true);
  return backend_->predict(E, {Ao_, Vector::Zero(Ao_.rows()), summands.terms});
}

Enclosure LuenbergerRecursion::residual_bound(const Enclosure& E, const Enclosure& X,
                                              const Sample& now) const {
  Summands summands;
  summands.terms.reserve(6);
  for (const Matrix* T : {&Dv_, &minus_Dv_}) summands.terms.push_back({*T, V0_});
  add_open(summands, Target::output, X, now.u, true);
  return backend_->predict(E, {C_, Vector::Zero(C_.rows()), summands.terms});
}

}  // namespace cordon::estimators
