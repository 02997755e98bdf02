# SPDX-License-Identifier: GPL-3.0-or-later
"""Cordon: guaranteed, set-based state estimation, fault diagnosis and input design.

    sets       convex sets as values, answers with proofs      cordon.zonotope, cordon.interval, …
    estimate   set-based observers, sample by sample           cordon.Observer
    diagnose   which faults are possible                       cordon.Diagnoser
    design     inputs that tell faults apart                   cordon.design_input
    study      studies: read, changed, run, verified           cordon.Study
    session    a study's pipeline beside a plant, with alarms  cordon.Session
    results    what a run has left, as arrays                  cordon.Results
    plot       figures with matplotlib                         cordon.plot
    extend     observers, metrics and plants in Python         cordon.extend.register
    known      components and their parameters                 cordon.components, cordon.info
"""

from importlib import import_module as _import_module
from typing import Any as _Any
from typing import List as _List

from . import _cordon, extend
from .answers import Answer
from .certificates import Certificate, Statement
from .design import Design, design_input, designs_of
from .diagnose import Diagnoser, Diagnosis, FaultBound
from .errors import ArgumentError, ArgumentTypeError, Error, InputError, Problem
from .estimate import Estimate, Gain, Observer
from .extend import Law, conform
from .known import ComponentInfo, ParameterInfo, components, info
from .results import ComparedNumber, Comparison, Pipeline, Results, compare
from .session import Alarm, AlarmChange, Session, SessionStep, Taken
from .sets import (Hull, Set, Support, Volume, constrained_zonotope, empty, interval, line_zonotope,
                   point, polytope, space, strip, zonotope)
from .study import Study, SweepResults
from .written import Model

__version__ = _cordon.version()

__all__ = [
    "Alarm", "AlarmChange", "Answer", "ArgumentError", "ArgumentTypeError", "Certificate",
    "ComparedNumber", "Comparison", "ComponentInfo", "Design", "Diagnoser", "Diagnosis", "Error",
    "Estimate", "FaultBound", "Gain", "Hull", "InputError", "Law", "Model", "Observer",
    "ParameterInfo", "Pipeline", "Problem", "Results", "Session", "SessionStep", "Set",
    "Statement", "Study", "Support", "SweepResults", "Taken", "Volume", "compare", "components",
    "conform", "constrained_zonotope", "design_input", "designs_of", "empty", "extend", "info",
    "interval", "line_zonotope", "plot", "point", "polytope", "space", "strip", "zonotope",
]


def __dir__() -> _List[str]:
    """What is for users: no names of other modules, and `plot` before it is imported."""
    return sorted([*__all__, "__doc__", "__version__"])


def __getattr__(name: str) -> _Any:
    if name == "plot":  # matplotlib is imported when something is drawn
        return _import_module(".plot", __name__)
    raise AttributeError(f"module 'cordon' has no attribute {name!r}")
