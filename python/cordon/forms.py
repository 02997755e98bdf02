# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets in exchange form over the rational numbers, and what multipliers and points prove of them.

{c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b}, cut by H x ≤ h. Kinds of proofs: certificates.py.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Dict, Iterator, List, Optional, Tuple

from . import rational, simplex


class Form:
    """Blocks of a set as rational numbers. `exact`: they are the set; else they hold it."""

    def __init__(self, view: Dict[str, Any]) -> None:
        self.c = rational.vector(view["c"])
        self.M = rational.matrix(view["M"])
        self.G = rational.matrix(view["G"])
        self.S = rational.matrix(view["S"])
        self.A = rational.matrix(view["A"])
        self.b = rational.vector(view["b"])
        self.H = rational.matrix(view["H"])
        self.h = rational.vector(view["h"])
        self.lines = view["M"].shape[1]
        self.generators = view["G"].shape[1]
        self.exact = view["claim"] == "exact"

    @property
    def dim(self) -> int:
        return len(self.c)

    def copy_of(self, **blocks: Any) -> "Form":
        made = object.__new__(Form)
        made.__dict__.update(self.__dict__)
        made.__dict__.update(blocks)
        return made

    def at(self, x: List[Fraction]) -> "Form":
        """The factors that give x: rows Mδ + Gξ = x - c below the set's own."""
        return self.copy_of(S=self.S + self.M, A=self.A + self.G,
                            b=self.b + [a - c for a, c in zip(x, self.c)])

    def met_by(self, other: "Form") -> "Form":
        """The factors of both sets that give one point, and the first set's points."""
        def beside(own: rational.Rows, columns: int, others: rational.Rows, own_columns: int,
                   shared: Tuple[rational.Rows, rational.Rows]) -> rational.Rows:
            zero = Fraction(0)
            return ([row + [zero] * columns for row in own] +
                    [[zero] * own_columns + row for row in others] +
                    [a + [-v for v in b] for a, b in zip(*shared)])
        zero = Fraction(0)
        return self.copy_of(
            lines=self.lines + other.lines, generators=self.generators + other.generators,
            M=[row + [zero] * other.lines for row in self.M],
            G=[row + [zero] * other.generators for row in self.G],
            S=beside(self.S, other.lines, other.S, self.lines, (self.M, other.M)),
            A=beside(self.A, other.generators, other.A, self.generators, (self.G, other.G)),
            b=self.b + other.b + [a - c for a, c in zip(other.c, self.c)],
            H=self.H + other.H, h=self.h + other.h)


def columns_of(A: rational.Rows, y: List[Fraction], columns: int) -> List[Fraction]:
    return [rational.dot([row[j] for row in A], y) for j in range(columns)]


def onto(form: Form, y: List[Fraction], d: Optional[List[Fraction]]) -> Optional[List[Fraction]]:
    """y moved so that Sᵀy = Mᵀd (d None: 0), by as few entries as it takes."""
    if form.lines == 0:
        return y
    target = columns_of(form.M, d, form.lines) if d is not None else [Fraction(0)] * form.lines
    missing = [t - v for t, v in zip(target, columns_of(form.S, y, form.lines))]
    if not any(missing):
        return y
    if not form.S:
        return None
    weights = [max(float(abs(v)), 1e-60) for v in y]
    moved = rational.correction(rational.transposed(form.S, form.lines), missing, weights)
    return None if moved is None else [a + b for a, b in zip(y, moved)]


def form_bound(form: Form, d: List[Fraction], y: List[Fraction]) -> Optional[Fraction]:
    """dᵀc + bᵀy + ‖Gᵀd - Aᵀy‖₁ for a y moved onto Sᵀy = Mᵀd."""
    moved = onto(form, y, d)
    if moved is None:
        return None
    spread = [a - b for a, b in zip(columns_of(form.G, d, form.generators),
                                    columns_of(form.A, moved, form.generators))]
    return (rational.dot(d, form.c) + rational.dot(form.b, moved) +
            sum((abs(v) for v in spread), Fraction(0)))


def bound_of(form: Form, d: List[Fraction], kind: str, data: List[Fraction]) -> Optional[Fraction]:
    """An upper bound of dᵀx over the set, by a proof of kind dual, rows or structure."""
    rows = len(form.b)
    if kind == "structure" and not data:
        return form_bound(form, d, [Fraction(0)] * rows)
    if kind == "dual" and len(data) == rows:
        return form_bound(form, d, data)
    if kind == "rows" and len(data) == rows + len(form.h):
        multipliers = data[rows:]
        if any(v < 0 for v in multipliers):
            return None
        rest = [a - b for a, b in zip(d, columns_of(form.H, multipliers, len(d)))]
        bound = form_bound(form, rest, data[:rows])
        return None if bound is None else bound + rational.dot(form.h, multipliers)
    return None


def has_no_solution(form: Form, kind: str, data: List[Fraction]) -> bool:
    if kind == "farkas" and len(data) == len(form.b):
        y = onto(form, data, None)
        if y is None:
            return False
        reach = sum((abs(v) for v in columns_of(form.A, y, form.generators)), Fraction(0))
        return rational.dot(form.b, y) > reach
    if kind == "structure" and not data:  # a row 0 = b
        return any(b != 0 and not any(s) and not any(a)
                   for s, a, b in zip(form.S, form.A, form.b))
    if kind == "rows":
        bound = bound_of(form, [Fraction(0)] * len(form.c), kind, data)
        return bound is not None and bound < 0
    return False


def solution_near(form: Form, data: List[Fraction]) -> Optional[List[Fraction]]:
    """(δ, ξ) moved onto the constraints, if ‖ξ‖∞ ≤ 1 can be kept: by few variables, by all of
    them, each by its share of the room that it has, or by the simplex method."""
    if len(data) != form.lines + form.generators:
        return None
    start = _within_bounds(form, data)
    rows = [s + a for s, a in zip(form.S, form.A)]
    missing = [b - v for b, v in zip(form.b, rational.product(rows, start))]
    if not any(missing):
        return start
    room = [Fraction(10**6)] * form.lines + [1 - abs(v) for v in start[form.lines:]]
    weights = [max(float(v), 1e-60) for v in room]
    for few in (True, False):
        change = (rational.correction(rows, missing, weights) if few else
                  rational.spread(rows, missing, room))
        if change is None:
            return None
        found = [a + b for a, b in zip(start, change)]
        if all(abs(v) <= 1 for v in found[form.lines:]):
            return found
    free: List[Optional[Fraction]] = [None] * form.lines
    change = simplex.solution_within(rows, missing, free + [-1 - v for v in start[form.lines:]],
                                     free + [1 - v for v in start[form.lines:]])
    return None if change is None else [a + b for a, b in zip(start, change)]


def _within_bounds(form: Form, factors: List[Fraction]) -> List[Fraction]:
    one = Fraction(1)
    return factors[:form.lines] + [min(max(v, -one), one) for v in factors[form.lines:]]


def has_solution(form: Form, kind: str, data: List[Fraction]) -> bool:
    if kind == "structure" and not data:
        return not form.b and not form.h
    if kind != "point":
        return False
    found = solution_near(form, data)
    if found is None:
        return False
    x = point_of(form, found)
    if all(v <= h for v, h in zip(rational.product(form.H, x), form.h)):
        return True
    slack, factors = with_slack(form, x)
    return solution_near(slack, data + factors) is not None


def with_slack(form: Form, x: List[Fraction]) -> Tuple[Form, List[Fraction]]:
    """The form with a factor per row of H x ≤ h that takes up what is left of it, and no rows, with
    these factors near x. Bounds of what is left are wide: a solution gives one of the rows."""
    left = [h - v for v, h in zip(rational.product(form.H, x), form.h)]
    half = [abs(v) + abs(h) + 1 for v, h in zip(left, form.h)]
    count, zero = len(left), Fraction(0)
    at = rational.product(form.H, form.c)
    lines = [columns_of(form.M, row, form.lines) for row in form.H]
    factors = [columns_of(form.G, row, form.generators) for row in form.H]
    slack = [[half[i] if j == i else zero for j in range(count)] for i in range(count)]
    made = form.copy_of(
        generators=form.generators + count, G=[row + [zero] * count for row in form.G],
        S=form.S + lines, A=[row + [zero] * count for row in form.A] +
        [own + more for own, more in zip(factors, slack)],
        b=form.b + [h - v - r for h, v, r in zip(form.h, at, half)], H=[], h=[])
    return made, [v / r - 1 for v, r in zip(left, half)]


def point_of(form: Form, factors: List[Fraction]) -> List[Fraction]:
    both = [m + g for m, g in zip(form.M, form.G)]
    return [c + v for c, v in zip(form.c, rational.product(both, factors))]


def reached(form: Form, d: List[Fraction], multipliers: List[Fraction],
            inside: List[Fraction]) -> Iterator[Fraction]:
    """dᵀx of points near the farthest along d, which `multipliers` of a proof of kind dual or rows
    point at: on the way there from factors that give a point of the set, as far as it goes."""
    y, scaled = multipliers[:len(form.b)], multipliers[len(form.b):]
    along = [a - b for a, b in zip(d, columns_of(form.H, scaled, form.dim))] if scaled else d
    goal, one = list(inside), Fraction(1)
    room = [10**6 * one] * form.lines
    for j in range(form.generators):
        terms = ([row[j] * v for row, v in zip(form.G, along)] +
                 [-row[j] * v for row, v in zip(form.A, y)])
        pull = sum(terms, Fraction(0))
        held = abs(pull) > Fraction(1, 10**9) * sum((abs(v) for v in terms), Fraction(0))
        room.append(Fraction(0) if held else 1 - abs(inside[form.lines + j]))
        if held:
            goal[form.lines + j] = one if pull > 0 else -one
    rows = [s + a for s, a in zip(form.S, form.A)]
    missing = [b - v for b, v in zip(form.b, rational.product(rows, goal))]
    weights = [max(float(v), 1e-60) for v in room]
    for few in (True, False):
        change = (rational.correction(rows, missing, weights) if few else
                  rational.spread(rows, missing, room))
        if change is not None:
            end = [a + b for a, b in zip(goal, change)]
            yield rational.dot(d, point_of(form, _towards(form, inside, end)))


def _towards(form: Form, start: List[Fraction], end: List[Fraction]) -> List[Fraction]:
    """Factors on the way from those of a point of the set to others, as far as the set goes."""
    share = Fraction(1)
    for at, to in zip(start[form.lines:], end[form.lines:]):
        if abs(to) > 1:
            share = min(share, ((1 if to > 0 else -1) - at) / (to - at))
    rows = zip(rational.product(form.H, point_of(form, start)),
               rational.product(form.H, point_of(form, end)), form.h)
    for at, to, h in rows:
        if to > h:
            share = min(share, (h - at) / (to - at))
    return [a + share * (b - a) for a, b in zip(start, end)]
