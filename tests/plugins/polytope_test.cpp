// SPDX-License-Identifier: GPL-3.0-or-later
// The backend `polytope` against the class Polytope, whose operations are exact: equal to it with
// rational numbers, around it by the last digits with doubles.
#include "cordon/solvers/polytope.hpp"

#include <cmath>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "cordon/solvers/certificate.hpp"
#include "published/study_models.hpp"

using namespace cordon;

namespace {

Params rounded_as(const std::string& how) {
  Params params;
  if (how == "outward") params.set("digits", std::int64_t{0});
  return params;
}

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  Matrix matrix(Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& entry : A.reshaped()) entry = number_(engine_);
    return A;
  }
  Vector vector(Index n) { return matrix(n, 1); }
  /// Coordinates between 1e-6 and 1e6 times as large as others.
  LineForm zonotope(Index n, bool scaled) {
    Matrix G = matrix(n, n + 1);
    if (scaled)
      G = Vector(Vector(6 * vector(n)).unaryExpr([](double e) {
            return std::pow(10, e);
          })).asDiagonal() *
          G;
    return make_zonotope(vector(n), G);
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> number_{-1, 1};
};

/// The set holds `exact`, and no more than that: nothing with rational numbers, a share of its size
/// with doubles.
void check_equals(const Enclosure& X, const Polytope& exact, Draw& draw, bool claims = true) {
  const bool rational = X->backend().info().rounding == Rounding::rational;
  CHECK(Polytope::from_inequalities(Matrix(0, exact.dim()), Vector(0)).contains(exact));
  const Vector size =
      exact.interval_hull().lower.cwiseAbs().cwiseMax(exact.interval_hull().upper.cwiseAbs());
  for (int trial = 0; trial < 8; ++trial) {
    const Vector d = trial == 0 ? Vector::Unit(exact.dim(), 0) : draw.vector(exact.dim());
    const Interval h = exact.support(d);
    const double room = rational ? 0 : 1e-11 * d.cwiseAbs().dot(size);
    CHECK(X->support(d) >= h.upper);
    CHECK(X->support(d) <= h.upper + room);
  }
  if (rational && claims) CHECK(X.tightness == Tightness::exact);
  const LineForm form = X->line_form();
  if (form.dim() + form.constraints() <= 12) CHECK(Polytope::from(form).contains(exact));
}

Vector zero(Index n) { return Vector::Zero(n); }

}  // namespace

TEST_CASE("operations are those of exact polytopes") {
  const Plugins plugins;
  for (const char* how : {"outward", "rational"}) {
    const auto backend = plugins.backend("polytope", rounded_as(how));
    for (unsigned seed = 1; seed <= 12; ++seed) {
      CAPTURE(how);
      CAPTURE(seed);
      Draw draw(seed);
      const Index n = 1 + seed % 3, m = 1 + seed / 2 % 2;
      const bool scaled = seed % 4 == 0;
      const LineForm X = draw.zonotope(n, scaled), Y = draw.zonotope(n, scaled),
                     V = draw.zonotope(m, false);
      const Polytope PX = Polytope::from(X), PY = Polytope::from(Y), PV = Polytope::from(V);
      const Enclosure EX{backend->import(X).set}, EY{backend->import(Y).set},
          EV{backend->import(V).set};
      // the imported sets are rounded themselves: what is compared begins with them
      const auto held = [&](const Enclosure& E, const Polytope& P) {
        return std::string(how) == "rational" ? P : Polytope::from(E->line_form());
      };
      const Polytope HX = held(EX, PX), HY = held(EY, PY), HV = held(EV, PV);
      check_equals(EX, PX, draw);

      const Matrix A = draw.matrix(n, n), T = draw.matrix(n, m), C = draw.matrix(m, n);
      const Vector f = draw.vector(n);
      const Term term{T, EV};
      check_equals(backend->predict(EX, {A, f, {&term, 1}}),
                   HX.affine_map(A, f).minkowski_sum(HV.affine_map(T, zero(n))), draw);
      const Matrix I = Matrix::Identity(m, m);
      const Vector z = C * X.c;
      // a set that is next to nothing in terms of the data has room for their rounding
      check_equals(backend->correct(EX, {C, z, {I, EV}}), HX.intersection(C, HV.affine_map(-I, z)),
                   draw, !scaled);
      check_equals(backend->convex_hull(EX, EY), HX.convex_hull(HY), draw);
      check_equals(backend->intersection(EX, Matrix::Identity(n, n), EX), HX, draw);
      const Interval volume = HX.volume();
      CHECK(EX->volume().exact);
      CHECK(EX->volume().value >= volume.lower);
      CHECK(EX->volume().value <= volume.upper * (1 + 1e-9));
    }
  }
}

TEST_CASE("images under interval matrices are convex hulls of all images") {
  const Plugins plugins;
  const auto backend = plugins.backend("polytope", rounded_as("rational"));
  const Enclosure X = backend->box({Vector{{1}}, Vector{{2}}});
  const Box scalar = backend->interval_map(X, {Matrix{{1}}, Matrix{{.25}}})->interval_hull();
  CHECK(scalar.lower[0] == .75);
  CHECK(scalar.upper[0] == 2.5);
  // what |x| is matters point by point, not over the whole segment
  const Enclosure segment{backend->import(make_zonotope(Vector{{2, 2}}, Matrix{{1}, {1}})).set};
  const IntervalMatrix A(Matrix{{1, 0}, {0, 1}}, Matrix{{.5, 0}, {0, 0}});
  const Enclosure image = backend->interval_map(segment, A);
  CHECK(image.tightness == Tightness::outer);
  CHECK(image->support(Vector{{1, 0}}) == 4.5);
  CHECK(image->support(Vector{{-1, 0}}) == -.5);  // of {mid(A) x} ⊕ box: .5
  CHECK(image->support(Vector{{1, -1}}) == 1.5);
  CHECK(image->contains(Vector{{1.5, 1}}) == Answer::yes);
  CHECK(image->contains(Vector{{1.5, 3}}) == Answer::yes);
  CHECK(image->contains(Vector{{1.6, 1}}) == Answer::no);
  CHECK(backend->interval_map(backend->space(2), A)->support(Vector{{1, 0}}) == infinity);
}

TEST_CASE("limits are errors that name them") {
  const Plugins plugins;
  const auto backend = plugins.backend("polytope");
  const auto refusal = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      CHECK(error.code() == Errc::unsupported);
      return error.what();
    }
    return "";
  };
  const Enclosure five = backend->box(cube(5, 1));  // as W may be
  const Matrix I = Matrix::Identity(5, 5), first = Matrix::Identity(1, 5);
  const std::string of_states = "of dimension 5; at most 4 dimensions";
  CHECK(refusal([&] { backend->affine_map(five, I, zero(5)); }).find(of_states) !=
        std::string::npos);
  CHECK(refusal([&] {
          backend->correct(five,
                           {first, zero(1), {Matrix::Identity(1, 1), backend->box(cube(1, 1))}});
        }).find(of_states) != std::string::npos);
  CHECK(refusal([&] { backend->convex_hull(five, five); }).find(of_states) != std::string::npos);
  CHECK(refusal([&] { backend->box(cube(9, 1)); }).find("of dimension 9; at most 8 dimensions") !=
        std::string::npos);
  CHECK(refusal([&] {
          backend->product(backend->box(cube(3, 1)), backend->box(cube(2, 1)));
        }).find(of_states) != std::string::npos);
  CHECK(backend->predict(backend->box(cube(2, 1)), {Matrix::Identity(2, 2), zero(2), {}})->dim() ==
        2);
  const Term term{Matrix::Ones(2, 5), five};
  CHECK(backend->predict(backend->box(cube(2, 1)), {Matrix::Identity(2, 2), zero(2), {&term, 1}})
            ->support(Vector{{1, 0}}) == 6);
  const auto is_refused = [&](const char* name, auto value) {
    Params params;
    params.set(name, value);
    return !plugins.registry.info("backend", "polytope")->schema.complete(params).empty();
  };
  CHECK(is_refused("rounding", std::string("nominal")));
  CHECK(is_refused("facets", std::int64_t{-1}));
  CHECK(is_refused("digits", std::int64_t{-1}));
  CHECK(is_refused("digits", std::int64_t{1} << 40));
  CHECK(is_refused("reduction", std::string("pca")));
}

TEST_CASE("numbers that have grown too long are rounded outward, and the claim says so") {
  const Plugins plugins;
  Params params = rounded_as("rational");
  params.set("digits", std::int64_t{2000});
  const auto backend = plugins.backend("polytope", params);
  const Matrix A{{.9, .3}, {-.2, .8}};
  Enclosure X = backend->box(cube(2, 1));
  Polytope exact = Polytope::from(make_box(cube(2, 1)));
  bool was_exact = false;
  for (int k = 0; k < 30; ++k) {
    X = backend->affine_map(X, A, zero(2));
    exact = exact.affine_map(A, zero(2));
    was_exact = was_exact || X.tightness == Tightness::exact;
    for (const Vector& d : {Vector{{1, 0}}, Vector{{.3, -1}}}) {
      const double h = exact.support(d).upper;
      CHECK(X->support(d) >= h);
      CHECK(X->support(d) <= h * (1 + 1e-12));
    }
  }
  CHECK(was_exact);
  CHECK(X.tightness == Tightness::outer);
}

TEST_CASE("a reduction keeps the facets that cut deepest") {
  const Plugins plugins;
  Params params;
  params.set("facets", std::int64_t{3});
  const auto backend = plugins.backend("polytope", params);
  Matrix G(2, 7);
  for (Index j = 0; j < 7; ++j) {
    const double turn = .4 * static_cast<double>(j) + .1;
    G.col(j) << std::cos(turn), std::sin(turn);
  }
  const Enclosure X = backend->import(make_zonotope(zero(2), G));
  CHECK(X->line_form().constraints() > 3);
  const Enclosure reduced = backend->reduce(X, {});
  CHECK(reduced.tightness == Tightness::outer);
  CHECK(reduced->line_form().constraints() == 3);
  CHECK(Polytope::from(reduced->line_form()).contains(Polytope::from(X->line_form())));
  CHECK(reduced->volume().value > X->volume().value);
  CHECK(reduced->volume().value < 1.2 * X->volume().value);
  CHECK(backend->reduce(reduced, {}).set == reduced.set);
}

TEST_CASE("data that contradict each other by rounding leave the state, others do not") {
  const Plugins plugins;
  for (const char* how : {"outward", "rational"}) {
    CAPTURE(how);
    const auto backend = plugins.backend("polytope", rounded_as(how));
    const Enclosure X = backend->box(cube(2, 3)), nothing = backend->point(Vector(0));
    const Matrix C{{1, .1}, {1, .1}, {3, .3}};  // fl(.3) is not three times fl(.1)
    const auto corrected = [&](double off) {
      return backend->correct(X, {C, Vector{{1, 1 + off, 3}}, {Matrix(3, 0), nothing}});
    };
    const Enclosure kept = corrected(1e-15);
    CHECK(kept->is_empty() == Answer::no);
    CHECK(kept.tightness == Tightness::outer);
    CHECK(kept->contains(Vector{{1, 0}}) != Answer::no);
    CHECK(kept->contains(Vector{{.5, 0}}) == Answer::no);
    CHECK(corrected(1e-6)->is_empty() == Answer::yes);
  }
}

TEST_CASE("answers have proofs about the exchange form where it has them") {
  const Plugins plugins;
  const auto backend = plugins.backend("polytope", rounded_as("outward"));
  Draw draw(5);
  for (Index n = 1; n <= 3; ++n) {
    const Enclosure X = backend->import(draw.zonotope(n, false));
    const LineForm form = X->line_form();
    Certificate why;
    CHECK(X->is_empty(&why) == Answer::no);
    CHECK(proves_not_empty(form, why));
    std::vector<Certificate> proofs;
    const Box hull = X->interval_hull(&proofs);
    REQUIRE(proofs.size() == static_cast<std::size_t>(2 * n));
    for (Index i = 0; i < n; ++i) {
      const double slack = 1e-14 * form.G.row(i).cwiseAbs().sum();
      CHECK(proves_support(form, Vector::Unit(n, i), hull.upper[i] + slack,
                           proofs[static_cast<std::size_t>(2 * i)]));
      CHECK(proves_support(form, -Vector::Unit(n, i), -hull.lower[i] + slack,
                           proofs[static_cast<std::size_t>(2 * i + 1)]));
    }
  }
  const Enclosure none = backend->empty(2);
  Certificate why;
  CHECK(none->is_empty(&why) == Answer::yes);
  CHECK(proves_empty(none->line_form(), why));
}

TEST_CASE("sets without bounds stay what they are") {
  const Plugins plugins;
  for (const char* how : {"outward", "rational"}) {
    CAPTURE(how);
    const auto backend = plugins.backend("polytope", rounded_as(how));
    const Enclosure space = backend->space(3);
    CHECK(space.tightness == Tightness::exact);
    const Enclosure strip = backend->correct(
        space, {Matrix{{1, 2, 0}}, Vector{{3}}, {Matrix{{1.}}, backend->box(cube(1, .5))}});
    CHECK(strip->is_bounded() == Answer::no);
    CHECK(strip->support(Vector{{1, 2, 0}}) == 3.5);
    CHECK(strip->support(Vector{{1, 0, 0}}) == infinity);
    CHECK(strip->complexity().lines == 2);
    CHECK(strip->volume().value == infinity);
    CHECK(strip->contains(Vector{{3, 0, 1e9}}) == Answer::yes);
    CHECK(strip->contains(Vector{{0, 0, 0}}) == Answer::no);
    const Enclosure cut =
        backend->intersection(strip, Matrix::Identity(3, 3), backend->box(cube(3, 2)));
    CHECK(cut->is_bounded() == Answer::yes);
    CHECK(cut->support(Vector{{-1, 0, 0}}) == 1.5);
  }
}
