// SPDX-License-Identifier: GPL-3.0-or-later
// Systems of up to three states: stable ones and others, without noise or with, with outputs that
// repeat, in other units.
#include <cmath>

#include "systems.hpp"

namespace cordon::conformance {

namespace {

class SystemGenerator {
 public:
  SystemGenerator(const Setting& s, const SystemShape& shape) : s_(s), shape_(shape) {}

  TestCase make() {
    n_ = s_.n;
    ny_ = random().between(1, shape_.outputs);
    nu_ = random().between(shape_.uncontrolled ? 0 : 1, shape_.inputs);
    nw_ = is_full() ? n_ : random().between(0, shape_.disturbances);
    nv_ = is_full() ? ny_ : random().between(0, ny_);
    TestCase test;
    test.sets.push_back(box("X0", 'n', n_, true));
    test.sets.push_back(box("W", 'w', nw_, is_full()));
    test.sets.push_back(box("V", 'v', nv_, is_full()));
    test.matrices.push_back({"u", 'u', 't', numbers(nu_, random().between(2, shape_.samples), 2)});
    const bool descriptor = shape_.descriptor && n_ > 1 && !is_full() && random().chance(0.25);
    const bool uncertain = shape_.uncertain && !descriptor && random().chance(0.2);
    for (Index j = 0; j < shape_.modes; ++j) add_mode(test, j);
    if (descriptor) add_static_row(test);
    if (uncertain) {
      Matrix radius = Matrix::Zero(n_, n_);
      for (Index k = 0; k < radius.size(); ++k)
        radius.data()[k] = random().chance(0.5) ? 0.0 : 0x1p-4;
      test.matrices.push_back({"A_radius", 'n', 'n', radius, true});
    }
    if (shape_.nonlinear && !descriptor && !uncertain && random().chance(0.1))
      test.matrices.push_back({"Q", 'n', 'n', numbers(n_, n_, 0.25)});
    if (shape_.faults) {
      Matrix F = numbers(n_, 1, 2);
      if (F.isZero(0)) F(0, 0) = 1;
      test.matrices.push_back({"F", 'n', 'f', F});
    }
    if (s_.style == Style::scaled) scale(test);
    return test;
  }

 private:
  Random& random() { return s_.random; }
  bool is_full() const { return s_.style == Style::full; }

  /// A number of few digits of at most `most`, or any number in cases of that style.
  double number(double most) {
    if (is_full()) return most * (2 * random().unit() - 1);
    return most * static_cast<double>(random().between(-4, 4)) / 4;
  }
  Matrix numbers(Index rows, Index cols, double most) {
    Matrix A(rows, cols);
    for (Index k = 0; k < A.size(); ++k) A.data()[k] = random().chance(0.25) ? 0.0 : number(most);
    return A;
  }

  /// Mostly a box; a zonotope, or a point, where it needs no room.
  TestSet box(const char* name, char space, Index n, bool room) {
    TestSet X;
    X.name = name;
    X.space = space;
    Matrix G = Matrix::Zero(n, n);
    for (Index i = 0; i < n; ++i)
      G(i, i) = is_full() ? 0.125 + random().unit() : std::exp2(random().between(-3, 1));
    if (!is_full() && n > 1 && random().chance(0.3)) G(0, n - 1) = number(1);
    if (!room && random().chance(0.15)) G.resize(n, 0);
    const Vector c = random().chance(0.5) ? Vector::Zero(n) : Vector(numbers(n, 1, 1));
    X.form = make_zonotope(c, G);
    X.xi = Vector::Zero(G.cols());
    return X;
  }

  Matrix dynamics() {
    Matrix A = numbers(n_, n_, 1);
    switch (random().below(7)) {
      case 0:
        return Matrix::Identity(n_, n_);
      case 1:  // nilpotent
        return A.triangularView<Eigen::StrictlyUpper>();
      case 2:  // a turn
        A.setZero();
        for (Index i = 0; i < n_; ++i) A(i, (i + 1) % n_) = i == 0 ? -1 : 1;
        return A;
      case 3:  // unstable
        A = A.triangularView<Eigen::Upper>();
        for (Index i = 0; i < n_; ++i) A(i, i) = 1.5;
        return A;
      default:  // mostly stable
        return A / static_cast<double>(n_ == 3 ? 4 : n_);
    }
  }

  void add_mode(TestCase& test, Index mode) {
    const std::string j = shape_.modes > 1 ? std::to_string(mode + 1) : "";
    Matrix A = dynamics(), B = numbers(n_, nu_, 1), C = numbers(ny_, n_, 1), D(ny_, nu_);
    if (C.isZero(0)) C(0, random().below(n_)) = 1;
    if (ny_ > 1 && random().chance(0.25)) C.row(ny_ - 1) = C.row(0);  // an output twice
    D.setZero();
    if (random().chance(0.3)) D = numbers(ny_, nu_, 1);
    if (mode > 0 && random().chance(0.6)) {  // modes that differ in a part only
      A = test.matrix(1);
      if (random().chance(0.5)) B = test.matrix(2);
      if (random().chance(0.7)) C = test.matrix(4);
    }
    const Matrix Bw = is_full() ? Matrix(Matrix::Identity(n_, n_)) : numbers(n_, nw_, 1),
                 Dv = is_full() || nv_ == ny_ ? Matrix(Matrix::Identity(ny_, nv_))
                                              : numbers(ny_, nv_, 1);
    test.matrices.push_back({"A" + j, 'n', 'n', A});
    test.matrices.push_back({"B" + j, 'n', 'u', B});
    test.matrices.push_back({"Bw" + j, 'n', 'w', Bw});
    test.matrices.push_back({"C" + j, 'y', 'n', C});
    test.matrices.push_back({"D" + j, 'y', 'u', D});
    test.matrices.push_back({"Dv" + j, 'y', 'v', Dv});
  }

  /// The last state follows from the others at every time.
  void add_static_row(TestCase& test) {
    Matrix E = Matrix::Identity(n_, n_);
    E(n_ - 1, n_ - 1) = 0;
    for (Index j = 0; j < shape_.modes; ++j)
      test.matrices[static_cast<std::size_t>(1 + 6 * j)].value(n_ - 1, n_ - 1) = -1;
    LineForm& X0 = test.sets[0].form;
    X0.c[n_ - 1] = 0;
    X0.G.row(n_ - 1).setZero();
    X0.G.col(n_ - 1).setZero();
    X0.G(n_ - 1, n_ - 1) = 64;
    test.matrices.push_back({"E", 'n', 'n', E});
  }

  /// Other units of states and outputs, by powers of two: nothing is rounded.
  void scale(TestCase& test) {
    const auto unit = [&] { return std::exp2(random().between(-20, 20)); };
    for (Index i = 0; i < n_; ++i) {
      const double s = unit();
      for (TestSet& X : test.sets) {
        if (X.space != 'n') continue;
        X.form.c[i] *= s;
        X.form.G.row(i) *= s;
      }
      for (TestMatrix& M : test.matrices) {
        if (M.name == "E") continue;
        if (M.name == "Q") M.value.col(i) /= s;  // of a square
        if (M.rows == 'n') M.value.row(i) *= s;
        if (M.cols == 'n') M.value.col(i) /= s;
      }
    }
    for (Index i = 0; i < ny_; ++i) {
      const double s = unit();
      for (TestMatrix& M : test.matrices) {
        if (M.rows == 'y') M.value.row(i) *= s;
      }
    }
  }

  const Setting& s_;
  const SystemShape& shape_;
  Index n_ = 0, ny_ = 0, nu_ = 0, nw_ = 0, nv_ = 0;
};

}  // namespace

TestCase system_case(const Setting& s, const SystemShape& shape) {
  return SystemGenerator(s, shape).make();
}

}  // namespace cordon::conformance
