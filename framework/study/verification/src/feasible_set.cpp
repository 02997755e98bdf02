// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/feasible_set.hpp"

#include <string>

#include "cordon/core/error.hpp"
#include "study/checks/equations.hpp"
#include "study/data/random.hpp"

namespace cordon::verification {

namespace {

constexpr int most_draws = 6;
constexpr double almost_all = 0.999;  // of a radius: no rounding leads out of the interval

Vector zero_vector(Index n) { return Vector::Zero(n); }

/// T x as a polytope of one point: the product is exact there.
Polytope image(MatrixIn T, VectorIn x) {
  return Polytope::from_generators(x).affine_map(T, zero_vector(T.rows()));
}

Matrix identity(Index n) { return Matrix::Identity(n, n); }

void expect_digits(const Polytope& P) {
  if (P.bits() <= most_bits) return;
  throw Error(Errc::unsupported, "the numbers of the exact set have " + std::to_string(P.bits()) +
                                     " binary digits; at most " + std::to_string(most_bits) +
                                     " are supported");
}

}  // namespace

FeasibleSets::FeasibleSets(const Model& model, const LineForm& initial_set,
                           const std::optional<LineForm>& admissible_set)
    : model_(model.linear),
      E_(model.linear.is_descriptor() ? model.linear.E : identity(model.linear.states())),
      initial_(Polytope::from(initial_set)),
      admissible_(admissible_set ? std::optional(Polytope::from(*admissible_set)) : std::nullopt),
      disturbance_(
          Polytope::from(model.W).affine_map(model.linear.Bw, zero_vector(model.linear.states()))),
      minus_disturbance_(
          Polytope::from(model.W).affine_map(-model.linear.Bw, zero_vector(model.linear.states()))),
      minus_noise_(Polytope::from(model.V).affine_map(-model.linear.Dv,
                                                      zero_vector(model.linear.outputs()))) {}

/// C x ∈ {y} ⊕ {-D u} ⊕ (-Dv V).
Polytope FeasibleSets::measured(const LinearModel& m, const Polytope& X, const Sample& now) const {
  const std::vector<Index> present = present_outputs(now);
  if (present.empty()) return X;
  if (now.is_complete()) {
    const Polytope target = minus_noise_.minkowski_sum(Polytope::from_generators(now.y))
                                .minkowski_sum(image(-m.D, now.u));
    return X.intersection(m.C, target);
  }
  const LinearModel others = with_outputs(m, present);
  const Index p = others.outputs();
  const Polytope minus_noise =
      minus_noise_.affine_map(identity(m.outputs())(present, Eigen::all), zero_vector(p));
  const Polytope target = minus_noise.minkowski_sum(Polytope::from_generators(now.y(present)))
                              .minkowski_sum(image(-others.D, now.u));
  return X.intersection(others.C, target);
}

/// {x : E x ∈ A P_{k-1} ⊕ {B u_{k-1}} ⊕ Bw W}.
Polytope FeasibleSets::next(const LinearModel& m) const {
  const Polytope f = P_->affine_map(m.A, zero_vector(m.states()))
                         .minkowski_sum(image(m.B, before_->u))
                         .minkowski_sum(disturbance_);
  if (!m.is_descriptor()) return f;
  if (E_.as_written) return f.preimage(E_.left, zero_vector(m.states()));
  return f.preimage(E_.left, zero_vector(m.states()))
      .affine_map(E_.core, zero_vector(E_.rank))
      .preimage(E_.right, zero_vector(E_.rank));
}

/// P_k with the matrices of `m`.
Polytope FeasibleSets::reached(const LinearModel& m, const Sample& now) const {
  Polytope P = P_ ? next(m) : initial_;
  if (admissible_) P = P.intersection(*admissible_);
  return measured(m, P, now);
}

Polytope FeasibleSets::step(const Sample& now) {
  const Index n = model_.states();
  Polytope P = reached(drawn(model_, now.k, 0), now);
  for (int draw = 1; model_.is_uncertain() && draw < most_draws && P.is_empty(); ++draw) {
    P = reached(drawn(model_, now.k, draw), now);
  }
  expect_digits(P);
  P_ = std::move(P);
  before_ = now;
  if (!model_.is_descriptor()) return *P_;
  const Polytope range = Polytope::from_generators(zero_vector(n), Matrix(n, 0), E_.left);
  const Polytope target =
      minus_disturbance_.minkowski_sum(image(-model_.B, now.u)).minkowski_sum(range);
  return P_->intersection(model_.A, target);
}

Polytope FeasibleSets::narrowed(const Polytope& F, const std::deque<Sample>& samples) const {
  const Index n = model_.states();
  Polytope later = Polytope::space(n);
  for (std::size_t j = samples.size() - 1; j > 0; --j) {
    later = measured(model_, later, samples[j])
                .minkowski_sum(minus_disturbance_)
                .minkowski_sum(image(-model_.B, samples[j - 1].u))
                .preimage(model_.A, zero_vector(n));
    expect_digits(later);
  }
  return F.intersection(later);
}

LinearModel drawn(const LinearModel& model, Index k, int draw) {
  LinearModel m = model;
  if (!model.is_uncertain() || model.is_descriptor() || draw == 1) return m;
  detail::RandomStream random(static_cast<std::uint64_t>(draw), detail::Purpose::direction,
                              static_cast<std::uint64_t>(k));
  for (const auto& [center, radius] :
       {std::pair(&m.A, &model.A_radius), {&m.B, &model.B_radius}, {&m.C, &model.C_radius}}) {
    for (Index j = 0; j < radius->cols(); ++j) {
      for (Index i = 0; i < radius->rows(); ++i)
        (*center)(i, j) += random.sign() * almost_all * (*radius)(i, j);
    }
  }
  return m;
}

LineForm successors(const Model& model, const LineForm& X,
                    const std::optional<LineForm>& admissible_set, const Transition& transition) {
  const LinearModel& m = model.linear;
  const Index n = m.states();
  const DescriptorMatrix E(m.is_descriptor() ? m.E : identity(n));
  Equations rows;
  const auto measured = [&](const Equations::Line& x, const Sample& sample) {
    const Equations::Line u = rows.constant(sample.u);
    const std::vector<Index> present = present_outputs(sample);
    const LinearModel seen = with_outputs(m, present);
    const Equations::Line y = rows.constant(sample.y(present)), v = rows.element(model.V);
    rows.add(seen.outputs(),
             {{y, identity(seen.outputs())}, {x, -seen.C}, {u, -seen.D}, {v, -seen.Dv}});
    return u;
  };
  const auto follows = [&](const Equations::Line& next, const Equations::Line& x,
                           const Equations::Line& u) {
    const Equations::Line w = rows.element(model.W);
    rows.add(n, {rows.product(E, next), {x, -m.A}, {u, -m.B}, {w, -m.Bw}});
  };
  Equations::Line x = rows.element(X);
  if (transition.before) {
    const Equations::Line u = measured(x, *transition.before), next = rows.line(n);
    follows(next, x, u);
    x = next;
  }
  const Equations::Line u = measured(x, transition.now);
  if (m.is_descriptor()) follows(rows.line(n), x, u);
  if (admissible_set) {
    const Equations::Line kept = rows.element(*admissible_set);
    rows.add(n, {{x, identity(n)}, {kept, -identity(n)}});
  }
  return rows.project(x);
}

Model widened(Model model, const Vector& radius) {
  const Index p = radius.size();
  Matrix Dv(p, model.linear.noises() + p);
  Dv << model.linear.Dv, Matrix::Identity(p, p);
  model.linear.Dv = Dv;
  model.V = cartesian_product(model.V, make_box({-radius, radius}));
  return model;
}

LineForm widened(LineForm X, double part) {
  const double share = part * rounding_share;
  const Index n = X.dim(), m = X.constraints(), g = X.generators();
  const Vector rows = share * (X.b.cwiseAbs() + X.A.cwiseAbs().rowwise().sum());
  const Vector coordinates = share * (X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
  X.G.conservativeResize(n, g + n + m);
  X.G.rightCols(n + m).setZero();
  X.G.middleCols(g, n) = coordinates.asDiagonal();
  X.A.conservativeResize(m, g + n + m);
  X.A.rightCols(n + m).setZero();
  X.A.rightCols(m) = rows.asDiagonal();
  return X;
}

}  // namespace cordon::verification
