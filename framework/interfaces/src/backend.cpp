// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/backend.hpp"

#include <cmath>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/recycled.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/core/vectors.hpp"
#include "cordon/solvers/view_questions.hpp"

namespace cordon {

namespace {

void require(bool fits, const std::string& message) {
  if (!fits) throw Error(Errc::dimension, message);
}

void require_map(MatrixIn T, Index rows, Index cols, const char* what) {
  if (T.rows() != rows ||
      T.cols() != cols) {  // texts are made for errors only: a step of an observer asks this often
    throw Error(Errc::dimension, std::string(what) + ": the matrix is " + std::to_string(T.rows()) +
                                     " x " + std::to_string(T.cols()) + ", must be " +
                                     std::to_string(rows) + " x " + std::to_string(cols));
  }
  if (!vectors::all_finite(T))
    throw Error(Errc::not_finite, std::string(what) + ": the matrix has a NaN or infinite entry");
}

void require_vector(VectorIn t, Index size, const char* what) {
  if (t.size() != size) {
    throw Error(Errc::dimension, std::string(what) + ": the vector has size " +
                                     std::to_string(t.size()) + ", must be " +
                                     std::to_string(size));
  }
  if (!vectors::all_finite(t))
    throw Error(Errc::not_finite, std::string(what) + ": the vector has a NaN or infinite entry");
}

/// With the backend's name in the texts of errors, which are made for these only.
template <class Form>
void check_import(const Form& X, const BackendInfo& info) {
  try {
    check(X, "import");
  } catch (const Error& error) {
    throw Error(error.code(), "backend " + info.name + ", " + error.what());
  }
}

const Set& require_set(const Enclosure& X, const char* what) {
  if (!X.set) throw Error(Errc::invalid, std::string(what) + ": no set was given");
  return *X.set;
}

bool is_own(const SetBackend& backend, const Enclosure& X) {
  return X.set && &X.set->backend() == &backend;
}

/// X itself where it is of the backend already, without counting one more reference to it; else X
/// imported.
class Own {
  Enclosure imported_;

 public:
  Own(const SetBackend& backend, const Enclosure& X)
      : imported_(is_own(backend, X) ? Enclosure{} : backend.import(X)),
        enclosure(is_own(backend, X) ? X : imported_) {}
  const Enclosure& enclosure;
};

/// Later code takes a result's dimension for granted, also in arithmetic without checks of its own.
template <class Made>
Made fitting(Made made, Index dim, const BackendInfo& info, const char* operation) {
  if (made.set && made.set->dim() == dim) return made;
  const std::string who = "backend " + info.name + ", " + operation + ": ";
  if (!made.set) throw Error(Errc::plugin, who + "returned no set");
  throw Error(Errc::plugin, who + "returned a set of dimension " + std::to_string(made.set->dim()) +
                                ", must be " + std::to_string(dim));
}

/// What is computed on exchange forms that enclose their sets is outer, whatever the import of the
/// result claims.
template <class Made>
Made through_exchange(bool exact_forms, Made made) {
  if (!exact_forms) made.tightness = Tightness::outer;
  return made;
}

}  // namespace

/// Control blocks are made here, so that no code of a plugin runs after its library has gone: the
/// deleter destroys the set, then lets go of the backend.
Enclosure SetBackend::adopt(Made made, Tightness inputs) const {
  const Set* raw = made.set.release();
  SetPtr set(
      raw, [keep = shared_from_this()](const Set* dying) { delete dying; }, Recycling<Set>());
  return {std::move(set), meet(made.tightness, inputs)};
}

Enclosure SetBackend::import(const LineForm& X, Tightness claim) const {
  check_import(X, info_);
  return adopt(fitting(do_import(X), X.dim(), info_, "import"), claim);
}

Enclosure SetBackend::import(const Enclosure& X) const {
  const Set& set = require_set(X, "import");
  if (&set.backend() == this) return X;
  View view = set.view();
  view.claim = meet(X.tightness, view.claim);
  return view.rows.rows() == 0 ? import(view.form, view.claim) : import(view);
}

Enclosure SetBackend::import(const View& X) const {
  check_import(X, info_);
  return adopt(fitting(do_import_view(X), X.dim(), info_, "import"), X.claim);
}

Enclosure SetBackend::box(const Box& box) const {
  const LineForm X = make_box(box);
  // with outward rounding, a box whose centre or radius was rounded is enclosed only
  const bool rounded = info_.rounding == Rounding::outward && !is_exact_form_of(box);
  return import(X, rounded ? Tightness::outer : Tightness::exact);
}
Enclosure SetBackend::point(VectorIn x) const { return import(make_point(x)); }
Enclosure SetBackend::space(Index n) const { return import(make_space(n)); }
Enclosure SetBackend::empty(Index n) const { return import(make_empty(n)); }

Enclosure SetBackend::predict(const Enclosure& X, const PredictionArgs& p) const {
  const Own converted(*this, X);
  const Enclosure& own = converted.enclosure;
  require_map(p.A, p.A.rows(), own->dim(), "predict: A");
  require_vector(p.f, p.A.rows(), "predict: f");
  Tightness inputs = own.tightness;
  bool all_own = true;
  for (const Term& term : p.terms) all_own = all_own && is_own(*this, term.set);
  const auto made = [&](std::span<const Term> terms) {
    for (const Term& term : terms) {
      require_map(term.T, p.A.rows(), term.set->dim(), "predict: T");
      inputs = meet(inputs, term.set.tightness);
    }
    return adopt(fitting(do_predict(*own.set, {p.A, p.f, terms}), p.A.rows(), info_, "predict"),
                 inputs);
  };
  if (all_own) return made(p.terms);
  std::vector<Enclosure> imported;
  imported.reserve(p.terms.size());
  std::vector<Term> terms;
  terms.reserve(p.terms.size());
  for (const Term& term : p.terms)
    terms.push_back({term.T, imported.emplace_back(import(term.set))});
  return made(terms);
}

Enclosure SetBackend::correct(const Enclosure& X, const CorrectionArgs& c) const {
  const Own converted(*this, X), converted_noise(*this, c.noise.set);
  const Enclosure &own = converted.enclosure, &noise = converted_noise.enclosure;
  require_map(c.C, c.C.rows(), own->dim(), "correct: C");
  require_vector(c.z, c.C.rows(), "correct: z");
  require_map(c.noise.T, c.C.rows(), noise->dim(), "correct: T");
  return adopt(
      fitting(do_correct(*own.set, {c.C, c.z, {c.noise.T, noise}}), own->dim(), info_, "correct"),
      meet(own.tightness, noise.tightness));
}

Enclosure SetBackend::reduce(const Enclosure& X, Budget budget) const {
  if (budget.generators < 0 || budget.constraints < 0)
    throw Error(Errc::invalid, "reduce: a negative budget");
  const Own converted(*this, X);
  const Enclosure& own = converted.enclosure;
  Made made = do_reduce(*own.set, budget);
  if (!made.set) return own;
  return adopt(fitting(std::move(made), own->dim(), info_, "reduce"), own.tightness);
}

Enclosure SetBackend::affine_map(const Enclosure& X, MatrixIn T, VectorIn t) const {
  return predict(X, {T, t, {}});
}

Enclosure SetBackend::interval_map(const Enclosure& X, const IntervalMatrix& A) const {
  const Enclosure own = import(X);
  require_map(A.center, A.center.rows(), own->dim(), "interval map: centre");
  require_map(A.radius, A.center.rows(), own->dim(), "interval map: radius");
  if (A.radius.size() && A.radius.minCoeff() < 0)
    throw Error(Errc::invalid, "interval map: a negative radius");
  return adopt(fitting(do_interval_map(*own.set, A), A.rows(), info_, "interval map"),
               own.tightness);
}

Enclosure SetBackend::sum(const Enclosure& X, const Enclosure& Y) const {
  const Index n = require_set(X, "sum").dim();
  require(require_set(Y, "sum").dim() == n, "sum: dimensions differ");
  const Matrix I = Matrix::Identity(n, n);
  const Term term{I, Y};
  return predict(X, {I, Vector::Zero(n), {&term, 1}});
}

Enclosure SetBackend::product(const Enclosure& X, const Enclosure& Y) const {
  const Index n = require_set(X, "product").dim(), m = require_set(Y, "product").dim();
  const Own left_own(*this, X), right_own(*this, Y);
  Made own = do_product(*left_own.enclosure.set, *right_own.enclosure.set);
  if (own.set) {
    return adopt(fitting(std::move(own), n + m, info_, "product"),
                 meet(left_own.enclosure.tightness, right_own.enclosure.tightness));
  }
  Matrix left = Matrix::Zero(n + m, n), right = Matrix::Zero(n + m, m);
  left.topRows(n).setIdentity();
  right.bottomRows(m).setIdentity();
  const Term term{right, right_own.enclosure};
  return predict(left_own.enclosure, {left, Vector::Zero(n + m), {&term, 1}});
}

Enclosure SetBackend::intersection(const Enclosure& X, MatrixIn R, const Enclosure& Y) const {
  const Enclosure own = import(X), other = import(Y);
  require_map(R, other->dim(), own->dim(), "intersection: R");
  return adopt(fitting(do_intersection(*own.set, R, *other.set), own->dim(), info_, "intersection"),
               meet(own.tightness, other.tightness));
}

Enclosure SetBackend::convex_hull(const Enclosure& X, const Enclosure& Y) const {
  const Enclosure own = import(X), other = import(Y);
  require(own->dim() == other->dim(), "convex hull: dimensions differ");
  if (own->is_empty() == Answer::yes) return {other.set, meet(own.tightness, other.tightness)};
  if (other->is_empty() == Answer::yes) return {own.set, meet(own.tightness, other.tightness)};
  return adopt(fitting(do_convex_hull(*own.set, *other.set), own->dim(), info_, "convex hull"),
               meet(own.tightness, other.tightness));
}

void SetBackend::serialize(SetPtr& X, Archive& archive) const {
  if (X && &X->backend() != this)
    throw Error(Errc::unsupported, "a set of another backend than " + info_.name +
                                       " cannot be saved; import it first");
  Made made{do_serialize(X.get(), archive)};
  if (X) return;
  if (!made.set)
    throw Error(Errc::plugin, "backend " + info_.name + ": a saved set was read as none");
  X = adopt(std::move(made), Tightness::exact).set;
}

std::unique_ptr<const Set> SetBackend::do_serialize(const Set*, Archive&) const {
  throw Error(Errc::unsupported, "sets of the backend \"" + info_.name + "\" cannot be saved");
}

SetBackend::Made SetBackend::do_predict(const Set& X, const PredictionArgs& p) const {
  LineForm sum = cordon::affine_map(X.line_form(), p.A, p.f);
  bool exact = X.has_exact_form();
  for (const Term& term : p.terms) {
    exact = exact && term.set->has_exact_form();
    sum = minkowski_sum(
        sum, cordon::affine_map(term.set->line_form(), term.T, Vector::Zero(p.A.rows())));
  }
  return through_exchange(exact, do_import(sum));
}

namespace {

/// Of rows of a correction whose noise has no extent: the size of the terms that they are made of;
/// 0 for the others.
Vector noise_free_terms(const CorrectionArgs& c, const LineForm& state, const LineForm& noise,
                        Vector terms) {
  const Matrix& T = c.noise.T;
  terms += linalg::product(c.C.cwiseAbs(), state.G.cwiseAbs().rowwise().sum());
  for (const Matrix& part : {noise.G, noise.M}) {
    const Vector extent = linalg::product(T.cwiseAbs(), part.cwiseAbs()).rowwise().sum();
    terms = (extent.array() > 0).select(0.0, terms);
  }
  return terms;
}

/// The last rows of X with a factor of their own, for the rounding errors of their coefficients:
/// where the noise has no extent, rows that repeat each other, or meet a set that is flat, would
/// else turn these into statements.
LineForm with_room(LineForm X, const Vector& terms) {
  const Index rows = X.constraints(), first = rows - terms.size();
  for (Index i = 0; i < terms.size(); ++i) {
    if (terms[i] == 0) continue;
    const Index g = X.generators();
    X.G.conservativeResize(Eigen::NoChange, g + 1);
    X.A.conservativeResize(Eigen::NoChange, g + 1);
    X.G.col(g).setZero();
    X.A.col(g).setZero();
    X.A(first + i, g) = tolerances::product_noise * terms[i];
  }
  return X;
}

}  // namespace

SetBackend::Made SetBackend::do_correct(const Set& X, const CorrectionArgs& c) const {
  // z - C x ∈ T V  ⇔  C x ∈ z ⊕ (-T V)
  const LineForm state = X.line_form(), noise = c.noise.set->line_form();
  LineForm kept = cordon::intersection(state, c.C, cordon::affine_map(noise, -c.noise.T, c.z));
  // z - T c_V - C c_X cancels where the sets touch: a residue is no statement
  const Vector terms = c.z.cwiseAbs() + linalg::product(c.noise.T.cwiseAbs(), noise.c.cwiseAbs()) +
                       linalg::product(c.C.cwiseAbs(), state.c.cwiseAbs());
  auto right = kept.b.tail(c.z.size());
  right =
      (right.array().abs() <= tolerances::product_noise * terms.array()).select(0.0, right).eval();
  if (info_.rounding == Rounding::nominal)
    kept = with_room(std::move(kept), noise_free_terms(c, state, noise, terms));
  return through_exchange(X.has_exact_form() && c.noise.set->has_exact_form(), do_import(kept));
}

SetBackend::Made SetBackend::do_interval_map(const Set& X, const IntervalMatrix& A) const {
  // A x = mid(A) x + Δ x with |Δ x| ≤ rad(A) |x|, |x| bounded by the interval hull
  const LineForm mapped = cordon::affine_map(X.line_form(), A.center, Vector::Zero(A.rows()));
  if (A.is_exact()) return through_exchange(X.has_exact_form(), do_import(mapped));
  const Box hull = X.interval_hull();
  if (hull.is_empty()) return do_import(make_empty(A.rows()));
  Box spread{Vector::Zero(A.rows()), Vector::Zero(A.rows())};
  for (Index i = 0; i < A.rows(); ++i) {
    double width = 0;
    for (Index j = 0; j < A.cols(); ++j) {
      if (A.radius(i, j) > 0)
        width += A.radius(i, j) * std::max(std::abs(hull.lower[j]), std::abs(hull.upper[j]));
    }
    spread.upper[i] =
        width == 0 ? 0 : rounding::up(width * (1 + rounding::gamma(2 * A.cols() + 2)));
    spread.lower[i] = -spread.upper[i];
  }
  Made made = do_import(minkowski_sum(mapped, make_box(spread)));
  made.tightness = Tightness::outer;
  return made;
}

SetBackend::Made SetBackend::do_intersection(const Set& X, MatrixIn R, const Set& Y) const {
  return through_exchange(X.has_exact_form() && Y.has_exact_form(),
                          do_import(cordon::intersection(X.line_form(), R, Y.line_form())));
}

SetBackend::Made SetBackend::do_convex_hull(const Set& X, const Set& Y) const {
  const LineForm A = X.line_form(), B = Y.line_form();
  Made made = through_exchange(X.has_exact_form() && Y.has_exact_form(),
                               do_import(cordon::convex_hull(A, B)));
  if (A.lines() > 0 || B.lines() > 0) made.tightness = Tightness::outer;
  return made;
}

SetBackend::Made SetBackend::do_import_view(const View& X) const {
  const Folded form = folded(X);
  Made made = do_import(form.form);
  made.tightness = meet(made.tightness, form.claim);
  if (X.rows.rows() > 0 && info_.rounding != Rounding::nominal)
    made.tightness = Tightness::outer;  // what rounds the constraints is added to their slack
  return made;
}

SetBackend::Made SetBackend::do_product(const Set&, const Set&) const { return {}; }

SetBackend::Made SetBackend::do_reduce(const Set&, Budget) const { return {}; }

}  // namespace cordon
