// SPDX-License-Identifier: GPL-3.0-or-later
// Polytopes as others see them.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "cordon/core/view.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::plugins {

/// The exchange form where that is the set; else what holds it as tightly: the form and
/// inequalities that are the set, or the form rounded outward, or for a set that is unbounded on
/// one side its box with the inequalities, each rounded outward. The claim is exact only if nothing
/// was rounded.
View view_of(const Polytope& P);

/// Is it unbounded along rays, which no exchange form holds?
bool is_one_sided(const Polytope& P);

/// What a view writes down, exactly.
Polytope polytope_of(const View& X);

/// A polytope, and its view, found when somebody asks first.
class Polyhedron {
 public:
  Polyhedron() : set(Polytope::empty(0)) {}
  explicit Polyhedron(Polytope P) : set(std::move(P)) {}
  /// `seen` is a view of P; `is_rounded`: it is what P was made of.
  Polyhedron(Polytope P, View seen, bool is_rounded)
      : set(std::move(P)), is_made_of_view(is_rounded) {
    seen_->view = std::move(seen);
  }

  const View& view() const {
    std::call_once(seen_->once, [this] {
      if (!seen_->view) seen_->view = view_of(set);
    });
    return *seen_->view;
  }

  Polytope set;
  bool is_made_of_view = false;

 private:
  struct Seen {
    std::once_flag once;
    std::optional<View> view;
  };
  std::shared_ptr<Seen> seen_ = std::make_shared<Seen>();
};

}  // namespace cordon::plugins
