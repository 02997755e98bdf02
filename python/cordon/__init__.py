# SPDX-License-Identifier: GPL-3.0-or-later
"""Cordon: guaranteed, set-based state estimation, fault diagnosis and input design.

    sets       convex sets as values, answers with proofs      cordon.zonotope, cordon.interval, …
    estimate   set-based observers, sample by sample           cordon.Observer
    diagnose   which faults are possible                       cordon.Diagnoser
    design     inputs that tell faults apart                   cordon.design_inputs
    study      studies: read, changed, run, verified           cordon.Study
    results    what a run has left, as arrays                  cordon.Results
    plot       figures with matplotlib                         cordon.plot
"""

from .answers import Answer
from .certificates import Certificate, Statement
from .errors import Error, InputError, Problem
from .sets import (Hull, Set, Support, Volume, constrained_zonotope, empty, interval, line_zonotope,
                   point, polytope, space, strip, zonotope)

__all__ = [
    "Answer", "Certificate", "Error", "Hull", "InputError", "Problem", "Set", "Statement",
    "Support", "Volume", "constrained_zonotope", "empty", "interval", "line_zonotope", "point",
    "polytope", "space", "strip", "zonotope",
]
