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

Solvers' numbers meet equations up to rounding only: they are moved onto them exactly first. What a
`direction` needs of the sets themselves is proven in the same way, after the library has proposed
it. Sets without an exact form (ellipsoids) are the exception: how far they reach along a direction
is taken from the library.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import (TYPE_CHECKING, Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Tuple,
                    Union)

import numpy as np

from . import rational
from .forms import (Form, bound_of, columns_of, has_no_solution, has_solution, onto, point_of,
                    reached, solution_near)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .sets import Set

    Floats = NDArray[np.float64]
    Bound = Union[Fraction, float]  # ±inf as a float

#: Bounds of zonotopes and boxes were rounded to nearest, and which multipliers are moved onto their
#: equations is a choice: this times the number of terms, as a share of the numbers in them.
SLACK = Fraction(1, 2**52)


class Statement(NamedTuple):
    """What a certificate proves."""

    what: str  #: "empty", "not empty", "contains", "excludes", "support", …
    sets: Tuple["Set", ...]
    vector: Optional[Floats] = None  #: the point or the direction
    bound: float = 0.0  #: of "support"

    @staticmethod
    def of_emptiness(X: "Set", status: str) -> "Statement":
        return Statement("empty" if status == "yes" else "not empty", (X,))

    @staticmethod
    def of_point(X: "Set", x: Floats, status: str) -> "Statement":
        return Statement("contains" if status == "yes" else "excludes", (X,), x)

    @staticmethod
    def of_subset(X: "Set", Y: "Set", status: str) -> "Statement":
        return Statement("subset" if status == "yes" else "not a subset", (X, Y))

    @staticmethod
    def of_disjoint(X: "Set", Y: "Set", status: str) -> "Statement":
        return Statement("disjoint" if status == "yes" else "meet", (X, Y))

    @staticmethod
    def of_support(X: "Set", d: Floats, bound: float) -> "Statement":
        return Statement("support", (X,), d, bound)

    def is_well_formed(self) -> bool:
        """Known, of sets of one dimension, with a finite vector of it where one is needed."""
        rule = _RULES.get(self.what)
        if rule is None or len(self.sets) != rule.sets or math.isnan(self.bound):
            return False
        n = self.sets[0].dim
        if any(X.dim != n for X in self.sets):
            return False
        if not rule.vector:
            return True
        return (self.vector is not None and np.shape(self.vector) == (n,) and
                bool(np.isfinite(self.vector).all()))


class Certificate:
    """A proof: `kind`, `data` (what the kind needs, shape (size,)), `margin` (by how much it
    holds), and the `statement` that it proves."""

    __slots__ = ("kind", "data", "margin", "statement")

    def __init__(self, kind: str, data: Floats, margin: float, statement: Statement) -> None:
        self.kind = kind
        self.data = np.array(data, dtype=np.float64)
        self.margin = margin
        self.statement = statement
        if self.data.ndim != 1:
            raise ValueError("data: a vector is needed")

    @staticmethod
    def of(proof: Optional[Tuple[Any, ...]], statement: Statement) -> Optional["Certificate"]:
        """What the library tells, if it can be checked: None where it is about the form of a set
        that this form only holds, or where a bound is infinite."""
        if proof is None or statement.what not in _RULES or statement.bound == math.inf:
            return None
        rule = _RULES[statement.what]
        kind, data, margin = proof
        exact = 1 if kind == "structure" else rule.exact
        if kind not in rule.kinds or not all(X.has_exact_form for X in statement.sets[:exact]):
            return None
        return Certificate(kind, data, margin, statement)

    def check(self) -> bool:
        """Repeats the proof in rational arithmetic. False: this proof does not hold, which says
        nothing of the statement itself. Bounds are compared with a slack of some units in
        the last place of the numbers in them; `proven_bound` has none."""
        if not self.statement.is_well_formed() or not np.isfinite(self.data).all():
            return False
        rule = _RULES[self.statement.what]
        forms = [Form(X.blocks()) for X in self.statement.sets]
        if self.kind not in rule.kinds or not all(form.exact for form in forms[:rule.exact]):
            return False
        return bool(rule.check(self, forms, rational.vector(self.data)))

    def proven_bound(self) -> Optional[Fraction]:
        """Of a support value: the bound that the proof proves, exactly. None: it proves none, or
        that the set is empty."""
        bound = self._proven()
        return bound if isinstance(bound, Fraction) else None

    def _proven(self) -> Optional[Bound]:
        """The same, -inf for a set that is proven empty."""
        if self.statement.what != "support" or not self.statement.is_well_formed():
            return None
        if not np.isfinite(self.data).all() or self.statement.vector is None:
            return None
        form, data = Form(self.statement.sets[0].blocks()), rational.vector(self.data)
        if has_no_solution(form, self.kind, data):
            return -math.inf
        return bound_of(form, rational.vector(self.statement.vector), self.kind, data)

    def witness(self) -> Optional[Floats]:
        """A direction, or a point of the set (of both sets), that shows it; else None."""
        what, X = self.statement.what, self.statement.sets[0]
        if self.kind == "direction":
            return self.data.copy()
        if self.statement.vector is not None and what in ("contains", "excludes"):
            return np.array(self.statement.vector, dtype=np.float64)
        if self.kind == "point":
            view = X.blocks()
            lines, generators = view["M"].shape[1], view["G"].shape[1]
            all_lines = sum(Y.blocks()["M"].shape[1] for Y in self.statement.sets)
            xi = self.data[all_lines:all_lines + generators]
            found: Floats = view["c"] + view["M"] @ self.data[:lines] + view["G"] @ xi
            return found
        return None

    def __repr__(self) -> str:
        return f"<proof of {self.statement.what} by {self.kind}, margin {self.margin:.3g}>"

    __str__ = __repr__

    def __reduce__(self) -> Tuple[Any, ...]:
        return Certificate, (self.kind, self.data, self.margin, self.statement)


def _vector(proof: Certificate) -> List[Fraction]:
    """The point or the direction that the statement is about."""
    given = proof.statement.vector
    return [] if given is None else rational.vector(given)


def _upper(X: "Set", d: Floats) -> Optional[Bound]:
    """A proven upper bound of dᵀx over X."""
    found = X.support(d)
    if found.certificate is not None:
        return found.certificate._proven()
    if X.has_exact_form and X.representation != "line_zonotope":
        # whose rows are those of the form, and one for each inequality
        proof = X.as_("line_zonotope").support(d).certificate
        form = Form(X.blocks())
        if proof is None or len(proof.data) != len(form.b) + len(form.h):
            return None
        data = rational.vector(proof.data)
        for i in range(len(form.b), len(data)):
            data[i] = max(data[i], Fraction(0))
        return bound_of(form, rational.vector(d), "rows", data)
    if X.has_exact_form or math.isnan(found.value) or found.value == math.inf:
        return None
    return found.value if math.isinf(found.value) else Fraction(found.value)


def _reached(X: "Set", form: Form, d: Floats) -> Iterator[Bound]:
    """dᵀx of points that are proven to lie in X, near the largest; inf where a line of X makes it
    as large as one likes."""
    direction = rational.vector(d)
    inside: Optional[List[Fraction]] = None
    if form.b or form.h:
        proof = X.is_empty().certificate
        if proof is None or proof.statement.what != "not empty" or not proof.check():
            return
        inside = solution_near(form, rational.vector(proof.data))
    if not form.h and onto(form, [Fraction(0)] * len(form.b), direction) is None:
        yield math.inf
    elif inside is None:
        spread = sum((abs(v) for v in columns_of(form.G, direction, form.generators)), Fraction(0))
        yield rational.dot(direction, form.c) + spread
    else:
        x = point_of(form, inside)
        yield rational.dot(direction, x)
        found = X.support(d)
        if found.certificate is not None and found.certificate.kind in ("dual", "rows"):
            yield from reached(form, direction, rational.vector(found.certificate.data), inside)
        middle: Floats = np.array([float(v) for v in x], dtype=np.float64)
        if found.at is None:
            return
        for share in (0.0, 1e-9, 1e-6, 1e-3):
            near = found.at + share * (middle - found.at)
            point = X.contains(near).certificate
            if point is not None and point.statement.what == "contains" and point.check():
                yield rational.dot(direction, rational.vector(near))


def _check_support(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    statement, form = proof.statement, forms[0]
    proven = proof._proven()
    if proven is None or statement.bound == math.inf:
        return False
    if not isinstance(proven, Fraction) or statement.bound == -math.inf:
        return proven == -math.inf
    size = sum((abs(a) * (abs(c) + sum((abs(g) for g in row), Fraction(0)))
                for a, c, row in zip(_vector(proof), form.c, form.G)), abs(proven))
    size += sum((abs(b * y) for b, y in zip(form.b, data)), Fraction(0))
    slack = SLACK * (form.dim + form.generators + 2) * size
    return bool(proven <= Fraction(statement.bound) + slack)


def _check_excludes(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    x = _vector(proof)
    form = forms[0]
    if proof.kind == "rows":
        multipliers = data[len(form.b):]
        if len(multipliers) != len(form.h) or any(v < 0 for v in multipliers):
            return False
        excess = [v - h for v, h in zip(rational.product(form.H, x), form.h)]
        return rational.dot(multipliers, excess) > 0
    if proof.kind == "direction":
        if len(data) != form.dim:
            return False
        upper = _upper(proof.statement.sets[0], proof.data)
        return upper is not None and bool(rational.dot(data, x) > upper)
    return has_no_solution(form.at(x), proof.kind, data)


def _check_contains(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    x = _vector(proof)
    kept = all(v <= h for v, h in zip(rational.product(forms[0].H, x), forms[0].h))
    form = forms[0].at(x).copy_of(H=[], h=[])
    return kept and has_solution(form, proof.kind, data)


def _check_disjoint(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    if proof.kind == "direction":
        X, Y = proof.statement.sets
        if len(data) != forms[0].dim:
            return False
        above, below = _upper(X, proof.data), _upper(Y, -proof.data)
        return above is not None and below is not None and above < -below
    return has_no_solution(forms[0].met_by(forms[1]), proof.kind, data)


def _check_no_subset(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    if len(data) != forms[0].dim:
        return False
    X, Y = proof.statement.sets
    bound = _upper(Y, proof.data)
    return bound is not None and any(value > bound
                                     for value in _reached(X, forms[0], proof.data))


def _check_empty(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    return has_no_solution(forms[0], proof.kind, data)


def _check_not_empty(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    return has_solution(forms[0], proof.kind, data)


def _check_meet(proof: Certificate, forms: List[Form], data: List[Fraction]) -> bool:
    return has_solution(forms[0].met_by(forms[1]), proof.kind, data)


class _Rule(NamedTuple):
    check: Callable[[Certificate, List[Form], List[Fraction]], bool]
    kinds: Tuple[str, ...]
    sets: int = 1
    exact: int = 0  #: of so many of the sets, a form that only holds them does not do
    vector: bool = False


_NOTHING, _SOMETHING = ("farkas", "rows", "structure"), ("point", "structure")
_RULES: Dict[str, _Rule] = {
    "empty": _Rule(_check_empty, _NOTHING),
    "not empty": _Rule(_check_not_empty, _SOMETHING, exact=1),
    "contains": _Rule(_check_contains, _SOMETHING, exact=1, vector=True),
    "excludes": _Rule(_check_excludes, _NOTHING + ("direction",), vector=True),
    "support": _Rule(_check_support, ("dual",) + _NOTHING, vector=True),
    "disjoint": _Rule(_check_disjoint, _NOTHING + ("direction",), sets=2),
    "meet": _Rule(_check_meet, _SOMETHING, sets=2, exact=2),
    "subset": _Rule(_check_empty, ("farkas", "rows"), sets=2),  # nothing is a part of everything
    "not a subset": _Rule(_check_no_subset, ("direction",), sets=2, exact=1),
}
