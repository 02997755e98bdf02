// SPDX-License-Identifier: GPL-3.0-or-later
// What the backend `polytope` answers itself: subsets, disjointness, products, vertices that are
// reached, views with inequalities, sizes; and where its work ends.
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/polytope.hpp"
#include "published/study_models.hpp"

using namespace cordon;

namespace {

std::shared_ptr<const SetBackend> polytopes(Params params = {}) {
  static const Plugins plugins;
  return plugins.backend("polytope", std::move(params));
}

/// {x : |x_1| + |x_2| ≤ r}
View diamond(double r) {
  const Matrix H{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  return {make_space(2), {H, Vector::Constant(4, r)}, Tightness::exact};
}

std::string refusal(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(error.code() == Errc::unsupported);
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const char* part) {
  CAPTURE(text);
  return text.find(part) != std::string::npos;
}

LineForm zonotope(Index n, Index g, double turn) {
  Matrix G(n, g);
  for (Index j = 0; j < g; ++j) {
    for (Index i = 0; i < n; ++i)
      G(i, j) = std::sin(turn * static_cast<double>(1 + i + (j + 1) * (j + 1) * (i + 2)));
  }
  return make_zonotope(Vector::Zero(n), G);
}

}  // namespace

TEST_CASE("subsets and disjointness are decided to the last bit") {
  const auto backend = polytopes();
  const Enclosure box = backend->box(cube(2, 1)), larger = backend->box(cube(2, 1 + 1e-15)),
                  round = backend->import(diamond(2));
  CHECK(box->is_subset_of(*larger) == Answer::yes);
  CHECK(larger->is_subset_of(*box) == Answer::no);
  CHECK(box->is_subset_of(*round) == Answer::yes);  // in its corners
  CHECK(larger->is_subset_of(*round) == Answer::no);
  const Enclosure beside = backend->box({Vector{{1, -1}}, Vector{{2, 1}}}),
                  apart = backend->box({Vector{{1 + 1e-15, -1}}, Vector{{2, 1}}});
  CHECK(box->is_disjoint_from(*beside) == Answer::no);
  CHECK(box->is_disjoint_from(*apart) == Answer::yes);
  // boxes around both overlap
  const Enclosure tip = backend->box({Vector{{1.5, .75}}, Vector{{2, 2}}});
  CHECK(round->is_disjoint_from(*tip) == Answer::yes);
  CHECK(backend->empty(2)->is_subset_of(*box) == Answer::yes);
}

TEST_CASE("products are exact, and hold at most four coordinates") {
  const auto backend = polytopes();
  const Enclosure round = backend->import(diamond(1)), segment = backend->box(cube(1, .1));
  const Enclosure both = backend->product(round, segment);
  CHECK(both.tightness == Tightness::exact);
  CHECK(both->support(Vector{{1, 1, 1}}) == 1.1);
  CHECK(both->complexity().count("facets") == 6);
  CHECK(both->complexity().count("vertices") == 8);
  CHECK(says(refusal([&] { backend->product(both, round); }), "of dimension 5; at most 4"));
}

TEST_CASE("a vertex is told that reaches the support value") {
  const auto backend = polytopes();
  const Enclosure round = backend->import(diamond(1));
  Vector at;
  CHECK(round->support(Vector{{.3, -2}}, &at) == 2);
  CHECK(at == Vector{{0, -1}});
  const Enclosure none = backend->empty(2);
  CHECK(none->support(Vector{{1, 0}}, &at) == -infinity);
  CHECK(at.size() == 0);
}

TEST_CASE("inequalities of views are taken as they are, and sets are seen with them") {
  const auto backend = polytopes();
  const Enclosure round = backend->import(diamond(1));  // its form is all of the plane
  CHECK(round.tightness == Tightness::exact);
  CHECK(round->support(Vector{{1, 0}}) == 1);
  const View half{make_space(2), {Matrix{{1, .1}}, Vector{{.3}}}, Tightness::exact};
  const Enclosure X = backend->import(half);
  CHECK(X.tightness == Tightness::exact);
  CHECK(X->support(Vector{{1, .1}}) == .3);
  CHECK(X->support(Vector{{1, 0}}) == infinity);
  const View seen = X->view();
  CHECK(seen.claim == Tightness::exact);
  CHECK(seen.rows.rows() == 1);
  CHECK_FALSE(X->has_exact_form());
  CHECK(backend->import(seen)->is_subset_of(*X) == Answer::yes);
  // a third of the bound is no double
  const Enclosure left =
      backend->import(View{make_space(2), {Matrix{{1, 0}}, Vector{{.3}}}, Tightness::exact});
  const Enclosure third =
      backend->affine_map(left, Matrix{{1. / 3, 0}, {0, 1. / 7}}, Vector{{0, .1}});
  const View around = third->view();
  CHECK(around.rows.rows() == 1);
  CHECK(around.claim == Tightness::outer);
  CHECK(third->is_bounded() == Answer::no);
  CHECK(third->is_subset_of(*backend->import(around)) == Answer::yes);
  const View outer{make_space(2), {Matrix{{1, 0}}, Vector{{1.}}}, Tightness::outer};
  CHECK(backend->import(outer).tightness == Tightness::outer);
}

TEST_CASE("what takes more work than is allowed is an error that names the limit") {
  const auto million = polytopes(Params().set("max_work", std::int64_t{1}));
  const Enclosure X = million->import(zonotope(3, 6, 1)), Y = million->import(zonotope(3, 6, 2));
  const std::string text = refusal([&] { million->sum(X, Y); });
  CHECK(says(text, "more than 1 million operations on machine words, the limit of exact work"));
  CHECK(says(text, "raise `max_work`"));
  const auto usual = polytopes();
  const Enclosure sum =
      usual->sum(usual->import(zonotope(3, 6, 1)), usual->import(zonotope(3, 6, 2)));
  CHECK(sum.tightness == Tightness::exact);
  const Vector d{{1, .5, -.25}};
  CHECK(sum->support(d) >= X->support(d) + Y->support(d) - 1e-12);
  CHECK(refusal([&] { usual->import(zonotope(4, 40, 1)); }) != "");
}

TEST_CASE("maps by interval matrices beyond the limit of work are wider, and not refused") {
  const auto little = polytopes(Params().set("max_work", std::int64_t{4})), usual = polytopes();
  const IntervalMatrix A(Matrix::Identity(3, 3), Matrix::Constant(3, 3, .1));
  const LineForm form = zonotope(3, 6, 1);
  const Enclosure X = little->interval_map(little->import(form), A),
                  Y = usual->interval_map(usual->import(form), A);
  const Vector d{{1, .5, -.25}};
  CHECK(X->support(d) > Y->support(d));
  CHECK(X.tightness == Tightness::outer);
}
