// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"

namespace cordon {

namespace {

void check(const Box& effectiveness, Index size, const char* of) {
  if (effectiveness.lower.size() != size || effectiveness.upper.size() != size) {
    throw Error(Errc::dimension, std::string("the effectiveness of the ") + of + " has " +
                                     std::to_string(effectiveness.dim()) +
                                     " entries, the model has " + std::to_string(size) + " " + of);
  }
  const bool inside =
      (effectiveness.lower.array() >= 0).all() && (effectiveness.upper.array() <= 1).all();
  if (!inside || !(effectiveness.lower.array() <= effectiveness.upper.array()).all()) {
    throw Error(Errc::invalid, std::string("the effectiveness of the ") + of +
                                   " must lie in [0, 1], lower bounds first");
  }
}

/// The exact entries, 1 in place of ranges; they become 1 in the box, which is emptied if no range
/// is left.
Vector take_exact(Box& effectiveness) {
  Vector factors = Vector::Ones(effectiveness.dim());
  bool ranges = false;
  for (Index i = 0; i < factors.size(); ++i) {
    if (effectiveness.lower[i] != effectiveness.upper[i]) {
      ranges = true;
    } else {
      factors[i] = effectiveness.lower[i];
      effectiveness.lower[i] = effectiveness.upper[i] = 1;
    }
  }
  if (!ranges) effectiveness = {};
  return factors;
}

/// Is fl(a b) = a b? In doubt no.
bool is_exact(double a, double b) {
  constexpr double smallest = 1e-290;  // below, the error itself may be no double
  const double product = a * b;
  return a == 0 || b == 0 || (std::abs(product) >= smallest && std::fma(a, b, -product) == 0);
}

/// Are the products of diag(g) M diag(f) exact, one after the other as they are taken? A vector
/// without entries stands for ones.
bool is_exact(const Vector& g, const Matrix& M, const Vector& f) {
  for (Index i = 0; i < M.rows(); ++i) {
    for (Index j = 0; j < M.cols(); ++j) {
      if (f.size() != 0 && !is_exact(M(i, j), f[j])) return false;
      if (g.size() != 0 && !is_exact(g[i], f.size() != 0 ? M(i, j) * f[j] : M(i, j))) return false;
    }
  }
  return true;
}

}  // namespace

LinearModel with_exact_effectiveness_applied(LinearModel model) {
  Vector f, g;
  if (model.actuator.dim() != 0) {
    check(model.actuator, model.inputs(), "actuators");
    f = take_exact(model.actuator);
  }
  if (model.sensor.dim() != 0) {
    check(model.sensor, model.outputs(), "sensors");
    g = take_exact(model.sensor);
  }
  if (!is_exact({}, model.B, f) || !is_exact(g, model.C, {}) || !is_exact(g, model.D, f)) {
    const auto ones_if_none = [](const Vector& factors, Index size) {
      return factors.size() ? factors : Vector::Ones(size);
    };
    model.unscaled = std::make_shared<LinearModel::Unscaled>(
        LinearModel::Unscaled{model.B, model.C, model.D, ones_if_none(f, model.inputs()),
                              ones_if_none(g, model.outputs())});
  }
  if (f.size() != 0) {
    model.B = model.B * f.asDiagonal();
    model.D = model.D * f.asDiagonal();
    if (model.B_radius.size() != 0) model.B_radius = model.B_radius * f.asDiagonal();
  }
  if (g.size() != 0) {
    model.C = g.asDiagonal() * model.C;
    model.D = g.asDiagonal() * model.D;
    if (model.C_radius.size() != 0) model.C_radius = g.asDiagonal() * model.C_radius;
  }
  return model;
}

std::vector<Index> present_outputs(const Sample& sample) {
  std::vector<Index> present;
  auto absent = sample.missing.begin();
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (absent != sample.missing.end() && *absent == i) {
      ++absent;
    } else {
      present.push_back(i);
    }
  }
  return present;
}

Sample missing_outputs(Sample sample, const std::vector<Index>& outputs) {
  std::vector<Index> missing;
  std::set_union(sample.missing.begin(), sample.missing.end(), outputs.begin(), outputs.end(),
                 std::back_inserter(missing));
  for (const Index i : outputs) sample.y[i] = std::numeric_limits<double>::quiet_NaN();
  sample.missing = std::move(missing);
  return sample;
}

Sample without_missing(const Sample& sample) {
  return {sample.k, sample.u, sample.y(present_outputs(sample))};
}

LinearModel with_outputs(const LinearModel& model, const std::vector<Index>& outputs) {
  LinearModel m = model;
  const auto keep = [&](Matrix& M) { M = Matrix(M(outputs, Eigen::all)); };
  for (Matrix* M : {&m.C, &m.D, &m.Dv}) keep(*M);
  if (m.C_radius.size() != 0) keep(m.C_radius);
  if (m.sensor.dim() != 0) m.sensor = {m.sensor.lower(outputs), m.sensor.upper(outputs)};
  if (!model.unscaled) return m;
  LinearModel::Unscaled unscaled = *model.unscaled;
  for (Matrix* M : {&unscaled.C, &unscaled.D}) keep(*M);
  unscaled.sensor = Vector(unscaled.sensor(outputs));
  m.unscaled = std::make_shared<LinearModel::Unscaled>(std::move(unscaled));
  return m;
}

Index Model::states() const { return nonlinear ? nonlinear->states() : linear.states(); }
Index Model::inputs() const { return nonlinear ? nonlinear->inputs : linear.inputs(); }
Index Model::outputs() const { return nonlinear ? nonlinear->outputs() : linear.outputs(); }
Index Model::noises() const { return nonlinear ? nonlinear->noises() : linear.noises(); }
Index Model::disturbances() const {
  return nonlinear ? nonlinear->disturbances() : linear.disturbances();
}

Model with_outputs(const Model& model, const std::vector<Index>& outputs) {
  if (model.nonlinear) throw Error(Errc::unsupported, "outputs of formulas are not left out");
  return {with_outputs(model.linear, outputs), model.X0, model.W, model.V, model.U};
}

}  // namespace cordon
