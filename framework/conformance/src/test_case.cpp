// SPDX-License-Identifier: GPL-3.0-or-later
#include "test_case.hpp"

#include <charconv>
#include <cmath>

namespace cordon::conformance {

namespace {

bool is_tame(const Matrix& A) {
  for (Index k = 0; k < A.size(); ++k) {
    const double a = A.data()[k];
    if (a == 0) continue;
    // a multiple of 1/64 of at most 64: at most 12 binary digits
    if (!(std::abs(a) <= 64) || std::nearbyint(a * 64) != a * 64) return false;
  }
  return true;
}

}  // namespace

Vector TestSet::point() const { return form.c + form.M * delta + form.G * xi; }

void TestSet::refit() {
  if (!empty) form.b = form.S * delta + form.A * xi;
}

Index TestCase::dim(char space) const {
  for (const TestSet& X : sets) {
    if (X.space == space) return X.form.dim();
  }
  for (const TestMatrix& A : matrices) {
    if (A.rows == space) return A.value.rows();
    if (A.cols == space) return A.value.cols();
  }
  for (const TestVector& v : vectors) {
    if (v.space == space) return v.value.size();
  }
  return -1;
}

bool TestCase::tame() const {
  for (const TestSet& X : sets) {
    for (const Matrix* block : {&X.form.M, &X.form.G, &X.form.S, &X.form.A}) {
      if (!is_tame(*block)) return false;
    }
    if (!is_tame(X.form.c) || !is_tame(X.form.b) || !is_tame(X.delta) || !is_tame(X.xi))
      return false;
  }
  for (const TestMatrix& A : matrices) {
    if (!is_tame(A.value)) return false;
  }
  for (const TestVector& v : vectors) {
    if (!is_tame(v.value)) return false;
  }
  return true;
}

std::string describe(double x) {
  if (std::isnan(x)) return "\"nan\"";
  if (std::isinf(x)) return x > 0 ? "\"inf\"" : "\"-inf\"";
  if (x == 0) return "0";
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  return std::string(text, end);
}

std::string describe_vector(const Vector& x) {
  std::string text = "[";
  for (Index i = 0; i < x.size(); ++i) text += (i ? ", " : "") + describe(x[i]);
  return text + "]";
}

std::string describe(const Matrix& A) {
  std::string text = "[";
  for (Index i = 0; i < A.rows(); ++i)
    text += (i ? ", " : "") + describe_vector(A.row(i).transpose());
  return text + "]";
}

std::string describe(const LineForm& X) {
  const bool lines = X.lines() > 0, constraints = X.constraints() > 0,
             generators = X.generators() > 0;
  const std::string type = lines         ? "line_zonotope"
                           : constraints ? "constrained_zonotope"
                           : generators  ? "zonotope"
                                         : "point";
  std::string text = "{\"type\": \"" + type + "\", \"center\": " + describe_vector(X.c);
  if (lines) text += ", \"lines\": " + describe(X.M);
  if (generators) text += ", \"generators\": " + describe(X.G);
  if (constraints && lines) text += ", \"S\": " + describe(X.S);
  if (constraints) text += ", \"A\": " + describe(X.A) + ", \"b\": " + describe_vector(X.b);
  return text + "}";
}

std::string describe(const TestCase& test) {
  std::string text;
  for (const TestSet& X : test.sets) text += X.name + " = " + describe(X.form) + "\n";
  for (const TestMatrix& A : test.matrices) text += A.name + " = " + describe(A.value) + "\n";
  for (const TestVector& v : test.vectors) text += v.name + " = " + describe_vector(v.value) + "\n";
  for (const TestNumber& k : test.numbers) text += k.name + " = " + std::to_string(k.value) + "\n";
  return text;
}

}  // namespace cordon::conformance
