# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex sets as values.

    import cordon as co
    X = co.zonotope([0, 0], [[1, 0.5], [0, 1]])
    W = co.interval([-0.1, -0.1], [0.1, 0.1])
    Y = (A @ X + W).reduce(20)
    Y.contains([0.3, 0.2]).yes

Operations give a set of the left operand's representation that encloses the result. Arguments are
arrays, lists or numpy scalars of any real dtype; wrong shapes, NaN and what holds no numbers are
refused. Errors are `cordon.Error`.
"""

from __future__ import annotations

import math
from typing import (TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional, Tuple, Union)

import numpy as np

from . import _cordon, arguments
from .answers import Answer
from .certificates import Certificate, Statement
from .errors import ArgumentError, Error
from .refused import Refused

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


class Hull(NamedTuple):
    """A box around a set: `lower` and `upper`, shape (n,); `proofs` two per coordinate, of the
    upper bound and of the lower one, None where there is none to check again."""

    lower: Floats
    upper: Floats
    proofs: List[Optional[Certificate]]

    @property
    def widths(self) -> Floats:
        return self.upper - self.lower


class Support(NamedTuple):
    """An upper bound of sup{dᵀx : x ∈ X}: +inf if unbounded or unsolved, -inf if proven empty; `at`
    is a point of the set, up to rounding, where it is reached, None if none is known."""

    value: float
    at: Optional[Floats]
    certificate: Optional[Certificate]


class Volume(NamedTuple):
    """The volume, or an upper bound of it."""

    value: float
    exact: bool


class Set(Refused):
    """A closed convex subset of Rⁿ in some representation; immutable, shared by copies, used from
    several threads. Made by `interval`, `zonotope`, `constrained_zonotope`, `line_zonotope`,
    `strip`, `point`, `space`, `empty`, `polytope`, and by operations:

        A @ X     {A x}, A of shape (m, n)          X + Y   Minkowski sum; Y a set or a vector
        s * X     {s x}, s a number                 X & Y   intersection
        -X        {-x}                              X / s   {x / s}, s a power of two
    """

    __slots__ = ("_set", "_view", "_parameters", "_bounds")
    __array_ufunc__ = None  # numpy leaves A @ X and t + X to us

    def __init__(self, made: _cordon.ConvexSet,
                 parameters: Optional[Mapping[str, Any]] = None) -> None:
        if not isinstance(made, _cordon.ConvexSet):
            raise TypeError("sets are made by cordon.zonotope, cordon.interval and so on")
        arguments.expect_few(made.dim)
        self._set = made
        self._parameters = dict(parameters or {})  # of the representation, for copies elsewhere
        self._view: Optional[Dict[str, Any]] = None
        self._bounds: "Optional[Tuple[Floats, Floats]]" = None  # of what interval() has made

    # What it is

    @property
    def dim(self) -> int:
        """n."""
        return self._set.dim

    @property
    def representation(self) -> str:
        """Name of the representation: "zonotope", "interval", …"""
        return self._set.representation

    @property
    def claim(self) -> str:
        """"exact": equal to the mathematical result; "outer": encloses it."""
        return self._set.claim

    @property
    def sizes(self) -> Dict[str, int]:
        """Numbers of generators, lines, constraints and what else the representation counts."""
        return self._set.sizes

    def view(self) -> Dict[str, Any]:
        """The set as others compute with it: {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b} cut by H x ≤ h.
        Arrays by name, and "claim": "exact", that is the set; "outer", it holds the set."""
        return {name: value.copy() if isinstance(value, np.ndarray) else value
                for name, value in self.blocks().items()}

    def blocks(self) -> Dict[str, Any]:
        """What `view` gives, made once; its arrays cannot be written to."""
        if self._view is None:
            made = self._set.view()
            for value in made.values():
                if isinstance(value, np.ndarray):
                    value.flags.writeable = False
            self._view = made
        return self._view

    @property
    def has_exact_form(self) -> bool:
        """Is the view the set itself, and not one that holds it?"""
        return bool(self.blocks()["claim"] == "exact")

    def _made(self, made: _cordon.ConvexSet) -> "Set":
        return Set(made, self._parameters)

    # Operations

    def as_(self, representation: str, **parameters: Any) -> "Set":
        """An enclosure in another representation ("polytope", rounding="outward", …)."""
        name = arguments.text(representation, "representation", "zonotope")
        return Set(self._set.as_(name, parameters), parameters)

    def __rmatmul__(self, A: ArrayLike) -> "Set":
        return self._made(self._set.map(A))

    def __rmul__(self, s: ArrayLike) -> "Set":
        if np.ndim(s) != 0:
            raise TypeError("a set is multiplied by a number; by a matrix it is A @ X")
        return self._made(self._set.scale(s))

    __mul__ = __rmul__

    def __truediv__(self, s: float) -> "Set":
        if not isinstance(s, (int, float, np.integer, np.floating)) or isinstance(s, bool):
            raise TypeError(f"a set is divided by a number, not by {arguments.told(s)}")
        if s == 0 or abs(math.frexp(s)[0]) != 0.5:
            raise ArgumentError(f"X / {s}: 1 / {s} is no number of 64 bits, and {{x / {s}}} no set "
                                f"that is known exactly; (1 / {s}) * X takes the nearest number")
        return self._made(self._set.scale(1.0 / s))

    def __neg__(self) -> "Set":
        return self._made(self._set.scale(-1.0))

    def __add__(self, other: Union["Set", ArrayLike]) -> "Set":
        if isinstance(other, Set):
            return self._made(self._set.sum(other._set))
        return self._made(self._set.translate(other))

    def __radd__(self, other: ArrayLike) -> "Set":
        return self._made(self._set.translate(other))

    def __sub__(self, t: ArrayLike) -> "Set":
        if isinstance(t, Set):
            raise TypeError("X - Y is no operation of sets here: the sum with {-y} is X + (-Y)")
        return self._made(self._set.translate_back(t))

    def __and__(self, other: "Set") -> "Set":
        return self._made(self._set.intersection(_set(other, "the right operand of &")))

    def affine_map(self, A: ArrayLike, t: ArrayLike) -> "Set":
        """{A x + t}."""
        return self._made(self._set.affine_map(A, t))

    def intersect(self, R: ArrayLike, other: "Set") -> "Set":
        """{x ∈ X : R x ∈ other}, R of shape (other.dim, n)."""
        return self._made(self._set.intersect(R, _set(other, "other")))

    def correct(self, C: ArrayLike, y: ArrayLike, V: "Set") -> "Set":
        """{x ∈ X : y - C x ∈ V}: what a measurement leaves."""
        return self._made(self._set.correct(C, y, _set(V, "V")))

    def product(self, other: "Set") -> "Set":
        """X × other."""
        return self._made(self._set.product(_set(other, "other")))

    def convex_hull(self, other: "Set") -> "Set":
        """The closure of conv(X ∪ other)."""
        return self._made(self._set.convex_hull(_set(other, "other")))

    def reduce(self, generators: Optional[int] = None, constraints: Optional[int] = None) -> "Set":
        """An enclosure with at most so many generators and constraints."""
        return self._made(self._set.reduce(generators, constraints))

    # Questions

    def is_empty(self) -> Answer:
        """X = ∅?"""
        status, proof = self._set.is_empty()
        return self._answer("is_empty", status, proof, Statement.of_emptiness(self, status))

    def contains(self, x: ArrayLike) -> Answer:
        """x ∈ X?"""
        status, proof = self._set.contains(x)
        point = np.array(x, dtype=np.float64)
        return self._answer("contains", status, proof, Statement.of_point(self, point, status))

    def is_subset(self, other: "Set") -> Answer:
        """X ⊆ other?"""
        status, proof = self._set.is_subset(_set(other, "other"))
        return self._answer("is_subset", status, proof, Statement.of_subset(self, other, status))

    def is_disjoint(self, other: "Set") -> Answer:
        """X ∩ other = ∅?"""
        status, proof = self._set.is_disjoint(_set(other, "other"))
        statement = Statement.of_disjoint(self, other, status)
        return self._answer("is_disjoint", status, proof, statement)

    def is_bounded(self) -> Answer:
        """Is X bounded?"""
        status, _ = self._set.is_bounded()
        return Answer(status, question="is_bounded")

    def _answer(self, question: str, status: str, proof: Optional[Tuple[Any, ...]],
                statement: Statement) -> Answer:
        certificate = None if status == "unknown" else Certificate.of(proof, statement)
        witness = None if certificate is None else certificate.witness()
        return Answer(status, certificate, witness, question)

    # Measures

    def support(self, d: ArrayLike) -> Support:
        """An upper bound of sup{dᵀx : x ∈ X}, with its proof."""
        value, at, proof = self._set.support(d)
        direction = np.array(d, dtype=np.float64)
        statement = Statement.of_support(self, direction, value)
        return Support(value, at, Certificate.of(self._by_structure(value, proof), statement))

    def _by_structure(self, value: float, proof: Optional[Tuple[Any, ...]]) -> Any:
        """The proof, or for sets without constraints that their form is one."""
        blocks = self.blocks()
        if proof is not None or not self.has_exact_form or value == np.inf:
            return proof
        is_plain = not blocks["b"].size and not blocks["h"].size
        return ("structure", np.zeros(0), value) if is_plain or value == -np.inf else None

    def hull(self) -> Hull:
        """The smallest box around X as far as proven."""
        return self._hull_of(*self._set.hull())

    def _hull_of(self, lower: Floats, upper: Floats, proofs: List[Any]) -> Hull:
        if (lower > upper).any():  # empty, which is what is proven
            proofs = [self._set.is_empty()[1]] * len(proofs)
        made: List[Optional[Certificate]] = []
        for i, proof in enumerate(proofs):
            d = np.zeros(self.dim)
            d[i // 2] = 1 if i % 2 == 0 else -1
            bound = upper[i // 2] if i % 2 == 0 else -lower[i // 2]
            made.append(Certificate.of(self._by_structure(bound, proof),
                                       Statement.of_support(self, d, bound)))
        return Hull(lower, upper, made)

    def volume(self) -> Volume:
        """The volume, or an upper bound of it; +inf for unbounded sets with interior."""
        return Volume(*self._set.volume())

    def vertices(self) -> Floats:
        """The vertices of a bounded polytope, n ≤ 6, shape (count, n), computed in exact arithmetic
        and rounded to nearest; in two dimensions counter-clockwise."""
        if not self.has_exact_form:
            raise Error(f'vertices: this set of "{self.representation}" has no exact form in '
                        'doubles; take those of an enclosure, X.as_("constrained_zonotope").vertices()',
                        "unsupported")
        found = np.ascontiguousarray(self._set.vertices().T)
        if self.dim == 2 and len(found) > 2:
            middle = found - found.mean(axis=0)
            found = found[np.argsort(np.arctan2(middle[:, 1], middle[:, 0]))]
        return found

    def gauge(self, x: ArrayLike) -> Tuple[float, float]:
        """Proven bounds of inf{t ≥ 0 : x ∈ t X} for a set that holds 0."""
        return self._set.gauge(x)

    def plot(self, dims: Tuple[int, int] = (0, 1), ax: Any = None, **style: Any) -> Any:
        """Draws two coordinates of the set with matplotlib; returns the axes."""
        from . import plot
        return plot.sets([self], dims, ax, **style)

    # Copies and texts

    def __reduce__(self) -> Tuple[Any, ...]:
        if self._bounds is not None:
            return interval, self._bounds
        view = self.view()
        claim = "exact" if view.pop("claim") == "exact" and self.claim == "exact" else "outer"
        parameters = dict(self._parameters)
        if self._set.rounding == "outward":
            parameters.setdefault("rounding", self._set.rounding)
        return _restored, (view, claim, self.representation, parameters)

    def __copy__(self) -> "Set":
        return self

    def __deepcopy__(self, _: Any) -> "Set":
        return self

    def __str__(self) -> str:
        return str(self._set)

    def __repr__(self) -> str:
        return f"<{self._set}>"


def _set(given: object, name: str) -> _cordon.ConvexSet:
    if not isinstance(given, Set):
        arguments.wrong_kind(name, "a cordon set is needed, as cordon.interval([-1], [1])", given)
    return given._set


def _restored(blocks: Dict[str, Any], claim: str, representation: str,
              parameters: Mapping[str, Any]) -> Set:
    made = _cordon.ConvexSet.of_view(blocks, claim, representation, parameters)
    return Set(made, parameters)


def interval(lower: ArrayLike, upper: ArrayLike) -> Set:
    """{x : lower ≤ x ≤ upper}, shapes (n,); infinite bounds in both directions only. Kept as centre
    and radius, which are rounded outward: the set may be larger by a unit in the last place.
    Models and pickles have the bounds as they were given."""
    arguments.expect_few(lower)
    made = Set(_cordon.ConvexSet.box(lower, upper))
    made._bounds = np.array(lower, dtype=np.float64), np.array(upper, dtype=np.float64)
    return made


def zonotope(c: ArrayLike, G: ArrayLike) -> Set:
    """{c + Gξ : ‖ξ‖∞ ≤ 1}, shapes (n,) and (n, g)."""
    return Set(_cordon.ConvexSet.zonotope(c, G))


def constrained_zonotope(c: ArrayLike, G: ArrayLike, A: ArrayLike, b: ArrayLike) -> Set:
    """{c + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b}, shapes (n,), (n, g), (m, g), (m,)."""
    blocks = {"c": c, "G": G, "A": A, "b": b}
    return Set(_cordon.ConvexSet.of_view(blocks, "exact", "constrained_zonotope", {}))


def line_zonotope(c: ArrayLike, M: ArrayLike, G: ArrayLike, S: Optional[ArrayLike] = None,
                  A: Optional[ArrayLike] = None, b: Optional[ArrayLike] = None) -> Set:
    """{c + Mδ + Gξ : δ ∈ Rˡ, ‖ξ‖∞ ≤ 1, Sδ + Aξ = b}."""
    blocks = {"c": c, "M": M, "G": G, "S": S, "A": A, "b": b}
    given = {name: value for name, value in blocks.items() if value is not None}
    return Set(_cordon.ConvexSet.of_view(given, "exact", "line_zonotope", {}))


def strip(rho: ArrayLike, d: float, sigma: float) -> Set:
    """{x : |ρᵀx - d| ≤ σ}, a line zonotope."""
    return Set(_cordon.ConvexSet.strip(rho, d, sigma))


def point(x: ArrayLike, representation: str = "zonotope", **parameters: Any) -> Set:
    """{x}."""
    name = arguments.text(representation, "representation", "zonotope")
    return Set(_cordon.ConvexSet.point(x, name, parameters), parameters)


def space(n: int, representation: str = "line_zonotope", **parameters: Any) -> Set:
    """Rⁿ."""
    name = arguments.text(representation, "representation", "line_zonotope")
    count = arguments.count(n, "n", 0, arguments.MOST_COORDINATES)
    return Set(_cordon.ConvexSet.space(count, name, parameters), parameters)


def empty(n: int, representation: str = "line_zonotope", **parameters: Any) -> Set:
    """∅ in Rⁿ."""
    name = arguments.text(representation, "representation", "line_zonotope")
    count = arguments.count(n, "n", 0, arguments.MOST_COORDINATES)
    return Set(_cordon.ConvexSet.empty(count, name, parameters), parameters)


def polytope(H: ArrayLike, h: ArrayLike, representation: str = "polytope",
             **parameters: Any) -> Set:
    """{x : H x ≤ h}, shapes (r, n) and (r,), enclosed by a representation: exactly by "polytope",
    and by "constrained_zonotope" and "line_zonotope" where the set is bounded, or unbounded along
    lines only, and no number has to be rounded."""
    name = arguments.text(representation, "representation", "polytope")
    return Set(_cordon.ConvexSet.inequalities(H, h, name, parameters), parameters)
