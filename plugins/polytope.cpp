// SPDX-License-Identifier: GPL-3.0-or-later
// Half-spaces and vertices over the rationals. Operations are exact; what they give is rounded
// outward to doubles when its numbers have grown long. Work is counted, and has a limit.
#include "cordon/solvers/polytope.hpp"

#include <algorithm>
#include <cmath>

#include "adapter.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/sets/interval.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "cordon/solvers/view_questions.hpp"
#include "cut_box.hpp"
#include "polytope_images.hpp"
#include "polytope_view.hpp"

namespace {

using namespace cordon;
using plugins::Operand;
using plugins::Polyhedron;

constexpr Index most_states = 4;      ///< of what an operation makes
constexpr Index most_given = 8;       ///< of a set that is given: W and V may have more coordinates
constexpr Index most_size = 2000;     ///< facets of a set, and vertices
constexpr double most_points = 4000;  ///< of the hull that encloses an interval map
constexpr double question_work = 1e8;

[[noreturn]] void refuse_dimension(const char* what, Index n, Index limit) {
  throw Error(Errc::unsupported, "polytope: " + std::string(what) + " of dimension " +
                                     std::to_string(n) + "; at most " + std::to_string(limit) +
                                     " dimensions are supported, for vertices and facets grow "
                                     "exponentially: use constrained_zonotope or line_zonotope");
}

constexpr const char* way_out =
    "; let fewer `facets` be kept, raise `max_work`, or use line_zonotope";

void limit_states(Index n) {
  if (n > most_states) refuse_dimension("a set", n, most_states);
}

/// With both descriptions, which the next operation needs anyway.
Polytope settled(Polytope P) {
  const Polytope::Inequalities faces = P.inequalities();
  const Index facets = faces.h.size() + faces.q.size(), vertices = P.generators().vertices.cols();
  if (facets > most_size || vertices > most_size) {
    throw Error(Errc::unsupported, "polytope: a set with " + std::to_string(facets) +
                                       " facets and " + std::to_string(vertices) +
                                       " vertices; at most " + std::to_string(most_size) +
                                       " of each are supported");
  }
  return P;
}

Vector zeros(Index n) { return Vector::Zero(n); }

struct Polyhedra {
  using Value = Polyhedron;
  using Result = plugins::ResultOf<Polyhedron>;

  std::optional<Index> facets;  ///< that cut the interval hull, kept by `reduce`
  std::size_t digits = 0;
  double work = 0;  ///< of one operation

  // ---- making

  /// Carries out an operation within the limit of its work.
  Result bounded(const auto& operation) const {
    const ExactBudget budget(work);
    try {
      return operation();
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
      throw Error(Errc::unsupported, std::string(error.what()) + way_out);
    }
  }

  /// What is left after rounding equals its view.
  static Result held(View seen) {
    seen.claim = Tightness::exact;
    Polytope P = settled(plugins::polytope_of(seen));
    return {Polyhedron(std::move(P), std::move(seen), true), Tightness::outer};
  }
  Result finish(Polytope P, Tightness claim = Tightness::exact) const {
    P = settled(std::move(P));
    if (P.bits() <= digits) return {Polyhedron(std::move(P)), claim};
    View seen = plugins::view_of(P);
    if (seen.claim == Tightness::outer) return held(std::move(seen));
    return {Polyhedron(std::move(P), std::move(seen), false), claim};
  }

  Result import_view(const View& X) const {
    if (X.dim() > most_given) refuse_dimension("a set that is given", X.dim(), most_given);
    return bounded([&] { return finish(plugins::polytope_of(X)); });
  }
  Result import(const LineForm& X) const { return import_view({X}); }

  Result predict(const Value& X, MatrixIn A, VectorIn f,
                 std::span<const Operand<Value>> operands) const {
    limit_states(A.rows());
    return bounded([&] {
      std::optional<Polytope> added;  // these first: they are small
      for (const auto& operand : operands) {
        Polytope term = operand.value.set.affine_map(operand.T, zeros(A.rows()));
        added = added ? added->minkowski_sum(term) : std::move(term);
      }
      const Polytope image = X.set.affine_map(A, f);
      return finish(added ? image.minkowski_sum(*added) : image);
    });
  }

  Result product(const Value& X, const Value& Y) const {
    limit_states(X.set.dim() + Y.set.dim());
    return bounded([&] { return finish(X.set.cartesian_product(Y.set)); });
  }

  Result correct(const Value& X, MatrixIn C, VectorIn z, const Operand<Value>& noise) const {
    limit_states(X.set.dim());
    return bounded([&] { return corrected(X, C, z, noise); });
  }
  Result corrected(const Value& X, MatrixIn C, VectorIn z, const Operand<Value>& noise) const {
    const Matrix minus = -noise.T;
    const Polytope measured = noise.value.set.affine_map(minus, z);
    const Polytope kept = X.set.intersection(C, measured);
    if (X.set.is_empty() || measured.is_empty()) return finish(kept);
    const Vector terms =
        z.cwiseAbs() + C.cwiseAbs() * extent(X) + minus.cwiseAbs() * extent(noise.value);
    const auto with_room = [&](const Vector& room) {
      return X.set.intersection(C, measured.minkowski_sum(Polytope::from(make_box({-room, room}))));
    };
    if (kept.is_empty()) {  // by a hair?
      const Polytope wider = with_room(tolerances::proof_margin * terms);
      return wider.is_empty() ? finish(kept) : finish(wider, Tightness::outer);
    }
    const Vector room = room_for_data(kept, C, terms);
    return room.isZero(0) ? finish(kept) : finish(with_room(room), Tightness::outer);
  }
  /// Where outputs leave next to nothing along a row, that they were rounded before they came here
  /// decides over all other directions.
  static Vector room_for_data(const Polytope& kept, MatrixIn C, const Vector& terms) {
    constexpr double thin = 1e-5;
    Vector room = zeros(C.rows());
    for (Index i = 0; i < C.rows(); ++i) {
      const Vector row = C.row(i);
      if (row.isZero(0)) continue;
      const double width = kept.support(row).upper + kept.support(-row).upper;
      if (width <= thin * terms[i]) room[i] = tolerances::product_noise * terms[i];
    }
    return room;
  }
  /// Magnitudes of the coordinates, 0 for those without bounds.
  static Vector extent(const Value& X) {
    const Box hull = X.set.interval_hull();
    const Vector size = hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
    return size.array().isFinite().select(size, 0.0);
  }

  Result interval_map(const Value& X, const IntervalMatrix& A) const {
    const Index m = A.rows(), n = X.set.dim();
    limit_states(m);
    return bounded([&] {
      if (A.is_exact()) return finish(X.set.affine_map(A.center, zeros(m)));
      if (X.set.is_empty()) return finish(Polytope::empty(m));
      const double pieces = std::ldexp(1.0, static_cast<int>(m + n));
      const auto points = static_cast<double>(X.set.generators().vertices.cols());
      if (n > most_states || !X.set.is_bounded() || pieces * points > most_points)
        return spread(X, A);
      try {
        const ExactBudget half(work / 2);
        return finish(plugins::hull_of_images(X.set, A), Tightness::outer);
      } catch (const Error& error) {
        if (error.code() != Errc::unsupported) throw;
        return spread(X, A);
      }
    });
  }
  /// mid(A) x + Δ x with |Δ x| ≤ rad(A) |x|, |x| bounded by the interval hull.
  Result spread(const Value& X, const IntervalMatrix& A) const {
    const Box box = sets::interval_map(X.set.interval_hull(),
                                       IntervalMatrix(Matrix::Zero(A.rows(), A.cols()), A.radius));
    return finish(
        X.set.affine_map(A.center, zeros(A.rows())).minkowski_sum(Polytope::from(make_box(box))),
        Tightness::outer);
  }

  Result intersection(const Value& X, MatrixIn R, const Value& Y) const {
    limit_states(X.set.dim());
    return bounded([&] { return finish(X.set.intersection(R, Y.set)); });
  }
  Result convex_hull(const Value& X, const Value& Y) const {
    limit_states(X.set.dim());
    return bounded([&] { return finish(X.set.convex_hull(Y.set)); });
  }
  /// Budgets count generators and rows, of which this representation has none; `facets` is its own.
  std::optional<Result> reduce(const Value& X, Budget) const {
    constexpr Index all = 0;
    const Index n = X.set.dim(), most = facets.value_or(n < 3 ? all : n == 3 ? 60 : 6);
    if (most == all || X.set.inequalities().h.size() <= most || plugins::is_one_sided(X.set))
      return std::nullopt;
    const LineForm& form = X.view().form;
    if (form.constraints() <= most) return std::nullopt;
    return bounded([&] {
      return held({plugins::with_largest_facets(form, X.set.generators().vertices, most)});
    });
  }

  // ---- questions

  Index dim(const Value& X) const { return X.set.dim(); }
  LineForm line_form(const Value& X) const { return X.view().form; }
  bool has_exact_form(const Value& X) const { return X.view().is_exact_form(); }
  View view(const Value& X) const { return X.view(); }
  /// What a rounded set was made of, or both descriptions, from which its view follows.
  void serialize(Value& X, Archive& archive) const {
    bool is_made_of_view = X.is_made_of_view;
    archive(is_made_of_view);
    View seen = !archive.is_reading() && is_made_of_view ? X.view() : View{};
    std::string text =
        !archive.is_reading() && !is_made_of_view ? X.set.descriptions() : std::string();
    if (is_made_of_view) {
      archive(seen.form, seen.rows.H, seen.rows.h);
    } else {
      archive(text);
    }
    if (!archive.is_reading()) return;
    try {
      const auto read = [&] {
        if (!is_made_of_view) return Result{Polyhedron(Polytope::from_descriptions(text))};
        check(seen, "a polytope that was saved");
        return held(std::move(seen));
      };
      X = bounded(read).value;
    } catch (const Error& error) {
      archive.refuse(error.what());
    }
  }
  /// Both descriptions are found for the next step anyway.
  Complexity complexity(const Value& X) const {
    const Polytope::Generators all = X.set.generators();
    const Index rows = X.set.inequalities().h.size();
    return {0, all.lines.cols(), 0, {{"facets", rows}, {"vertices", all.vertices.cols()}}};
  }
  Answer is_empty(const Value& X, Certificate* why) const {
    const bool empty = X.set.is_empty();
    if (why)
      *why = empty ? Certificate{Certificate::Kind::farkas, Vector::Ones(1), 1} : point_in(X);
    return empty ? Answer::yes : Answer::no;
  }
  /// The solver's point of the view, where it proves something: thin sets may leave it no room. Of
  /// a view that is outer it proves what is recorded, and no more.
  static Certificate point_in(const Value& X) {
    const View& view = X.view();
    Certificate why;
    if (cordon::is_empty(view, &why) == Answer::no && proves_not_empty(view, why)) return why;
    return {};
  }
  /// `no` beyond the rounding of data alone.
  Answer contains(const Value& X, VectorIn x, Certificate*) const {
    if (X.set.is_empty()) return Answer::no;
    if (X.set.contains(x)) return Answer::yes;
    const Polytope::Inequalities faces = X.set.inequalities();
    for (const Matrix* rows : {&faces.H, &faces.Q}) {
      const Vector& bounds = rows == &faces.H ? faces.h : faces.q;
      for (Index i = 0; i < rows->rows(); ++i) {
        const Vector normal = rows->row(i);
        const double reached = normal.dot(x);
        if (reached > bounds[i] && is_beyond(X.set, normal, x)) return Answer::no;
        if (rows == &faces.Q && reached < bounds[i] && is_beyond(X.set, -normal, x))
          return Answer::no;
      }
    }
    return Answer::unknown;
  }
  static bool is_beyond(const Polytope& X, const Vector& normal, VectorIn x) {
    const double h = X.support(normal).upper;
    const double terms = normal.cwiseAbs().dot(x.cwiseAbs()) + std::abs(h);
    return normal.dot(x) - h >
           tolerances::proof_margin * std::max(terms, tolerances::smallest_terms);
  }
  /// Without a certificate: the sets are not those of forms.
  Answer is_subset(const Value& X, const Value& Y, Certificate*) const {
    return known([&] { return Y.set.contains(X.set); });
  }
  Answer is_disjoint(const Value& X, const Value& Y, Certificate*) const {
    return known([&] { return X.set.intersection(Y.set).is_empty(); });
  }
  /// Beyond the limits of conversions views are compared.
  static Answer known(const auto& question) {
    const ExactBudget budget(question_work);
    try {
      return question() ? Answer::yes : Answer::no;
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
      return Answer::unknown;
    }
  }
  Answer is_bounded(const Value& X) const { return X.set.is_bounded() ? Answer::yes : Answer::no; }
  double support(const Value& X, VectorIn d, Certificate*) const { return X.set.support(d).upper; }
  /// A vertex.
  Vector maximizer(const Value& X, VectorIn d) const {
    const Matrix vertices = X.set.generators().vertices;
    if (vertices.cols() == 0) return Vector(0);
    Index best = 0;
    (Vector(d).transpose() * vertices).maxCoeff(&best);
    return vertices.col(best);
  }
  /// Proven by the box of the exchange form, where that is the set.
  Box interval_hull(const Value& X, std::vector<Certificate>* why) const {
    const Box hull = X.set.interval_hull();
    if (why) {
      const bool exact = has_exact_form(X);
      const Index rows = X.view().form.constraints();
      why->clear();
      for (Index i = 0; i < X.set.dim(); ++i) {
        for (const double bound : {hull.upper[i], -hull.lower[i]}) {
          const bool proven = exact && std::isfinite(bound);
          why->push_back(proven ? Certificate{Certificate::Kind::dual, zeros(rows), bound}
                                : Certificate{});
        }
      }
    }
    return hull;
  }
  std::optional<Volume> volume(const Value& X) const {
    if (!X.set.is_bounded()) return std::nullopt;
    const ExactBudget budget(question_work);
    try {
      return Volume{X.set.volume().upper, true};
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported) throw;
      return std::nullopt;
    }
  }
};

ParamSchema schema() {
  ParamSchema schema;
  schema.integer("digits",
                 "binary digits of all coordinates of a set's vertices, beyond which it is rounded "
                 "outward to doubles; 0 rounds every result",
                 500'000, 0, 100'000'000);
  schema.integer("max_work",
                 "million operations on machine words, 150 to 300 per second, that one operation "
                 "on sets may take; what takes more is an error",
                 100, 1, 1'000'000);
  schema.integer("facets",
                 "most facets besides those of the interval hull that a reduction keeps, the "
                 "largest ones; 0 keeps all; absent: all for one and two states, 60 for three, 6 "
                 "for four",
                 std::nullopt, 0, 10'000);
  return schema;
}

std::unique_ptr<SetBackend> create(const Params& params) {
  Polyhedra polyhedra;
  polyhedra.digits = static_cast<std::size_t>(params.integer("digits"));
  polyhedra.work = 1e6 * static_cast<double>(params.integer("max_work"));
  if (params.has("facets")) polyhedra.facets = params.integer("facets");
  BackendInfo info;
  info.name = "polytope";
  info.unbounded = true;
  info.intersections = true;
  info.rounding = polyhedra.digits > 0 ? Rounding::rational : Rounding::outward;
  info.exact_exchange = polyhedra.digits == 0;  // sets say it of themselves as well
  info.summary = "half-spaces and vertices with exact operations, up to four states";
  info.citation = "Fukuda1996";
  return std::make_unique<plugins::ValueBackend<Polyhedra>>(info, polyhedra);
}

void register_components(Registrar& registrar) {
  registrar.add(
      BackendEntry{{"polytope", "half-spaces and vertices with exact operations, up to four states",
                    "Fukuda1996", schema()},
                   create});
}

}  // namespace

CORDON_PLUGIN("polytope", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "polytopes by half-spaces and vertices", register_components)
