// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/values/convex_set.hpp"

#include <cmath>
#include <ostream>

#include "cordon/core/error.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/view_questions.hpp"

namespace cordon {

namespace {

const SetBackend& of_left(const ConvexSet& X) { return X.backend(); }

void expect_same_dimension(const ConvexSet& X, const ConvexSet& Y, const char* what) {
  if (X.dim() == Y.dim()) return;
  throw Error(Errc::dimension, std::string(what) + " of sets of " + std::to_string(X.dim()) +
                                   " and " + std::to_string(Y.dim()) + " dimensions");
}

void expect_size(VectorIn x, const ConvexSet& X, const char* what) {
  if (x.size() == X.dim()) return;
  throw Error(Errc::dimension, std::string(what) + " has " + std::to_string(x.size()) +
                                   " entries, the set is one of " + std::to_string(X.dim()) +
                                   " dimensions");
}

void expect_count(Index n, const char* what) {
  if (n >= 0) return;
  throw Error(Errc::dimension, std::string(what) + " of " + std::to_string(n) + " dimensions");
}

/// Asks a set, and where it answers without a proof the views. What these exclude, by the answer
/// `lasting`, holds for all that they enclose.
template <class Own, class OfViews>
Answer proven(Certificate* why, bool exact, Answer lasting, const Own& own,
              const OfViews& of_views) {
  if (why) *why = {};
  const Answer answer = own(why);
  if (!why) return answer;
  if (answer == Answer::unknown) *why = {};
  if (answer == Answer::unknown || why->kind != Certificate::Kind::none) return answer;
  Certificate proof;
  if ((exact || answer == lasting) && of_views(&proof) == answer) *why = std::move(proof);
  return answer;
}

bool is_exact(const View& X) { return X.claim == Tightness::exact; }

void append_count(std::string& text, Index count, const std::string& name) {
  if (count != 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + name;
}

}  // namespace

ConvexSet::ConvexSet(Enclosure X) : X_(std::move(X)) {
  if (!X_.set) throw Error(Errc::invalid, "a set as a value needs a set");
}

ConvexSet ConvexSet::box(VectorIn lower, VectorIn upper) {
  return cordon::representation("interval")->box({lower, upper});
}

ConvexSet ConvexSet::point(VectorIn x, std::string_view representation) {
  return cordon::representation(representation)->point(x);
}

ConvexSet ConvexSet::zonotope(VectorIn c, MatrixIn G) {
  return cordon::representation("zonotope")->import(make_zonotope(c, G));
}

ConvexSet ConvexSet::constrained_zonotope(VectorIn c, MatrixIn G, MatrixIn A, VectorIn b) {
  const LineForm form{Matrix(c.size(), 0), G, c, Matrix(b.size(), 0), A, b};
  return cordon::representation("constrained_zonotope")->import(form);
}

ConvexSet ConvexSet::line_zonotope(const LineForm& form) {
  return cordon::representation("line_zonotope")->import(form);
}

ConvexSet ConvexSet::strip(VectorIn rho, double d, double sigma) {
  return line_zonotope(make_strip(rho, d, sigma));
}

ConvexSet ConvexSet::space(Index n, std::string_view representation) {
  expect_count(n, "space");
  return cordon::representation(representation)->space(n);
}

ConvexSet ConvexSet::empty(Index n, std::string_view representation) {
  expect_count(n, "an empty set");
  Enclosure X = cordon::representation(representation)->empty(n);
  // what encloses nothing by nothing is equal to it
  if (X->is_empty() == Answer::yes) X.tightness = Tightness::exact;
  return X;
}

ConvexSet ConvexSet::of(const View& X, const std::shared_ptr<const SetBackend>& backend) {
  if (!backend) throw Error(Errc::invalid, "a set needs a representation");
  return backend->import(X);
}

ConvexSet ConvexSet::as(std::string_view representation, const Params& params) const {
  return as(cordon::representation(representation, params));
}

ConvexSet ConvexSet::as(const std::shared_ptr<const SetBackend>& backend) const {
  if (!backend) throw Error(Errc::invalid, "a set needs a representation");
  return backend->import(X_);
}

ConvexSet operator*(MatrixIn A, const ConvexSet& X) {
  return X.affine_map(A, Vector::Zero(A.rows()));
}

ConvexSet operator*(double s, const ConvexSet& X) {
  if (!std::isfinite(s)) throw Error(Errc::not_finite, "a set times NaN or infinity");
  return X.affine_map(s * Matrix::Identity(X.dim(), X.dim()), Vector::Zero(X.dim()));
}

ConvexSet operator+(const ConvexSet& X, const ConvexSet& Y) {
  expect_same_dimension(X, Y, "sum");
  return of_left(X).sum(X.X_, Y.X_);
}

ConvexSet operator+(const ConvexSet& X, VectorIn t) {
  expect_size(t, X, "the translation");
  return X.affine_map(Matrix::Identity(X.dim(), X.dim()), t);
}

ConvexSet operator&(const ConvexSet& X, const ConvexSet& Y) {
  expect_same_dimension(X, Y, "intersection");
  return X.intersect(Matrix::Identity(X.dim(), X.dim()), Y);
}

ConvexSet ConvexSet::affine_map(MatrixIn A, VectorIn t) const {
  return of_left(*this).affine_map(X_, A, t);
}

ConvexSet ConvexSet::intersect(MatrixIn R, const ConvexSet& Y) const {
  return of_left(*this).intersection(X_, R, Y.X_);
}

ConvexSet ConvexSet::correct(MatrixIn C, VectorIn y, const ConvexSet& V) const {
  return of_left(*this).correct(X_, {C, y, {Matrix::Identity(y.size(), y.size()), V.X_}});
}

ConvexSet ConvexSet::interval_map(const IntervalMatrix& A) const {
  return of_left(*this).interval_map(X_, A);
}

ConvexSet ConvexSet::product(const ConvexSet& Y) const { return of_left(*this).product(X_, Y.X_); }

ConvexSet ConvexSet::convex_hull(const ConvexSet& Y) const {
  expect_same_dimension(*this, Y, "convex hull");
  return of_left(*this).convex_hull(X_, Y.X_);
}

ConvexSet ConvexSet::reduce(Index generators, Index constraints) const {
  return of_left(*this).reduce(X_, {generators, constraints});
}

Answer ConvexSet::is_empty(Certificate* why) const {
  const auto own = [this](Certificate* proof) { return X_.set->is_empty(proof); };
  if (!why) return own(nullptr);
  const View X = view();
  return proven(why, is_exact(X), Answer::yes, own,
                [&](Certificate* proof) { return cordon::is_empty(X, proof); });
}

Answer ConvexSet::contains(VectorIn x, Certificate* why) const {
  const auto own = [&](Certificate* proof) { return X_.set->contains(x, proof); };
  if (!why) return own(nullptr);
  const View X = view();
  return proven(why, is_exact(X), Answer::no, own,
                [&](Certificate* proof) { return cordon::contains(X, x, proof); });
}

Answer ConvexSet::is_subset(const ConvexSet& Y, Certificate* why) const {
  if (why) *why = {};
  const Answer answer = X_.set->is_subset_of(*Y.X_.set, why);
  if (why && answer == Answer::unknown) *why = {};
  return answer;
}

Answer ConvexSet::is_disjoint(const ConvexSet& Y, Certificate* why) const {
  const auto own = [&](Certificate* proof) { return X_.set->is_disjoint_from(*Y.X_.set, proof); };
  if (!why) return own(nullptr);
  const View left = view(), right = Y.view();
  return proven(why, is_exact(left) && is_exact(right), Answer::yes, own,
                [&](Certificate* proof) { return cordon::is_disjoint(left, right, proof); });
}

double ConvexSet::support(VectorIn d, Vector* at, Certificate* why) const {
  if (why) *why = {};
  const double h = X_.set->support(d, at, why);
  if (!why || why->kind != Certificate::Kind::none || !(h < infinity)) return h;
  const View X = view();
  Certificate proof;
  cordon::support(X, d, &proof);
  if (proves_support(X, d, h, proof)) *why = std::move(proof);
  return h;
}

Matrix ConvexSet::vertices() const {
  const View seen = view();
  if (seen.claim != Tightness::exact) {
    throw Error(Errc::unsupported, "vertices: sets of \"" + representation() +
                                       "\" tell no exact form; take vertices of an enclosure, "
                                       "as(\"constrained_zonotope\")");
  }
  Polytope P = Polytope::from(seen.form);
  if (seen.rows.rows() > 0)
    P = P.intersection(Polytope::from_inequalities(seen.rows.H, seen.rows.h));
  if (!P.is_empty() && !P.is_bounded())
    throw Error(Errc::unsupported, "vertices: the set is unbounded");
  return P.generators().vertices;
}

std::string to_string(const ConvexSet& X) {
  const Complexity size = X.complexity();
  std::string counts;
  append_count(counts, size.generators, size.generators == 1 ? "generator" : "generators");
  append_count(counts, size.lines, size.lines == 1 ? "line" : "lines");
  append_count(counts, size.constraints, size.constraints == 1 ? "constraint" : "constraints");
  for (const Complexity::Named& other : size.others) append_count(counts, other.count, other.name);
  return X.representation() + " in R^" + std::to_string(X.dim()) +
         (counts.empty() ? "" : ": " + counts) + " (" + std::string(to_string(X.claim())) + ")";
}

std::ostream& operator<<(std::ostream& out, const ConvexSet& X) { return out << to_string(X); }

}  // namespace cordon
