// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/inner_envelope.hpp"

#include <random>

#include "cordon/core/linalg.hpp"
#include "observer_parameters.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;

constexpr std::int64_t most_samples = 10'000, most_seed = std::int64_t{1} << 53;

bool is_plain(const LineForm& X) { return X.lines() == 0 && X.constraints() == 0; }

Matrix or_zero(const Matrix& radius, Index rows, Index cols) {
  return radius.size() ? radius : Matrix::Zero(rows, cols);
}

}  // namespace

void InnerEnvelope::add_parameters(ParamSchema& schema) {
  schema.integer("inner_samples",
                 "random constant matrices, besides centre and ends, for the inner estimate of "
                 "what has to be enclosed; 0: none",
                 0, 0, most_samples);
  schema.integer("inner_seed", "seed of these matrices", 1, 0, most_seed);
}

void InnerEnvelope::check(const ObserverContext& context, const Params& params,
                          std::vector<Diagnostic>& problems) {
  if (params.integer("inner_samples") == 0) return;
  if (!is_plain(initial_set_from(context.model, params)) || !is_plain(context.model.W) ||
      !is_plain(context.model.V)) {
    problems.push_back(
        {"/inner_samples",
         "an inner estimate needs zonotopes, and the initial set, W or V has constraints or lines",
         "leave it out, or give these sets by a centre and generators, or by bounds"});
  }
}

InnerEnvelope::InnerEnvelope(const Model& model, const Matrix& L, const Params& params) : L_(L) {
  const std::int64_t samples = params.integer("inner_samples");
  if (samples == 0) return;
  const LinearModel& m = model.linear;
  const Matrix LDv = product(L, m.Dv);
  noises_.resize(m.states(), model.W.generators() + model.V.generators());
  noises_ << product(m.Bw, model.W.G), product(LDv, model.V.G);
  drift_ = product(m.Bw, model.W.c) - product(LDv, model.V.c);
  const Matrix A = or_zero(m.A_radius, m.states(), m.states()),
               B = or_zero(m.B_radius, m.states(), m.inputs()),
               C = or_zero(m.C_radius, m.outputs(), m.states());
  add(model, L, 0 * A, 0 * B, 0 * C);
  if (!m.is_uncertain()) return;
  add(model, L, A, B, -C);
  add(model, L, -A, -B, C);
  std::mt19937_64 engine(static_cast<std::uint64_t>(params.integer("inner_seed")));
  std::uniform_real_distribution<double> factor(-1, 1);
  const auto drawn = [&](const Matrix& radius) {
    return Matrix(radius.unaryExpr([&](double r) { return r * factor(engine); }));
  };
  for (std::int64_t i = 0; i < samples; ++i) {
    const Matrix dA = drawn(A), dB = drawn(B), dC = drawn(C);
    add(model, L, dA, dB, dC);
  }
}

void InnerEnvelope::add(const Model& model, const Matrix& L, const Matrix& dA, const Matrix& dB,
                        const Matrix& dC) {
  const LinearModel& m = model.linear;
  const Vector g = m.sensor_center(), f = m.actuator_center();
  const Matrix C = g.asDiagonal() * (m.C + dC), D = g.asDiagonal() * m.D;
  copies_.push_back(
      {m.A + dA - product(L, C), (m.B + dB - product(L, D)) * f.asDiagonal(), {}, {}, {}});
}

void InnerEnvelope::start(const LineForm& X0) {
  running_ = is_on() && is_plain(X0);
  if (!running_) return;
  G0_ = X0.G;
  for (Copy& copy : copies_) {
    copy.power = Matrix::Identity(X0.dim(), X0.dim());
    copy.center = X0.c;
    copy.noise = Vector::Zero(X0.dim());
  }
}

void InnerEnvelope::step(const Sample& before) {
  if (!before.is_complete()) end();  // the gain's columns would have to vary
  if (!running_) return;
  const Vector measured = product(L_, before.y) + drift_;
  for (Copy& copy : copies_) {
    copy.center = product(copy.A, copy.center) + product(copy.B, before.u) + measured;
    copy.noise += product(copy.power, noises_).cwiseAbs().rowwise().sum();
    copy.power = product(copy.A, copy.power);
  }
}

std::optional<Box> InnerEnvelope::hull() const {
  if (!running_) return std::nullopt;
  std::optional<Box> hull;
  for (const Copy& copy : copies_) {
    const Vector radius = product(copy.power, G0_).cwiseAbs().rowwise().sum() + copy.noise;
    const Vector lower = copy.center - radius, upper = copy.center + radius;
    hull = hull ? Box{hull->lower.cwiseMin(lower), hull->upper.cwiseMax(upper)} : Box{lower, upper};
  }
  return hull;
}

void InnerEnvelope::serialize(Archive& archive) {
  archive(running_);
  if (!running_) return;
  if (!is_on()) archive.refuse("an inner estimate that was not asked for");
  archive(G0_);
  const Index n = copies_.front().A.rows();
  if (G0_.rows() != n) archive.refuse("generators of another dimension");
  for (Copy& copy : copies_) {
    archive(copy.power, copy.center, copy.noise);
    if (copy.power.rows() != n || copy.power.cols() != n || copy.center.size() != n ||
        copy.noise.size() != n)
      archive.refuse("an inner estimate of another dimension");
  }
}

}  // namespace cordon::estimators
