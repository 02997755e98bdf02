# SPDX-License-Identifier: GPL-3.0-or-later
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def examples() -> Path:
    return REPOSITORY / "examples" / "studies"


def inputs_and_outputs(results):
    """The data of a run as two arrays with a row per sample, of which none need have columns."""
    data = results.data
    return [np.column_stack([data[name] for name in data if name.startswith(letter)] or
                            [np.zeros((len(data["k"]), 0))]) for letter in ("u_", "y_")]
