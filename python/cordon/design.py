# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs that make the outputs of all modes differ, whatever the disturbances are."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Union

import numpy as np

from . import _cordon
from .answers import Answer
from .arguments import text
from .errors import Error
from .written import Model, component_json, read, study_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .study import Study


class Design:
    """A designed input and what is proven of it.

    `u`: shape (samples, inputs), or None where none was found; `status`: "optimal", "feasible",
    "infeasible", "unknown" or "given", as the designer says; `separates`: proven over the rationals
    by the host; `cost`, `lower_bound`; `outcome` and `exact` as docs/results_format.md has them.
    """

    def __init__(self, found: Dict[str, Any]) -> None:
        self.name: str = found["name"]
        self.u: "Optional[NDArray[np.float64]]" = found.get("u")
        self.outcome: Dict[str, Any] = json.loads(found["outcome"]) or {}
        self.exact: Dict[str, Any] = json.loads(found["exact"]) or {}
        self.refuted: List[str] = found["refuted"]
        self.seconds: float = found["design_s"]
        self.status: str = self.outcome.get("status", "unknown")
        self.lower_bound: float = float(self.outcome.get("lower_bound", "-inf"))
        self.cost: float = float(self.outcome.get("cost", "inf"))
        self.separates = Answer(self.exact.get("separates", "unknown"), question="separates")

    def __repr__(self) -> str:
        return (f"<design {self.name}: {self.status}, cost {self.cost:g}, "
                f"separates: {self.separates}>")


def _designs(study: _cordon.Study, pipeline: str) -> List[Design]:
    made = []
    for found in _cordon.design(study, pipeline):
        if found["error"]:
            raise Error(f"{found['name']}: {found['error']}")
        made.append(Design(found))
    return made


def design_input(type: str, model: Model,
                 backend: Union[str, Mapping[str, Any]] = "constrained_zonotope",
                 **parameters: Any) -> Design:
    """Designs an input for the modes of a model; parameters have the names of studies."""
    pipeline = {"name": "design", "backend": component_json(backend, where="backend"),
                "designer": component_json(type, parameters, "designer")}
    study = Model.given(model).study([pipeline])
    return _designs(read(study, needs_data=False), "design")[0]


def designs_of(study: "Study", pipeline: str = "") -> List[Design]:
    """The designs of a study's pipelines with a designer, or of one of them."""
    given = study_of(study).checked(needs_data=False)
    return _designs(given, text(pipeline, "pipeline", "designed"))
