# SPDX-License-Identifier: GPL-3.0-or-later
"""Cordon: guaranteed, set-based state estimation, fault diagnosis and input design.

    sets       convex sets as values, answers with proofs      cordon.zonotope, cordon.interval, …
    estimate   set-based observers, sample by sample           cordon.Observer
    diagnose   which faults are possible                       cordon.Diagnoser
    design     inputs that tell faults apart                   cordon.design_input
    study      studies: read, changed, run, verified           cordon.Study
    results    what a run has left, as arrays                  cordon.Results
    plot       figures with matplotlib                         cordon.plot
    extend     observers, metrics and plants in Python         cordon.extend.register
"""

from importlib import import_module
from typing import Any, List

from . import extend
from ._cordon import components as _components
from .answers import Answer
from .certificates import Certificate, Statement
from .design import Design, design_input, designs_of
from .diagnose import Diagnoser, Diagnosis, FaultBound
from .errors import ArgumentError, Error, InputError, Problem
from .estimate import Estimate, Gain, Observer
from .extend import Law, conform
from .results import ComparedNumber, Comparison, Pipeline, Results, compare
from .sets import (Hull, Set, Support, Volume, constrained_zonotope, empty, interval, line_zonotope,
                   point, polytope, space, strip, zonotope)
from .study import Study, SweepResults
from .written import Model

__all__ = [
    "Answer", "ArgumentError", "Certificate", "ComparedNumber", "Comparison", "Design",
    "Diagnoser", "Diagnosis", "Error", "Estimate", "FaultBound", "Gain", "Hull", "InputError",
    "Law", "Model", "Observer", "Pipeline", "Problem", "Results", "Set", "Statement", "Study",
    "Support", "SweepResults", "Volume", "compare", "components", "conform",
    "constrained_zonotope", "design_input", "designs_of", "empty", "extend", "interval",
    "line_zonotope", "point", "polytope", "space", "strip", "zonotope",
]


def components(kind: str) -> List[str]:
    """Names of the components of a kind: "backend", "observer", "diagnoser", "designer", "gain",
    "metric" or "plant"."""
    return _components(kind)


def __getattr__(name: str) -> Any:
    if name == "plot":  # matplotlib is imported when something is drawn
        return import_module(".plot", __name__)
    raise AttributeError(f"module 'cordon' has no attribute {name!r}")
