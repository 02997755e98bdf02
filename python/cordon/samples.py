# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded rows as samples."""

from __future__ import annotations

from typing import TYPE_CHECKING, AbstractSet, Any, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from .arguments import flag, wrong_kind
from .errors import ArgumentError, ArgumentTypeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Sample = Tuple[Optional["np.ndarray[Any, Any]"], "np.ndarray[Any, Any]", List[int]]


def missing_outputs(given: object) -> Sequence[int]:
    """What names missing outputs by their indices."""
    kinds = (Sequence, np.ndarray, AbstractSet)
    if isinstance(given, (str, bytes)) or not isinstance(given, kinds):
        wrong_kind("missing", "a list of indices of outputs is needed, as [0]", given)
    return given  # type: ignore[return-value]


def samples(u: "ArrayLike | None", y: "ArrayLike", nan_is_missing: bool) -> Iterator[Sample]:
    """Input, outputs and missing outputs of each row: u of shape (samples, inputs) or None, y of
    shape (samples, outputs). Shapes, and NaN that has not been said to mean a missing output, are
    looked for before the first one."""
    nan_is_missing = flag(nan_is_missing, "nan_is_missing")
    if any(isinstance(given, np.ma.MaskedArray) and given.mask.any() for given in (u, y)):
        raise ArgumentTypeError("entries of a masked array are masked, which are no numbers; those "
                                "of y that mean missing outputs are y.filled(numpy.nan), with "
                                "nan_is_missing=True")
    outputs = np.asarray(y)
    inputs = None if u is None else np.asarray(u)
    if outputs.ndim != 2 or (inputs is not None and inputs.ndim != 2):
        found = None if inputs is None else inputs.shape
        raise ArgumentError("y and u need a row per sample: shapes (samples, outputs) and (samples,"
                            f" inputs), not {outputs.shape} and {found}", "dimension")
    if inputs is not None and len(inputs) != len(outputs):
        raise ArgumentError(f"u has {len(inputs)} samples, y has {len(outputs)}", "dimension")
    if outputs.dtype.kind != "f":
        nan_is_missing = False  # integers are never missing
    elif not nan_is_missing and np.isnan(outputs).any():
        row, output = np.argwhere(np.isnan(outputs))[0]
        raise ArgumentError(f"y[{row}, {output}] is NaN; where that means a missing output, say "
                            "nan_is_missing=True", "not_finite")
    return ((None if inputs is None else inputs[i], row,
             np.flatnonzero(np.isnan(row)).tolist() if nan_is_missing else [])
            for i, row in enumerate(outputs))
