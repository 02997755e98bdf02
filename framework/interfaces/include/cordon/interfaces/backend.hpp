// SPDX-License-Identifier: GPL-3.0-or-later
// The set backend: one representation of sets with its operations.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>

#include "cordon/core/interval_matrix.hpp"
#include "cordon/interfaces/set.hpp"

namespace cordon {

class Archive;  // archive.hpp

/// What a backend can do. Observers choose their recursion by this, never by name.
struct BackendInfo {
  std::string name;            ///< component name, e.g. "zonotope"
  bool unbounded = false;      ///< represents Rⁿ and other sets with lines exactly
  bool intersections = false;  ///< X ∩_R Y of representable sets is exact
  bool exact_exchange = true;  ///< line_form() equals the set, for all sets that say nothing else
  Rounding rounding = Rounding::nominal;
  std::string summary, citation;
};

/// Upper limits of a representation's size after `reduce`; a representation without the notion
/// ignores the number.
struct Budget {
  static constexpr Index unlimited = std::numeric_limits<Index>::max();
  Index generators = unlimited, constraints = unlimited;
};

/// The summand T·set. A view of the caller's matrix: never store it.
struct Term {
  MatrixIn T;
  const Enclosure& set;
};
/// A X ⊕ {f} ⊕ Σ Tᵢ Sᵢ. A is m×n (rectangular allowed), f has size m.
struct PredictionArgs {
  MatrixIn A;
  VectorIn f;
  std::span<const Term> terms;
};
/// {x ∈ X : z - C x ∈ T V}. With dim V = 0 (T p×0): the equality C x = z.
struct CorrectionArgs {
  MatrixIn C;
  VectorIn z;
  Term noise;
};

/// A representation. Public functions check shapes, convert operands of other backends by `import`,
/// meet the claims and keep the backend (and its plugin) alive as long as a set of it lives; `do_…`
/// functions see operands of their own type only. Backends are immutable after construction and are
/// used from several threads.
class SetBackend : public std::enable_shared_from_this<SetBackend> {
 public:
  virtual ~SetBackend() = default;
  SetBackend(const SetBackend&) = delete;
  SetBackend& operator=(const SetBackend&) = delete;

  const BackendInfo& info() const { return info_; }

  /// An enclosure of X; exact if the representation can hold X. Throws Errc::unsupported if it
  /// cannot enclose X at all (an unbounded set in a bounded representation). `claim` is the claim
  /// of X itself.
  Enclosure import(const LineForm& X, Tightness claim = Tightness::exact) const;
  Enclosure import(const View& X) const;       ///< with inequalities; the view's own claim
  Enclosure import(const Enclosure& X) const;  ///< X itself if it is of this backend already
  Enclosure box(const Box& box) const;
  Enclosure point(VectorIn x) const;
  Enclosure space(Index n) const;
  Enclosure empty(Index n) const;

  Enclosure predict(const Enclosure& X, const PredictionArgs& p) const;
  Enclosure correct(const Enclosure& X, const CorrectionArgs& c) const;
  /// Encloses X within the budget. X itself if it fits already. Separate from the rest, so that it
  /// is timed and chosen separately.
  Enclosure reduce(const Enclosure& X, Budget budget) const;

  Enclosure affine_map(const Enclosure& X, MatrixIn T, VectorIn t) const;  ///< T X + t
  Enclosure interval_map(const Enclosure& X,
                         const IntervalMatrix& A) const;  ///< {A x : A ∈ [A], x ∈ X}, outer
  Enclosure sum(const Enclosure& X, const Enclosure& Y) const;      ///< X ⊕ Y
  Enclosure product(const Enclosure& X, const Enclosure& Y) const;  ///< X × Y
  Enclosure intersection(const Enclosure& X, MatrixIn R,
                         const Enclosure& Y) const;                     ///< {x ∈ X : R x ∈ Y}
  Enclosure convex_hull(const Enclosure& X, const Enclosure& Y) const;  ///< closure of conv(X ∪ Y)

  /// Writes X, a set of this backend, to the archive, or reads it from there: with the same numbers
  /// in it, so that every operation on it gives the same bits as before. Throws Errc::unsupported
  /// if the backend does not offer it, Errc::invalid for what is no set of its own.
  void serialize(SetPtr& X, Archive& archive) const;

 protected:
  explicit SetBackend(BackendInfo info) : info_(std::move(info)) {}

  /// A new set and the claim of the operation alone (the public function meets it with the inputs'
  /// claims).
  struct Made {
    std::unique_ptr<const Set> set;
    Tightness tightness = Tightness::exact;
  };

  /// Default: inequalities become constraints with slack factors as far as the form bounds them
  /// (solvers/view_questions.hpp), and the others are left out.
  virtual Made do_import_view(const View& X) const;
  /// Writes X, or reads a set where X is null, and returns it. Default: Errc::unsupported.
  virtual std::unique_ptr<const Set> do_serialize(const Set* X, Archive& archive) const;

 private:
  virtual Made do_import(const LineForm& X) const = 0;
  // Defaults: the exact block matrices of core/line_form.hpp on the exchange forms, then one
  // import.
  virtual Made do_predict(const Set& X, const PredictionArgs& p) const;
  virtual Made do_correct(const Set& X, const CorrectionArgs& c) const;
  virtual Made do_interval_map(const Set& X, const IntervalMatrix& A) const;
  virtual Made do_intersection(const Set& X, MatrixIn R, const Set& Y) const;
  virtual Made do_convex_hull(const Set& X, const Set& Y) const;
  /// X × Y. Default: no set, and `predict` with the blocks of the identity is asked.
  virtual Made do_product(const Set& X, const Set& Y) const;
  /// Default: leaves X as it is (no set: "nothing to do").
  virtual Made do_reduce(const Set& X, Budget budget) const;

  Enclosure adopt(Made made, Tightness inputs) const;

  BackendInfo info_;
};

}  // namespace cordon
