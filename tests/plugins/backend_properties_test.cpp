// SPDX-License-Identifier: GPL-3.0-or-later
// Every backend encloses: points of the operands, mapped by hand, lie in the result of every
// operation. And a claim of `exact` means the support function of the exact block form. Sets are
// random, degenerate, flat, badly scaled, empty or unbounded.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "published/study_models.hpp"

using namespace cordon;

namespace {

/// A set with points known to lie in it.
struct Sampled {
  LineForm form;
  std::vector<Vector> points;
  double scale = 1;
};

double number(int range = 1000) {
  return static_cast<double>(*rc::gen::inRange(-range, range + 1)) / range;
}

Matrix random_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index k = 0; k < A.size(); ++k) A.data()[k] = *rc::gen::inRange(0, 4) == 0 ? 0.0 : number();
  return A;
}
Vector random_vector(Index n) { return random_matrix(n, 1); }

/// Orthogonal projector on the null space of the rows.
Matrix null_projector(const Matrix& rows) {
  const Matrix basis = linalg::null_space(rows);
  return basis * basis.transpose();
}

/// {c + Mδ + Gξ : Sδ + Aξ = b} around one feasible (δ, ξ); more points along the rows' null space.
Sampled random_set(Index n, bool lines_allowed) {
  const int kind = *rc::gen::inRange(0, 6);  // 0 point, 1 flat, 2 badly scaled, else ordinary
  const Index g = kind == 0 ? 0 : *rc::gen::inRange<Index>(1, 8);
  const Index m = g > 1 ? *rc::gen::inRange<Index>(0, std::min<Index>(3, g)) : 0;
  const Index l = lines_allowed && kind > 2 ? *rc::gen::inRange<Index>(0, 3) : 0;
  Sampled s;
  s.form = {random_matrix(n, l), random_matrix(n, g), random_vector(n),
            random_matrix(m, l), random_matrix(m, g), Vector(m)};
  if (kind == 1) s.form.G.row(0).setZero();
  if (kind == 2) {
    for (Index j = 0; j < g; ++j) s.form.G.col(j) *= std::pow(10.0, *rc::gen::inRange(-8, 9));
  }
  const Vector xi = 0.9 * random_vector(g), delta = random_vector(l);
  s.form.b = s.form.S * delta + s.form.A * xi;
  s.points.push_back(s.form.c + s.form.M * delta + s.form.G * xi);
  Matrix rows(m, l + g);
  rows << s.form.S, s.form.A;
  const Matrix kernel = null_projector(rows);
  for (int more = 0; more < 3 && l + g > 0; ++more) {
    Vector step = kernel * random_vector(l + g);
    Vector full(l + g);
    full << delta, xi;
    double t = 1;
    for (Index j = 0; j < g; ++j) {
      const double d = step[l + j];
      if (d > 0) t = std::min(t, (1 - xi[j]) / d);
      if (d < 0) t = std::min(t, (-1 - xi[j]) / d);
    }
    if (!step.allFinite() || (m > 0 && (rows * step).cwiseAbs().maxCoeff() > 1e-12)) continue;
    full += t * step;
    s.points.push_back(s.form.c + s.form.M * full.head(l) + s.form.G * full.tail(g));
  }
  s.scale = 1 + s.form.c.cwiseAbs().maxCoeff() + (g ? s.form.G.cwiseAbs().sum() : 0) +
            (l ? s.form.M.cwiseAbs().sum() : 0);
  return s;
}

struct Case {
  std::string name;
  bool lines;  ///< is it given sets with lines? every backend must enclose what it accepts
  std::string rounding = "nominal";
  Index largest_dim = 3;  ///< of operands, whose product it must hold

  std::shared_ptr<const SetBackend> backend(const Plugins& plugins) const {
    if (name != "polytope") return plugins.backend(name, Params().set("rounding", rounding));
    const bool rounds = rounding == "outward";
    return plugins.backend(name, rounds ? Params().set("digits", std::int64_t{0}) : Params());
  }
};
const std::vector<Case> cases = [] {
  std::vector<Case> all;
  for (const std::string rounding : {"nominal", "outward"}) {
    for (const std::string name :
         {"interval", "zonotope", "constrained_zonotope", "ellipsoid", "line_zonotope"})
      all.push_back({name, name == "line_zonotope", rounding});
  }
  for (const char* rounding : {"outward", "rational"})
    all.push_back({"polytope", true, rounding, 2});
  return all;
}();

void assert_contains(const Enclosure& X, const Vector& x, double scale, const char* what) {
  RC_LOG() << what << "\n";
  RC_ASSERT(X->is_empty() != Answer::yes);
  const Box hull = X->interval_hull();
  for (Index i = 0; i < x.size(); ++i) {
    RC_ASSERT(hull.lower[i] <= x[i] + 1e-9 * scale);
    RC_ASSERT(hull.upper[i] >= x[i] - 1e-9 * scale);
  }
  for (int k = 0; k < 2; ++k) {
    const Vector d = random_vector(x.size());
    RC_ASSERT(X->support(d) >= d.dot(x) - 1e-8 * scale);
  }
}

/// If `exact` is claimed, the support function is that of the exact form (which must not be empty).
void assert_claim(const Enclosure& X, const LineForm& exact, double scale) {
  if (X.tightness != Tightness::exact) return;
  for (int k = 0; k < 2; ++k) {
    const Vector d = random_vector(exact.dim());
    const double expected = support(exact, d), got = X->support(d);
    if (std::isinf(expected) || std::isinf(got)) {
      RC_ASSERT(expected == got);
    } else {
      RC_ASSERT(std::abs(expected - got) <= 1e-7 * scale);
    }
  }
}

/// One property: every operation on random sets.
void check_operations(const Case& c, const SetBackend& backend) {
  const Index n = *rc::gen::inRange<Index>(1, c.largest_dim + 1),
              p = *rc::gen::inRange<Index>(1, c.largest_dim + 1);
  const Sampled X = random_set(n, c.lines), Y = random_set(p, c.lines);
  const double scale = X.scale + Y.scale;
  const Enclosure EX = backend.import(X.form), EY = backend.import(Y.form);
  for (const Vector& x : X.points) assert_contains(EX, x, scale, "import");
  assert_claim(EX, X.form, scale);

  // A X ⊕ {f} ⊕ T Y
  const Matrix A = random_matrix(p, n), T = random_matrix(p, p);
  const Vector f = random_vector(p);
  const Term term{T, EY};
  const Enclosure predicted = backend.predict(EX, {A, f, {&term, 1}});
  for (const Vector& x : X.points) {
    for (const Vector& y : Y.points)
      assert_contains(predicted, A * x + f + T * y, 10 * scale, "predict");
  }
  assert_claim(predicted,
               minkowski_sum(affine_map(X.form, A, f), affine_map(Y.form, T, Vector::Zero(p))),
               100 * scale);

  // {x ∈ X : z - C x ∈ T Y} with z chosen so that a known x stays
  const Vector& kept = X.points.front();
  const Vector z = A * kept + T * Y.points.back();
  const Enclosure corrected = backend.correct(EX, {A, z, {T, EY}});
  assert_contains(corrected, kept, 10 * scale, "correct");

  assert_contains(backend.product(EX, EY), (Vector(n + p) << kept, Y.points.front()).finished(),
                  scale, "product");
  const Enclosure both = backend.intersection(
      EX, Matrix::Identity(n, n),
      backend.import(make_box({kept - Vector::Constant(n, .5), kept + Vector::Constant(n, .5)})));
  assert_contains(both, kept, scale, "intersection");

  const Matrix radius = random_matrix(p, n).cwiseAbs();
  const IntervalMatrix interval(A, radius);
  assert_contains(backend.interval_map(EX, interval), (A + radius * number()) * kept, 10 * scale,
                  "interval map");

  const Sampled Z = random_set(n, c.lines);
  const Enclosure EZ = backend.import(Z.form);
  const double mix = (number() + 1) / 2;
  assert_contains(backend.convex_hull(EX, EZ), mix * kept + (1 - mix) * Z.points.front(),
                  scale + Z.scale, "convex hull");

  const Budget budget{n + 2, *rc::gen::inRange<Index>(0, 3)};
  const Enclosure reduced = backend.reduce(predicted, {p + 2, budget.constraints});
  for (const Vector& x : X.points)
    assert_contains(reduced, A * x + f + T * Y.points.front(), 10 * scale, "reduce");
  const Complexity size = reduced->complexity();
  RC_ASSERT(size.generators <= p + 2);
  RC_ASSERT(size.constraints <= budget.constraints);
  assert_claim(reduced,
               minkowski_sum(affine_map(X.form, A, f), affine_map(Y.form, T, Vector::Zero(p))),
               100 * scale);
}

}  // namespace

TEST_CASE("operations enclose and keep their claims") {
  const Plugins plugins;
  for (const Case& c : cases) {
    CAPTURE(c.name);
    CAPTURE(c.rounding);
    const auto backend = c.backend(plugins);
    CHECK(rc::check(c.name, [&] { check_operations(c, *backend); }));
  }
}

TEST_CASE("an ellipsoid around constraints is not claimed to be the set") {
  const Plugins plugins;
  const auto backend = plugins.backend("ellipsoid");
  // a segment of the diagonal, and its image
  const LineForm X{Matrix(2, 0), Matrix::Identity(2, 2), Vector::Zero(2),
                   Matrix(1, 0), Matrix{{1, -1}},        Vector{{0.0}}};
  const Enclosure segment = backend->import(X);
  CHECK(segment.tightness == Tightness::exact);
  CHECK(segment->support(Vector{{1, -1}}) == doctest::Approx(0));
  const Matrix T{{2, 0}, {0, 1}};
  CHECK(backend->affine_map(segment, T, Vector::Zero(2)).tightness == Tightness::outer);
  CHECK(backend->interval_map(segment, IntervalMatrix(T)).tightness == Tightness::outer);
  const Enclosure plain = backend->import(make_zonotope(Vector{{1, 2}}, Matrix{{1}, {1}}));
  CHECK(backend->affine_map(plain, T, Vector::Zero(2)).tightness == Tightness::exact);
}

TEST_CASE("the empty set absorbs, and is neutral in the hull") {
  const Plugins plugins;
  for (const Case& c : cases) {
    CAPTURE(c.name);
    CAPTURE(c.rounding);
    const auto backend = c.backend(plugins);
    const Enclosure X = backend->box(cube(2, 1)), none = backend->empty(2);
    const Matrix I = Matrix::Identity(2, 2);
    CHECK(none->is_empty() == Answer::yes);
    CHECK(backend->sum(X, none)->is_empty() == Answer::yes);
    CHECK(backend->sum(none, X)->is_empty() == Answer::yes);
    CHECK(backend->product(X, none)->is_empty() == Answer::yes);
    CHECK(backend->intersection(X, I, none)->is_empty() == Answer::yes);
    CHECK(backend->affine_map(none, I, Vector::Zero(2))->is_empty() == Answer::yes);
    CHECK(none->support(Vector{{1, 0}}) == -infinity);
    CHECK(none->interval_hull().is_empty());
    CHECK(none->contains(Vector{{0, 0}}) == Answer::no);
    CHECK(none->is_subset_of(*X) == Answer::yes);
    CHECK(none->is_disjoint_from(*X) == Answer::yes);
    CHECK(none->volume().value == 0);
    for (const Enclosure& hull : {backend->convex_hull(X, none), backend->convex_hull(none, X)}) {
      CHECK(hull->support(Vector{{1, 1}}) == doctest::Approx(2));
    }
    CHECK(backend
              ->correct(X, {Matrix{{1, 0}}, Vector{{5}}, {Matrix{{1.0}}, backend->box(cube(1, 1))}})
              ->is_empty() == Answer::yes);
  }
}

TEST_CASE("unbounded sets: lines and boxes hold them, the others refuse") {
  const Plugins plugins;
  for (const Case& c : cases) {
    CAPTURE(c.name);
    CAPTURE(c.rounding);
    const auto backend = c.backend(plugins);
    if (!backend->info().unbounded) {
      CHECK_THROWS_AS(backend->space(2), Error);
      continue;
    }
    const Enclosure space = backend->space(2);
    CHECK(space->is_empty() == Answer::no);
    CHECK(space->contains(Vector{{0, 0}}) == Answer::yes);
    CHECK(space->is_bounded() == Answer::no);
    CHECK(space->support(Vector{{0, 1}}) == infinity);
    const Enclosure strip = backend->correct(
        space, {Matrix{{0, 1}}, Vector{{3}}, {Matrix{{1.0}}, backend->box(cube(1, 1))}});
    const Box hull = strip->interval_hull();
    CHECK(hull.upper[0] == infinity);
    CHECK(hull.lower[1] == doctest::Approx(2));
    CHECK(hull.upper[1] == doctest::Approx(4));
  }
}

TEST_CASE("dimension 0, points and unlike operands") {
  const Plugins plugins;
  const auto interval = plugins.backend("interval");
  for (const Case& c : cases) {
    CAPTURE(c.name);
    CAPTURE(c.rounding);
    const auto backend = c.backend(plugins);
    const Enclosure nothing = backend->point(Vector(0));
    CHECK(nothing->dim() == 0);
    CHECK(nothing->is_empty() == Answer::no);
    const Enclosure point = backend->point(Vector{{1, 2}});
    CHECK(backend->product(point, nothing)->dim() == 2);
    CHECK(point->contains(Vector{{1, 2}}) == Answer::yes);
    // coordinates that are flat but for outward rounding: their product underflows
    CHECK(backend->product(point, point)->volume().value == doctest::Approx(0));
    CHECK(backend->product(nothing, backend->point(Vector{{0, 0}}))->volume().value ==
          doctest::Approx(0));
    if (backend->info().unbounded) {
      const Volume thin = backend
                              ->product(backend->affine_map(backend->point(Vector{{0, 0}}),
                                                            Matrix::Identity(2, 2), Vector{{0, 0}}),
                                        backend->space(1))
                              ->volume();
      CHECK(thin.value >= 0);
    }
    // an operand of another backend is imported
    const Enclosure sum = backend->sum(point, interval->box(cube(2, 1)));
    CHECK(&sum->backend() == backend.get());
    const bool round = c.name == "ellipsoid";  // the circle around the square
    CHECK(sum->support(Vector{{1, 0}}) == doctest::Approx(round ? 1 + std::sqrt(2) : 2));
    CHECK_THROWS_AS(backend->sum(point, nothing), Error);
    CHECK_THROWS_AS(backend->affine_map(point, Matrix{{1.0, std::nan("")}}, Vector{{0.0}}), Error);
    CHECK_THROWS_AS(point->contains(Vector{{1.0}}), Error);
  }
}

namespace {

/// Hands out sets of dimension 1 whatever is asked for; everything else is left to the framework.
class Shrinking final : public SetBackend {
 public:
  explicit Shrinking(Index kept) : SetBackend(info_of()), kept_(kept) {}

 private:
  class Held final : public Set {
   public:
    Held(const SetBackend& backend, LineForm form)
        : Set(backend, form.dim()), form_(std::move(form)) {}

   private:
    Complexity do_complexity() const override {
      return {form_.generators(), form_.lines(), form_.constraints()};
    }
    LineForm do_line_form() const override { return form_; }
    LineForm form_;
  };
  static BackendInfo info_of() {
    BackendInfo info;
    info.name = "shrinking";
    info.unbounded = true;
    return info;
  }
  Made do_import(const LineForm& X) const override {
    const Index n = std::min(kept_, X.dim());
    return {std::make_unique<Held>(
                *this, cordon::affine_map(X, Matrix::Identity(n, X.dim()), Vector::Zero(n))),
            Tightness::exact};
  }
  Index kept_;
};

/// The framework's own operations on exchange forms.
std::shared_ptr<const SetBackend> defaults() { return std::make_shared<Shrinking>(100); }

}  // namespace

TEST_CASE("a result of another dimension is the plugin's error") {
  const auto backend = std::make_shared<Shrinking>(1);
  const Enclosure X = backend->point(Vector{{1}});
  const auto refused = [&](const auto& operation, const std::string& name) {
    try {
      operation();
    } catch (const Error& error) {
      CHECK(error.code() == Errc::plugin);
      CHECK(std::string(error.what()).find("backend shrinking, " + name) != std::string::npos);
      return;
    }
    FAIL_CHECK(name << " was accepted");
  };
  refused([&] { backend->point(Vector{{1, 2}}); }, "import");
  refused([&] { backend->affine_map(X, Matrix{{1}, {2}}, Vector{{0, 0}}); }, "predict");
  refused([&] { backend->product(X, X); }, "predict");
  refused([&] { backend->interval_map(X, IntervalMatrix(Matrix{{1}, {2}})); }, "interval map");
}

TEST_CASE("sets that touch where z - T c - C x cancels are not called empty") {
  const Plugins plugins;
  std::vector<std::shared_ptr<const SetBackend>> backends{defaults()};
  for (const Case& c : cases) backends.push_back(c.backend(plugins));
  const double ulp = 0x1p-52;
  for (const auto& backend : backends) {
    CAPTURE(backend->info().name);
    CAPTURE(backend->info().rounding == Rounding::outward);
    const auto correct = [&](const Enclosure& X, const Matrix& C, const Vector& z, const Matrix& T,
                             const Enclosure& V) {
      return backend->correct(X, {C, z, {T, V}})->is_empty();
    };
    const Enclosure origin = backend->point(Vector{{0}});
    CHECK(correct(origin, Matrix{{0}}, Vector{{.3}}, Matrix{{3}}, backend->point(Vector{{.1}})) !=
          Answer::yes);
    CHECK(correct(origin, Matrix{{0}}, Vector{{.30000000000000004}}, Matrix{{3}},
                  backend->point(Vector{{.1}})) != Answer::yes);
    const Enclosure one = backend->box({Vector{{1 - ulp}}, Vector{{1 + 2 * ulp}}});
    const Enclosure zero = backend->box({Vector{{-ulp}}, Vector{{ulp}}});
    const Matrix C{{0}, {0}}, T{{1}, {-3}};
    CHECK(correct(zero, C, Vector{{1, -3}}, T, one) != Answer::yes);
    CHECK(correct(origin, C, Vector{{1, -3 * (1 + ulp)}}, T, backend->point(Vector{{1}})) !=
          Answer::yes);
    CHECK(correct(origin, C, Vector{{1e-9, -3e-9}}, T, backend->point(Vector{{1e-9}})) !=
          Answer::yes);
    // what does not cancel stays a statement, however small
    CHECK(correct(origin, Matrix{{0}}, Vector{{1e-9}}, Matrix{{3}},
                  backend->point(Vector{{1e-12}})) == Answer::yes);
    CHECK(correct(origin, Matrix{{0}}, Vector{{.3001}}, Matrix{{3}},
                  backend->point(Vector{{.1}})) == Answer::yes);
  }
}
