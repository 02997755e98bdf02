// SPDX-License-Identifier: GPL-3.0-or-later
// Is a set empty, does it hold a point, do two meet, is one bounded?
#include "cordon/solvers/set_questions.hpp"

#include <cmath>
#include <optional>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "question_rows.hpp"
#include "questioned_set.hpp"
#include "rational_effort.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

namespace {

/// x - y and a bound of its rounding error, 0 where it is exact.
void difference(VectorIn x, VectorIn y, Vector& value, Vector& error) {
  value.resize(x.size());
  error.resize(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const double d = x[i] - y[i], part = d - x[i];
    value[i] = d;
    error[i] = std::abs((x[i] - (d - part)) - (y[i] + part));
  }
  if (!value.allFinite() || !error.allFinite())
    throw Error(Errc::not_finite, "a set question overflows; scale the problem");
}

/// Are the rows of a question unsatisfiable? What is proven with bounded rounding errors stands.
/// Lines are unbounded, so that no bound of rounding errors covers their elimination: there, and
/// where rows are dependent or a solution touches its bounds, rational arithmetic decides.
class Infeasibility {
 public:
  explicit Infeasibility(rational::Rows rows)
      : rows_(std::move(rows)), lines_(rows_.S.cols() > 0 && !rows_.S.isZero(0)) {
    difference(rows_.plus, rows_.minus, b_, error_);
    magnitude_ =
        (rows_.minus.array() == 0).select(0.0, rows_.plus.cwiseAbs() + rows_.minus.cwiseAbs());
  }

  Answer answer(Certificate* why) {
    Certificate proof;
    const Answer answer = lines_ ? through_lines(proof) : directly(proof);
    if (why) *why = answer == Answer::unknown ? Certificate{} : std::move(proof);
    return answer;
  }

 private:
  Answer directly(Certificate& proof) {
    BoxedProgram program(rows_.A, b_, {magnitude_, error_});
    const Answer answer = program.is_empty(&proof);
    if (proof.kind == Certificate::Kind::structure)
      proof = {Certificate::Kind::point, Vector::Zero(rows_.A.cols()), proof.margin};
    if (answer == Answer::unknown && is_small()) {
      if (const auto xi = program.central_point()) proof = {Certificate::Kind::point, *xi, 0};
      return decided(with_idle_lines(std::move(proof)), proof);
    }
    proof = with_idle_lines(std::move(proof));
    return answer;
  }

  Answer through_lines(Certificate& proof) {
    const LineForm X{
        Matrix(0, rows_.S.cols()), Matrix(0, rows_.A.cols()), Vector(0), rows_.S, rows_.A, b_};
    Questioned q(X, magnitude_);
    const Answer answer = q.is_empty(&proof);
    if (answer != Answer::unknown && holds(proof)) return answer;
    return is_small() ? decided(q.candidate(), proof) : Answer::unknown;
  }

  /// By rational arithmetic, from a point that may be a solution.
  Answer decided(Certificate candidate, Certificate& proof) {
    proof = candidate.kind == Certificate::Kind::point && holds(candidate) ? std::move(candidate)
                                                                           : settled();
    return proof.kind == Certificate::Kind::none     ? Answer::unknown
           : proof.kind == Certificate::Kind::farkas ? Answer::yes
                                                     : Answer::no;
  }

  bool is_small() {
    if (!small_) small_ = cordon::is_small(rows_.S, rows_.A);
    return *small_;
  }

  /// Lines that enter no row were left out: any value will do.
  Certificate with_idle_lines(Certificate proof) const {
    if (rows_.S.cols() > 0 && proof.kind == Certificate::Kind::point) {
      Vector both = Vector::Zero(rows_.S.cols() + proof.data.size());
      both.tail(proof.data.size()) = proof.data;
      proof.data = std::move(both);
    }
    return proof;
  }

  /// In rational arithmetic; a margin of emptiness must exceed what nominal operations may have
  /// added.
  bool holds(Certificate& proof) {
    if (!is_small()) return false;
    if (!system_) system_.emplace(rows_);
    if (proof.kind == Certificate::Kind::point) return has_solution_near(*system_, proof.data);
    const auto margin = rational::farkas_margin(*system_, proof.data);
    if (!margin) return false;
    proof.margin = margin->get_d();
    const Vector weight = b_.cwiseAbs() + rows_.A.cwiseAbs().rowwise().sum() + magnitude_;
    return proof.margin > tolerances::proof_margin * proof.data.cwiseAbs().dot(weight.cwiseMax(
                                                         tolerances::smallest_terms));
  }

  Certificate settled() {
    const rational::Finding found = rational::settle(rows_);
    Certificate proof{found.feasible ? Certificate::Kind::point : Certificate::Kind::farkas,
                      found.data, 0};
    return holds(proof) ? proof : Certificate{};
  }

  rational::Rows rows_;
  bool lines_;
  std::optional<bool> small_;
  Vector b_, error_, magnitude_;
  std::optional<rational::System> system_;
};

}  // namespace

Answer is_empty(const LineForm& X, Certificate* why) {
  if (X.constraints() == 0) {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 1};
    return Answer::no;
  }
  if (X.lines() ==
      0) {  // nearly always known at once, without a copy of the rows for rational arithmetic
    Certificate proof;
    const Answer answer = BoxedProgram(X.A, X.b).is_empty(&proof);
    if (why) *why = std::move(proof);
    if (answer != Answer::unknown) return answer;
  }
  return Infeasibility(rows_of(X)).answer(why);
}

Answer contains(const LineForm& X, VectorIn x, Certificate* why) {
  if (x.size() != X.dim())
    throw Error(Errc::dimension, "contains: the point has another dimension than the set");
  return negate(Infeasibility(rows_of_point(X, x)).answer(why));
}

Matrix lineality_space(const LineForm& X) {
  return X.lines() ? linalg::range_basis(eliminate_lines(X).M) : Matrix(X.dim(), 0);
}

Answer is_bounded(const LineForm& X) {
  if (!has_lineality(X)) return Answer::yes;
  const Answer empty = is_empty(X);
  return empty == Answer::yes ? Answer::yes : empty == Answer::no ? Answer::no : Answer::unknown;
}

Answer is_disjoint(const LineForm& X, const LineForm& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_disjoint: the dimensions differ");
  return Infeasibility(rows_of_intersection(X, Y)).answer(why);
}

}  // namespace cordon
