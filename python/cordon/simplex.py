# SPDX-License-Identifier: GPL-3.0-or-later
"""Solutions of equations between bounds, in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction
from typing import List, Optional, Sequence, Tuple

from .rational import Row, Rows

#: Beyond this many numbers the method is not begun.
LARGEST = 1500


def solution_within(A: Rows, r: Sequence[Fraction], lower: Sequence[Optional[Fraction]],
                    upper: Sequence[Optional[Fraction]]) -> Optional[Row]:
    """An x with A x = r and lower ≤ x ≤ upper, where lower ≤ 0 ≤ upper and None is no bound. None:
    there is none, or the equations are too many. Phase 1 of the simplex method with Bland's rule,
    x as the difference of what is above 0 and what is below."""
    parts: List[Tuple[int, int, Optional[Fraction]]] = []  # column, sign, bound
    for j, (low, high) in enumerate(zip(lower, upper)):
        for sign, bound in ((1, high), (-1, None if low is None else -low)):
            if bound is None or bound > 0:
                parts.append((j, sign, bound))
    if len(A) * len(parts) > LARGEST:
        return None
    table = _Table([[row[j] * sign for j, sign, _ in parts] for row in A], list(r),
                   [bound for _, _, bound in parts])
    if not table.solved():
        return None
    x = [Fraction(0)] * len(lower)
    for (j, sign, _), value in zip(parts, table.values()):
        x[j] += sign * value
    return x


class _Table:
    """Rows x_b + Σ T z = r ≥ 0 with 0 ≤ x ≤ bounds; the first basis is of variables that no row
    has, which are to become 0."""

    def __init__(self, T: Rows, r: Row, bounds: List[Optional[Fraction]]) -> None:
        self.T = [row if v >= 0 else [-a for a in row] for row, v in zip(T, r)]
        self.r = [abs(v) for v in r]
        self.bounds = bounds
        self.basis = [-1] * len(T)
        self.turned = [False] * len(bounds)  # bound - x is looked at in place of x

    def solved(self) -> bool:
        for _ in range(20 * (len(self.bounds) + len(self.r))):
            open_rows = [i for i, b in enumerate(self.basis) if b < 0]
            if not any(self.r[i] for i in open_rows):
                return True
            entering = next((k for k in range(len(self.bounds)) if k not in self.basis and
                             sum((self.T[i][k] for i in open_rows), Fraction(0)) > 0), None)
            if entering is None:
                return False
            self.enter(entering)
        return False

    def enter(self, k: int) -> None:
        step, row, above = self.bounds[k], -1, False
        for i, (line, value, b) in enumerate(zip(self.T, self.r, self.basis)):
            limit: Optional[Fraction] = None
            cap = None if b < 0 else self.bounds[b]
            if line[k] > 0:
                limit = value / line[k]
            elif line[k] < 0 and cap is not None:
                limit = (cap - value) / -line[k]
            if limit is None:
                continue
            first = row >= 0 and limit == step and b < self.basis[row]
            if step is None or limit < step or first:
                step, row, above = limit, i, line[k] < 0
        if row < 0:
            self.turn(k)
            return
        if above:
            self.turn_basic(row)
        pivot = self.T[row][k]
        self.T[row] = [v / pivot for v in self.T[row]]
        self.r[row] /= pivot
        for i, line in enumerate(self.T):
            factor = line[k]
            if i != row and factor:
                self.T[i] = [a - factor * b if b else a for a, b in zip(line, self.T[row])]
                self.r[i] -= factor * self.r[row]
        self.basis[row] = k

    def turn(self, k: int) -> None:
        """A variable outside the basis goes to its bound."""
        bound = self.bounds[k] or Fraction(0)
        for i, line in enumerate(self.T):
            self.r[i] -= line[k] * bound
            line[k] = -line[k]
        self.turned[k] = not self.turned[k]

    def turn_basic(self, row: int) -> None:
        b = self.basis[row]
        self.T[row] = [v if k == b else -v for k, v in enumerate(self.T[row])]
        self.r[row] = (self.bounds[b] or Fraction(0)) - self.r[row]
        self.turned[b] = not self.turned[b]

    def values(self) -> Row:
        found = [Fraction(0)] * len(self.bounds)
        for value, b in zip(self.r, self.basis):
            if b >= 0:
                found[b] = value
        return [(bound or Fraction(0)) - v if turned else v
                for v, bound, turned in zip(found, self.bounds, self.turned)]
