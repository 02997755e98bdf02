// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems.hpp"

#include <cmath>

#include "cordon/core/interval.hpp"
#include "cordon/solvers/exact_questions.hpp"

namespace cordon::conformance {

namespace {

constexpr std::size_t per_mode = 6;  ///< A, B, Bw, C, D, Dv

const Matrix& part_of(const TestCase& test, Index mode, std::size_t part) {
  return test.matrix(1 + per_mode * static_cast<std::size_t>(mode) + part);
}

bool is_diagonal_with_room(const Matrix& A) {
  for (Index i = 0; i < A.rows(); ++i) {
    if (!(A.row(i).cwiseAbs().maxCoeff() > 0)) return false;
  }
  return A.rows() == 0 || A.cols() > 0;
}

/// Does the noise move every coordinate of `M` times the set by much more than roundoff?
bool has_room(const Matrix& M, const LineForm& X) {
  if (M.rows() == 0) return true;
  if (M.cols() == 0 || X.constraints() > 0) return false;
  const Vector reach = M.cwiseAbs() * X.G.cwiseAbs().rowwise().sum();
  return is_diagonal_with_room(M) && reach.minCoeff() > 0x1p-8;
}

/// c + Gξ of a zonotope.
Vector drawn_from(const LineForm& X, Noise noise, bool inside, Random& random, ExactSums& sums) {
  Vector xi(X.generators());
  for (double& x : xi) {
    x = noise == Noise::zero       ? 0
        : noise == Noise::vertices ? random.sign()
                                   : static_cast<double>(random.between(-8, 8)) / 8;
    if (inside) x *= 1 - 0x1p-20;
  }
  return sums.sum(X.c, sums.product(X.G, xi));
}

/// x with its static coordinates made by 0 = A x + f; false: the rows do not say what they are.
bool settle(const Matrix& E, const Matrix& A, const Vector& f, Vector& x, ExactSums& sums) {
  for (Index i = 0; i < E.rows(); ++i) {
    if (!E.row(i).isZero(0)) continue;
    Vector row = A.row(i).transpose();
    for (Index j = 0; j < E.rows(); ++j) {
      if (j != i && row[j] != 0 && E.row(j).isZero(0)) return false;
    }
    if (row[i] != -1) return false;
    row[i] = 0;
    x[i] = sums.sum(sums.product(row.transpose(), x), f.segment(i, 1))[0];
  }
  return true;
}

/// E is a projection onto coordinates.
bool is_simple(const Matrix& E) {
  return E.rows() == E.cols() && Matrix(E.diagonal().asDiagonal()) == E &&
         (E.diagonal().array() == 0 || E.diagonal().array() == 1).all();
}

/// A matrix between A - A_radius and A + A_radius.
Matrix drawn(const Matrix& A, const Matrix* radius, Random& random) {
  Matrix result = A;
  for (Index k = 0; radius && k < A.size(); ++k)
    result.data()[k] += radius->data()[k] * static_cast<double>(random.between(-1, 1));
  return result;
}

}  // namespace

double ExactSums::plus(double a, double b) {
  const Interval s = directed::plus(a, b);
  exact_ = exact_ && s.is_point();
  return a + b;
}

double ExactSums::times(double a, double b) {
  const Interval p = directed::times(a, b);
  exact_ = exact_ && p.is_point();
  return a * b;
}

Vector ExactSums::product(const Matrix& A, const Vector& x) {
  Vector y = Vector::Zero(A.rows());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) y[i] = plus(y[i], times(A(i, j), x[j]));
  }
  return y;
}

Vector ExactSums::sum(const Vector& x, const Vector& y) {
  Vector z(x.size());
  for (Index i = 0; i < x.size(); ++i) z[i] = plus(x[i], y[i]);
  return z;
}

Vector ExactSums::squares(const Vector& x) {
  Vector y(x.size());
  for (Index i = 0; i < x.size(); ++i) y[i] = times(x[i], x[i]);
  return y;
}

const Matrix* matrix_of(const TestCase& test, const std::string& name) {
  for (const TestMatrix& M : test.matrices) {
    if (M.name == name) return &M.value;
  }
  return nullptr;
}

Index modes_of(const TestCase& test) {
  Index count = 0;
  for (const TestMatrix& M : test.matrices) count += M.name.starts_with("Dv");
  return count;
}

Model model_of(const TestCase& test, Index mode) {
  Model model;
  LinearModel& m = model.linear;
  m.A = part_of(test, mode, 0);
  m.B = part_of(test, mode, 1);
  m.Bw = part_of(test, mode, 2);
  m.C = part_of(test, mode, 3);
  m.D = part_of(test, mode, 4);
  m.Dv = part_of(test, mode, 5);
  if (const Matrix* E = matrix_of(test, "E")) m.E = *E;
  if (const Matrix* radius = matrix_of(test, "A_radius")) m.A_radius = *radius;
  if (const Matrix* F = matrix_of(test, "F")) m.F = *F;
  model.X0 = test.set(0).form;
  model.W = test.set(1).form;
  model.V = test.set(2).form;
  model.U = test.sets.size() > 3 ? test.set(3).form : make_space(m.inputs());
  return model;
}

ModeBank bank_of(const TestCase& test) {
  ModeBank bank;
  for (Index j = 0; j < modes_of(test); ++j)
    bank.modes.push_back({"m" + std::to_string(j + 1), model_of(test, j)});
  return bank;
}

namespace {

/// With `inside`, noise keeps a little away from the ends of its sets, where rounding would not.
std::optional<Trajectory> run_plant(const TestCase& test, const Course& course, bool inside) {
  Trajectory data;
  Random random(seed_of(course.seed, "trajectory", 0));
  const Noise noise = noise_of(test);
  const LineForm &X0 = test.set(0).form, &W = test.set(1).form, &V = test.set(2).form;
  const Matrix *E = matrix_of(test, "E"), *radius = matrix_of(test, "A_radius"),
               *F = matrix_of(test, "F"), *Q = matrix_of(test, "Q");
  if ((E && !is_simple(*E)) || (radius && (radius->array() < 0).any())) return std::nullopt;
  const Matrix& u = test.matrix(0);
  for (Index j = 0; j < modes_of(test); ++j) {
    data.fat =
        data.fat && !E && has_room(part_of(test, j, 2), W) && has_room(part_of(test, j, 5), V);
  }
  data.fat = data.fat && has_room(Matrix::Identity(X0.dim(), X0.dim()), X0);
  ExactSums sums;
  Vector x = drawn_from(X0, noise, inside, random, sums);
  for (Index t = 0; t < u.cols(); ++t) {
    const Index mode = course.modes.empty() ? 0 : course.modes[as_size(t)];
    const Model model = model_of(test, mode);
    const LinearModel& m = model.linear;
    const Vector w = drawn_from(W, noise, inside, random, sums),
                 v = drawn_from(V, noise, inside, random, sums);
    const Matrix A = drawn(m.A, radius, random);
    Vector f = sums.sum(sums.product(m.B, u.col(t)), sums.product(m.Bw, w));
    if (F && course.fault.size() > 0) f = sums.sum(f, sums.product(*F, course.fault));
    if (E && !settle(*E, A, f, x, sums)) return std::nullopt;
    if (E && t == 0 && exact::contains(X0, x) != Answer::yes) return std::nullopt;
    Sample sample{course.first + t, u.col(t), {}};
    sample.y = sums.sum(sums.sum(sums.product(m.C, x), sums.product(m.D, sample.u)),
                        sums.product(m.Dv, v));
    for (Index i = 0; course.gaps && i < sample.y.size(); ++i) {
      if (random.chance(0.3)) sample = missing_outputs(sample, {i});
    }
    data.samples.push_back(std::move(sample));
    data.states.push_back(x);
    data.mode.push_back(mode);
    Vector next = sums.sum(sums.product(A, x), f);
    if (Q) next = sums.sum(next, sums.product(*Q, sums.squares(x)));
    for (Index i = 0; E && i < next.size(); ++i) {
      if ((*E)(i, i) == 0) next[i] = 0;
    }
    x = std::move(next);
    if (!x.allFinite()) return std::nullopt;
  }
  data.exact = sums.exact();
  return data;
}

}  // namespace

std::optional<Trajectory> simulate(const TestCase& test, const Course& course) {
  std::optional<Trajectory> data = run_plant(test, course, false);
  if (data && !data->exact && data->fat) data = run_plant(test, course, true);
  return data;
}

std::vector<std::pair<std::string, std::string>> described(const Trajectory& data) {
  std::string y = "[", x = "[";
  for (std::size_t t = 0; t < data.samples.size(); ++t) {
    y += (t ? ", " : "") + describe_vector(data.samples[t].y);
    x += (t ? ", " : "") + describe_vector(data.states[t]);
  }
  std::vector<std::pair<std::string, std::string>> all{{"y", y + "]"}, {"true x", x + "]"}};
  if (!data.samples.empty() && data.samples.front().k != 0)
    all.emplace_back("first time", std::to_string(data.samples.front().k));
  return all;
}

}  // namespace cordon::conformance
