// SPDX-License-Identifier: GPL-3.0-or-later
// The single checks of one reported step.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "cordon/solvers/polytope.hpp"
#include "cordon/study/verify.hpp"
#include "solvers/rational.hpp"
#include "study/results/recorded_run.hpp"
#include "study/verification/enclosed_successors.hpp"

namespace cordon::verification {

inline constexpr double almost_all_of_margin =
    0.999;  ///< of a margin: what is left covers the rounding of a vertex or a facet

/// x as messages name it: (1, 2.5).
std::string text(VectorIn x);

/// A step with its set, and what its checks found.
class StepCheck {
 public:
  /// `margin`: what rounding errors may amount to, per coordinate (RoundingMargin).
  StepCheck(const RecordedStep& step, const RecordedSet& row, Rounding rounding,
            const Vector& margin);

  /// X_k or the set before it has lines, and the model takes them to directions of which nominal
  /// operations keep few digits: what is missed along them is undecided.
  void lines_have_few_digits() { few_digits_ = nominal_; }

  void proofs();
  /// Successors of X_{k-1}: as they are, and with outputs and rows that hold up to rounding. By as
  /// much as these reach farther, a nominal claim may do so too, and nominal operations may fall
  /// short: the rounding of rows that nearly depend on each other, or that leave hardly anything,
  /// moves a set by far more than itself.
  struct Successors {
    std::function<LineForm()> exact;
    std::function<LineForm(double share)> relaxed;  ///< by this share of the rounding that may be
    static constexpr double next_to_nothing = 1.0 / 64;  ///< such a share
    std::function<std::optional<Enclosure>()> enclosed;  ///< of the exact ones, if there is one
  };

  /// F ⊆ X_k and F ⊆ hull, by the vertices of F; where `exact` is claimed, X_k ⊆ F by its
  /// inequalities.
  void against(const Polytope& F, const Successors& successors);
  /// The same inclusions for the successors, in the directions of the columns. Is X_k an estimate
  /// that `holds_them_all`? Else one that it does not hold decides nothing. Ends early, with
  /// nothing decided, once `stop` is set.
  void against(const Successors& successors, const Matrix& directions, bool holds_them_all,
               const std::atomic<bool>* stop);

  /// X_k and the hull hold these states, which are consistent.
  void against(const std::vector<Vector>& states);

  /// An inclusion could not be checked at all.
  void skipped(std::string why) { open(std::move(why)); }

  struct Finding {
    std::string what;
    bool in_sets_file = false;  ///< else in the step's hull
  };
  const std::optional<Finding>& violation() const { return violation_; }
  std::int64_t proofs_that_hold() const { return proofs_; }
  std::int64_t undecided() const { return undecided_; }
  const std::string& first_undecided() const { return first_undecided_; }
  bool exact_claim_holds() const { return exact_holds_; }
  /// Not proven, and not refuted: it was held against directions alone, or the recorded form only
  /// encloses the set in question and reaches beyond the exact one.
  bool exact_claim_stays() const { return exact_stays_; }

 private:
  struct Along;
  void along(const Vector& d, Along& by);
  void violated(std::string what, bool in_sets_file);
  void missed(std::string what, bool in_sets_file);
  /// By how much farther the successors reach, coordinate by coordinate, if rows are relaxed by
  /// rounding: than if they are relaxed by next to nothing, and than as they are. The latter may be
  /// the whole set, where rows say one thing twice and leave no room between them: it decides
  /// nothing.
  struct Moved {
    Vector surely, perhaps;
  };

  void open(std::string what);
  void emptiness_proof();
  void emptiness_without_proof();
  void bound_proof(Index i, bool upper);
  void contains_vertex(const rational::RationalVector& exact, const Successors& successors);
  std::optional<Index> outside_hull(const rational::RationalVector& exact,
                                    const Vector& margin) const;
  const Moved& moved_by_rounding(const Successors& successors);
  bool fits(const rational::RationalVector& exact, const Vector& margin) const;
  bool holds_nearby(const Vector& x);
  void contains_direction(const Vector& d, bool line);
  Vector turned_by(const Vector& x) const;
  bool keeps_across_lines(const Vector& d, double limit) const;
  /// What the recorded inequalities say of dᵀx: +inf but along one of them.
  double limit_of(const Vector& d) const;
  /// Do the exact states keep to them?
  void keep_to_inequalities(const Polytope& F, const Successors& successors);
  void within(const rational::RationalVector& normal, const rational::Rational& h,
              const Successors& successors);
  bool reported_empty() const { return step_.consistent == Answer::no; }

  const RecordedStep& step_;
  const RecordedSet& row_;
  View view_;                   ///< of the set, with what its inequalities say
  bool nominal_;                ///< operations were rounded to nearest
  bool few_digits_ = false;     ///< of the directions of lines
  double line_tolerance_;       ///< of the directions of lines
  Vector size_;                 ///< of each coordinate
  Vector margin_;               ///< within which F_k has to lie in X_k and in the hull
  Vector claim_margin_;         ///< within which X_k has to lie in F_k, if it is claimed exact
  Vector row_margin_;           ///< within which constraints of X_k have to hold
  LineForm widened_;            ///< X_k ⊕ margin_
  std::optional<Moved> moved_;  ///< along the coordinates, once asked for
  std::optional<std::optional<Vector>>
      center_;  ///< factors of a point well inside X_k, once asked for
  std::optional<Finding> violation_;
  std::int64_t proofs_ = 0, undecided_ = 0;
  std::string first_undecided_;
  bool exact_holds_ = false, exact_stays_ = false;
  bool beyond_exchange_ = false;  ///< an outer exchange form reaches beyond the exact set
};

/// Into vertices and inequalities? False: it cannot be.
bool is_converted(const Polytope& F);

/// Where the set before is not recorded: rounding is not taken to move anything.
StepCheck::Successors unknown_successors(Index n);

}  // namespace cordon::verification
