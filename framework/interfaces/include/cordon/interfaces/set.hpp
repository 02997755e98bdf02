// SPDX-License-Identifier: GPL-3.0-or-later
// The abstract set. A plugin author derives from Set and SetBackend (backend.hpp); a caller sees
// the public functions only.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/core/recycled.hpp"
#include "cordon/core/view.hpp"

namespace cordon {

class Set;
class SetBackend;

/// Sets are immutable and shared: no operation changes an operand, a copy is a reference count,
/// threads need no locks.
using SetPtr = std::shared_ptr<const Set>;

/// A set and its producer's claim; they travel together. An operation's result claims at most the
/// weakest claim of its inputs.
struct Enclosure {
  SetPtr set;
  Tightness tightness = Tightness::exact;

  const Set& operator*() const { return *set; }
  const Set* operator->() const { return set.get(); }
};

/// Size of a representation: the numbers that budgets limit, and further ones under names of its
/// own, in snake_case: {{"facets", 12}, {"vertices", 8}}.
struct Complexity {
  struct Named {
    std::string name;
    Index count = 0;
  };
  Index generators = 0, lines = 0, constraints = 0;
  std::vector<Named> others = {};

  /// The number of that name, one of the first three included; 0 for a name that it does not have.
  Index count(std::string_view name) const;
};

/// Volume of a set, or an upper bound of it.
struct Volume {
  double value = 0;  ///< +inf for an unbounded set with interior, 0 for ∅ and for flat sets
  bool exact = false;
};

/// A closed convex subset of Rⁿ in some representation.
///
/// Public functions check dimensions and finiteness (Errc::dimension, Errc::not_finite), settle n =
/// 0 and what follows from the answer "empty", and then call the private `do_…` function, whose
/// preconditions are thereby met. Every `do_…` function but the first two has a default through the
/// view. What a representation knows better than its view (an ellipsoid its support function, a
/// polytope whether it holds another one) it answers itself; drawing, measuring and results ask
/// these functions.
class Set {
 public:
  virtual ~Set() = default;
  Set(const Set&) = delete;
  Set& operator=(const Set&) = delete;
  /// Every step makes sets, and lets others go: their memory is used again.
  static void* operator new(std::size_t size);
  static void* operator new(std::size_t size, std::align_val_t alignment);
  static void operator delete(void* memory) { give_memory(memory); }
  static void operator delete(void* memory, std::align_val_t alignment) {
    ::operator delete(memory, alignment);
  }

  Index dim() const { return dim_; }
  const SetBackend& backend() const { return *backend_; }
  Complexity complexity() const { return do_complexity(); }

  /// A set in exchange form that holds this one; equal to it if `has_exact_form()`.
  LineForm line_form() const;
  bool has_exact_form() const { return do_has_exact_form(); }
  /// The set as others compute with it.
  View view() const;
  /// The view with an inequality dᵀx ≤ h(d) for every column d of `directions` (n×r) whose support
  /// value is finite: what is known of a set that has no exact form.
  View view_along(MatrixIn directions) const;

  /// Three-valued questions. A view that is outer gives `is_empty: yes`, `contains: no`,
  /// `is_disjoint_from: yes`, `is_bounded: yes` and, for an exact right-hand side, `is_subset_of:
  /// yes` only. Where it leaves exclusion open, directions are searched in which the support values
  /// of both sets exclude each other. `why` receives the proof.
  Answer is_empty(Certificate* why = nullptr) const;
  Answer contains(VectorIn x, Certificate* why = nullptr) const;
  Answer is_subset_of(const Set& other, Certificate* why = nullptr) const;
  Answer is_disjoint_from(const Set& other, Certificate* why = nullptr) const;
  Answer is_bounded() const;

  /// Upper bound of h_X(d) = sup{dᵀx : x ∈ X}; +inf when unbounded or unsolved, -inf when proven
  /// empty. `at` receives a point of the set, up to rounding, in which dᵀx is largest, or a vector
  /// of size 0 where none is known: nothing is proven by it.
  double support(VectorIn d, Vector* at = nullptr, Certificate* why = nullptr) const;

  /// Smallest box around the set as far as proven: contains X in any case. An empty box only if X
  /// is proven empty. `why` receives the proofs of the bounds: two per coordinate, of the upper
  /// bound (direction e_i) and of the lower (-e_i).
  Box interval_hull(std::vector<Certificate>* why = nullptr) const;

  /// Exact where the representation offers it (see the backend), else an upper bound: the volume
  /// of the interval hull, or a smaller one that the representation knows.
  Volume volume() const;

 protected:
  Set(const SetBackend& backend, Index dim) : backend_(&backend), dim_(dim) {}

  /// Default: what the backend says of all its sets (`exact_exchange`).
  virtual bool do_has_exact_form() const;
  /// Default: the exchange form alone. For sets with half-spaces that it cannot hold.
  virtual View do_view() const;
  /// The point of `support`. Default: of an exact form; none for others.
  virtual Vector do_maximizer(VectorIn d) const;

 private:
  virtual Complexity do_complexity() const = 0;
  virtual LineForm do_line_form() const = 0;
  // Defaults: the certified questions of solvers/view_questions.hpp on the view.
  virtual Answer do_is_empty(Certificate* why) const;
  virtual Answer do_contains(VectorIn x, Certificate* why) const;
  virtual Answer do_is_bounded() const;
  virtual double do_support(VectorIn d, Certificate* why) const;
  // Asked first, for sets of the same backend; `unknown` leaves the question to the views.
  virtual Answer do_is_subset_of(const Set&, Certificate*) const { return Answer::unknown; }
  virtual Answer do_is_disjoint_from(const Set&, Certificate*) const { return Answer::unknown; }
  virtual Box do_interval_hull(std::vector<Certificate>* why) const;
  /// Volume of a bounded set, or an upper bound of it; none: "not offered".
  virtual std::optional<Volume> do_volume() const { return std::nullopt; }

  Answer is_within_form(const Set& other, const View& right, Certificate* why) const;

  const SetBackend* backend_;
  Index dim_;
};

}  // namespace cordon
