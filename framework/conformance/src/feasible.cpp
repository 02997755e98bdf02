// SPDX-License-Identifier: GPL-3.0-or-later
#include "feasible.hpp"

#include "cordon/core/error.hpp"
#include "systems.hpp"

namespace cordon::conformance {

namespace {

/// A number of the data would have to be rounded.
struct Rounded {};

class Feasible {
 public:
  explicit Feasible(const Model& model)
      : m_(model.linear),
        disturbance_(Polytope::from(model.W).affine_map(m_.Bw, Vector::Zero(m_.states()))),
        noise_(Polytope::from(model.V)) {}

  Polytope reached(const Polytope& X, const Vector& u) const {
    return X.affine_map(m_.A, forced(u)).minkowski_sum(disturbance_);
  }
  Polytope measured(const Polytope& X, const Sample& sample) const {
    const std::vector<Index> rows = present_outputs(sample);
    if (rows.empty()) return X;
    const Vector y = exact(
        [&](ExactSums& sums) { return sums.sum(sample.y, -sums.product(m_.D, sample.u)); }, rows);
    const Matrix C = m_.C(rows, Eigen::all), Dv = m_.Dv(rows, Eigen::all);
    return X.intersection(C, noise_.affine_map(-Dv, y));
  }
  /// States that have a successor in X.
  Polytope before(const Polytope& X, const Vector& u) const {
    const Index n = m_.states();
    const Polytope minus = disturbance_.affine_map(-Matrix::Identity(n, n), Vector::Zero(n));
    return X.minkowski_sum(minus).preimage(m_.A, forced(u));
  }

 private:
  template <class Compute>
  static Vector exact(Compute&& compute, const std::vector<Index>& rows) {
    ExactSums sums;
    const Vector all = compute(sums), result = all(rows);
    if (!sums.exact()) throw Rounded{};
    return result;
  }
  Vector forced(const Vector& u) const {
    ExactSums sums;
    Vector f = sums.product(m_.B, u);
    if (!sums.exact()) throw Rounded{};
    return f;
  }

  const LinearModel& m_;
  Polytope disturbance_, noise_;
};

template <class Compute>
std::optional<Polytope> attempted(const Model& model, Compute&& compute) {
  if (!model.is_linear() || model.linear.is_descriptor() || model.linear.is_uncertain())
    return std::nullopt;
  try {
    return compute(Feasible(model));
  } catch (const Rounded&) {
    return std::nullopt;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return std::nullopt;
  }
}

}  // namespace

std::optional<Polytope> feasible_states(const Model& model, const LineForm& X0,
                                        const std::vector<Sample>& samples, std::size_t at) {
  return attempted(model, [&](const Feasible& of) {
    Polytope X = of.measured(Polytope::from(X0), samples.front());
    for (std::size_t k = 1; k <= at; ++k)
      X = of.measured(of.reached(X, samples[k - 1].u), samples[k]);
    Polytope later = Polytope::space(X.dim());
    for (std::size_t k = samples.size() - 1; k > at; --k)
      later = of.before(of.measured(later, samples[k]), samples[k - 1].u);
    return X.intersection(later);
  });
}

std::optional<Polytope> feasible_successors(const Model& model, const LineForm& X,
                                            const Sample& before, const Sample& now) {
  return attempted(model, [&](const Feasible& of) {
    const Polytope allowed = of.measured(Polytope::from(X), before);
    return of.measured(of.reached(allowed, before.u), now);
  });
}

}  // namespace cordon::conformance
