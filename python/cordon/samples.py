# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded rows as samples."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator, List, Optional, Tuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Sample = Tuple[Optional["np.ndarray[Any, Any]"], "np.ndarray[Any, Any]", List[int]]


def samples(u: "ArrayLike | None", y: "ArrayLike", nan_is_missing: bool) -> Iterator[Sample]:
    """Input, outputs and missing outputs of each row: u of shape (samples, inputs) or None, y of
    shape (samples, outputs). Shapes are checked before the first one."""
    outputs = np.asarray(y)
    inputs = None if u is None else np.asarray(u)
    if outputs.ndim != 2 or (inputs is not None and inputs.ndim != 2):
        found = None if inputs is None else inputs.shape
        raise ValueError("y and u need a row per sample: shapes (samples, outputs) and (samples, "
                         f"inputs), not {outputs.shape} and {found}")
    if inputs is not None and len(inputs) != len(outputs):
        raise ValueError(f"u has {len(inputs)} samples, y has {len(outputs)}")
    if nan_is_missing and outputs.dtype.kind != "f":
        nan_is_missing = False  # integers are never missing
    return ((None if inputs is None else inputs[i], row,
             np.flatnonzero(np.isnan(row)).tolist() if nan_is_missing else [])
            for i, row in enumerate(outputs))
