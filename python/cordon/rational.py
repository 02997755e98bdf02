# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact arithmetic on small arrays: every double is the rational number that it is."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, Iterable, List, Optional, Sequence

Row = List[Fraction]
Rows = List[Row]


def vector(values: Iterable[Any]) -> Row:
    return [Fraction(float(value)) for value in values]


def matrix(rows: Iterable[Iterable[Any]]) -> Rows:
    return [vector(row) for row in rows]


def dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b) if x and y), Fraction(0))


def product(A: Rows, x: Sequence[Fraction]) -> Row:
    return [dot(row, x) for row in A]


def transposed(A: Rows, columns: int) -> Rows:
    return [[row[j] for row in A] for j in range(columns)]


def correction(A: Rows, r: Sequence[Fraction], weights: Sequence[float]) -> Optional[Row]:
    """An x with A x = r that is 0 but in as many columns as there are independent rows: in those
    that have most weight, times the size of what the elimination leaves of them. None: there is
    none."""
    work = [list(row) + [value] for row, value in zip(A, r)]
    pivots: List[int] = []
    left = [j for j, weight in enumerate(weights) if weight > 0]
    done = 0
    while done < len(work) and left:
        best, at, column = max((_size(work[i][j]) * weights[j], -i, -j)
                               for i in range(done, len(work)) for j in left)
        if best == 0:
            break
        i, j = -at, -column
        work[done], work[i] = work[i], work[done]
        pivot = work[done]
        for i, row in enumerate(work):
            if i != done and row[j] != 0:
                factor = row[j] / pivot[j]
                work[i] = [a - factor * b if b else a for a, b in zip(row, pivot)]
        pivots.append(j)
        left.remove(j)
        done += 1
    if any(row[-1] != 0 for row in work[done:]):
        return None
    x = [Fraction(0)] * len(weights)
    for row, j in zip(work, pivots):
        x[j] = row[-1] / row[j]
    return x


def _size(value: Fraction) -> float:
    """|value| to the next power of 2 or so, never 0 for another number."""
    if value == 0:
        return 0.0
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return math.ldexp(1.0, max(-700, min(700, exponent)))


def spread(A: Rows, r: Sequence[Fraction], room: Sequence[Fraction]) -> Optional[Row]:
    """The solution W Aᵀy of A x = r, W the squares of `room` to a power of 2. None: there is
    none."""
    weights = [_power_of_4(value) for value in room]
    WAt = [[w * v for v in column] for w, column in zip(weights, transposed(A, len(room)))]
    N = [[dot(row, [line[k] for line in WAt]) for k in range(len(A))] for row in A]
    y = correction(N, r, [1.0] * len(A))
    return None if y is None else product(WAt, y)


def _power_of_4(value: Fraction) -> Fraction:
    """Near value², with few digits; of no value a tiny one."""
    if value <= 0:
        return Fraction(1, 4**200)
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return Fraction(4)**exponent
