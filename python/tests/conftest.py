# SPDX-License-Identifier: GPL-3.0-or-later
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def examples() -> Path:
    return REPOSITORY / "examples" / "studies"
