# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact arithmetic on small arrays: every double is the rational number that it is."""

from __future__ import annotations

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


def correction(A: Rows, r: Sequence[Fraction], order: Sequence[int]) -> Optional[Row]:
    """An x with A x = r in which, of the columns in this order, the first independent ones alone
    are not 0. None: there is none."""
    work = [list(row) + [value] for row, value in zip(A, r)]
    columns = len(A[0]) if A else 0
    pivots: List[int] = []
    done = 0
    for j in order:
        if done == len(work):
            break
        at = max(range(done, len(work)), key=lambda i: abs(work[i][j]))
        if work[at][j] == 0:
            continue
        work[done], work[at] = work[at], work[done]
        pivot = work[done]
        for i, row in enumerate(work):
            if i != done and row[j] != 0:
                factor = row[j] / pivot[j]
                work[i] = [a - factor * b if b else a for a, b in zip(row, pivot)]
        pivots.append(j)
        done += 1
    if any(row[-1] != 0 for row in work[done:]):
        return None
    x = [Fraction(0)] * columns
    for row, j in zip(work, pivots):
        x[j] = row[-1] / row[j]
    return x
