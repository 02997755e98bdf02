// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/error_dynamics.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::estimators {

namespace {

using linalg::product;
using sets::Zonotope;

/// Columns of a zonotope, block by block.
class Columns {
 public:
  explicit Columns(Index rows) : zonotope_{Vector::Zero(rows), Matrix(rows, 0)} {}
  void shift(const Vector& center) { zonotope_.c += center; }
  void add(const Matrix& block) {
    const Index old = zonotope_.G.cols();
    zonotope_.G.conservativeResize(Eigen::NoChange, old + block.cols());
    zonotope_.G.rightCols(block.cols()) = block;
  }
  Zonotope take() { return sets::drop_zero_generators(zonotope_); }

 private:
  Zonotope zonotope_;
};

Matrix stacked_rows(const Matrix& top, const Matrix& bottom) {
  Matrix T(top.rows() + bottom.rows(), top.cols());
  T << top, bottom;
  return T;
}

/// Adds P f_i u - O f_j u for u in its box. One factor per input for u, and what the ranges of f
/// leave open: one column per input, since every entry of f varies on its own.
void add_inputs(Columns& to, const Matrix& P, const ModeDynamics& plant, const Matrix& O,
                const ModeDynamics& observer, bool separate) {
  const Matrix plant_mid = P * plant.f.asDiagonal(), observer_mid = O * observer.f.asDiagonal();
  const Vector& center = plant.u;
  const Vector& radius = plant.u_rad;
  to.shift(product(plant_mid - observer_mid, center));
  const Matrix plant_open = P * plant.f_rad.asDiagonal(),
               observer_open = O * observer.f_rad.asDiagonal();
  if (separate) {
    to.add(plant_mid * radius.asDiagonal());
    to.add(plant_open * radius.asDiagonal());
    to.add(plant_open * center.asDiagonal());
    to.add(observer_mid * radius.asDiagonal());
    to.add(observer_open * radius.asDiagonal());
    to.add(observer_open * center.asDiagonal());
  } else {
    to.add((plant_mid - observer_mid) * radius.asDiagonal());
    to.add(plant_open * radius.asDiagonal());
    to.add(observer_open * radius.asDiagonal());
    to.add(plant_open * center.asDiagonal());
    to.add(observer_open * center.asDiagonal());
  }
}

void add_noise(Columns& to, const Matrix& T, const Zonotope& noise) {
  to.shift(product(T, noise.c));
  to.add(product(T, noise.G));
}

void add_slack(Columns& to, const Matrix& T, const Vector& half_widths) {
  if (half_widths.size() != 0) to.add(T * half_widths.asDiagonal());
}

/// Everything that drives (x, e) but x itself.
Zonotope joint_drive(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                     const SensorSlack& slack) {
  const Index n = plant.A.rows();
  const auto both = [](const Matrix& top, const Matrix& bottom) {
    return stacked_rows(top, bottom);
  };
  const auto error_only = [n](const Matrix& bottom) {
    return stacked_rows(Matrix::Zero(n, bottom.cols()), bottom);
  };
  Columns columns(2 * n);
  add_inputs(columns, both(plant.B, plant.B - product(observer.L, plant.D)), plant,
             error_only(observer.Bo), observer, separate);
  add_noise(columns, error_only(-product(observer.L, plant.Dv)), plant.V);
  add_noise(columns, error_only(product(observer.L, observer.Dv)), observer.V);
  add_noise(columns, both(plant.Bw, plant.Bw), plant.W);
  add_noise(columns, error_only(-observer.Bw), observer.W);
  add_slack(columns, error_only(-observer.L), slack.plant);
  add_slack(columns, error_only(observer.L), slack.observer);
  return columns.take();
}

Zonotope rows_of(const Zonotope& Z, Index first, Index count) {
  return sets::drop_zero_generators({Z.c.segment(first, count), Z.G.middleRows(first, count)});
}

ModeDynamics dynamics_of(const Mode& mode, const Matrix& gain) {
  const LinearModel& m = mode.model.linear;
  const std::string of = " of mode \"" + mode.name + "\"";
  if (m.is_descriptor())
    throw Error(Errc::unsupported, "offline conditions take systems without E, unlike that" + of);
  if (gain.rows() != m.states() || gain.cols() != m.outputs())
    throw Error(Errc::dimension, "the gain" + of + " has a wrong shape");
  ModeDynamics d;
  d.name = mode.name;
  d.A = m.A;
  d.B = m.B;
  d.C = m.sensor_center().asDiagonal() * m.C;
  d.D = m.sensor_center().asDiagonal() * m.D;
  d.Bw = m.Bw;
  d.Dv = m.Dv;
  d.L = gain;
  d.Ao = m.A - product(gain, d.C);
  d.Bo = m.B - product(gain, d.D);
  d.f = m.actuator_center();
  d.f_rad = m.actuator_radius();
  d.g_rad = m.sensor_radius();
  d.C_raw = m.C;
  invariant::require_schur(d.Ao, "A - L C" + of);
  d.W = invariant::enclosing_zonotope(mode.model.W, "W" + of);
  d.V = invariant::enclosing_zonotope(mode.model.V, "V" + of);
  const LineForm& U = mode.model.U;
  const Box inputs = U.dim() == m.inputs() ? interval_hull(U) : Box::space(m.inputs());
  if (inputs.is_empty()) throw Error(Errc::invalid, "U" + of + " is empty");
  if (!inputs.is_bounded())
    throw Error(Errc::unsupported,
                "the inputs" + of + " are unbounded: statements in advance need bounds of u");
  d.u = inputs.center();
  d.u_rad = inputs.radius();
  d.feedthrough = product(m.D.cwiseAbs(), (d.f + d.f_rad).cwiseProduct(d.u.cwiseAbs() + d.u_rad));
  return d;
}

}  // namespace

std::vector<ModeDynamics> dynamics_of(const ModeBank& bank, const std::vector<Matrix>& gains) {
  if (static_cast<Index>(gains.size()) != bank.size())
    throw Error(Errc::dimension, "a bank needs one gain per mode");
  std::vector<ModeDynamics> all;
  for (Index j = 0; j < bank.size(); ++j)
    all.push_back(dynamics_of(bank[j], gains[static_cast<std::size_t>(j)]));
  for (const ModeDynamics& one : all) {
    if (one.A.rows() != all[0].A.rows() || one.B.cols() != all[0].B.cols() ||
        one.C.rows() != all[0].C.rows()) {
      throw Error(Errc::dimension,
                  "mode \"" + one.name +
                      "\" has other numbers of states, inputs or outputs than mode \"" +
                      all[0].name + "\"");
    }
  }
  return all;
}

bool is_coupled(const ModeDynamics& plant, const ModeDynamics& observer) {
  return plant.A != observer.A || plant.C != observer.C;
}

Matrix state_to_error(const ModeDynamics& plant, const ModeDynamics& observer) {
  return plant.A - observer.A - product(observer.L, plant.C - observer.C);
}

Zonotope error_drive(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                     const SensorSlack& slack) {
  const Index n = plant.A.rows();
  return rows_of(joint_drive(plant, observer, separate, slack), n, n);
}

Zonotope direct_part(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                     const SensorSlack& slack) {
  const Index q = plant.C.rows();
  Columns columns(q);
  add_inputs(columns, plant.D, plant, observer.D, observer, separate);
  add_noise(columns, plant.Dv, plant.V);
  add_noise(columns, -observer.Dv, observer.V);
  add_slack(columns, Matrix::Identity(q, q), slack.plant);
  add_slack(columns, Matrix::Identity(q, q), slack.observer);
  return columns.take();
}

Zonotope plant_drive(const ModeDynamics& plant) {
  const Index n = plant.A.rows();
  return rows_of(joint_drive(plant, plant, false, {}), 0, n);
}

PairDynamics pair_dynamics(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                           const SensorSlack& slack) {
  PairDynamics pair{observer.Ao, {}, observer.C, direct_part(plant, observer, separate, slack)};
  if (!is_coupled(plant, observer)) {
    pair.drive = error_drive(plant, observer, separate, slack);
    return pair;
  }
  const Index n = plant.A.rows();
  pair.A = Matrix::Zero(2 * n, 2 * n);
  pair.A.topLeftCorner(n, n) = plant.A;
  pair.A.bottomLeftCorner(n, n) = state_to_error(plant, observer);
  pair.A.bottomRightCorner(n, n) = observer.Ao;
  pair.drive = joint_drive(plant, observer, separate, slack);
  pair.C = Matrix(plant.C.rows(), 2 * n);
  pair.C << plant.C - observer.C, observer.C;
  return pair;
}

}  // namespace cordon::estimators
