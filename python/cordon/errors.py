# SPDX-License-Identifier: GPL-3.0-or-later
"""Exceptions of the package."""

from __future__ import annotations

from typing import Any, NamedTuple, Sequence, Tuple


class Problem(NamedTuple):
    """One problem of an input: where, what, and what to do about it."""

    pointer: str  #: JSON pointer of the offending value; "" is the whole
    message: str
    suggestion: str  #: may be empty
    line: int  #: of the file, from 1; 0: not known


class Error(Exception):
    """What every function of the package raises beside TypeError, ValueError and IndexError.

    `code` is the reason for programs: "dimension", "not_finite", "invalid", "unsupported",
    "not_enclosed", "solver", "time_limit", "plugin", "io", "violated", "internal".
    `problems` lists every problem of an input; of other errors it is empty.
    """

    def __init__(self, message: str, code: str = "invalid",
                 problems: Sequence[Tuple[Any, ...]] = ()) -> None:
        super().__init__(message)
        self.code = code
        self.problems = [Problem(*problem) for problem in problems]

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (str(self), self.code, [tuple(problem) for problem in self.problems])


class ArgumentError(Error, ValueError):
    """An argument of a wrong size, or with a value that it cannot have; the `code` is "dimension",
    "not_finite" or "invalid"."""


class ArgumentTypeError(ArgumentError, TypeError):
    """An argument of a wrong kind; a `TypeError` as well."""


class InputError(Error, ValueError):
    """A study, an argument or a file that is wrong, with all its problems in `problems`."""
