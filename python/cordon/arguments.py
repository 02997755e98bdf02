# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments that are checked before they go on: what was given, what is needed, what to do."""

from __future__ import annotations

import difflib
import operator
import reprlib
from typing import Any, List, Mapping, NoReturn, Optional, Sequence, Tuple

import numpy as np

from .errors import ArgumentError, ArgumentTypeError

#: Matrices of sets are dense: n × n numbers.
MOST_COORDINATES = 10_000
LARGEST_TIME = 2**53


def told(value: object) -> str:
    """A value as messages name it."""
    if isinstance(value, np.ndarray) and value.size > 4:
        return f"an array of shape {value.shape}"
    text = reprlib.repr(value)
    kind = type(value).__name__
    is_plain = value is None or isinstance(value, (int, float, str, list, tuple, dict, set))
    return text if is_plain or kind in text else f"{text} ({kind})"


def wrong_kind(name: str, needed: str, value: object) -> NoReturn:
    raise ArgumentTypeError(f"{name}: {needed}, not {told(value)}")


def count(value: object, name: str, lowest: int = 0, highest: int = LARGEST_TIME) -> int:
    """An integer from lowest to highest."""
    limits = (f"{lowest} or more" if highest == LARGEST_TIME else
              str(lowest) if highest == lowest else f"{lowest} to {highest}")
    if isinstance(value, (bool, np.bool_)) or not hasattr(value, "__index__"):
        wrong_kind(name, f"an integer is needed, {limits}", value)
    try:
        made = operator.index(value)
    except TypeError:
        wrong_kind(name, f"an integer is needed, {limits}", value)
    if not lowest <= made <= highest:
        raise ArgumentError(f"{name}: an integer is needed, {limits}, not {told(value)}")
    return made


def expect_few(given: object) -> None:
    """Neither a number of coordinates nor a vector that is too large."""
    number = given if isinstance(given, int) else 0
    if isinstance(given, (list, tuple)) or (isinstance(given, np.ndarray) and given.ndim > 0):
        number = len(given)
    if number > MOST_COORDINATES:
        raise ArgumentError(f"a set of {number} coordinates: the matrices of sets are dense, and "
                            f"at most {MOST_COORDINATES} coordinates are taken", "dimension")


def flag(value: object, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        wrong_kind(name, "True or False is needed", value)
    return bool(value)


def text(value: object, name: str, example: str) -> str:
    """A text; `example` is one in messages."""
    if not isinstance(value, str):
        wrong_kind(name, f"a text is needed, as {example!r}", value)
    return value


def suggestion(given: str, names: Sequence[str]) -> str:
    near = difflib.get_close_matches(given, names, 1)
    return f"did you mean {near[0]!r}?" if near else f"there are {', '.join(map(repr, names))}"


def choice(value: object, name: str, choices: Sequence[str]) -> str:
    """One of some texts."""
    given = text(value, name, choices[0])
    if given not in choices:
        listed = ", ".join(map(repr, choices))
        near = difflib.get_close_matches(given, choices, 1)
        raise ArgumentError(f"{name}: {given!r} is none of {listed}" +
                            (f"; did you mean {near[0]!r}?" if near else ""))
    return given


def mapping(value: object, name: str, example: str) -> Mapping[Any, Any]:
    if not isinstance(value, Mapping):
        wrong_kind(name, f"a dictionary is needed, as {example}", value)
    return value


def indices(value: object, name: str, what: str, number: int) -> List[int]:
    """Indices of `number` things, from 0; one alone or several."""
    one = isinstance(value, (str, bytes, Mapping)) or not hasattr(value, "__iter__")
    if one or not isinstance(value, (Sequence, np.ndarray, range)):
        wrong_kind(name, f"a list of indices is needed, as [0], from 0 to {number - 1}", value)
    found = [index(i, name, what, number) for i in value]
    if not found:
        raise ArgumentError(f"{name}: at least one index is needed, from 0 to {number - 1}")
    return found


def index(value: object, name: str, what: str, number: int) -> int:
    """An index of `number` things, from 0."""
    needed = f"an index is needed, from 0 to {number - 1}"
    if isinstance(value, (bool, np.bool_)) or not hasattr(value, "__index__"):
        wrong_kind(name, needed, value)
    try:
        made = operator.index(value)
    except TypeError:  # an array of several
        wrong_kind(name, needed, value)
    if not 0 <= made < number:
        raise ArgumentError(f"{name}: there is no {what} {made}; they are counted from 0, and "
                            f"there {'is' if number == 1 else 'are'} {number}")
    return made


def pair(value: object, name: str, number: int) -> Tuple[int, int]:
    """Two different coordinates of `number`."""
    if number < 2:
        raise ArgumentError(f"{name}: the set has {number} coordinate{'s' * (number != 1)}, and a "
                            "figure needs two; its bounds are X.hull(), and a second coordinate is "
                            "X.product(cordon.interval([0], [1]))")
    found = indices(value, name, "coordinate", number)
    if len(found) != 2 or found[0] == found[1]:
        raise ArgumentError(f"{name}: two different coordinates are needed, as (0, 1), not "
                            f"{told(value)}")
    return found[0], found[1]


def array(value: object, name: str, shape: Sequence[Optional[int]], meaning: str) -> Any:
    """Real numbers of a shape; None: any length. `meaning` names the axes."""
    try:
        made = np.asarray(value)
    except ValueError:
        made = np.asarray(None)
    if made.dtype.kind not in "fiu":
        wrong_kind(name, f"an array of numbers is needed, of shape {meaning}", value)
    fits = made.ndim == len(shape) and all(want in (None, have)
                                           for want, have in zip(shape, made.shape))
    if not fits:
        raise ArgumentError(f"{name}: the shape {meaning} is needed"
                            f"{_numbers(shape)}, not {made.shape}")
    return made.astype(float)


def _numbers(shape: Sequence[Optional[int]]) -> str:
    known = ", ".join("…" if n is None else str(n) for n in shape)
    return f", here ({known})"
