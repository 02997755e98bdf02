# SPDX-License-Identifier: GPL-3.0-or-later
"""Proofs of answers, checked again in exact rational arithmetic, without the library.

Sets are looked at in exchange form, {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b}, cut by H x ≤ h. A proof
is of one of these kinds:

    farkas     y with Sᵀy = 0 and bᵀy > ‖Aᵀy‖₁: the constraints have no solution
    point      (δ, ξ), near a solution of the constraints
    dual       y with Sᵀy = Mᵀd: dᵀx ≤ dᵀc + bᵀy + ‖Gᵀd - Aᵀy‖₁ for all x of the set
    rows       (y, λ), λ ≥ 0, of a set with inequalities: the same for dᵀx ≤ λᵀh + (d - Hᵀλ)ᵀx
    direction  d, along which two sets are apart, or one reaches beyond the other
    structure  follows from the form alone: there are no constraints

Solvers' numbers meet equations up to rounding only: they are moved onto them exactly first.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from . import rational

if TYPE_CHECKING:
    from .sets import Set

#: Bounds of representations with nominal rounding hold up to this share of the numbers in them.
SLACK = 1e-14


class _Form:
    """Blocks of a set as rational numbers."""

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

    def copy_of(self, **blocks: Any) -> "_Form":
        made = object.__new__(_Form)
        made.__dict__.update(self.__dict__)
        made.__dict__.update(blocks)
        return made

    def at(self, x: List[Fraction]) -> "_Form":
        """The factors that give x: rows Mδ + Gξ = x - c below the set's own."""
        return self.copy_of(S=self.S + self.M, A=self.A + self.G,
                            b=self.b + [a - c for a, c in zip(x, self.c)])

    def met_by(self, other: "_Form") -> "_Form":
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


def _columns(A: rational.Rows, y: List[Fraction], columns: int) -> List[Fraction]:
    return [rational.dot([row[j] for row in A], y) for j in range(columns)]


def _onto(form: _Form, y: List[Fraction], d: Optional[List[Fraction]]) -> Optional[List[Fraction]]:
    """y moved so that Sᵀy = Mᵀd (d None: 0), by as few entries as it takes."""
    if form.lines == 0:
        return y
    target = _columns(form.M, d, form.lines) if d is not None else [Fraction(0)] * form.lines
    missing = [t - v for t, v in zip(target, _columns(form.S, y, form.lines))]
    if not any(missing):
        return y
    if not form.S:
        return None
    order = sorted(range(len(y)), key=lambda i: -abs(y[i]))
    moved = rational.correction(rational.transposed(form.S, form.lines), missing, order)
    return None if moved is None else [a + b for a, b in zip(y, moved)]


def _form_bound(form: _Form, d: List[Fraction], y: List[Fraction]) -> Optional[Fraction]:
    """dᵀc + bᵀy + ‖Gᵀd - Aᵀy‖₁ for a y moved onto Sᵀy = Mᵀd."""
    moved = _onto(form, y, d)
    if moved is None:
        return None
    spread = [a - b for a, b in zip(_columns(form.G, d, form.generators),
                                    _columns(form.A, moved, form.generators))]
    return (rational.dot(d, form.c) + rational.dot(form.b, moved) +
            sum((abs(v) for v in spread), Fraction(0)))


def _bound(form: _Form, d: List[Fraction], kind: str, data: List[Fraction]) -> Optional[Fraction]:
    """An upper bound of dᵀx over the set, by a proof of kind dual, rows or structure."""
    rows = len(form.b)
    if kind == "structure":
        return _form_bound(form, d, [Fraction(0)] * rows)
    if kind == "dual" and len(data) == rows:
        return _form_bound(form, d, data)
    if kind == "rows" and len(data) == rows + len(form.h):
        multipliers = data[rows:]
        if any(v < 0 for v in multipliers):
            return None
        rest = [a - b for a, b in zip(d, _columns(form.H, multipliers, len(d)))]
        bound = _form_bound(form, rest, data[:rows])
        return None if bound is None else bound + rational.dot(form.h, multipliers)
    return None


def _has_no_solution(form: _Form, kind: str, data: List[Fraction]) -> bool:
    if kind == "farkas" and len(data) == len(form.b):
        y = _onto(form, data, None)
        if y is None:
            return False
        reach = sum((abs(v) for v in _columns(form.A, y, form.generators)), Fraction(0))
        return rational.dot(form.b, y) > reach
    if kind == "structure":  # a row 0 = b
        return any(b != 0 and not any(s) and not any(a)
                   for s, a, b in zip(form.S, form.A, form.b))
    if kind == "rows":
        bound = _bound(form, [Fraction(0)] * len(form.c), kind, data)
        return bound is not None and bound < 0
    return False


def _solution(form: _Form, data: List[Fraction]) -> Optional[List[Fraction]]:
    """(δ, ξ) moved onto the constraints, if ‖ξ‖∞ ≤ 1 is kept."""
    if len(data) != form.lines + form.generators:
        return None
    rows = [s + a for s, a in zip(form.S, form.A)]
    missing = [b - v for b, v in zip(form.b, rational.product(rows, data))]
    found = data
    if any(missing):
        def room(j: int) -> Fraction:  # free first, then those that are farthest from a bound
            return Fraction(2) if j < form.lines else 1 - abs(data[j])
        order = sorted(range(len(data)), key=lambda j: -room(j))
        moved = rational.correction(rows, missing, order)
        if moved is None:
            return None
        found = [a + b for a, b in zip(data, moved)]
    return found if all(abs(v) <= 1 for v in found[form.lines:]) else None


def _has_solution(form: _Form, kind: str, data: List[Fraction]) -> bool:
    if kind == "structure":
        return not form.b and not form.h
    if kind != "point":
        return False
    found = _solution(form, data)
    if found is None:
        return False
    x = _point(form, found)
    return all(v <= h for v, h in zip(rational.product(form.H, x), form.h))


def _point(form: _Form, factors: List[Fraction]) -> List[Fraction]:
    both = [m + g for m, g in zip(form.M, form.G)]
    return [c + v for c, v in zip(form.c, rational.product(both, factors))]


class Statement(NamedTuple):
    """What a certificate proves."""

    what: str  #: "empty", "not empty", "contains", "excludes", "support", …
    sets: Tuple["Set", ...]
    vector: Optional[np.ndarray] = None  #: the point or the direction
    bound: float = 0.0  #: of "support"

    @staticmethod
    def of_emptiness(X: "Set", status: str) -> "Statement":
        return Statement("empty" if status == "yes" else "not empty", (X,))

    @staticmethod
    def of_point(X: "Set", x: np.ndarray, status: str) -> "Statement":
        return Statement("contains" if status == "yes" else "excludes", (X,), x)

    @staticmethod
    def of_subset(X: "Set", Y: "Set", status: str) -> "Statement":
        return Statement("subset" if status == "yes" else "not a subset", (X, Y))

    @staticmethod
    def of_disjoint(X: "Set", Y: "Set", status: str) -> "Statement":
        return Statement("disjoint" if status == "yes" else "meet", (X, Y))

    @staticmethod
    def of_support(X: "Set", d: np.ndarray, bound: float) -> "Statement":
        return Statement("support", (X,), d, bound)


class Certificate:
    """A proof: `kind`, `data` (what the kind needs, shape (size,)), `margin` (by how much it holds),
    and the `statement` that it proves."""

    __slots__ = ("kind", "data", "margin", "statement")

    def __init__(self, kind: str, data: np.ndarray, margin: float, statement: Statement) -> None:
        self.kind = kind
        self.data = np.asarray(data, dtype=np.float64)
        self.margin = margin
        self.statement = statement

    def check(self) -> bool:
        """Repeats the proof in rational arithmetic. False: this proof does not hold, which says
        nothing of the statement itself. Bounds of representations with nominal rounding are compared
        with a slack of 1e-14 of the numbers in them; `proven_bound` has none."""
        if not np.isfinite(self.data).all():
            return False
        data = rational.vector(self.data)
        forms = [_Form(X.view()) for X in self.statement.sets]
        return _CHECKS[self.statement.what](self, forms, data)

    def proven_bound(self) -> Optional[Fraction]:
        """Of a support value: the bound that the proof proves, exactly. None: it proves none."""
        if self.statement.what != "support" or self.statement.vector is None:
            return None
        form = _Form(self.statement.sets[0].view())
        return _bound(form, rational.vector(self.statement.vector), self.kind,
                      rational.vector(self.data))

    def witness(self) -> Optional[np.ndarray]:
        """A direction, or a point of the set (of both sets), that shows it; None for other kinds."""
        what, X = self.statement.what, self.statement.sets[0]
        if self.kind == "direction":
            return self.data.copy()
        if what == "contains" or what == "excludes":
            return self.statement.vector
        if self.kind == "point":
            view = X.view()
            lines, generators = view["M"].shape[1], view["G"].shape[1]
            l_all = len(self.data) - generators
            if what == "meet":
                l_all = lines + self.statement.sets[1].view()["M"].shape[1]
            xi = self.data[l_all:l_all + generators]
            return view["c"] + view["M"] @ self.data[:lines] + view["G"] @ xi
        return None

    def __repr__(self) -> str:
        return f"<proof of {self.statement.what} by {self.kind}, margin {self.margin:.3g}>"

    __str__ = __repr__

    def __reduce__(self) -> Tuple[Any, ...]:
        return Certificate, (self.kind, self.data, self.margin, self.statement)


def _upper(X: "Set", d: np.ndarray) -> Optional[Fraction]:
    """A proven upper bound of dᵀx over X."""
    if X.view()["claim"] != "exact" and X.representation == "ellipsoid":
        return _ellipsoid_bound(X, d)
    found = X.support(d)
    return None if found.certificate is None else found.certificate.proven_bound()


def _ellipsoid_bound(X: "Set", d: np.ndarray) -> Optional[Fraction]:
    value = X.support(d).value  # of a formula, without a proof of its own
    return Fraction(value) if math.isfinite(value) else None


def _lower(X: "Set", d: np.ndarray) -> Optional[Fraction]:
    """dᵀx of a point that is proven to lie in X, near the largest."""
    form = _Form(X.view())
    direction = rational.vector(d)
    at = X.support(d).at
    if X.view()["claim"] != "exact" or form.h:
        return None
    if not form.b and form.lines == 0:
        spread = sum((abs(v) for v in _columns(form.G, direction, form.generators)), Fraction(0))
        return rational.dot(direction, form.c) + spread
    proof = None if at is None else X.contains(at).certificate
    if proof is None or proof.kind != "point":
        return None
    inward = [v if j < form.lines else v * (1 - Fraction(1, 10**12))
              for j, v in enumerate(rational.vector(proof.data))]
    found = _solution(form, inward)
    return None if found is None else rational.dot(direction, _point(form, found))


def _check_support(proof: Certificate, forms: List[_Form], data: List[Fraction]) -> bool:
    statement = proof.statement
    assert statement.vector is not None
    d = rational.vector(statement.vector)
    if proof.kind == "farkas":
        return _has_no_solution(forms[0], "farkas", data)
    if math.isinf(statement.bound):
        return False
    proven = _bound(forms[0], d, proof.kind, data)
    if proven is None:
        return False
    form = forms[0]
    size = sum((abs(a) * (abs(c) + sum((abs(g) for g in row), Fraction(0)))
                for a, c, row in zip(d, form.c, form.G)), Fraction(0))
    return proven <= Fraction(statement.bound) + Fraction(SLACK) * max(size, abs(proven))


def _check_excludes(proof: Certificate, forms: List[_Form], data: List[Fraction]) -> bool:
    assert proof.statement.vector is not None
    x = rational.vector(proof.statement.vector)
    form = forms[0]
    if proof.kind == "rows":
        multipliers = data[len(form.b):]
        if len(multipliers) != len(form.h) or any(v < 0 for v in multipliers):
            return False
        excess = [v - h for v, h in zip(rational.product(form.H, x), form.h)]
        return rational.dot(multipliers, excess) > 0
    if proof.kind == "direction":
        upper = _upper(proof.statement.sets[0], proof.data)
        return upper is not None and rational.dot(data, x) > upper
    return _has_no_solution(form.at(x), proof.kind, data)


def _check_contains(proof: Certificate, forms: List[_Form], data: List[Fraction]) -> bool:
    assert proof.statement.vector is not None
    x = rational.vector(proof.statement.vector)
    kept = all(v <= h for v, h in zip(rational.product(forms[0].H, x), forms[0].h))
    form = forms[0].at(x).copy_of(H=[], h=[])
    return kept and _has_solution(form, proof.kind, data)


def _check_disjoint(proof: Certificate, forms: List[_Form], data: List[Fraction]) -> bool:
    if proof.kind == "direction":
        X, Y = proof.statement.sets
        above, below = _upper(X, proof.data), _upper(Y, -proof.data)
        return above is not None and below is not None and above + below < 0
    return _has_no_solution(forms[0].met_by(forms[1]), proof.kind, data)


def _check_no_subset(proof: Certificate, forms: List[_Form], data: List[Fraction]) -> bool:
    if proof.kind != "direction":
        return False
    X, Y = proof.statement.sets
    reached, bound = _lower(X, proof.data), _upper(Y, proof.data)
    return reached is not None and bound is not None and reached > bound


_CHECKS = {
    "empty": lambda proof, forms, data: _has_no_solution(forms[0], proof.kind, data),
    "not empty": lambda proof, forms, data: _has_solution(forms[0], proof.kind, data),
    "contains": _check_contains,
    "excludes": _check_excludes,
    "support": _check_support,
    "disjoint": _check_disjoint,
    "meet": lambda proof, forms, data: _has_solution(forms[0].met_by(forms[1]), proof.kind, data),
    "not a subset": _check_no_subset,
    "subset": lambda proof, forms, data: _has_no_solution(forms[0], proof.kind, data),
}
