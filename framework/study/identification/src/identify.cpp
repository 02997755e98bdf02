// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/identify.hpp"

#include "cordon/core/error.hpp"
#include "study/identification/scaling_program.hpp"
#include "study/identification/scaling_proof.hpp"

namespace cordon {

namespace {

constexpr double proven_enough = 1e-7;  ///< short of the factor found: what the solver rounds

/// Those of the program's rows; μ as they are, and p with the other sign.
identification::Multipliers multipliers_of(const Model& model, const Vector& y,
                                           const std::vector<std::vector<Index>>& output_rows,
                                           const std::vector<Index>& step_rows) {
  const LinearModel& linear = model.linear;
  const Index count = std::ssize(output_rows), n = linear.states();
  identification::Multipliers made{Matrix::Zero(linear.outputs(), count),
                                   Matrix::Zero(linear.is_descriptor() ? n : 0, count)};
  for (Index k = 0; k < count; ++k) {
    for (Index i = 0; i < linear.outputs(); ++i) {
      const Index row = output_rows[as_size(k)][as_size(i)];
      if (row >= 0) made.outputs(i, k) = y[row];
    }
    const Index step = step_rows[as_size(k)];
    if (linear.is_descriptor() && step >= 0) made.steps.col(k) = -y.segment(step, n);
  }
  return made;
}

bool is_zonotope(const LineForm& X) { return X.lines() == 0 && X.constraints() == 0; }

}  // namespace

std::string why_not_identified(const Model& model) {
  if (!model.is_linear()) return "the system is written as formulas";
  if (model.region) return "the model is proven in a region, which data may leave";
  if (model.linear.is_uncertain() || model.linear.has_ranges())
    return "matrices of the system are known by intervals";
  if (!is_zonotope(model.W)) return "W is no zonotope, which generators with factors would be";
  if (!is_zonotope(model.V)) return "V is no zonotope, which generators with factors would be";
  if (model.X0.constraints() > 0) return "X0 has constraints";
  return "";
}

BoundFactors identify_bounds(const Model& model, std::span<const Sample> samples,
                             const IdentifyOptions& options) {
  if (const std::string why = why_not_identified(model); !why.empty())
    throw Error(Errc::unsupported, "bounds are not identified: " + why);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].k != samples[i - 1].k + 1)
      throw Error(Errc::invalid, "bounds are identified from samples that follow each other");
  }
  const identification::Factors factors = identification::factors_of(model, options.scaled);
  BoundFactors found;
  found.disturbances = Vector::Ones(model.W.generators());
  found.noises = Vector::Ones(model.V.generators());
  const auto [program, output_rows, step_rows] =
      identification::scaling_program(model, samples, factors);
  const LinearProgram::Solution solution = minimize(program, options.seconds);
  if (solution.status == LinearProgram::Status::infeasible)
    found.status = BoundFactors::Status::none;
  if (solution.status != LinearProgram::Status::optimal) return found;
  found.status = BoundFactors::Status::found;
  found.cost = std::max(0.0, solution.objective);
  const auto take = [&](const std::vector<Index>& of, Vector& values) {
    for (Index j = 0; j < values.size(); ++j)
      if (of[as_size(j)] >= 0) values[j] = std::max(0.0, solution.x[of[as_size(j)]]);
  };
  take(factors.of_disturbances, found.disturbances);
  take(factors.of_noises, found.noises);
  const identification::Multipliers multipliers =
      multipliers_of(model, solution.y, output_rows, step_rows);
  const auto proof = identification::scaling_proof(model, samples, factors, multipliers,
                                                   (1 - proven_enough) * found.cost);
  if (!proof) return found;
  found.proven = proof->least;
  for (const Index place : proof->samples) {
    found.required_by.push_back(samples[as_size(place)].k);
    found.weights.push_back(multipliers.outputs.col(place).cwiseAbs().sum());
  }
  return found;
}

LineForm with_factors(const LineForm& zonotope, VectorIn factors) {
  return make_zonotope(zonotope.c, zonotope.G * factors.asDiagonal());
}

}  // namespace cordon
