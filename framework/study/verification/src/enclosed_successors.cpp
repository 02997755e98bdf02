// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/enclosed_successors.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"

namespace cordon::verification {

namespace {

/// Errors are sums of a few products of numbers that are not negative: this covers their own
/// rounding.
constexpr double rounded_up = 1 + 1e-10;

Vector zeros(Index n) { return Vector::Zero(n); }

/// Known up to `center` and `rows`.
struct Rounded {
  LineForm set;
  Vector center, rows;
};

Rounded exactly(LineForm X) {
  Vector center = zeros(X.dim()), rows = zeros(X.constraints());
  return {std::move(X), std::move(center), std::move(rows)};
}

/// Of the rows of T X: what c was off by, and the products with c and G.
Vector image_errors(MatrixIn T, const Rounded& X) {
  Vector errors = linalg::product(T.cwiseAbs(), X.center) + rounding::product_error(T, X.set.c);
  if (X.set.generators() > 0) errors += rounding::product_error(T, X.set.G).rowwise().sum();
  return errors * rounded_up;
}

Rounded image(MatrixIn T, const Rounded& X) {
  return {affine_map(X.set, T, zeros(T.rows())), image_errors(T, X), X.rows};
}

Vector joined(const Vector& x, const Vector& y) {
  Vector both(x.size() + y.size());
  both << x, y;
  return both;
}

Rounded sum(const Rounded& X, const Rounded& Y) {
  LineForm Z = minkowski_sum(X.set, Y.set);
  const Vector last = (2 * rounding::unit * Z.c.cwiseAbs()).array() + rounding::tiny;
  return {std::move(Z), (X.center + Y.center + last) * rounded_up, joined(X.rows, Y.rows)};
}

/// {x ∈ X : R x ∈ Y}. The intersection takes a difference of centres that is noise for 0.
Rounded restricted(const Rounded& X, MatrixIn R, const Rounded& Y) {
  constexpr double noise = 1.1e-14;
  const Vector terms = Y.set.c.cwiseAbs() + linalg::product(R.cwiseAbs(), X.set.c.cwiseAbs());
  const Vector errors = (image_errors(R, X) + Y.center + noise * terms) * rounded_up;
  return {intersection(X.set, R, Y.set), X.center, joined(joined(X.rows, Y.rows), errors)};
}

Rounded enclosed(const Model& model, const LineForm& X,
                 const std::optional<LineForm>& admissible_set, const Transition& transition) {
  const LinearModel& m = model.linear;
  const Index n = m.states();
  const Rounded disturbance = image(m.Bw, exactly(model.W));
  const auto measured = [&](const Rounded& x, const Sample& sample) {
    const std::vector<Index> present = present_outputs(sample);
    if (present.empty()) return x;
    const LinearModel seen = with_outputs(m, present);
    const Rounded y = exactly(make_point(sample.y(present))), u = exactly(make_point(sample.u)),
                  noise = image(-seen.Dv, exactly(model.V));
    return restricted(x, seen.C, sum(sum(y, image(-seen.D, u)), noise));
  };
  const auto driven = [&](const Sample& sample) {
    return sum(image(m.B, exactly(make_point(sample.u))), disturbance);
  };
  Rounded x = exactly(X);
  if (transition.before) {
    const Rounded f = sum(image(m.A, measured(x, *transition.before)), driven(*transition.before));
    x = m.is_descriptor() ? restricted(exactly(make_space(n)), m.E, f)
                          : f;  // its lines are the columns of the identity
  }
  x = measured(x, transition.now);
  if (m.is_descriptor()) {  // A x + B u + Bw w is reached by some E z
    const Rounded values = exactly(affine_map(make_space(n), m.E, zeros(n)));
    x = restricted(x, m.A, sum(values, image(-Matrix::Identity(n, n), driven(transition.now))));
  }
  if (admissible_set) x = restricted(x, Matrix::Identity(n, n), exactly(*admissible_set));
  return x;
}

LineForm widened(const Rounded& x) {
  LineForm X = x.set;
  const Index n = X.dim(), m = X.constraints(), g = X.generators();
  X.G.conservativeResize(n, g + n + m);
  X.G.rightCols(n + m) << Matrix(x.center.asDiagonal()), Matrix::Zero(n, m);
  X.A.conservativeResize(m, g + n + m);
  X.A.rightCols(n + m) << Matrix::Zero(m, n), Matrix(x.rows.asDiagonal());
  return X;
}

}  // namespace

std::optional<Enclosure> enclosed_successors(const Model& model, const LineForm& X,
                                             const std::optional<LineForm>& admissible_set,
                                             const Transition& transition) {
  if (X.lines() > 0 || model.W.lines() > 0 || model.V.lines() > 0) return std::nullopt;
  if (admissible_set && admissible_set->lines() > 0) return std::nullopt;
  if (model.linear.is_descriptor() && !DescriptorMatrix(model.linear.E).as_written)
    return std::nullopt;
  try {
    Rounded x = enclosed(model, X, admissible_set, transition);
    LineForm all = widened(x);
    return Enclosure{std::move(x.set), std::move(x.center), std::move(x.rows), std::move(all)};
  } catch (const Error& error) {
    if (error.code() != Errc::not_finite) throw;
    return std::nullopt;  // an overflow
  }
}

}  // namespace cordon::verification
