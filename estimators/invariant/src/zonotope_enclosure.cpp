// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/invariant/zonotope_enclosure.hpp"

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::invariant {

sets::Zonotope enclosing_zonotope(const LineForm& X, const std::string& what) {
  check(X, what);
  if (X.lines() == 0 && X.constraints() == 0) return sets::drop_zero_generators({X.c, X.G});
  const Box hull = interval_hull(X);
  if (hull.is_empty()) throw Error(Errc::invalid, what + " is empty");
  if (!hull.is_bounded())
    throw Error(Errc::unsupported, what + " is unbounded, no zonotope encloses it");
  const LineForm box = make_box(hull);
  return sets::drop_zero_generators({box.c, box.G});
}

}  // namespace cordon::invariant
