// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of wrong and of strange calls.
#include "thrown_errors.hpp"

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"

namespace cordon::conformance {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Call = std::pair<std::string, std::function<void()>>;

/// Every call throws an Error of that code.
Verdict all_throw(const std::vector<Call>& calls, Errc code) {
  const std::string expected = "Errc::" + std::string(to_string(code));
  for (const auto& [what, call] : calls) {
    try {
      call();
    } catch (const Error& error) {
      if (error.code() == code) continue;
      return Verdict::fails(what + ": expected " + expected + ", found Errc::" +
                            std::string(to_string(error.code())) + ": " + error.what());
    }
    return Verdict::fails(what + ": expected " + expected + ", but nothing was thrown");
  }
  return {};
}

/// What the calls throw is a cordon::Error, if anything.
Verdict throw_only_errors(const std::vector<Call>& calls) {
  for (const auto& [what, call] : calls) {
    try {
      call();
    } catch (const Error&) {
    } catch (const std::exception& error) {
      return Verdict::fails(what +
                            ": an exception that is no cordon::Error was thrown: " + error.what());
    } catch (...) {
      return Verdict::fails(what + ": an exception that is no std::exception was thrown");
    }
  }
  return {};
}

/// Numbers near the ends of their range, which leave it in an operation.
Verdict extreme_numbers_throw_only_errors(const SetBackend& b, const Enclosure& X, Index n) {
  const Matrix I = Matrix::Identity(n, n), huge = 1e200 * I;
  const Vector zero = Vector::Zero(n);
  return throw_only_errors({
      {"an overflow of a map", [&] { b.affine_map(b.affine_map(X, huge, zero), huge, zero); }},
      {"an overflow of a translation",
       [&] {
         b.affine_map(b.point(Vector::Constant(n, 1.7e308)), I, Vector::Constant(n, 1.7e308));
       }},
      {"an overflow of a sum",
       [&] {
         b.sum(b.point(Vector::Constant(n, 1.7e308)), b.point(Vector::Constant(n, 1.7e308)));
       }},
      {"tiny numbers", [&] { b.affine_map(b.affine_map(X, 1e-200 * I, zero), 1e-200 * I, zero); }},
  });
}

}  // namespace

Verdict check_dimension_errors(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Enclosure X = b.import(test.set(0).form);
  const Index n = X->dim();
  const Enclosure wider = b.point(Vector::Zero(n + 1));
  const Matrix I = Matrix::Identity(n, n), wide = Matrix::Identity(n, n + 1);
  const Vector zero = Vector::Zero(n), longer = Vector::Zero(n + 1);
  LineForm broken = make_point(zero);
  broken.b = Vector::Ones(1);
  return all_throw(
      {
          {"contains of a longer point", [&] { X->contains(longer); }},
          {"support in a longer direction", [&] { X->support(longer); }},
          {"is_subset_of a set of another dimension", [&] { X->is_subset_of(*wider); }},
          {"is_disjoint_from a set of another dimension", [&] { X->is_disjoint_from(*wider); }},
          {"affine_map by a wider T", [&] { b.affine_map(X, wide, zero); }},
          {"affine_map with a longer t", [&] { b.affine_map(X, I, longer); }},
          {"sum of different dimensions", [&] { b.sum(X, wider); }},
          {"intersection with a wider R", [&] { b.intersection(X, wide, X); }},
          {"intersection with R that does not reach Y", [&] { b.intersection(X, I, wider); }},
          {"correct with a wider C",
           [&] {
             b.correct(X, {wide, zero, {I, X}});
           }},
          {"correct with a longer z",
           [&] {
             b.correct(X, {I, longer, {I, X}});
           }},
          {"correct with a wider T",
           [&] {
             b.correct(X, {I, zero, {wide, X}});
           }},
          {"interval_map by a wider matrix", [&] { b.interval_map(X, IntervalMatrix(wide)); }},
          {"interval_map with a radius of another size",
           [&] { b.interval_map(X, IntervalMatrix(I, wide)); }},
          {"convex_hull of different dimensions", [&] { b.convex_hull(X, wider); }},
          {"import of blocks that do not fit", [&] { b.import(broken); }},
      },
      Errc::dimension);
}

Verdict check_not_finite_errors(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Enclosure X = b.import(test.set(0).form);
  const Index n = X->dim();
  const Matrix I = Matrix::Identity(n, n);
  const Vector zero = Vector::Zero(n);
  for (const double bad : {nan, infinity}) {
    Matrix T = I;
    T(0, n - 1) = bad;
    Vector t = zero;
    t[n - 1] = bad;
    LineForm broken = make_zonotope(zero, T);
    const Verdict verdict = all_throw(
        {
            {"contains", [&] { X->contains(t); }},
            {"support", [&] { X->support(t); }},
            {"affine_map, T", [&] { b.affine_map(X, T, zero); }},
            {"affine_map, t", [&] { b.affine_map(X, I, t); }},
            {"intersection, R", [&] { b.intersection(X, T, X); }},
            {"correct, C",
             [&] {
               b.correct(X, {T, zero, {I, X}});
             }},
            {"correct, z",
             [&] {
               b.correct(X, {I, t, {I, X}});
             }},
            {"correct, T",
             [&] {
               b.correct(X, {I, zero, {T, X}});
             }},
            {"interval_map, centre", [&] { b.interval_map(X, IntervalMatrix(T, I)); }},
            {"interval_map, radius", [&] { b.interval_map(X, IntervalMatrix(I, T)); }},
            {"import", [&] { b.import(broken); }},
        },
        Errc::not_finite);
    if (verdict.failed()) return verdict;
  }
  return {};
}

Verdict check_only_cordon_errors(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Index n = test.set(0).form.dim();
  const Matrix I = Matrix::Identity(n, n), none(0, n);
  const Vector zero = Vector::Zero(n), nothing(0);
  const Enclosure X = b.import(test.set(0).form), Y = b.import(test.set(1).form);
  const Enclosure R0 = b.point(nothing), point = b.point(zero);
  const Verdict verdict = throw_only_errors({
      {"no operand", [&] { b.sum(X, {}); }},
      {"import of no set", [&] { b.import(Enclosure{}); }},
      {"a negative budget",
       [&] {
         b.reduce(X, {-1, -1});
       }},
      {"a budget of nothing",
       [&] {
         b.reduce(X, {0, 0});
       }},
      {"a negative radius", [&] { b.interval_map(X, IntervalMatrix(I, -I)); }},
      {"Rⁿ", [&] { b.space(n); }},
      {"∅", [&] { b.empty(n); }},
      {"a half-bounded box",
       [&] {
         b.box({zero, Vector::Constant(n, infinity)});
       }},
      {"a map to R⁰", [&] { b.affine_map(X, none, nothing); }},
      {"a product with R⁰", [&] { b.product(X, R0); }},
      {"a product of R⁰ and R⁰", [&] { b.product(R0, R0); }},
      {"no measurement",
       [&] {
         b.correct(X, {none, nothing, {Matrix(0, 0), R0}});
       }},
      {"a measurement without noise",
       [&] {
         b.correct(X, {I, zero, {Matrix(n, 0), R0}});
       }},
      {"a measurement of nothing",
       [&] {
         b.correct(X, {Matrix::Zero(1, n), Vector::Zero(1), {Matrix::Zero(1, n), Y}});
       }},
      {"a measurement that cannot be",
       [&] {
         b.correct(X, {Matrix::Zero(1, n), Vector::Ones(1), {Matrix::Zero(1, n), Y}});
       }},
      {"an intersection with R⁰", [&] { b.intersection(X, none, R0); }},
      {"an interval map to R⁰", [&] { b.interval_map(X, IntervalMatrix(none, none)); }},
      {"a hull with a point", [&] { b.convex_hull(X, point); }},
      {"a hull of a point and a set", [&] { b.convex_hull(point, X); }},
      {"a hull of a point with itself", [&] { b.convex_hull(point, point); }},
      {"questions about R⁰",
       [&] {
         R0->is_empty(), R0->contains(nothing), R0->support(nothing), R0->interval_hull(),
             R0->volume();
       }},
      {"support in direction 0", [&] { X->support(zero); }},
  });
  return verdict.failed() ? verdict : extreme_numbers_throw_only_errors(b, X, n);
}

}  // namespace cordon::conformance
