# SPDX-License-Identifier: GPL-3.0-or-later
"""What Python would let a set be taken for, and what to write in its place."""

from __future__ import annotations

from typing import NoReturn


class Refused:
    """Operators that sets do not have."""

    __slots__ = ()

    def __bool__(self) -> bool:
        raise TypeError("a set is no truth value: whether it holds a point is X.is_empty().no")

    def __contains__(self, x: object) -> bool:
        raise TypeError("x in X is True or False, and whether a set holds a point may be unknown: "
                        "write X.contains(x).yes")

    def __matmul__(self, A: object) -> NoReturn:
        raise TypeError("X @ A is no operation of sets: the image {A x} is A @ X, with the matrix, "
                        "an array of numpy, on the left")

    def __rtruediv__(self, s: object) -> NoReturn:
        raise TypeError("a number is not divided by a set; {s x} is s * X")

    def __len__(self) -> int:
        raise TypeError("a set has no length: X.dim is the number of its coordinates, X.sizes what "
                        "it is made of")

    def __iter__(self) -> NoReturn:
        raise TypeError("a set is no sequence: its corners are X.vertices(), several sets are [X]")
