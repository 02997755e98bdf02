// SPDX-License-Identifier: GPL-3.0-or-later
// Outward rounding: for the numbers that operands and results hold, every operation of every
// backend encloses its exact result. The oracle is rational arithmetic: support functions of the
// exact result and of the set returned, in several directions. The nominal mode is put to the same
// test, which it must fail.
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/sets/sampling.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "published/study_models.hpp"
#include "sets/rational_set.hpp"

using namespace cordon;
using test::RationalSet;
using Support = test::RationalSet::Support;

namespace {

/// Random operands. Numbers are of one kind within a case: integers, ordinary ones with all digits,
/// badly scaled ones.
class Source {
 public:
  explicit Source(std::uint64_t seed)
      : random_(seed), kind_(static_cast<int>(random_.unit() * 4)) {}

  Index upto(Index largest) {
    return static_cast<Index>(random_.unit() * static_cast<double>(largest + 1));
  }
  double number() {
    if (random_.unit() < 0.2) return 0;
    const double x = random_.between(-1, 1);
    if (kind_ == 0) return std::round(4 * x);
    if (kind_ == 1) return x;
    return x *
           std::pow(10.0, std::round(random_.between(kind_ == 2 ? -2 : -8, kind_ == 2 ? 2 : 8)));
  }
  Matrix matrix(Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) a = number();
    return A;
  }
  Vector vector(Index n) { return matrix(n, 1); }
  /// With constraints that some point meets up to rounding, and lines.
  LineForm set(Index n, Index most_lines, Index most_constraints) {
    const Index g = 1 + upto(3), m = upto(std::min(most_constraints, g - 1)), l = upto(most_lines);
    LineForm X{matrix(n, l), matrix(n, g), vector(n), matrix(m, l), matrix(m, g), Vector(m)};
    const Vector delta = vector(l), xi = 0.7 * random_.cube(g);
    X.b = X.S * delta + X.A * xi;
    if (kind_ == 0) X.b = X.b.array().round();
    if (m > 0 && random_.unit() < 0.1) X.b *= 100;  // most probably ∅
    return X;
  }
  Vector direction(Index n, const Box& hull) {
    if (random_.unit() < 0.3) return Vector::Unit(n, upto(n - 1)) * (random_.unit() < 0.5 ? 1 : -1);
    Vector d = random_.cube(n);
    for (Index i = 0; i < n; ++i) {  // coordinates of unlike scale count alike
      const double width = hull.upper[i] - hull.lower[i];
      if (std::isfinite(width) && width > 1e-200) d[i] /= width;  // not what rounding made of 0
    }
    return d;
  }
  sets::Random& random() { return random_; }

 private:
  sets::Random random_;
  int kind_;
};

struct Bench {
  std::string name;
  bool lines, constraints;
};
const std::vector<Bench> benches{{"interval", false, false},
                                 {"zonotope", false, false},
                                 {"constrained_zonotope", false, true},
                                 {"line_zonotope", true, true},
                                 {"ellipsoid", false, true}};

RationalSet exact(const Set& X) {
  return X.backend().info().name == "interval" ? RationalSet::of(X.interval_hull())
                                               : RationalSet::of(X.line_form());
}

/// Counts, over all cases, of results that do not enclose and of claims that do not hold.
struct Tally {
  int checks = 0, escapes = 0, false_claims = 0, false_bounds = 0, exact_claims = 0;

  /// sup over the exact result, h_X, against the set returned; `claimed` is the operation's claim
  /// for exact operands.
  void compare(const Support& h, const Enclosure& result, const Vector& d, bool claimed) {
    if (h.kind == Support::empty) {
      if (claimed) false_claims += exact(*result).support(d).kind != Support::empty;
      return;
    }
    ++checks;
    const Support returned = exact(*result).support(d);
    const bool encloses = returned.kind == Support::infinite ||
                          (returned.kind == Support::finite && h.kind == Support::finite &&
                           h.value <= returned.value);
    escapes += !encloses;
    const double bound = result->support(d);
    false_bounds +=
        !(std::isinf(bound) && bound > 0) && (h.kind == Support::infinite || std::isinf(bound) ||
                                              (encloses && mpq_class(bound) < h.value));
    if (claimed) {
      ++exact_claims;
      false_claims += encloses && (returned.kind != h.kind ||
                                   (h.kind == Support::finite && returned.value != h.value));
    }
  }

  void compare(Source& source, const RationalSet& truth, const Enclosure& result,
               int directions = 3) {
    const Box hull = result->interval_hull();
    for (int k = 0; k < directions; ++k) {
      const Vector d =
          source.direction(result->dim(), hull.is_empty() ? Box::space(result->dim()) : hull);
      compare(truth.support(d), result, d, result.tightness == Tightness::exact);
    }
    if (result->is_empty() == Answer::yes)
      escapes += truth.support(Vector::Zero(result->dim())).kind != Support::empty;
  }
};

Enclosure fresh(Enclosure X) {
  X.tightness = Tightness::exact;  // so that a result's claim is that of its operation
  return X;
}

/// The ends of the intervals that are doubles, else their middles.
Matrix end_of(const Matrix& A, const Matrix& radius) {
  Matrix member = A;
  for (Index k = 0; k < member.size(); ++k) {
    const double a = A.data()[k] + radius.data()[k];
    if (mpq_class(a) - mpq_class(A.data()[k]) <= mpq_class(radius.data()[k])) member.data()[k] = a;
  }
  return member;
}

Tally run(const SetBackend& backend, const Bench& bench, int first, int seeds) {
  Tally tally;
  for (int seed = first; seed < first + seeds; ++seed) {
    Source source(static_cast<std::uint64_t>(seed));
    const Index n = 1 + source.upto(2), p = 1 + source.upto(1);
    const Index lines = bench.lines ? 2 : 0, constraints = 2;
    const LineForm forms[]{source.set(n, lines, constraints),
                           source.set(p, lines, bench.constraints ? 1 : 0),
                           source.set(n, lines, bench.constraints ? 1 : 0)};
    const Enclosure imported = backend.import(forms[0]);
    tally.compare(source, RationalSet::of(forms[0]), imported);
    const Enclosure X = fresh(imported), Y = fresh(backend.import(forms[1])),
                    Z = fresh(backend.import(forms[2]));
    const RationalSet x = exact(*X), y = exact(*Y), z = exact(*Z);

    const Matrix A = source.matrix(p, n), T = source.matrix(p, p);
    Vector f = source.vector(p);
    if (seed % 3 == 0) f = -(A * X->interval_hull().center());  // the centre cancels
    const Term term{T, Y};
    const Enclosure predicted = backend.predict(X, {A, f, {&term, 1}});
    tally.compare(source, RationalSet::affine_sum(x, A, f, y, T), predicted);

    const Vector kept =
        X->interval_hull().is_empty() ? Vector(Vector::Zero(n)) : X->interval_hull().center();
    const Vector data =
        A * kept +
        T * (Y->interval_hull().is_empty() ? Vector(Vector::Zero(p)) : Y->interval_hull().center());
    const Enclosure corrected = backend.correct(X, {A, data, {T, Y}});
    const RationalSet cut = RationalSet::strip_intersection(x, A, data, T, y);
    tally.compare(source, cut, corrected);
    tally.compare(
        source, RationalSet::strip_intersection(x, A, Vector::Zero(p), -Matrix::Identity(p, p), y),
        backend.intersection(X, A, Y));

    // one more operation on a result that has been rounded, and its reductions
    const Enclosure again = fresh(corrected);
    const Matrix B = source.matrix(n, n);
    const Enclosure mapped = fresh(backend.affine_map(again, B, source.vector(n)));
    const Enclosure reduced = backend.reduce(mapped, {n + 1 + source.upto(1), source.upto(1)});
    // of an ellipsoid the exchange form is larger than the set
    if (bench.name != "ellipsoid") tally.compare(source, exact(*mapped), reduced);

    const Matrix radius = source.matrix(p, n).cwiseAbs(), member = end_of(A, radius);
    Enclosure image = backend.interval_map(X, {A, radius});
    image.tightness = Tightness::outer;  // compared with one of its members
    tally.compare(
        source, RationalSet::affine_sum(x, member, Vector::Zero(p), y, Matrix::Zero(p, p)), image);

    const Enclosure hull = backend.convex_hull(X, Z);
    for (int k = 0; k < 2 && n > 0; ++k) {
      const Vector d = source.direction(n, hull->interval_hull());
      for (const RationalSet* part : {&x, &z}) tally.compare(part->support(d), hull, d, false);
    }
  }
  return tally;
}

/// Parameters with outward rounding and a choice for another one.
Params outward(const std::string& name = "", const Params::Value& value = {}) {
  Params params;
  params.set("rounding", std::string("outward"));
  if (!name.empty()) params.set(name, value);
  return params;
}

void check_encloses(const Tally& tally) {
  CHECK(tally.escapes == 0);
  CHECK(tally.false_claims == 0);
  CHECK(tally.false_bounds == 0);
}

}  // namespace

TEST_CASE("with outward rounding no exact result escapes; with nominal rounding some do") {
  const Plugins plugins;
  for (const Bench& bench : benches) {
    CAPTURE(bench.name);
    const auto backend = plugins.backend(bench.name, outward());
    CHECK(backend->info().rounding == Rounding::outward);
    const Tally tally = run(*backend, bench, 1, 16);
    CHECK(tally.checks > 200);
    CHECK(tally.exact_claims > 20);
    check_encloses(tally);
    // kernels that round outward in either mode
    if (bench.name == "interval" || bench.name == "ellipsoid") continue;
    CHECK(run(*plugins.backend(bench.name), bench, 1, 6).escapes > 3);
  }
}

TEST_CASE("every method of reduction and intersection keeps to it") {
  const Plugins plugins;
  int first = 100;  // other operands for each
  for (const Bench& bench : {benches[1], benches[2], benches[3]}) {
    for (const char* reduction : {"girard", "combastel", "pca"}) {
      CAPTURE(bench.name);
      CAPTURE(reduction);
      check_encloses(run(*plugins.backend(bench.name, outward("reduction", std::string(reduction))),
                         bench, first += 10, 3));
    }
  }
  for (const char* strip : {"bravo", "volume"}) {
    CAPTURE(strip);
    check_encloses(run(*plugins.backend("zonotope", outward("strip", std::string(strip))),
                       benches[1], first += 10, 3));
  }
  check_encloses(run(*plugins.backend("constrained_zonotope", outward("rescale", true)), benches[2],
                     first += 10, 3));
  check_encloses(
      run(*plugins.backend("line_zonotope", outward("precondition", std::string("gauss_jordan"))),
          benches[3], first += 10, 3));
}
