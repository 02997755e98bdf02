// SPDX-License-Identifier: GPL-3.0-or-later
#include "fingerprint.hpp"

#include "cordon/core/error.hpp"

namespace cordon::conformance {

std::string fingerprint(const Set& X) {
  const Index n = X.dim();
  const Complexity size = X.complexity();
  const Box hull = X.interval_hull();
  std::string text = describe(X.line_form()) + " size " + std::to_string(size.generators) + "/" +
                     std::to_string(size.lines) + "/" + std::to_string(size.constraints) +
                     " hull " + describe_vector(hull.lower) + " " + describe_vector(hull.upper) +
                     " empty " + std::string(to_string(X.is_empty())) +
                     " h(1) = " + describe(X.support(Vector::Ones(n)));
  return text;
}

std::string fingerprint(const std::optional<Enclosure>& X) {
  return X ? std::string(to_string(X->tightness)) + " " + fingerprint(**X) : "refused";
}

std::vector<std::pair<std::string, Run>> program(const SetBackend& b, const Enclosure& X,
                                                 const Enclosure& Y, const TestCase& test) {
  const Matrix A = test.matrix(0);
  const Vector f = test.vector(0);
  const Index n = X->dim(), p = A.rows();
  const Matrix I = Matrix::Identity(n, n);
  return {
      {"affine_map", [=, &b] { return b.affine_map(X, A, f); }},
      {"predict",
       [=, &b] {
         const Term term{A, Y};
         return b.predict(X, {A, f, {&term, 1}});
       }},
      {"sum", [=, &b] { return b.sum(X, Y); }},
      {"product", [=, &b] { return b.product(X, Y); }},
      {"intersection", [=, &b] { return b.intersection(X, I, Y); }},
      {"correct",
       [=, &b] {
         return b.correct(X, {A, f, {A, Y}});
       }},
      {"interval_map",
       [=, &b] { return b.interval_map(X, IntervalMatrix(A, Matrix::Constant(p, n, 0.125))); }},
      {"convex_hull", [=, &b] { return b.convex_hull(X, Y); }},
      {"reduce",
       [=, &b] {
         return b.reduce(b.sum(X, Y), {n + 1, 1});
       }},
      {"reduce of an operand",
       [=, &b] {
         return b.reduce(X, {n, 0});
       }},
  };
}

std::optional<Enclosure> attempt_operation(const Run& run) {
  try {
    return run();
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported && error.code() != Errc::solver) throw;
    return std::nullopt;
  }
}

}  // namespace cordon::conformance
